//! Two classical estimates of the dynamic yield stress from a Taylor test.
//!
//! A rod of length `L` and density `rho` strikes a rigid wall at `V` and keeps the length `L1`, of
//! which `X` at the rear is undeformed. Estimates within a few tens of per cent: they neglect
//! hardening, rate and the radial motion.
//! * G. I. Taylor, Proc. R. Soc. A 194 (1948) 289, for a plastic front of constant speed:
//!   `Y = rho V^2 (L - X)/(2 (L - L1) ln(L/X))`.
//! * M. L. Wilkins and M. W. Guinan, J. Appl. Phys. 44 (1973) 1200, for a front that stays at
//!   `h` from the wall: `(L1 - h)/(L - h) = exp(-rho V^2/(2 Y))`, with `h = 0.12 L` for metals.

use super::{InputError, above, at_least, below};

/// Fraction of the initial length at which the front of Wilkins and Guinan stays, for metals.
pub const FRONT_FRACTION: f64 = 0.12;

/// A rod that strikes a rigid wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaylorRod {
    length: f64,
    density: f64,
    velocity: f64,
}

impl TaylorRod {
    /// Rod of `length` and `density` at `velocity`.
    ///
    /// # Errors
    /// Any number that is not positive.
    pub fn new(length: f64, density: f64, velocity: f64) -> Result<Self, InputError> {
        Ok(Self {
            length: above("length", length, 0.0)?,
            density: above("density", density, 0.0)?,
            velocity: above("velocity", velocity, 0.0)?,
        })
    }

    /// Stagnation pressure `rho V^2/2`, a stress.
    #[must_use]
    pub fn dynamic_pressure(&self) -> f64 {
        0.5 * self.density * self.velocity * self.velocity
    }

    /// Taylor's yield stress from the final length and that of the undeformed rear.
    ///
    /// # Errors
    /// Lengths that do not satisfy `0 < undeformed < final_length < length`.
    pub fn taylor_yield(&self, final_length: f64, undeformed: f64) -> Result<f64, InputError> {
        let undeformed = above("undeformed length", undeformed, 0.0)?;
        let kept = above("final length", final_length, undeformed)?;
        let kept = below("final length", kept, self.length)?;
        let deformed = (self.length - undeformed) / (self.length - kept);
        Ok(self.dynamic_pressure() * deformed / (self.length / undeformed).ln())
    }

    /// Yield stress of Wilkins and Guinan from the final length, with the front at `fraction` of
    /// the initial length from the wall.
    ///
    /// # Errors
    /// A `fraction` outside `0 <= fraction < 1`, or a final length not between the front and the
    /// initial length.
    pub fn wilkins_yield(&self, final_length: f64, fraction: f64) -> Result<f64, InputError> {
        let front = self.length * below("fraction", at_least("fraction", fraction, 0.0)?, 1.0)?;
        let kept = above("final length", final_length, front)?;
        let kept = below("final length", kept, self.length)?;
        Ok(self.dynamic_pressure() / ((self.length - front) / (kept - front)).ln())
    }

    /// Final length by Wilkins and Guinan for a yield stress, with the front at `fraction`.
    ///
    /// # Errors
    /// `yield_stress <= 0`, or a `fraction` outside `0 <= fraction < 1`.
    pub fn final_length(&self, yield_stress: f64, fraction: f64) -> Result<f64, InputError> {
        let yield_stress = above("yield stress", yield_stress, 0.0)?;
        let fraction = below("fraction", at_least("fraction", fraction, 0.0)?, 1.0)?;
        let shrink = (-self.dynamic_pressure() / yield_stress).exp();
        Ok(self.length * (fraction + (1.0 - fraction) * shrink))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    /// 6061-T6 at 373 m/s, 23.47 mm to 16.51 mm (Wilkins and Guinan 1973, recalled), who quote
    /// about 4 kbar, above the static 2.9 kbar.
    #[test]
    fn gives_the_order_of_a_measured_yield() {
        let rod = TaylorRod::new(2.347, 2.703, 0.0373).unwrap();
        let dynamic = rod.wilkins_yield(1.651, FRONT_FRACTION).unwrap();
        assert!((0.0035..0.006).contains(&dynamic), "{dynamic}");
        assert_relative_eq!(rod.dynamic_pressure(), 0.5 * 2.703 * 0.0373 * 0.0373);
        // An even taper: X halfway between nothing and the final length.
        let taylor = rod.taylor_yield(1.651, 0.8).unwrap();
        assert!((0.5..2.0).contains(&(taylor / dynamic)), "{taylor}");
    }

    #[test]
    fn refuses_nonsense() {
        let rod = TaylorRod::new(1.0, 1.0, 1.0).unwrap();
        assert!(rod.taylor_yield(1.1, 0.5).is_err() && rod.taylor_yield(0.4, 0.5).is_err());
        assert!(rod.wilkins_yield(0.1, 0.12).is_err() && rod.final_length(1.0, 1.0).is_err());
        assert!(TaylorRod::new(1.0, 0.0, 1.0).is_err());
    }

    proptest! {
        #![proptest_config(cases(64))]

        #[test]
        fn length_and_yield_invert_each_other(v in 0.01..0.2, y in 0.001..0.1, at in 0.0..0.5) {
            let rod = TaylorRod::new(3.0, 8.0, v).unwrap();
            let kept = rod.final_length(y, at).unwrap();
            prop_assume!(kept > 3.0 * at * (1.0 + 1e-6) && kept > 0.0 && kept < 3.0 * (1.0 - 1e-9));
            prop_assert!((rod.wilkins_yield(kept, at).unwrap() / y - 1.0).abs() < 1e-6);
        }
    }
}
