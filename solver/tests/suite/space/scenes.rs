//! Scenes that the tests in three dimensions share. Units: cm, g, us, Mbar.

use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::method::Method;
use whipple_solver::space::output::Particle;
use whipple_solver::space::restart::Values;
use whipple_solver::space::scene::{
    Body, EosData, Failure, Flow, GammaLaw, Hold, Material, Scene, Shape, Side, Strength, Turn,
    Wall,
};
use whipple_solver::units::Units;

/// A tungsten alloy and a steel, as hardening solids that fail.
pub fn tungsten() -> Material {
    solid("tungsten", [17.6, 0.403, 1.237, 1.67, 0.143e-5], 1.45, [0.0105, 2.66, 0.12, 1723.0])
}

pub fn steel() -> Material {
    solid("steel", [7.87, 0.4578, 1.33, 1.67, 0.448e-5], 0.801, [0.0075, 5.67, 0.49, 1700.0])
}

fn solid(
    name: &str,
    [density, c0, s, gamma_0, c_v]: [f64; 5],
    shear_modulus: f64,
    [y_0, kappa, alpha, melt]: [f64; 4],
) -> Material {
    let flow = Flow::Hardening { y_0, kappa, alpha, eta: 1.0, reference: 300.0, melt };
    Material {
        name: name.into(),
        density,
        eos: mie_gruneisen(c0, s, gamma_0, c_v),
        strength: Some(Strength { shear_modulus, flow: Some(flow) }),
        failure: Failure {
            plastic_strain: Some(1.0),
            melt: Some(melt),
            compression: 0.3,
            spall: None,
        },
    }
}

pub fn mie_gruneisen(c0: f64, s: f64, gamma_0: f64, c_v: f64) -> EosData {
    EosData::MieGruneisen { c0, s, gamma_0, law: GammaLaw::ConstantProduct, c_v, theta_0: 300.0 }
}

/// Copper without strength.
pub fn copper() -> Material {
    Material {
        name: "copper".into(),
        density: 8.93,
        eos: mie_gruneisen(0.394, 1.489, 2.02, 0.383e-5),
        strength: None,
        failure: Failure::default(),
    }
}

/// A gas whose elements live.
pub fn gas() -> Material {
    Material {
        name: "gas".into(),
        density: 1.0,
        eos: EosData::IdealGas { adiabatic_index: 1.4, c_v: 1.0 },
        strength: None,
        failure: Failure { compression: 0.0, ..Failure::default() },
    }
}

/// The same with strength.
pub fn strong(mut material: Material, shear_modulus: f64, flow: Option<Flow>) -> Material {
    material.strength = Some(Strength { shear_modulus, flow });
    material
}

/// A body at rest in the middle, not turned.
pub fn body(material: &str, shape: Shape, cells: [usize; 3]) -> Body {
    Body {
        name: "body".into(),
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

/// A box of cubic cells with this edge.
pub fn block(material: &str, cells: [usize; 3], edge: f64) -> Body {
    body(material, Shape::Box { size: cells.map(|n| n as f64 * edge) }, cells)
}

pub fn scene(materials: Vec<Material>, bodies: Vec<Body>) -> Scene {
    Scene {
        name: "test".into(),
        units: Units::CmGUsMbar,
        stop_time: 1.0,
        method: default(),
        walls: vec![],
        materials,
        bodies,
    }
}

pub fn default() -> Method {
    Preset::Default.space()
}

pub fn mirror(axis: usize, position: f64, material: Side) -> Wall {
    Wall { axis, position, material, hold: Hold::Mirror }
}

/// A rod of `n` cells across and `long` along that hits a plate at 60 degrees from its normal.
pub fn rod(n: usize, long: usize, plate: [usize; 3]) -> Scene {
    let a = 0.5 / n as f64;
    let (s, c) = 60f64.to_radians().sin_cos();
    let half = 0.5 * long as f64 * a;
    let rod = Body {
        name: "rod".into(),
        // Off the middle and by no round part of a cell: nothing is symmetric, no jump is almost nothing.
        centre: [-half * s, -0.9 * a - half * c - 0.25 * s, 0.237 * a],
        // From the third axis to (s, c, 0).
        turn: Turn { axis: [-c, s, 0.0], degrees: 90.0 },
        velocity: [0.15 * s, 0.15 * c, 0.0],
        ..body("tungsten", Shape::Cylinder { diameter: 0.5, length: 2.0 * half }, [n, n, long])
    };
    let plate = Body {
        name: "plate".into(),
        centre: [0.0, 0.5 * a * plate[1] as f64, 0.0],
        ..block("steel", plate, a)
    };
    scene(vec![tungsten(), steel()], vec![rod, plate])
}

/// The simulation of a scene that must be valid.
pub fn start(scene: &Scene) -> Simulation {
    Simulation::new(scene).expect("the scene of a test is valid")
}

/// The scene after some steps.
pub fn after(scene: &Scene, steps: usize) -> Simulation {
    let mut simulation = start(scene);
    march(&mut simulation, steps);
    simulation
}

pub fn march(simulation: &mut Simulation, steps: usize) {
    for _ in 0..steps {
        simulation.step(f64::INFINITY).expect("the scene of a test runs");
    }
}

/// The bits of everything that can be seen of a simulation.
pub fn bits(simulation: &Simulation) -> Vec<u64> {
    let particles = simulation.all_particles().flat_map(|p| {
        let [x, y, z] = p.position;
        let [vx, vy, vz] = p.velocity;
        [x, y, z, vx, vy, vz, p.rho, p.pressure, p.theta, p.u, p.held]
    });
    let elements = simulation
        .all_elements()
        .flat_map(|e| [e.strain, e.damage, e.equivalent_stress, f64::from(u8::from(e.live))]);
    particles.chain(elements).chain([simulation.time()]).map(f64::to_bits).collect()
}

/// Sets every particle moving.
pub fn push(simulation: &mut Simulation, velocity: impl Fn(&Particle) -> [f64; 3]) {
    let moving: Vec<_> =
        simulation.all_particles().map(|p| (p.id as usize, velocity(&p))).collect();
    let mut sections = simulation.sections();
    for section in &mut sections {
        let axis = ["state.vx", "state.vy", "state.vz"].iter().position(|n| *n == section.name);
        match (&mut section.values, axis) {
            (Values::F64(column), Some(axis)) => {
                moving.iter().for_each(|(i, v)| column[*i] += v[axis]);
            }
            (Values::U8(flags), _) if section.name.ends_with("awake") => flags.fill(1),
            (Values::U8(flags), _) if section.name.ends_with("active") => flags.fill(1),
            _ => {}
        }
    }
    simulation.restore(&sections).expect("its own sections");
    simulation.start_books();
}
