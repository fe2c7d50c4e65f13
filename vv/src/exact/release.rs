//! Isentropic release of a shocked Mie-Gruneisen solid, and its free-surface velocity.
//!
//! Along the isentrope and the simple wave that carries it, `d rho = dP/c^2`,
//! `d e = P/(rho^2 c^2) dP` and `d u = -dP/(rho c)`, integrated in the pressure. Release to zero
//! pressure gives the velocity of a free surface, close to `2 up`. Source: the Riemann invariant;
//! L. V. Al'tshuler, Sov. Phys. Usp. 8 (1965) 52.

use super::gruneisen::MieGruneisen;
use super::numerics::runge_kutta;
use super::{InputError, at_least, finite};

/// Steps of the integration.
const STEPS: u32 = 512;

/// A state on the isentrope through a shocked state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Released {
    /// Velocity after the release, larger than behind the shock.
    pub velocity: f64,
    /// Density after the release.
    pub density: f64,
    /// Specific internal energy left, energy per mass.
    pub energy: f64,
}

impl MieGruneisen {
    /// State after isentropic release to `pressure` from behind a shock of velocity
    /// `particle_speed`, by Runge-Kutta in the pressure:
    /// `d rho = dP/c^2`, `d e = P/(rho^2 c^2) dP`, `d u = -dP/(rho c)`.
    ///
    /// Release to zero pressure gives the free-surface velocity.
    ///
    /// # Errors
    /// A negative `particle_speed`, a `pressure` not between zero and the shock pressure, or an
    /// isentrope that meets an unstable state.
    pub fn release(&self, particle_speed: f64, pressure: f64) -> Result<Released, InputError> {
        let shock = self.hugoniot().at_particle_speed(particle_speed)?;
        let pressure = at_least("pressure", pressure, 0.0)?;
        let drop = at_least("pressure drop", shock.pressure - pressure, 0.0)?;
        let step = -drop / f64::from(STEPS);
        let rate = |[pressure, log_density, energy, _]: [f64; 4]| {
            let density: f64 = f64::exp(log_density);
            let sound2 = self.raw_sound_speed_squared(density, energy);
            let compliance = 1.0 / (density * sound2);
            let impedance = density * sound2.sqrt();
            [1.0, compliance, pressure * compliance / density, -1.0 / impedance]
        };
        let start = [shock.pressure, shock.density.ln(), shock.energy, particle_speed];
        let [_, log_density, energy, velocity] =
            (0..STEPS).fold(start, |state, _| runge_kutta(state, step, rate));
        let velocity = finite("released velocity", velocity)?;
        Ok(Released { velocity, density: log_density.exp(), energy })
    }
}

#[cfg(test)]
mod tests {
    use super::super::gruneisen::tests::any;
    use super::super::hugoniot::Hugoniot;
    use super::super::testing::cases;
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    #[test]
    fn weak_shocks_release_acoustically() {
        let hugoniot = Hugoniot::new(2.703, 0.524, 1.4).unwrap();
        let solid = MieGruneisen::steinberg(hugoniot, 1.97, 0.48).unwrap();
        let released = solid.release(1e-3, 0.0).unwrap();
        assert_relative_eq!(released.velocity, 2e-3, max_relative = 1e-5);
        assert_relative_eq!(released.density, 2.703, max_relative = 1e-7);
        let doubled = solid.release(0.1, 0.0).unwrap().velocity / 0.2;
        assert!((0.99..1.02).contains(&doubled), "{doubled}");
        assert!(solid.release(0.1, 1.0).is_err() && solid.release(-0.1, 0.0).is_err());
    }

    proptest! {
        #![proptest_config(cases(96))]

        #[test]
        fn release_ends_at_its_pressure(solid in any(), up in 1e-3..0.15, part in 0.0..1.0) {
            let shock = solid.hugoniot().at_particle_speed(up).unwrap();
            let target = part * shock.pressure;
            let released = solid.release(up, target).unwrap();
            let pressure = solid.pressure(released.density, released.energy).unwrap();
            prop_assert!((pressure - target).abs() < 1e-7 * shock.pressure);
            prop_assert!(released.velocity >= up && released.energy <= shock.energy);
        }
    }
}
