//! Acoustic theory of plate impact and spall, for a flyer and a target of one material.
//!
//! The plates together are a bar with free ends whose left part moves: d'Alembert's solution is
//! `u = (f(x - c t) + f(x + c t))/2`, `sigma = rho c (f(x + c t) - f(x - c t))/2` in tension,
//! with the initial velocity `f` continued evenly about both ends. For a flyer of thickness `h`
//! on a thicker target the releases from both rear faces meet at `h` from the rear of the target,
//! where full tension `rho c V/2` appears first. The free surface then falls back by
//! `du = 2 sigma_s/(rho c)` if the material fails at `sigma_s`. Sources: d'Alembert's solution;
//! T. Antoun et al., *Spall Fracture* (2003), ch. 2.

use super::{InputError, above, at_least, finite};

/// A plate impact; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateImpact {
    density: f64,
    wave_speed: f64,
    flyer: f64,
    target: f64,
    velocity: f64,
}

/// Velocity and stress at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateState {
    /// Velocity in the direction of the flyer.
    pub velocity: f64,
    /// Stress, positive in tension.
    pub stress: f64,
}

impl PlateImpact {
    /// Plates of `thicknesses` `[flyer, target]`, of `[density, wave speed]` as `material` says,
    /// the flyer moving at `velocity`.
    ///
    /// # Errors
    /// Any number that is not positive, or a target no thicker than the flyer, in which no
    /// tension arises.
    pub fn new(
        material: [f64; 2],
        thicknesses: [f64; 2],
        velocity: f64,
    ) -> Result<Self, InputError> {
        let flyer = above("flyer thickness", thicknesses[0], 0.0)?;
        Ok(Self {
            density: above("density", material[0], 0.0)?,
            wave_speed: above("wave speed", material[1], 0.0)?,
            flyer,
            target: above("target thickness", thicknesses[1], flyer)?,
            velocity: above("velocity", velocity, 0.0)?,
        })
    }

    /// Impedance `rho c`, stress per velocity.
    #[must_use]
    pub fn impedance(&self) -> f64 {
        self.density * self.wave_speed
    }

    /// Stress `rho c V/2`, first in compression and, if the plates hold, later in tension.
    #[must_use]
    pub fn peak_stress(&self) -> f64 {
        0.5 * self.impedance() * self.velocity
    }

    /// Distance of the spall plane from the rear face of the target: the flyer's thickness.
    #[must_use]
    pub const fn spall_depth(&self) -> f64 {
        self.flyer
    }

    /// Time after impact at which tension appears at the spall plane, `(h_f + h_t)/c`.
    #[must_use]
    pub fn spall_time(&self) -> f64 {
        (self.flyer + self.target) / self.wave_speed
    }

    /// Time after impact at which the rear face starts to move, `h_t/c`.
    #[must_use]
    pub fn breakout_time(&self) -> f64 {
        self.target / self.wave_speed
    }

    /// Duration `2 h_f/c` of the pulse.
    #[must_use]
    pub fn pulse_duration(&self) -> f64 {
        2.0 * self.flyer / self.wave_speed
    }

    /// Fall of the free-surface velocity before the signal of the spall arrives, for a spall
    /// `strength`: `2 sigma_s/(rho c)`, or all of `V` if the plates hold.
    ///
    /// # Errors
    /// A negative `strength`.
    pub fn pull_back(&self, strength: f64) -> Result<f64, InputError> {
        let strength = at_least("spall strength", strength, 0.0)?;
        Ok((2.0 * strength / self.impedance()).min(self.velocity))
    }

    /// Spall strength `rho c du/2` that a measured pull-back indicates.
    ///
    /// # Errors
    /// A negative `pull_back`.
    pub fn strength(&self, pull_back: f64) -> Result<f64, InputError> {
        Ok(0.5 * self.impedance() * at_least("pull-back velocity", pull_back, 0.0)?)
    }

    /// State at time `t` and the place `x` from the impact face, the flyer being at `x < 0`, if
    /// nothing breaks; displacements are neglected.
    ///
    /// # Errors
    /// `t < 0`, or `x` outside the plates.
    pub fn sample(&self, x: f64, t: f64) -> Result<PlateState, InputError> {
        let t = at_least("t", t, 0.0)?;
        let x = at_least("x", finite("x", x)?, -self.flyer)?;
        at_least("target thickness - x", self.target - x, 0.0)?;
        let (place, travel) = (x + self.flyer, self.wave_speed * t);
        let (rightward, leftward) = (self.initial(place - travel), self.initial(place + travel));
        Ok(PlateState {
            velocity: 0.5 * (rightward + leftward),
            stress: 0.5 * self.impedance() * (leftward - rightward),
        })
    }

    /// Initial velocity at `place` from the rear of the flyer, continued evenly.
    fn initial(&self, place: f64) -> f64 {
        let length = self.flyer + self.target;
        let folded = place.rem_euclid(2.0 * length);
        let place = folded.min(2.0 * length - folded);
        if place < self.flyer { self.velocity } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    #[test]
    fn a_flyer_on_twice_its_thickness_opens_the_middle() {
        let impact = PlateImpact::new([8.93, 0.394], [0.1, 0.2], 0.02).unwrap();
        let c = 0.394;
        assert_relative_eq!(impact.spall_depth(), 0.1);
        assert_relative_eq!(impact.spall_time(), 0.3 / c, max_relative = 1e-14);
        assert_relative_eq!(impact.breakout_time(), 0.2 / c, max_relative = 1e-14);
        assert_relative_eq!(impact.pulse_duration(), 0.2 / c, max_relative = 1e-14);
        let at = |x: f64, t: f64| impact.sample(x, t / c).unwrap();
        assert_eq!(at(0.05, 0.1).stress, -impact.peak_stress());
        assert_eq!(at(0.2, 0.21).velocity, 0.02);
        assert_relative_eq!(at(0.1, 0.301).stress, impact.peak_stress());
        assert_eq!(at(0.1, 0.299).stress, -impact.peak_stress());
        assert_eq!((at(0.08, 0.301).stress, at(0.12, 0.301).stress), (0.0, 0.0));
        let strength = impact.strength(impact.pull_back(0.01).unwrap()).unwrap();
        assert_relative_eq!(strength, 0.01, max_relative = 1e-14);
        assert_relative_eq!(impact.pull_back(1.0).unwrap(), 0.02);
    }

    #[test]
    fn refuses_nonsense() {
        assert!(PlateImpact::new([1.0, 1.0], [1.0, 1.0], 1.0).is_err());
        let impact = PlateImpact::new([1.0, 1.0], [1.0, 2.0], 1.0).unwrap();
        assert!(impact.sample(-1.1, 0.0).is_err() && impact.sample(2.1, 0.0).is_err());
        assert!(impact.sample(0.0, -1.0).is_err() && impact.pull_back(f64::NAN).is_err());
    }

    proptest! {
        #![proptest_config(cases(64))]

        /// Free faces carry no stress, momentum is kept, and tension appears at the spall plane
        /// and nowhere earlier.
        #[test]
        fn waves_meet_where_they_should(
            ratio in 1.05..6.0_f64, t in 0.0..20.0_f64, at in 0.0..1.0_f64,
        ) {
            let impact = PlateImpact::new([3.0, 2.0], [1.0, ratio], 0.5).unwrap();
            let state = |x: f64, t: f64| impact.sample(x, t).unwrap();
            prop_assert!(state(-1.0, t).stress == 0.0);
            let cells = 4000_u32;
            let width = (1.0 + ratio) / f64::from(cells);
            let momentum = (0..cells)
                .map(|i| state(-1.0 + (f64::from(i) + 0.5) * width, t).velocity * width)
                .sum::<f64>();
            prop_assert!((momentum - 0.5).abs() < 4.0 * width);
            let early = impact.spall_time() * (1.0 - 1e-9);
            let x = -1.0 + at * (1.0 + ratio);
            prop_assert!(state(x, t.min(early)).stress <= 0.0);
            let plane = ratio - impact.spall_depth();
            let just_after = impact.spall_time() * (1.0 + 1e-9);
            prop_assert!(state(plane, just_after).stress == impact.peak_stress());
        }
    }
}
