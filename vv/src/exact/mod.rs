//! Closed-form and semi-analytic solutions used as oracles.
//!
//! Units are whatever consistent set the caller uses; every formula is dimensionally homogeneous.
//! Nothing here panics on input: constructors return [`InputError`] and solutions are then total.

pub mod beam;
pub mod collapse;
pub mod collision;
pub mod elastic_limit;
pub mod gruneisen;
pub mod heat;
pub mod hugoniot;
pub mod kidder;
pub mod lattice;
pub mod noh;
mod numerics;
pub mod penetration;
pub mod piston;
pub mod release;
pub mod riemann;
pub mod saltzman;
pub mod sedov;
pub mod spall;
pub mod strength;
pub mod taylor;
pub mod verney;
pub mod waves;

use std::fmt;

/// Why an argument was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InputError {
    /// The quantity is not a finite number.
    NotFinite {
        /// Name of the argument.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },
    /// The quantity must exceed `bound`.
    NotAbove {
        /// Name of the argument.
        quantity: &'static str,
        /// The value given.
        value: f64,
        /// The exclusive lower bound.
        bound: f64,
    },
    /// The quantity must be at least `bound`.
    Below {
        /// Name of the argument.
        quantity: &'static str,
        /// The value given.
        value: f64,
        /// The inclusive lower bound.
        bound: f64,
    },
    /// The quantity must stay below `bound`.
    NotBelow {
        /// Name of the argument.
        quantity: &'static str,
        /// The value given.
        value: f64,
        /// The exclusive upper bound.
        bound: f64,
    },
    /// A gas of zero density was given a pressure.
    VacuumPressure {
        /// The pressure given.
        value: f64,
    },
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite { quantity, value } => write!(f, "{quantity} = {value} is not finite"),
            Self::NotAbove { quantity, value, bound } => {
                write!(f, "{quantity} = {value} must be greater than {bound}")
            }
            Self::Below { quantity, value, bound } => {
                write!(f, "{quantity} = {value} must not be less than {bound}")
            }
            Self::NotBelow { quantity, value, bound } => {
                write!(f, "{quantity} = {value} must be less than {bound}")
            }
            Self::VacuumPressure { value } => {
                write!(f, "pressure = {value} in a gas of zero density")
            }
        }
    }
}

impl std::error::Error for InputError {}

/// Returns `value` if it is finite.
pub(crate) fn finite(quantity: &'static str, value: f64) -> Result<f64, InputError> {
    if value.is_finite() { Ok(value) } else { Err(InputError::NotFinite { quantity, value }) }
}

/// Returns `value` if it is finite and greater than `bound`.
pub(crate) fn above(quantity: &'static str, value: f64, bound: f64) -> Result<f64, InputError> {
    let value = finite(quantity, value)?;
    if value > bound { Ok(value) } else { Err(InputError::NotAbove { quantity, value, bound }) }
}

/// Returns `value` if it is finite and at least `bound`.
pub(crate) fn at_least(quantity: &'static str, value: f64, bound: f64) -> Result<f64, InputError> {
    let value = finite(quantity, value)?;
    if value >= bound { Ok(value) } else { Err(InputError::Below { quantity, value, bound }) }
}

/// Returns `value` if it is finite and less than `bound`.
pub(crate) fn below(quantity: &'static str, value: f64, bound: f64) -> Result<f64, InputError> {
    let value = finite(quantity, value)?;
    if value < bound { Ok(value) } else { Err(InputError::NotBelow { quantity, value, bound }) }
}

/// Symmetry of a one-dimensional flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Geometry {
    /// Slabs, `k = 1`.
    Planar,
    /// Cylinders, `k = 2`.
    Cylindrical,
    /// Spheres, `k = 3`.
    Spherical,
}

impl Geometry {
    /// The three geometries in order of dimension.
    pub const ALL: [Self; 3] = [Self::Planar, Self::Cylindrical, Self::Spherical];

    /// Number of dimensions `k` in which the flow converges.
    #[must_use]
    pub const fn dimension(self) -> i32 {
        match self {
            Self::Planar => 1,
            Self::Cylindrical => 2,
            Self::Spherical => 3,
        }
    }
}

/// A point state of an ideal gas, `p = (gamma - 1) rho e`.
///
/// Zero density (with zero pressure) is vacuum; zero pressure at positive density is cold gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gas {
    /// Mass density `rho`.
    pub density: f64,
    /// Velocity `u` along `x` (or `r`).
    pub velocity: f64,
    /// Pressure `p`.
    pub pressure: f64,
    /// Ratio of specific heats.
    pub gamma: f64,
}

impl Gas {
    /// Empty space; its velocity is zero by convention.
    #[must_use]
    pub const fn vacuum(gamma: f64) -> Self {
        Self { density: 0.0, velocity: 0.0, pressure: 0.0, gamma }
    }

    /// Returns the state itself if it is admissible.
    ///
    /// # Errors
    /// Non-finite fields, `gamma <= 1`, negative density or pressure, or pressure in a vacuum.
    pub fn validated(self) -> Result<Self, InputError> {
        above("gamma", self.gamma, 1.0)?;
        at_least("density", self.density, 0.0)?;
        at_least("pressure", self.pressure, 0.0)?;
        finite("velocity", self.velocity)?;
        if self.is_vacuum() && self.pressure > 0.0 {
            return Err(InputError::VacuumPressure { value: self.pressure });
        }
        Ok(self)
    }

    /// Whether the density is zero.
    #[must_use]
    pub fn is_vacuum(&self) -> bool {
        self.density <= 0.0
    }

    /// Adiabatic sound speed `sqrt(gamma p / rho)`; zero in vacuum.
    #[must_use]
    pub fn sound_speed(&self) -> f64 {
        if self.is_vacuum() { 0.0 } else { (self.gamma * self.pressure / self.density).sqrt() }
    }

    /// Specific internal energy `p / ((gamma - 1) rho)`, energy per mass; zero in vacuum.
    #[must_use]
    pub fn energy(&self) -> f64 {
        if self.is_vacuum() { 0.0 } else { self.pressure / ((self.gamma - 1.0) * self.density) }
    }

    /// Mass, momentum and total energy per volume, `[rho, rho u, p/(gamma-1) + rho u^2/2]`.
    #[must_use]
    pub fn conserved(&self) -> [f64; 3] {
        let momentum = self.density * self.velocity;
        let energy = self.pressure / (self.gamma - 1.0) + 0.5 * momentum * self.velocity;
        [self.density, momentum, energy]
    }

    /// Flux of [`Self::conserved`] through a surface moving at `speed`:
    /// `[rho w, rho u w + p, E w + p u]` with `w = u - speed`.
    #[must_use]
    pub fn flux(&self, speed: f64) -> [f64; 3] {
        let [mass, momentum, energy] = self.conserved();
        let relative = self.velocity - speed;
        [
            mass * relative,
            momentum * relative + self.pressure,
            energy * relative + self.pressure * self.velocity,
        ]
    }

    /// The same state seen in a mirror, `u -> -u`.
    #[must_use]
    pub const fn mirrored(self) -> Self {
        Self { velocity: -self.velocity, ..self }
    }
}

#[cfg(test)]
pub(crate) mod testing {
    use proptest::test_runner::{Config, RngSeed};

    /// A deterministic property-test configuration of `cases` cases that writes no files.
    pub(crate) fn cases(cases: u32) -> Config {
        Config {
            cases,
            rng_seed: RngSeed::Fixed(20_240_229),
            failure_persistence: None,
            ..Config::default()
        }
    }

    /// Whether two triples agree to `tolerance` relative to `scale`.
    pub(crate) fn close(a: [f64; 3], b: [f64; 3], scale: [f64; 3], tolerance: f64) -> bool {
        (0..3).all(|i| (a[i] - b[i]).abs() <= tolerance * scale[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_bad_states_with_a_message() {
        let good = Gas { density: 1.0, velocity: 0.0, pressure: 1.0, gamma: 1.4 };
        assert_eq!(good.validated(), Ok(good));
        let message = |gas: Gas| gas.validated().map_err(|e| e.to_string());
        assert_eq!(
            message(Gas { gamma: 1.0, ..good }),
            Err("gamma = 1 must be greater than 1".into())
        );
        assert_eq!(
            message(Gas { density: 0.0, ..good }),
            Err("pressure = 1 in a gas of zero density".into())
        );
        assert!(Gas { velocity: f64::NAN, ..good }.validated().is_err());
        assert!(Gas { pressure: -1.0, ..good }.validated().is_err());
        assert!(Gas::vacuum(1.4).validated().is_ok());
    }
}
