//! What is to be simulated, as plain data: written as TOML, kept in records as JSON.
//!
//! A [`Scene`] is validated once, by [`Scene::validate`], and frozen into a simulation. Invariant:
//! nothing past validation looks at strings or checks input again.

use serde::{Deserialize, Serialize};

use crate::error::SceneError;
use crate::method::{Conduction, Density, Method, STRONGEST, STRONGEST_WHY};
use crate::units::Units;

/// Largest number of particles that a scene may ask for.
pub const MAX_PARTICLES: usize = 100_000_000;

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
    /// What stands at the two ends.
    pub boundaries: Boundaries,
    /// Materials, named by the bodies.
    pub materials: Vec<Material>,
    /// Bodies, from left to right.
    pub bodies: Vec<Body>,
}

/// The two ends of a one-dimensional scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Boundaries {
    /// Left end.
    pub left: Boundary,
    /// Right end.
    pub right: Boundary,
}

/// What stands at an end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Boundary {
    /// Nothing.
    Free,
    /// A rigid wall at rest at this position, at the face of the outermost body, modelled by mirror
    /// images of the particles. For a solid it is a symmetry plane: the body stays bonded to its
    /// image.
    Mirror(f64),
    /// The outermost particle is held where it is.
    Fixed,
    /// A constant pressure on the outermost particle; negative pulls.
    Pressure(f64),
}

/// A material: reference density, equation of state, and whether it resists tension.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name, unique in the scene.
    pub name: String,
    /// Reference density `rho_o`.
    pub density: f64,
    /// Equation of state, Eq. (22).
    pub eos: EosData,
}

/// Constants of an equation of state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum EosData {
    /// Eq. (80): a gas, which has no tensile strength.
    IdealGas {
        /// Ratio of specific heats, `gamma` of Eq. (80).
        adiabatic_index: f64,
        /// Specific heat at constant volume, `c_v`.
        c_v: f64,
        /// Internal energy per mass of the cold gas, `u_o`.
        u_0: f64,
        /// Temperature of the cold gas, `theta_o`.
        theta_0: f64,
    },
    /// Eq. (83): an elastic solid, whose tension the segment elements carry, Eq. (25).
    Linear {
        /// Bulk modulus `K`.
        bulk: f64,
        /// Specific heat at constant volume, `c_v`.
        c_v: f64,
        /// Temperature at zero internal energy.
        theta_0: f64,
    },
}

/// Where the particles of a body sit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    /// At the centres of equal cells: every particle has the mass of a cell.
    Centres,
    /// At the nodes of equal cells, both ends included: the end particles have half the mass.
    Nodes,
}

/// How a body meets the one on its left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Interface {
    /// Free to separate; they push while `zeta < 1`, Eq. (35).
    Contact,
    /// One continuous medium.
    Joined,
}

/// A stretch of particles of one material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name of its material.
    pub material: String,
    /// Left face.
    pub from: f64,
    /// Right face.
    pub to: f64,
    /// Number of particles.
    pub particles: usize,
    /// Where the particles sit.
    pub layout: Layout,
    /// Initial density over the reference density of the material.
    pub compression: f64,
    /// How it meets the body on its left; without meaning for the first.
    pub interface: Interface,
    /// Initial velocity.
    pub velocity: Profile,
    /// Initial internal energy per unit mass, `u`.
    pub energy: Profile,
}

/// An initial field over a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Profile {
    /// The same value everywhere.
    Uniform(f64),
    /// `at_origin + slope * x`.
    Linear {
        /// Value at x = 0.
        at_origin: f64,
        /// Change per length.
        slope: f64,
    },
    /// `mean + amplitude * cos(pi * mode * (x - from) / (to - from))`.
    Cosine {
        /// Mean value.
        mean: f64,
        /// Amplitude.
        amplitude: f64,
        /// Number of half waves over the body.
        mode: f64,
    },
}

impl Profile {
    /// Value at `x` in a body from `from` to `to`.
    #[must_use]
    pub fn at(self, x: f64, (from, to): (f64, f64)) -> f64 {
        match self {
            Self::Uniform(value) => value,
            Self::Linear { at_origin, slope } => at_origin + slope * x,
            Self::Cosine { mean, amplitude, mode } => {
                mean + amplitude * (std::f64::consts::PI * mode * (x - from) / (to - from)).cos()
            }
        }
    }

    /// A value that it nowhere falls below in a body from `from` to `to`.
    fn lowest(self, (from, to): (f64, f64)) -> f64 {
        match self {
            Self::Cosine { mean, amplitude, .. } => mean - amplitude.abs(),
            Self::Uniform(_) | Self::Linear { .. } => {
                self.at(from, (from, to)).min(self.at(to, (from, to)))
            }
        }
    }

    fn check(self, key: &str) -> Result<(), SceneError> {
        match self {
            Self::Uniform(value) => finite(key, value),
            Self::Linear { at_origin, slope } => {
                finite(&format!("{key}.linear.at_origin"), at_origin)?;
                finite(&format!("{key}.linear.slope"), slope)
            }
            Self::Cosine { mean, amplitude, mode } => {
                finite(&format!("{key}.cosine.mean"), mean)?;
                finite(&format!("{key}.cosine.amplitude"), amplitude)?;
                finite(&format!("{key}.cosine.mode"), mode)
            }
        }
    }
}

impl Body {
    /// Position and share of a cell's mass of particle `k`.
    #[must_use]
    pub fn particle(&self, k: usize) -> (f64, f64) {
        let size = self.cell();
        match self.layout {
            Layout::Centres => (self.from + (k as f64 + 0.5) * size, 1.0),
            Layout::Nodes => {
                let end = k == 0 || k + 1 == self.particles;
                let x = if k + 1 == self.particles { self.to } else { self.from + k as f64 * size };
                (x, if end { 0.5 } else { 1.0 })
            }
        }
    }

    /// Size of a cell, which is the particle spacing.
    #[must_use]
    pub fn cell(&self) -> f64 {
        let cells = match self.layout {
            Layout::Centres => self.particles,
            Layout::Nodes => self.particles - 1,
        };
        (self.to - self.from) / cells as f64
    }
}

impl EosData {
    /// Smallest internal energy per mass that the equation of state accepts.
    #[must_use]
    pub fn cold_energy(&self) -> f64 {
        match *self {
            Self::IdealGas { u_0, .. } => u_0,
            Self::Linear { .. } => 0.0,
        }
    }

    fn check(&self, key: &str) -> Result<(), SceneError> {
        match *self {
            Self::IdealGas { adiabatic_index, c_v, u_0, theta_0 } => {
                let key = format!("{key}.ideal_gas");
                if !(adiabatic_index.is_finite() && adiabatic_index > 1.0) {
                    let key = format!("{key}.adiabatic_index");
                    return Err(SceneError::new(key, adiabatic_index, "it must be above 1"));
                }
                positive(&format!("{key}.c_v"), c_v)?;
                not_negative(&format!("{key}.u_0"), u_0)?;
                finite(&format!("{key}.theta_0"), theta_0)
            }
            Self::Linear { bulk, c_v, theta_0 } => {
                let key = format!("{key}.linear");
                positive(&format!("{key}.bulk"), bulk)?;
                positive(&format!("{key}.c_v"), c_v)?;
                finite(&format!("{key}.theta_0"), theta_0)
            }
        }
    }
}

impl Scene {
    /// Number of particles in all bodies.
    #[must_use]
    pub fn particles(&self) -> usize {
        self.bodies.iter().fold(0, |n, b| n.saturating_add(b.particles))
    }

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
        self.check_materials()?;
        self.check_bodies()?;
        self.check_boundary("boundaries.left", self.boundaries.left, true)?;
        self.check_boundary("boundaries.right", self.boundaries.right, false)
    }

    fn check_materials(&self) -> Result<(), SceneError> {
        if self.materials.len() > usize::from(u16::MAX) {
            let (given, wanted) = (self.materials.len(), "65535 materials are the most");
            return Err(SceneError::new("materials", given, wanted));
        }
        for (k, material) in self.materials.iter().enumerate() {
            let key = format!("materials.{k}");
            positive(&format!("{key}.density"), material.density)?;
            material.eos.check(&format!("{key}.eos"))?;
            if self.material_index(&material.name) != Some(k) {
                let wanted = "names of materials must be unique";
                return Err(SceneError::new(format!("{key}.name"), &material.name, wanted));
            }
            let solid = |m: &Material| matches!(m.eos, EosData::Linear { .. });
            if solid(material) != solid(&self.materials[0]) {
                let wanted = "gases and solids cannot share a one-dimensional scene yet";
                return Err(SceneError::new(format!("{key}.eos"), &material.name, wanted));
            }
        }
        Ok(())
    }

    fn check_bodies(&self) -> Result<(), SceneError> {
        if self.bodies.is_empty() {
            return Err(SceneError::new("bodies", "empty", "a scene needs a body"));
        }
        if self.bodies.len() > usize::from(u16::MAX) {
            return Err(SceneError::new("bodies", self.bodies.len(), "65535 bodies are the most"));
        }
        let mut previous: Option<&Body> = None;
        for (k, body) in self.bodies.iter().enumerate() {
            let key = |name: &str| format!("bodies.{k}.{name}");
            if body.particles < 2 {
                let wanted = "a body needs at least 2 particles";
                return Err(SceneError::new(key("particles"), body.particles, wanted));
            }
            let Some(index) = self.material_index(&body.material) else {
                let names = self.materials.iter().map(|material| material.name.as_str());
                let body_key = format!("bodies.{k}");
                return Err(SceneError::no_material(&body_key, &body.material, names));
            };
            finite(&key("from"), body.from)?;
            finite(&key("to"), body.to)?;
            positive(&key("compression"), body.compression)?;
            if body.to <= body.from {
                return Err(SceneError::new(key("to"), body.to, "it must be right of `from`"));
            }
            for (name, profile) in [("velocity", body.velocity), ("energy", body.energy)] {
                profile.check(&key(name))?;
                // A slope may be finite and still lead beyond the numbers.
                finite(&key(name), profile.at(body.from, (body.from, body.to)))?;
                finite(&key(name), profile.at(body.to, (body.from, body.to)))?;
            }
            self.check_energy(body, index, &key("energy"))?;
            if let Some(left) = previous {
                // Faces may touch; the last digit of a computed face is forgiven.
                if body.from < left.to - 1e-9 * left.cell() {
                    let wanted = "bodies are listed from left to right and may not overlap";
                    return Err(SceneError::new(key("from"), body.from, wanted));
                }
                // Nodes of touching bodies would coincide.
                if body.particle(0).0 <= left.particle(left.particles - 1).0 {
                    let wanted =
                        "its first particle must be right of the last one of the body before";
                    return Err(SceneError::new(key("from"), body.from, wanted));
                }
                if body.interface == Interface::Joined && body.from > left.to + 1e-9 * left.cell() {
                    let wanted = "a joined body must touch the one on its left";
                    return Err(SceneError::new(key("from"), body.from, wanted));
                }
            }
            previous = Some(body);
        }
        let n = self.particles();
        if n > MAX_PARTICLES {
            let wanted = format!("{MAX_PARTICLES} particles are the most");
            return Err(SceneError::new("bodies", format!("{n} particles"), &wanted));
        }
        Ok(())
    }

    fn check_energy(&self, body: &Body, material: usize, key: &str) -> Result<(), SceneError> {
        let floor = self.materials[material].eos.cold_energy();
        let lowest = body.energy.lowest((body.from, body.to));
        if lowest < floor {
            let wanted = format!("it may not be below {floor}, the cold energy of its material");
            return Err(SceneError::new(key, lowest, &wanted));
        }
        Ok(())
    }

    fn check_boundary(&self, key: &str, b: Boundary, left: bool) -> Result<(), SceneError> {
        match b {
            Boundary::Free | Boundary::Fixed => Ok(()),
            Boundary::Pressure(p) => finite(&format!("{key}.pressure"), p),
            Boundary::Mirror(wall) => {
                let key = format!("{key}.mirror");
                finite(&key, wall)?;
                let (first, last) = (&self.bodies[0], &self.bodies[self.bodies.len() - 1]);
                let (body, x, inward) = if left {
                    (first, first.particle(0).0, 1.0)
                } else {
                    (last, last.particle(last.particles - 1).0, -1.0)
                };
                // Up to half a cell: the gas of the outermost particle reaches no further.
                let distance = inward * (x - wall);
                if !(distance > 0.0 && distance <= 0.5 * body.cell() * (1.0 + 1e-9)) {
                    let wanted = format!(
                        "a wall stands at the face of its body, within half a cell of the outermost \
                         particle at {x}"
                    );
                    return Err(SceneError::new(key, wall, &wanted));
                }
                Ok(())
            }
        }
    }
}

impl Method {
    fn validate(&self) -> Result<(), SceneError> {
        for (key, value) in [
            ("method.visc_linear", self.visc_linear),
            ("method.visc_quad", self.visc_quad),
            ("method.visc_expansion", self.visc_expansion),
            ("method.heat_coeff", self.heat_coeff),
        ] {
            SceneError::coefficient(key, value, (STRONGEST, STRONGEST_WHY))?;
        }
        positive("method.limiter", self.limiter)?;
        if !(self.cfl > 0.0 && self.cfl <= 1.0) {
            return Err(SceneError::new("method.cfl", self.cfl, "it must be in (0, 1]"));
        }
        if self.density == Density::Kernel
            && !(self.kernel_support > 1.0 && self.kernel_support <= 4.0)
        {
            let wanted = "it must be in (1, 4] particle spacings";
            return Err(SceneError::new("method.kernel_support", self.kernel_support, wanted));
        }
        Ok(())
    }

    /// Whether the scene conducts heat at all.
    #[must_use]
    pub fn conducts(&self) -> bool {
        self.conduction != Conduction::None && self.heat_coeff > 0.0
    }
}

fn finite(key: &str, value: f64) -> Result<(), SceneError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(SceneError::new(key, value, "it must be a finite number"))
}

fn positive(key: &str, value: f64) -> Result<(), SceneError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(SceneError::new(key, value, "it must be a positive number"))
}

fn not_negative(key: &str, value: f64) -> Result<(), SceneError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(SceneError::new(key, value, "it must be a finite number, zero or more"))
}
