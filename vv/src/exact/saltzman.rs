//! Saltzman's piston: a shock driven through a box of gas, with its reflections.
//!
//! A wall at `x = U t` drives a shock into gas at rest that ends at a fixed wall. Each time the
//! shock meets a wall it returns, and the gas behind it takes the velocity of that wall. A shock
//! that changes the velocity by `U` runs, relative to the gas of sound speed `c` ahead of it, at
//! `W = (g+1) U/4 + sqrt(((g+1) U/4)^2 + c^2)`, and leaves `p' = p + rho W U`,
//! `rho' = rho W/(W - U)`. Cold gas gives the strong shock `W = (g+1) U/2`. Sources: the jump
//! conditions; J. K. Dukowicz and B. J. A. Meltz, J. Comput. Phys. 99 (1992) 115.

use super::{Gas, InputError, above, at_least, below};

/// Bound of the passages that are followed.
const MOST_PASSAGES: f64 = 1e6;

/// A box of gas and its piston; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saltzman {
    initial: Gas,
    length: f64,
    speed: f64,
}

/// One run of the shock from one wall to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Time at which the shock leaves its wall.
    pub start: f64,
    /// Time at which it meets the other wall.
    pub end: f64,
    /// Place at which it starts.
    pub origin: f64,
    /// Velocity of the shock, negative for an even number of passages.
    pub velocity: f64,
    /// State ahead of it.
    pub ahead: Gas,
    /// State behind it.
    pub behind: Gas,
}

impl Saltzman {
    /// Gas of density and pressure as in `initial` (whose velocity is ignored) in a box of
    /// `length`, with the piston at `speed`.
    ///
    /// # Errors
    /// An inadmissible or empty gas, `length <= 0` or `speed <= 0`.
    pub fn new(initial: Gas, length: f64, speed: f64) -> Result<Self, InputError> {
        let initial = Gas { velocity: 0.0, ..initial }.validated()?;
        above("density", initial.density, 0.0)?;
        let (length, speed) = (above("length", length, 0.0)?, above("speed", speed, 0.0)?);
        Ok(Self { initial, length, speed })
    }

    /// Position of the piston at time `t`.
    #[must_use]
    pub fn piston(&self, t: f64) -> f64 {
        self.speed * t
    }

    /// The first passage, from the piston to the fixed wall.
    #[must_use]
    pub fn first(&self) -> Passage {
        self.passage(0.0, 0.0, self.initial)
    }

    /// The passage after `passage`.
    #[must_use]
    pub fn next(&self, passage: &Passage) -> Passage {
        let from = if passage.velocity > 0.0 { self.length } else { self.piston(passage.end) };
        self.passage(passage.end, from, passage.behind)
    }

    /// The passage under way at time `t`, found by following all before it.
    ///
    /// # Errors
    /// `t < 0`, the piston at or beyond the fixed wall, or more than a million passages, as
    /// happens where the piston is far slower than sound.
    pub fn at(&self, t: f64) -> Result<Passage, InputError> {
        let t = at_least("t", t, 0.0)?;
        below("piston position", self.piston(t), self.length)?;
        let mut passage = self.first();
        let mut count = 1.0;
        while passage.end <= t {
            count = below("number of shock passages", count + 1.0, MOST_PASSAGES)?;
            let next = self.next(&passage);
            // Close to the end passages become shorter than the spacing of the numbers.
            if next.end <= passage.end {
                break;
            }
            passage = next;
        }
        Ok(passage)
    }

    /// State at `x` and time `t`; the shock itself counts as behind.
    ///
    /// # Errors
    /// `x` outside the gas, or as for [`Self::at`].
    pub fn sample(&self, x: f64, t: f64) -> Result<Gas, InputError> {
        let passage = self.at(t)?;
        let x = at_least("x", x, self.piston(t))?;
        at_least("length - x", self.length - x, 0.0)?;
        let ahead = (x - passage.position(t)) * passage.velocity > 0.0;
        Ok(if ahead { passage.ahead } else { passage.behind })
    }

    /// Passage from `origin` at the time `start` into the gas `ahead`.
    fn passage(&self, start: f64, origin: f64, ahead: Gas) -> Passage {
        let Gas { density, pressure, gamma, .. } = ahead;
        // The gas stands with one wall and meets the other: either way the velocity jumps by U.
        let rightward = ahead.velocity < 0.5 * self.speed;
        let half = 0.25 * (gamma + 1.0) * self.speed;
        let relative = half + half.hypot(ahead.sound_speed());
        let (wall, direction) = if rightward { (self.speed, 1.0) } else { (0.0, -1.0) };
        let behind = Gas {
            density: density * relative / (relative - self.speed),
            velocity: wall,
            pressure: pressure + density * relative * self.speed,
            gamma,
        };
        let velocity = ahead.velocity + direction * relative;
        let end = if rightward {
            start + (self.length - origin) / velocity
        } else {
            start + (origin - self.piston(start)) / (self.speed - velocity)
        };
        Passage { start, end, origin, velocity, ahead, behind }
    }
}

impl Passage {
    /// Position of the shock at time `t`, from [`Self::start`] to [`Self::end`].
    #[must_use]
    pub fn position(&self, t: f64) -> f64 {
        self.origin + self.velocity * (t - self.start)
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{cases, close};
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    fn cold() -> Gas {
        Gas { density: 1.0, velocity: 0.0, pressure: 0.0, gamma: 5.0 / 3.0 }
    }

    #[test]
    fn reproduces_the_reference_states() {
        let box_ = Saltzman::new(cold(), 1.0, 1.0).unwrap();
        let first = box_.first();
        assert_relative_eq!(first.velocity, 4.0 / 3.0, max_relative = 1e-14);
        assert_relative_eq!(first.behind.density, 4.0, max_relative = 1e-14);
        assert_relative_eq!(first.behind.pressure, 4.0 / 3.0, max_relative = 1e-14);
        assert_relative_eq!(first.behind.energy(), 0.5, max_relative = 1e-14);
        assert_relative_eq!(first.end, 0.75, max_relative = 1e-14);
        assert_relative_eq!(first.position(0.6), 0.8, max_relative = 1e-14);
        let second = box_.next(&first);
        assert_relative_eq!(second.velocity, -2.0 / 3.0, max_relative = 1e-13);
        assert_relative_eq!(second.behind.density, 10.0, max_relative = 1e-13);
        assert_relative_eq!(second.behind.pressure, 8.0, max_relative = 1e-13);
        assert_relative_eq!(second.end, 0.9, max_relative = 1e-13);
    }

    #[test]
    fn refuses_nonsense_and_reaches_the_end() {
        let box_ = Saltzman::new(cold(), 1.0, 1.0).unwrap();
        assert!(box_.sample(0.1, 0.2).is_err() && box_.sample(1.1, 0.2).is_err());
        assert!(box_.at(1.0).is_err() && box_.at(-1.0).is_err());
        assert!(box_.at(1.0 - f64::EPSILON).unwrap().behind.density > 1e3);
        assert!(Saltzman::new(Gas::vacuum(1.4), 1.0, 1.0).is_err());
        let hot = Gas { pressure: 1e18, ..cold() };
        assert!(Saltzman::new(hot, 1.0, 1.0).unwrap().sample(0.9, 0.5).is_err());
    }

    proptest! {
        #![proptest_config(cases(96))]

        #[test]
        fn conserves_mass_and_energy(
            gamma in 1.1..3.0, pressure in 0.0..2.0, speed in 0.1..5.0, part in 0.01..0.97,
        ) {
            let initial = Gas { density: 1.5, velocity: 7.0, pressure, gamma };
            let box_ = Saltzman::new(initial, 2.0, speed).unwrap();
            let t = part * 2.0 / speed;
            let passage = box_.at(t).unwrap();
            let shock = passage.position(t);
            let (left, right) = (box_.piston(t), 2.0);
            prop_assert!(shock >= left - 1e-9 && shock <= right + 1e-9);
            let a = box_.sample(left, t).unwrap().conserved();
            let b = box_.sample(right, t).unwrap().conserved();
            let content = |i: usize| a[i] * (shock - left) + b[i] * (right - shock);
            prop_assert!((content(0) / 3.0 - 1.0).abs() < 1e-9);
            // The work of the piston, passage by passage.
            let mut work = 0.0;
            let mut now = box_.first();
            loop {
                let face = if now.velocity > 0.0 { now.behind } else { now.ahead };
                work += face.pressure * speed * (now.end.min(t) - now.start);
                if now.end > t { break }
                now = box_.next(&now);
            }
            let before = 2.0 * pressure / (gamma - 1.0);
            prop_assert!((content(2) / (before + work) - 1.0).abs() < 1e-9);
            let scale = passage.behind.flux(passage.velocity).map(f64::abs);
            let scale = [scale[0], scale[1].max(passage.behind.pressure), scale[2] + work];
            let (ahead, behind) = (passage.ahead, passage.behind);
            let d = passage.velocity;
            prop_assert!(close(ahead.flux(d), behind.flux(d), scale, 1e-9));
        }
    }
}
