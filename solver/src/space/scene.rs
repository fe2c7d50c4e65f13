//! What is to be simulated in three dimensions, as plain data.

use serde::{Deserialize, Serialize};

use super::mapping::Mapping;
use super::method::Method;
pub use super::shape::Shape;
use crate::error::SceneError;
use crate::method::{Density, Heating, Integrator, STRONGEST, STRONGEST_WHY};
use crate::units::Units;

/// A complete problem statement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Short name, for messages and records.
    pub name: String,
    /// Unit system of every number below.
    pub units: Units,
    /// Time at which the run ends, reached exactly.
    pub stop_time: f64,
    /// Numerical choices.
    pub method: Method,
    /// Plane walls.
    #[serde(default)]
    pub walls: Vec<Wall>,
    /// Materials, named by the bodies.
    pub materials: Vec<Material>,
    /// Bodies.
    pub bodies: Vec<Body>,
}

/// A rigid, frictionless wall at rest, normal to a coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Its normal: 0, 1 or 2 for x, y or z.
    pub axis: usize,
    /// Its position on that axis.
    pub position: f64,
    /// On which side of it the material is.
    pub material: Side,
    /// What it does to particles that start on it.
    pub hold: Hold,
}

/// A side of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// At larger coordinates.
    Above,
    /// At smaller coordinates.
    Below,
}

/// What a wall does to the nodes that start on it. Everything else it keeps on its side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hold {
    /// They stay on it and slide: a symmetry plane, mirroring the body.
    Mirror,
    /// They may leave it: an anvil.
    Rest,
}

/// A material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name, unique in the scene.
    pub name: String,
    /// Reference density `rho_o`.
    pub density: f64,
    /// Equation of state, Eq. (22).
    pub eos: EosData,
    /// Resistance to shear; none for a fluid, whose elements carry pressure alone.
    #[serde(default)]
    pub strength: Option<Strength>,
    /// What makes its elements fail, Eq. (47).
    #[serde(default)]
    pub failure: Failure,
}

/// Constants of an equation of state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum EosData {
    /// Mie-Grueneisen on the shock Hugoniot `U_s = c0 + s u_p`.
    MieGruneisen {
        /// Bulk sound speed `c0`.
        c0: f64,
        /// Slope `s`.
        s: f64,
        /// Grueneisen coefficient at the reference density.
        gamma_0: f64,
        /// How it varies with the density.
        law: GammaLaw,
        /// Specific heat `c_v`.
        c_v: f64,
        /// Temperature of the reference state.
        theta_0: f64,
    },
    /// Eq. (80): a gas, whose elements carry no tension.
    IdealGas {
        /// Ratio of specific heats.
        adiabatic_index: f64,
        /// Specific heat `c_v`.
        c_v: f64,
    },
}

/// How the Grueneisen coefficient varies with the density.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum GammaLaw {
    /// `Gamma rho = gamma_0 rho_o`.
    ConstantProduct,
    /// Steinberg: `Gamma = (gamma_0 + b mu) / (1 + mu)`, `mu = rho/rho_o - 1`.
    Steinberg(f64),
}

/// Resistance to shear.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strength {
    /// Shear modulus `mu` of Eq. (24).
    pub shear_modulus: f64,
    /// Yield stress; elastic without.
    #[serde(default)]
    pub flow: Option<Flow>,
}

/// A law of the yield stress `Y`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Flow {
    /// Eq. (44): `Y0 (1 + kappa eps)^alpha (1 - eta theta_H)`,
    /// `theta_H = (theta - reference) / (melt - reference)` within 0 and 1.
    Hardening {
        /// Reference yield stress `Y_o`.
        y_0: f64,
        /// Hardening coefficient `kappa`.
        kappa: f64,
        /// Hardening exponent `alpha`.
        alpha: f64,
        /// Thermal softening coefficient `eta`; negative hardens.
        eta: f64,
        /// Reference temperature.
        reference: f64,
        /// Melt temperature.
        melt: f64,
    },
    /// Johnson and Cook: `(a + b eps^n) (1 + c ln(rate / rate_0)) (1 - theta_H^m)`.
    JohnsonCook {
        /// Yield stress `A`.
        a: f64,
        /// Hardening `B`.
        b: f64,
        /// Hardening exponent `n`.
        n: f64,
        /// Rate coefficient `C`; no effect below the reference rate.
        c: f64,
        /// Reference strain rate, per unit of time of the scene.
        rate_0: f64,
        /// Exponent of the softening `m`.
        m: f64,
        /// Reference temperature.
        reference: f64,
        /// Melt temperature.
        melt: f64,
    },
}

/// Failure criteria of a material; absent ones are infinite or zero.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    /// Effective plastic strain, `eps_f`.
    pub plastic_strain: Option<f64>,
    /// Melt temperature `theta_m`.
    pub melt: Option<f64>,
    /// Smallest volume ratio `J_c` of an element.
    pub compression: f64,
    /// Tensile (spall) strength.
    pub spall: Option<f64>,
}

impl Default for Failure {
    fn default() -> Self {
        Self { plastic_strain: None, melt: None, compression: 0.3, spall: None }
    }
}

/// A body: a shape, filled with cells, equal ones unless they are mapped; particles at their nodes and
/// centroids.
///
/// The cell size is such that the cells have exactly the volume of the shape.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name, for histories.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// Shape.
    pub shape: Shape,
    /// Number of cells across the shape along its own axes.
    pub cells: [usize; 3],
    /// Where its centre is.
    pub centre: [f64; 3],
    /// Turn about this axis by this angle in degrees.
    #[serde(default)]
    pub turn: Turn,
    /// Velocity.
    pub velocity: [f64; 3],
    /// Angular velocity about the centre.
    #[serde(default)]
    pub spin: [f64; 3],
    /// Initial internal energy per mass.
    #[serde(default)]
    pub energy: f64,
    /// Largest random part of the initial velocity of a particle along each axis: a test of
    /// stability. The same in every run.
    #[serde(default)]
    pub noise: f64,
    /// Where the places of its lattice lie instead, for a box that is not turned; its cells are then
    /// unequal. Shape, cells and centre are those before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mapping: Option<Mapping>,
}

impl Body {
    /// Volume of the body, which its cells have but for the facets of curved faces.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let half = self.shape.extent().map(|edge| 0.5 * edge);
        let ends = [-1.0, 1.0].map(|side| std::array::from_fn(|d| self.centre[d] + side * half[d]));
        self.mapping.map_or(self.shape.volume(), |mapping| mapping.volume(ends))
    }
}

/// A rotation about an axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// Axis; any length but zero.
    pub axis: [f64; 3],
    /// Angle in degrees.
    pub degrees: f64,
}

impl Turn {
    /// What it makes of the coordinate axes.
    #[must_use]
    pub fn axes(&self) -> [[f64; 3]; 3] {
        super::lattice::rotation(self.axis, self.degrees.to_radians())
    }

    /// Checks that it is a turn about an axis.
    pub(super) fn validate(&self, key: &str) -> Result<(), SceneError> {
        for axis in 0..3 {
            finite(&format!("{key}.axis.{axis}"), self.axis[axis])?;
        }
        positive(&format!("{key}.axis"), self.axis.iter().map(|a| a * a).sum())?;
        finite(&format!("{key}.degrees"), self.degrees)
    }
}

impl Default for Turn {
    fn default() -> Self {
        Self { axis: [0.0, 0.0, 1.0], degrees: 0.0 }
    }
}

/// Longest edge of equal cells over the shortest.
const LONGEST_EDGE: f64 = 16.0;

/// Most particles of a scene.
const MAX_PARTICLES: usize = 50_000_000;

/// Most particles of a mapped body, every cell of which is looked at beforehand.
const MAX_MAPPED: usize = 2_000_000;

impl Scene {
    /// Index of the material called `name`.
    #[must_use]
    pub fn material_index(&self, name: &str) -> Option<usize> {
        self.materials.iter().position(|m| m.name == name)
    }

    /// Checks everything that a simulation takes for granted.
    ///
    /// # Errors
    /// The first value that cannot be used, with its key and the wanted form.
    pub fn validate(&self) -> Result<(), SceneError> {
        positive("stop_time", self.stop_time)?;
        self.method.validate()?;
        for (k, wall) in self.walls.iter().enumerate() {
            finite(&format!("walls.{k}.position"), wall.position)?;
            if wall.axis > 2 {
                let wanted = "the axis of a wall is 0, 1 or 2";
                return Err(SceneError::new(format!("walls.{k}.axis"), wall.axis, wanted));
            }
        }
        for (k, material) in self.materials.iter().enumerate() {
            material.validate(&format!("materials.{k}"))?;
            if self.material_index(&material.name) != Some(k) {
                let wanted = "names of materials must be unique";
                return Err(SceneError::new(format!("materials.{k}.name"), &material.name, wanted));
            }
        }
        if self.bodies.is_empty() || self.bodies.len() > 1000 {
            let wanted = "a scene has from 1 to 1000 bodies";
            return Err(SceneError::new("bodies", self.bodies.len(), wanted));
        }
        let mut particles = 0usize;
        for (k, body) in self.bodies.iter().enumerate() {
            let key = format!("bodies.{k}");
            let Some(material) = self.material_index(&body.material) else {
                let names = self.materials.iter().map(|material| material.name.as_str());
                return Err(SceneError::no_material(&key, &body.material, names));
            };
            particles = particles.saturating_add(body.validate(self.method.balance, &key)?);
            if body.mapping.is_some() && self.method.density != Density::Hybrid {
                let wanted = "contacts and kernels know equal cells alone, and its lattice is mapped: that needs `hybrid`";
                return Err(SceneError::new("method.density", self.method.density.name(), wanted));
            }
            let gas = matches!(self.materials[material].eos, EosData::IdealGas { .. });
            if body.mapping.is_some() && !gas && self.method.hourglass > 0.0 {
                let wanted = "it must be 0 with mapped bodies of solids: this stiffness does not turn with their \
                              cells; drag (`visc_hourglass_strong`) does";
                return Err(SceneError::new("method.hourglass", self.method.hourglass, wanted));
            }
        }
        if particles > MAX_PARTICLES {
            return Err(too_many(particles));
        }
        Ok(())
    }
}

fn too_many(particles: usize) -> SceneError {
    let wanted = format!("{MAX_PARTICLES} particles are the most");
    SceneError::new("bodies", format!("{particles} particles"), &wanted)
}

impl Method {
    fn validate(&self) -> Result<(), SceneError> {
        if self.integrator == Integrator::SinglePass && self.density == Density::Hybrid {
            let wanted = "elements that carry the pressure need `compatible`: their second pass";
            return Err(SceneError::new("method.integrator", self.integrator.name(), wanted));
        }
        if self.heating != Heating::Pair {
            let wanted = "in three dimensions there is `pair` alone: half to each particle";
            return Err(SceneError::new("method.heating", self.heating.name(), wanted));
        }
        if !(self.cfl > 0.0 && self.cfl <= 1.0) {
            return Err(SceneError::new("method.cfl", self.cfl, "it must be in (0, 1]"));
        }
        not_negative("method.limiter", self.limiter)?;
        let spread = (STRONGEST, STRONGEST_WHY);
        let dragged = (1.0, "modes stop before sound has crossed half of their cell");
        let locked = (10.0, "a mode that is so much stiffer than its cell cannot move");
        for (key, value, most) in [
            ("method.visc_linear", self.visc_linear, spread),
            ("method.visc_quad", self.visc_quad, spread),
            ("method.heat_coeff", self.heat_coeff, spread),
            ("method.visc_expansion", self.visc_expansion, spread),
            ("method.visc_volume", self.visc_volume, spread),
            ("method.visc_hourglass", self.visc_hourglass, dragged),
            ("method.visc_hourglass_strong", self.visc_hourglass_strong, dragged),
            ("method.hourglass", self.hourglass, locked),
            ("method.centring", self.centring, locked),
            ("method.balance", self.balance, (2.0, "it overshoots the balance, which is 1")),
            (
                "method.contact_tolerance",
                self.contact_tolerance,
                (0.3, "contacts reach through neighbours"),
            ),
        ] {
            SceneError::coefficient(key, value, most)?;
        }
        if !(1.0..1.3).contains(&self.contact_reach) {
            let wanted = "it must be from 1 to 1.3: beyond, contacts reach through neighbours";
            return Err(SceneError::new("method.contact_reach", self.contact_reach, wanted));
        }
        if !(1.1..=2.0).contains(&self.kernel_support) {
            let wanted = "it must be from 1.1 to 2: the nearest shell, and no more than two cells";
            return Err(SceneError::new("method.kernel_support", self.kernel_support, wanted));
        }
        match self.release {
            super::method::Release::Steps(n) => positive("method.release.steps", n),
            super::method::Release::Crossings(n) => positive("method.release.crossings", n),
        }
    }
}

impl Material {
    fn validate(&self, key: &str) -> Result<(), SceneError> {
        positive(&format!("{key}.density"), self.density)?;
        match self.eos {
            EosData::MieGruneisen { c0, s, gamma_0, c_v, theta_0, .. } => {
                let key = format!("{key}.eos.mie_gruneisen");
                positive(&format!("{key}.c0"), c0)?;
                not_negative(&format!("{key}.s"), s)?;
                not_negative(&format!("{key}.gamma_0"), gamma_0)?;
                positive(&format!("{key}.c_v"), c_v)?;
                finite(&format!("{key}.theta_0"), theta_0)?;
            }
            EosData::IdealGas { adiabatic_index, c_v } => {
                let key = format!("{key}.eos.ideal_gas");
                positive(&format!("{key}.adiabatic_index"), adiabatic_index - 1.0)?;
                positive(&format!("{key}.c_v"), c_v)?;
            }
        }
        if let Some(strength) = &self.strength {
            positive(&format!("{key}.strength.shear_modulus"), strength.shear_modulus)?;
            match strength.flow {
                Some(Flow::Hardening { y_0, kappa, alpha, eta, reference, melt }) => {
                    let key = format!("{key}.strength.flow.hardening");
                    not_negative(&format!("{key}.y_0"), y_0)?;
                    not_negative(&format!("{key}.kappa"), kappa)?;
                    not_negative(&format!("{key}.alpha"), alpha)?;
                    finite(&format!("{key}.eta"), eta)?;
                    positive(&format!("{key}.melt"), melt - reference)?;
                }
                Some(Flow::JohnsonCook { a, b, n, c, rate_0, m, reference, melt }) => {
                    let key = format!("{key}.strength.flow.johnson_cook");
                    not_negative(&format!("{key}.a"), a)?;
                    not_negative(&format!("{key}.b"), b)?;
                    positive(&format!("{key}.n"), n)?;
                    not_negative(&format!("{key}.c"), c)?;
                    positive(&format!("{key}.rate_0"), rate_0)?;
                    positive(&format!("{key}.m"), m)?;
                    positive(&format!("{key}.melt"), melt - reference)?;
                }
                None => {}
            }
        }
        let failure = &self.failure;
        not_negative(&format!("{key}.failure.compression"), failure.compression)?;
        for (name, value) in [
            ("plastic_strain", failure.plastic_strain),
            ("melt", failure.melt),
            ("spall", failure.spall),
        ] {
            if let Some(value) = value {
                positive(&format!("{key}.failure.{name}"), value)?;
            }
        }
        Ok(())
    }
}

impl Body {
    /// Checks the body, whose corners share volumes with this part of the opposite ones; an upper bound of
    /// its particles.
    fn validate(&self, balance: f64, key: &str) -> Result<usize, SceneError> {
        for (axis, &n) in self.cells.iter().enumerate() {
            if !(1..=16_000).contains(&n) {
                let wanted = "a body has from 1 to 16000 cells across";
                return Err(SceneError::new(format!("{key}.cells.{axis}"), n, wanted));
            }
        }
        for axis in 0..3 {
            finite(&format!("{key}.centre.{axis}"), self.centre[axis])?;
            finite(&format!("{key}.velocity.{axis}"), self.velocity[axis])?;
            finite(&format!("{key}.spin.{axis}"), self.spin[axis])?;
        }
        self.shape.validate(self.cells, &format!("{key}.shape"))?;
        self.turn.validate(&format!("{key}.turn"))?;
        not_negative(&format!("{key}.energy"), self.energy)?;
        not_negative(&format!("{key}.noise"), self.noise)?;
        if let Some(mapping) = &self.mapping {
            mapping.validate(&format!("{key}.mapping"))?;
            if !matches!(self.shape, Shape::Box { .. }) || self.turn.degrees != 0.0 {
                let wanted = "only a box that is not turned can be mapped";
                return Err(SceneError::new(
                    format!("{key}.mapping"),
                    format!("{mapping:?}"),
                    wanted,
                ));
            }
            let particles = self.most_particles();
            if particles > MAX_MAPPED {
                let wanted = format!("{MAX_MAPPED} particles are the most of a mapped body");
                let given = format!("{particles} particles");
                return Err(SceneError::new(format!("{key}.cells"), given, &wanted));
            }
            super::cells::check(self, balance, key)?;
            return Ok(particles);
        }
        let particles = self.most_particles();
        if particles > MAX_PARTICLES {
            return Err(too_many(particles));
        }
        if !super::lattice::fills(self) {
            let wanted =
                "no cell has its centre within the shape: smaller cells, or a thicker shape";
            return Err(SceneError::new(
                format!("{key}.cells"),
                format!("{:?}", self.cells),
                wanted,
            ));
        }
        let size = super::lattice::cell_size(self);
        let longest = size.iter().copied().fold(0.0, f64::max);
        let shortest = size.iter().copied().fold(f64::INFINITY, f64::min);
        if longest > LONGEST_EDGE * shortest {
            let [a, b, c] = self.cells;
            let wanted = format!(
                "that makes the longest edge of a cell {:.3} times its shortest, and {LONGEST_EDGE} is the \
                 most",
                longest / shortest
            );
            return Err(SceneError::new(
                format!("{key}.cells"),
                format!("[{a}, {b}, {c}]"),
                &wanted,
            ));
        }
        Ok(particles)
    }

    /// An upper bound of its particles.
    fn most_particles(&self) -> usize {
        self.cells.iter().fold(2, |all: usize, n| all.saturating_mul(n.saturating_add(1)))
    }
}

fn finite(key: &str, value: f64) -> Result<(), SceneError> {
    if value.is_finite() { Ok(()) } else { Err(SceneError::new(key, value, "it must be finite")) }
}

pub(super) fn positive(key: &str, value: f64) -> Result<(), SceneError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(SceneError::new(key, value, "it must be positive"))
    }
}

fn not_negative(key: &str, value: f64) -> Result<(), SceneError> {
    if value.is_finite() && value >= 0.0 {
        Ok(())
    } else {
        Err(SceneError::new(key, value, "it may not be negative"))
    }
}
