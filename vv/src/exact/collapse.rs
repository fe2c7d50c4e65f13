//! Uniform homologous collapse ("Noh2"): `u = -r/T` initially, with uniform density and energy.
//!
//! Source: W. F. Noh, J. Comput. Phys. 72 (1987) p. 92. Pressure stays uniform, so every particle
//! keeps its velocity: `r = R (1 - t/T)`, `rho = rho0 (1 - t/T)^-k` and, adiabatically,
//! `e = e0 (1 - t/T)^(-k (gamma - 1))`. A test of the density and energy equations without shocks.

use super::{Gas, Geometry, InputError, above, at_least, below};

/// Initial data of a uniform collapse in `geometry`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformCollapse {
    geometry: Geometry,
    initial: Gas,
    time: f64,
}

impl UniformCollapse {
    /// Gas of density and pressure as in `initial` (whose velocity is ignored: it is `-r/time`),
    /// reaching the centre at `time`.
    ///
    /// # Errors
    /// An inadmissible or empty gas, or `time <= 0`.
    pub fn new(geometry: Geometry, initial: Gas, time: f64) -> Result<Self, InputError> {
        let initial = Gas { velocity: 0.0, ..initial }.validated()?;
        above("density", initial.density, 0.0)?;
        Ok(Self { geometry, initial, time: above("time", time, 0.0)? })
    }

    /// State at radius `r` and time `t`; only the velocity depends on `r`.
    ///
    /// # Errors
    /// `r < 0`, `t < 0` or `t` at or beyond the collapse.
    pub fn sample(&self, r: f64, t: f64) -> Result<Gas, InputError> {
        let (r, scale) = (at_least("r", r, 0.0)?, self.scale(t)?);
        let volume = scale.powi(self.geometry.dimension());
        let Gas { density, pressure, gamma, .. } = self.initial;
        Ok(Gas {
            density: density / volume,
            velocity: -r / (self.time * scale),
            pressure: pressure * volume.powf(-gamma),
            gamma,
        })
    }

    /// Radius at time `t` of the particle that started at radius `label`.
    ///
    /// # Errors
    /// `label < 0`, `t < 0` or `t` at or beyond the collapse.
    pub fn position(&self, label: f64, t: f64) -> Result<f64, InputError> {
        Ok(at_least("label", label, 0.0)? * self.scale(t)?)
    }

    /// `1 - t/T`.
    fn scale(&self, t: f64) -> Result<f64, InputError> {
        let t = below("t", at_least("t", t, 0.0)?, self.time)?;
        Ok(1.0 - t / self.time)
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cases(48))]

        /// Continuity, uniform pressure and adiabaticity by central differences along particles.
        #[test]
        fn satisfies_the_euler_equations(k in 0..3_usize, gamma in 1.1..3.0, t in 0.01..0.8) {
            let geometry = Geometry::ALL[k];
            let initial = Gas { density: 2.0, velocity: 0.0, pressure: 0.7, gamma };
            let flow = UniformCollapse::new(geometry, initial, 1.0).unwrap();
            let (h, label) = (1e-5, 1.3);
            let at = |t: f64| flow.sample(flow.position(label, t).unwrap(), t).unwrap();
            let (before, now, after) = (at(t - h), at(t), at(t + h));
            let divergence = -f64::from(geometry.dimension()) / (1.0 - t);
            let rate = (after.density - before.density) / (2.0 * h);
            prop_assert!((rate / (-now.density * divergence) - 1.0).abs() < 1e-6);
            let heating = (after.energy() - before.energy()) / (2.0 * h);
            let work = -now.pressure / now.density * divergence;
            prop_assert!((heating / work - 1.0).abs() < 1e-6);
            prop_assert!((now.velocity + label).abs() < 1e-12);
        }
    }

    #[test]
    fn matches_the_unit_form_and_refuses_the_singularity() {
        let gamma = 5.0 / 3.0;
        let initial = Gas { density: 1.0, velocity: 0.0, pressure: gamma - 1.0, gamma };
        let flow = UniformCollapse::new(Geometry::Spherical, initial, 1.0).unwrap();
        let gas = flow.sample(0.25, 0.5).unwrap();
        assert!((gas.density - 8.0).abs() < 1e-12);
        assert!((gas.energy() - 4.0).abs() < 1e-12, "e0 (1-t)^(-d (g-1)) = 2^2");
        assert!((gas.velocity + 0.5).abs() < 1e-15);
        assert!(flow.sample(0.1, 1.0).is_err() && flow.position(0.1, -1.0).is_err());
    }
}
