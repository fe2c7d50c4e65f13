//! Scenes that hard cases share. Units in three dimensions: cm, g, us, Mbar.

use whipple_solver::space::method::Method;
use whipple_solver::space::restart::{Section, Values};
use whipple_solver::space::scene::{
    Body, EosData, Failure, Flow, GammaLaw, Hold, Material, Scene, Shape, Side, Strength, Turn,
    Wall,
};
use whipple_solver::space::{Simulation, output::Particle};
use whipple_solver::units::Units;

use super::sheet::Trouble;
use crate::exact::InputError;
use crate::exact::gruneisen::MieGruneisen;
use crate::exact::hugoniot::Hugoniot;

/// A metal, with the constants of `references/materials.toml`: density, `c0`, `s`, Grueneisen's constant,
/// `c_v`.
pub(super) struct Metal {
    /// Its name.
    pub(super) name: &'static str,
    /// Its constants.
    pub(super) constants: [f64; 5],
    /// Shear modulus.
    pub(super) shear: f64,
}

pub(super) const COPPER: Metal =
    Metal { name: "copper", constants: [8.93, 0.394, 1.489, 2.02, 0.383e-5], shear: 0.477 };
pub(super) const ALUMINIUM: Metal =
    Metal { name: "aluminium", constants: [2.70, 0.5386, 1.339, 1.97, 0.884e-5], shear: 0.276 };
pub(super) const TUNGSTEN: Metal =
    Metal { name: "tungsten", constants: [17.6, 0.403, 1.237, 1.67, 0.143e-5], shear: 1.45 };
pub(super) const STEEL: Metal =
    Metal { name: "steel", constants: [7.87, 0.4578, 1.33, 1.67, 0.448e-5], shear: 0.801 };

impl Metal {
    /// Without strength.
    pub(super) fn fluid(&self) -> Material {
        let [density, c0, s, gamma_0, c_v] = self.constants;
        let law = GammaLaw::ConstantProduct;
        Material {
            name: self.name.into(),
            density,
            eos: EosData::MieGruneisen { c0, s, gamma_0, law, c_v, theta_0: 300.0 },
            strength: None,
            failure: Failure::default(),
        }
    }

    /// With shear, which never yields.
    pub(super) fn elastic(&self) -> Material {
        let strength = Some(Strength { shear_modulus: self.shear, flow: None });
        Material { strength, ..self.fluid() }
    }

    /// That hardens and fails: yield stress, hardening and its exponent, melt temperature (44).
    pub(super) fn ductile(&self, [y_0, kappa, alpha, melt]: [f64; 4]) -> Material {
        let flow = Flow::Hardening { y_0, kappa, alpha, eta: 1.0, reference: 300.0, melt };
        let failure = Failure { plastic_strain: Some(1.0), melt: Some(melt), ..Failure::default() };
        let strength = Some(Strength { shear_modulus: self.shear, flow: Some(flow) });
        Material { strength, failure, ..self.fluid() }
    }

    pub(super) fn density(&self) -> f64 {
        self.constants[0]
    }

    pub(super) fn sound(&self) -> f64 {
        self.constants[1]
    }

    pub(super) fn hugoniot(&self) -> Result<Hugoniot, InputError> {
        let [density, c0, s, ..] = self.constants;
        Hugoniot::new(density, c0, s)
    }

    pub(super) fn gruneisen(&self) -> Result<MieGruneisen, InputError> {
        MieGruneisen::constant_product(self.hugoniot()?, self.constants[3])
    }
}

/// Tungsten and steel that harden and fail, as in the rod impact.
pub(super) fn rod_metals() -> [Material; 2] {
    [TUNGSTEN.ductile([0.0105, 2.66, 0.12, 1723.0]), STEEL.ductile([0.0075, 5.67, 0.49, 1700.0])]
}

/// A gas whose elements never fail, of density 1 and unit specific heat.
pub(super) fn gas(adiabatic_index: f64) -> Material {
    Material {
        name: "gas".into(),
        density: 1.0,
        eos: EosData::IdealGas { adiabatic_index, c_v: 1.0 },
        strength: None,
        failure: Failure { compression: 0.0, ..Failure::default() },
    }
}

/// A body at rest in the middle, named like its material.
pub(super) fn body(material: &str, shape: Shape, cells: [usize; 3]) -> Body {
    Body {
        name: material.into(),
        material: material.into(),
        shape,
        cells,
        centre: [0.0; 3],
        turn: Turn::default(),
        velocity: [0.0; 3],
        spin: [0.0; 3],
        energy: 0.0,
        noise: 0.0,
        mapping: None,
    }
}

/// A box of cells with these edges.
pub(super) fn bricks(material: &str, cells: [usize; 3], edges: [f64; 3]) -> Body {
    let size = std::array::from_fn(|k| cells[k] as f64 * edges[k]);
    body(material, Shape::Box { size }, cells)
}

/// A box of cubic cells with this edge.
pub(super) fn block(material: &str, cells: [usize; 3], edge: f64) -> Body {
    bricks(material, cells, [edge; 3])
}

/// A scene of bodies alone.
pub(super) fn scene(method: Method, materials: Vec<Material>, bodies: Vec<Body>) -> Scene {
    Scene {
        name: "hard".into(),
        units: Units::CmGUsMbar,
        stop_time: 1.0,
        method,
        walls: Vec::new(),
        materials,
        bodies,
    }
}

/// A plane of symmetry.
pub(super) fn mirror(axis: usize, position: f64, material: Side) -> Wall {
    Wall { axis, position, material, hold: Hold::Mirror }
}

/// Mirrors that hold a column along x of these widths about the x axis.
pub(super) fn sleeve(widths: [f64; 2]) -> Vec<Wall> {
    let sides = |axis: usize| {
        let half = 0.5 * widths[axis - 1];
        [mirror(axis, -half, Side::Above), mirror(axis, half, Side::Below)]
    };
    [1, 2].into_iter().flat_map(sides).collect()
}

/// A tungsten rod of `n` cells across and `long` along that hits a steel plate at 60 degrees from its
/// normal, at 1.5 km/s.
pub(super) fn rod(method: Method, n: usize, long: usize, plate: [usize; 3]) -> Scene {
    let a = 0.5 / n as f64;
    let (s, c) = 60f64.to_radians().sin_cos();
    let half = 0.5 * long as f64 * a;
    let rod = Body {
        // Off the middle and by no round part of a cell: nothing is symmetric.
        centre: [-half * s, -0.9 * a - half * c - 0.25 * s, 0.237 * a],
        // From the third axis to (s, c, 0).
        turn: Turn { axis: [-c, s, 0.0], degrees: 90.0 },
        velocity: [0.15 * s, 0.15 * c, 0.0],
        ..body("tungsten", Shape::Cylinder { diameter: 0.5, length: 2.0 * half }, [n, n, long])
    };
    let plate = Body { centre: [0.0, 0.5 * a * plate[1] as f64, 0.0], ..block("steel", plate, a) };
    scene(method, rod_metals().into(), vec![rod, plate])
}

/// The scene after some steps of its own length.
pub(super) fn march(simulation: &mut Simulation, steps: usize) -> Result<(), Trouble> {
    for _ in 0..steps {
        simulation.step(f64::INFINITY)?;
    }
    Ok(())
}

/// Most steps of a run: one whose steps get so short is given up.
const MOST_STEPS: u64 = 200_000;

/// Steps until a time.
///
/// # Errors
/// A numerical failure, or too many steps, with the step and who decides it.
pub(super) fn advance(simulation: &mut Simulation, time: f64) -> Result<(), Trouble> {
    while simulation.time() < time {
        simulation.step(time)?;
        if simulation.counters().steps > MOST_STEPS {
            let voter = simulation.votes().last.map_or("nothing", |voter| voter.name());
            return Err(Trouble::Other(format!(
                "given up after {MOST_STEPS} steps at t = {:.4e} of {time:.4e}: the step is {:.2e}, decided by {voter}",
                simulation.time(),
                simulation.last_step()
            )));
        }
    }
    Ok(())
}

/// A new simulation of a scene whose particles have so much more in three columns of the state.
///
/// # Errors
/// As [`shift`].
pub(super) fn begin(
    scene: &Scene,
    names: [&str; 3],
    change: impl Fn(&Particle) -> [f64; 3],
) -> Result<Simulation, Trouble> {
    shift(scene, &Simulation::new(scene)?, names, change)
}

/// A simulation in the state of another of the same scene, but for three columns, such as those of
/// [`VELOCITY`]: `change` says how much is added there. Its books start there.
///
/// # Errors
/// A scene, or a state, that is refused.
pub(super) fn shift(
    scene: &Scene,
    simulation: &Simulation,
    names: [&str; 3],
    change: impl Fn(&Particle) -> [f64; 3],
) -> Result<Simulation, Trouble> {
    let added: Vec<(usize, [f64; 3])> =
        simulation.all_particles().map(|p| (p.id as usize, change(&p))).collect();
    let mut sections = simulation.sections();
    for Section { name, values } in &mut sections {
        let axis = names.iter().position(|own| own == name);
        match (values, axis) {
            (Values::F64(column), Some(axis)) => {
                added.iter().for_each(|(i, by)| column[*i] += by[axis]);
            }
            // What was done so far is none of what begins here.
            (Values::F64(books), _) if name == "run.ledger" => books.fill(0.0),
            (Values::U8(flags), _) if name == "group.awake" || name == "piece.active" => {
                flags.fill(1);
            }
            _ => {}
        }
    }
    let mut shifted = Simulation::new(scene)?;
    shifted.restore(&sections)?;
    shifted.start_books();
    Ok(shifted)
}

/// Columns of velocities.
pub(super) const VELOCITY: [&str; 3] = ["state.vx", "state.vy", "state.vz"];
/// Columns of displacements.
pub(super) const DISPLACEMENT: [&str; 3] = ["state.dx", "state.dy", "state.dz"];
/// Columns of energies and of the pressures that follow from them.
pub(super) const HEAT: [&str; 3] = ["state.u", "derived.pressure", "derived.grip"];

/// A number from -1 to 1 that looks random, the same in every run: the finaliser of `SplitMix64`.
pub(super) fn scatter(k: u64) -> f64 {
    let mut z = (k + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as f64 / 2f64.powi(63) - 1.0
}
