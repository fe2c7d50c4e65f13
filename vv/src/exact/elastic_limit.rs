//! The Hugoniot elastic limit of a linear elastic, perfectly plastic solid.
//!
//! With `K = rho0 c0^2`: `c_L = sqrt((K + 4 G/3)/rho0)`, `HEL = Y (K + 4 G/3)/(2 G)` and
//! `u_HEL = HEL/(rho0 c_L)`; a weak plastic wave follows at `c0`. Source: G. R. Fowles, J. Appl.
//! Phys. 32 (1961) 1475. The nonlinear state is in [`piston`](super::piston).

use super::gruneisen::MieGruneisen;
use super::strength::Strength;

/// Linear elastic, perfectly plastic estimate of the elastic limit, with `K = rho0 c0^2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticLimit {
    /// Longitudinal wave speed `sqrt((K + 4 G/3)/rho0)`.
    pub longitudinal_speed: f64,
    /// Bulk wave speed `c0`, that of a weak plastic wave.
    pub bulk_speed: f64,
    /// Hugoniot elastic limit `Y (K + 4 G/3)/(2 G)`, a stress.
    pub stress: f64,
    /// Particle velocity at the limit, `stress/(rho0 c_L)`.
    pub velocity: f64,
}

impl ElasticLimit {
    /// The estimate for a solid; all readings of yield enter by their uniaxial yield stress.
    #[must_use]
    pub fn new(eos: &MieGruneisen, strength: &Strength) -> Self {
        let (rho0, bulk_speed) = (eos.hugoniot().density(), eos.hugoniot().sound_speed());
        let shear = strength.shear_modulus();
        let modulus = rho0 * bulk_speed * bulk_speed + 4.0 / 3.0 * shear;
        let longitudinal_speed = (modulus / rho0).sqrt();
        let stress = strength.uniaxial_yield() * modulus / (2.0 * shear);
        let velocity = stress / (rho0 * longitudinal_speed);
        Self { longitudinal_speed, bulk_speed, stress, velocity }
    }
}

#[cfg(test)]
mod tests {
    use super::super::hugoniot::Hugoniot;
    use super::super::piston::{Piston, Structure};
    use super::super::strength::{Elasticity, YieldReading};
    use super::*;
    use approx::assert_relative_eq;

    /// The nonlinear state at yield differs by terms of the order of the compression.
    #[test]
    fn is_the_first_wave_of_a_piston() {
        let hugoniot = Hugoniot::new(2.7, 0.5, 1.4).unwrap();
        let solid = MieGruneisen::constant_gamma(hugoniot, 2.0).unwrap();
        for reading in YieldReading::ALL {
            let law = Strength::new(Elasticity::IsochoricGreen(reading), 0.28, 0.003).unwrap();
            let limit = ElasticLimit::new(&solid, &law);
            let piston = Piston::new(&solid, &law, 0.02).unwrap();
            let Structure::TwoWave { elastic, .. } = piston.structure() else { panic!() };
            assert_relative_eq!(piston.at_yield().stress, limit.stress, max_relative = 0.03);
            assert_relative_eq!(elastic, limit.longitudinal_speed, max_relative = 0.03);
        }
    }
}
