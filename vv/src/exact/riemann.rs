//! Exact solution of the Riemann problem of two ideal gases, with vacuum.
//!
//! Source: E. F. Toro, *Riemann Solvers and Numerical Methods for Fluid Dynamics*, ch. 4 (equation
//! numbers below are those of its third edition), written for a separate `gamma` on each side.
//! The left half of the problem is the mirror image of a right half, so one set of wave relations,
//! that of the private `RightWave`, serves both.

mod right_wave;

use super::{Gas, InputError, at_least, finite};
use right_wave::RightWave;

/// Pressures below this fraction of the largest in the problem count as vacuum.
const VACUUM_FRACTION: f64 = 1e-250;

/// An acoustic wave of the solution, moving into a left or right initial state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wave {
    /// A shock.
    Shock {
        /// Velocity of the shock.
        speed: f64,
    },
    /// A centred rarefaction; of zero width if the pressure does not change.
    Rarefaction {
        /// Velocity of the edge next to the initial state.
        head: f64,
        /// Velocity of the edge next to the contact or vacuum.
        tail: f64,
    },
}

impl Wave {
    /// Velocity of the edge next to the initial state.
    #[must_use]
    pub const fn head(&self) -> f64 {
        match *self {
            Self::Shock { speed } => speed,
            Self::Rarefaction { head, .. } => head,
        }
    }

    /// Velocity of the edge next to the contact or vacuum.
    #[must_use]
    pub const fn tail(&self) -> f64 {
        match *self {
            Self::Shock { speed } => speed,
            Self::Rarefaction { tail, .. } => tail,
        }
    }

    const fn mirrored(self) -> Self {
        match self {
            Self::Shock { speed } => Self::Shock { speed: -speed },
            Self::Rarefaction { head, tail } => Self::Rarefaction { head: -head, tail: -tail },
        }
    }
}

/// What lies between the two acoustic waves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Middle {
    /// Two states of common pressure and velocity, separated by a contact at that velocity.
    Star {
        /// Star state on the left of the contact.
        left: Gas,
        /// Star state on the right of the contact.
        right: Gas,
    },
    /// Empty space between two velocities; infinite on the side of an initial vacuum.
    Vacuum {
        /// Velocity of the left edge.
        left: f64,
        /// Velocity of the right edge.
        right: f64,
    },
}

/// The initial state from which a piece of gas stems.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Left of the contact.
    Left,
    /// Right of the contact.
    Right,
    /// No gas here.
    Vacuum,
}

/// State and origin of the gas at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The state.
    pub gas: Gas,
    /// The side from which it stems.
    pub origin: Origin,
}

/// The self-similar solution for two gases that meet at `x = 0`, `t = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Riemann {
    left: RightWave,
    right: RightWave,
    middle: Middle,
}

impl Riemann {
    /// Solves the problem of `left` (`x < 0`) and `right` (`x > 0`).
    ///
    /// # Errors
    /// An inadmissible state; see [`Gas::validated`].
    pub fn new(left: Gas, right: Gas) -> Result<Self, InputError> {
        let (left, right) = (left.validated()?, right.validated()?);
        let (left, right) = (RightWave::new(left.mirrored()), RightWave::new(right));
        let middle = match star_pressure(&left, &right) {
            None => {
                Middle::Vacuum { left: -left.escape_velocity(), right: right.escape_velocity() }
            }
            Some(p) => {
                let velocity = 0.5 * (right.gas.velocity + right.velocity_change(p).0)
                    - 0.5 * (left.gas.velocity + left.velocity_change(p).0);
                let star = |side: &RightWave| Gas { velocity, ..side.star(p) };
                Middle::Star { left: star(&left), right: star(&right) }
            }
        };
        Ok(Self { left, right, middle })
    }

    /// The region between the waves.
    #[must_use]
    pub const fn middle(&self) -> Middle {
        self.middle
    }

    /// The left-going wave; `None` if there is no gas on the left.
    #[must_use]
    pub fn left_wave(&self) -> Option<Wave> {
        self.left.wave(self.middle_pressure()).map(Wave::mirrored)
    }

    /// The right-going wave; `None` if there is no gas on the right.
    #[must_use]
    pub fn right_wave(&self) -> Option<Wave> {
        self.right.wave(self.middle_pressure())
    }

    /// Solution on the ray `x/t = xi`; an edge belongs to the gas on its outer side.
    #[must_use]
    pub fn sample(&self, xi: f64) -> Sample {
        let pressure = self.middle_pressure();
        let (left_edge, right_edge) = match self.middle {
            Middle::Star { left, right } => (left.velocity, right.velocity),
            Middle::Vacuum { left, right } => (left, right),
        };
        if xi <= left_edge && !self.left.gas.is_vacuum() {
            let gas = self.left.sample(-xi, -left_edge, pressure).mirrored();
            Sample { gas, origin: Origin::Left }
        } else if xi >= right_edge && !self.right.gas.is_vacuum() {
            let gas = self.right.sample(xi, right_edge, pressure);
            Sample { gas, origin: Origin::Right }
        } else {
            Sample { gas: Gas::vacuum(self.right.gas.gamma), origin: Origin::Vacuum }
        }
    }

    /// Position at time `t` of the particle that started at `label` (at the contact, `label = 0`
    /// counts as right), from conservation of the mass between it and the contact.
    ///
    /// # Errors
    /// Non-finite `label`, or negative or non-finite `t`.
    pub fn position(&self, label: f64, t: f64) -> Result<f64, InputError> {
        let (label, t) = (finite("label", label)?, at_least("t", t, 0.0)?);
        let star = match self.middle {
            Middle::Star { left, .. } => Some((left.pressure, left.velocity)),
            Middle::Vacuum { .. } => None,
        };
        Ok(if t <= 0.0 {
            label
        } else if label < 0.0 {
            -t * self.left.particle(-label / t, star.map(|(p, u)| (p, -u)))
        } else {
            t * self.right.particle(label / t, star)
        })
    }

    const fn middle_pressure(&self) -> f64 {
        match self.middle {
            Middle::Star { left, .. } => left.pressure,
            Middle::Vacuum { .. } => 0.0,
        }
    }
}

/// Pressure at the contact, or `None` if a vacuum forms (or is there from the start).
///
/// Solves `f_l(p) + f_r(p) + u_r - u_l = 0` (Toro 4.5) by Newton's method in `ln p`, which is
/// nearly linear in both the shock and the rarefaction limits, guarded by bisection in `ln p`.
fn star_pressure(left: &RightWave, right: &RightWave) -> Option<f64> {
    if left.gas.is_vacuum() || right.gas.is_vacuum() {
        return None;
    }
    let separation = right.gas.velocity + left.gas.velocity;
    let residual = |p: f64| {
        let ((f_l, slope_l), (f_r, slope_r)) = (left.velocity_change(p), right.velocity_change(p));
        (f_l + f_r + separation, slope_l + slope_r)
    };
    let ram = left.gas.density.max(right.gas.density) * separation * separation;
    let mut high = left.gas.pressure.max(right.gas.pressure).max(ram);
    let mut low = (high * VACUUM_FRACTION).max(f64::MIN_POSITIVE);
    if residual(low).0 >= 0.0 {
        return None;
    }
    while residual(high).0 < 0.0 {
        (low, high) = (high, 4.0 * high);
    }
    let mut p = high;
    for _ in 0..2000 {
        let (value, slope) = residual(p);
        if value < 0.0 {
            low = p;
        } else {
            high = p;
        }
        let step = value / (p * slope);
        let newton = p * (-step).exp();
        let next = if newton > low && newton < high { newton } else { low.sqrt() * high.sqrt() };
        if value == 0.0 || step.abs() < 4.0 * f64::EPSILON || high - low <= f64::EPSILON * high {
            break;
        }
        p = next;
    }
    Some(p)
}

#[cfg(test)]
mod tests;
