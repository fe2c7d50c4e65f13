//! Mie-Gruneisen equation of state about a linear Hugoniot: pressure, sound speed, temperature.
//!
//! With `mu = rho/rho0 - 1`, `eta = 1 - rho0/rho` and `gamma rho = rho0 (gamma0 + b mu)`:
//! `P = P_H (1 - (gamma0 + b mu) eta/2) + rho0 (gamma0 + b mu) e` in compression, where
//! `P_H = rho0 c0^2 eta/(1 - s eta)^2`, and `P = rho0 c0^2 mu + rho0 (gamma0 + b mu) e` in
//! expansion. Source: D. J. Steinberg, UCRL-MA-106439 (1996), whose cubic in `mu` this is.
//! The coefficient `b` selects the reading of `gamma`: `b = 0` is constant `gamma rho`,
//! `b = gamma0` is constant `gamma`, and values between are Steinberg's
//! `gamma = (gamma0 + b mu)/(1 + mu)`.

use super::hugoniot::Hugoniot;
use super::numerics::integrate;
use super::{InputError, above, at_least, below, finite};

/// Panels of the temperature quadrature.
const PANELS: u32 = 32;

/// A Mie-Gruneisen solid; see the [module](self) for its equation of state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MieGruneisen {
    hugoniot: Hugoniot,
    gamma: f64,
    correction: f64,
}

impl MieGruneisen {
    /// Steinberg's reading, `gamma = (gamma0 + b mu)/(1 + mu)`.
    ///
    /// # Errors
    /// `gamma0 < 0`, or `b` outside `0 <= b <= gamma0`, for which `gamma` could change sign.
    pub fn steinberg(hugoniot: Hugoniot, gamma0: f64, b: f64) -> Result<Self, InputError> {
        let gamma = at_least("gamma0", gamma0, 0.0)?;
        let correction = at_least("b", b, 0.0)?;
        at_least("gamma0 - b", gamma - correction, 0.0)?;
        Ok(Self { hugoniot, gamma, correction })
    }

    /// Constant product `gamma rho = gamma0 rho0`.
    ///
    /// # Errors
    /// `gamma0 < 0`.
    pub fn constant_product(hugoniot: Hugoniot, gamma0: f64) -> Result<Self, InputError> {
        Self::steinberg(hugoniot, gamma0, 0.0)
    }

    /// Constant `gamma`.
    ///
    /// # Errors
    /// `gamma < 0`.
    pub fn constant_gamma(hugoniot: Hugoniot, gamma: f64) -> Result<Self, InputError> {
        Self::steinberg(hugoniot, gamma, gamma)
    }

    /// The Hugoniot the equation of state refers to.
    #[must_use]
    pub const fn hugoniot(&self) -> &Hugoniot {
        &self.hugoniot
    }

    /// Pressure at `density` and specific internal `energy`.
    ///
    /// # Errors
    /// A `density` not between zero and the limiting one, or a non-finite `energy`.
    pub fn pressure(&self, density: f64, energy: f64) -> Result<f64, InputError> {
        Ok(self.raw_pressure(self.admissible(density)?, finite("energy", energy)?))
    }

    /// Square of the adiabatic sound speed, `dP/drho|_e + (P/rho^2) dP/de|_rho`; negative where
    /// the equation of state is unstable.
    ///
    /// # Errors
    /// As for [`Self::pressure`].
    pub fn sound_speed_squared(&self, density: f64, energy: f64) -> Result<f64, InputError> {
        Ok(self.raw_sound_speed_squared(self.admissible(density)?, finite("energy", energy)?))
    }

    /// Temperature behind a shock of velocity `particle_speed` into material at `initial`
    /// temperature, for a constant `specific_heat` `c_v`:
    /// `T = e^G(up) [T0 + (s/c_v) int_0^up u^2/(c0 + s u) e^(-G(u)) du]` with
    /// `G = int gamma d ln rho` to the density behind the shock of velocity `u`.
    /// Source: J. M. Walsh and R. H. Christian, Phys. Rev. 97 (1955) 1544, integrated for the
    /// linear Hugoniot.
    ///
    /// # Errors
    /// A negative `particle_speed` or `initial`, or `specific_heat <= 0`.
    pub fn temperature(
        &self,
        particle_speed: f64,
        initial: f64,
        specific_heat: f64,
    ) -> Result<f64, InputError> {
        let shock = self.hugoniot.at_particle_speed(particle_speed)?;
        let initial = at_least("initial temperature", initial, 0.0)?;
        let specific_heat = above("specific heat", specific_heat, 0.0)?;
        let (c0, s) = (self.hugoniot.sound_speed(), self.hugoniot.slope());
        let heating = |u: f64| {
            let shock_speed = c0 + s * u;
            s * u * u / shock_speed * (-self.isentrope(u / shock_speed)).exp()
        };
        let integral = integrate(heating, 0.0, particle_speed, PANELS);
        let factor = self.isentrope(1.0 - shock.volume_ratio).exp();
        Ok(factor * (initial + integral / specific_heat))
    }

    /// Factor `exp(int gamma d ln rho)` by which temperature changes along an isentrope from
    /// density `from` to density `to`, for a constant specific heat.
    ///
    /// # Errors
    /// A density not between zero and the limiting one.
    pub fn isentropic_heating(&self, from: f64, to: f64) -> Result<f64, InputError> {
        let eta = |density| Ok(1.0 - self.hugoniot.density() / self.admissible(density)?);
        Ok((self.isentrope(eta(to)?) - self.isentrope(eta(from)?)).exp())
    }

    /// `G(eta) = gamma0 eta - b (ln(1 - eta) + eta)`.
    fn isentrope(&self, eta: f64) -> f64 {
        self.gamma * eta - self.correction * ((-eta).ln_1p() + eta)
    }

    fn admissible(&self, density: f64) -> Result<f64, InputError> {
        below("density", above("density", density, 0.0)?, self.hugoniot.limiting_density())
    }

    /// [`Self::pressure`] without the check of its arguments.
    pub(crate) fn raw_pressure(&self, density: f64, energy: f64) -> f64 {
        let [reference, _] = self.reference(density);
        reference + self.gamma_density(density) * energy
    }

    /// [`Self::sound_speed_squared`] without the check of its arguments.
    pub(crate) fn raw_sound_speed_squared(&self, density: f64, energy: f64) -> f64 {
        let [reference, slope] = self.reference(density);
        let thermal = self.gamma_density(density);
        let pressure = reference + thermal * energy;
        slope + self.correction * energy + pressure * thermal / (density * density)
    }

    /// `gamma rho`, the derivative of the pressure by the energy.
    pub(crate) fn gamma_density(&self, density: f64) -> f64 {
        let rho0 = self.hugoniot.density();
        rho0 * self.gamma + self.correction * (density - rho0)
    }

    /// Pressure at zero energy and its derivative by the density.
    fn reference(&self, density: f64) -> [f64; 2] {
        let (rho0, c0, s) =
            (self.hugoniot.density(), self.hugoniot.sound_speed(), self.hugoniot.slope());
        if density < rho0 {
            return [c0 * c0 * (density - rho0), c0 * c0];
        }
        let eta = 1.0 - rho0 / density;
        let eta_slope = rho0 / (density * density);
        let gap = 1.0 - s * eta;
        let shock = rho0 * c0 * c0 * eta / (gap * gap);
        let shock_slope = rho0 * c0 * c0 * (1.0 + s * eta) / (gap * gap * gap) * eta_slope;
        let half_gamma = 0.5 * self.gamma_density(density) / rho0;
        let factor = 1.0 - half_gamma * eta;
        let factor_slope = -half_gamma * eta_slope - 0.5 * self.correction * eta / rho0;
        [shock * factor, shock_slope * factor + shock * factor_slope]
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::super::numerics::runge_kutta;
    use super::super::testing::cases;
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    fn aluminium(b: f64) -> MieGruneisen {
        let hugoniot = Hugoniot::new(2.703, 0.524, 1.4).unwrap();
        MieGruneisen::steinberg(hugoniot, 1.97, b).unwrap()
    }

    #[test]
    fn the_two_readings_differ_as_the_density() {
        let hugoniot = *aluminium(0.0).hugoniot();
        let product = MieGruneisen::constant_product(hugoniot, 1.97).unwrap();
        let constant = MieGruneisen::constant_gamma(hugoniot, 1.97).unwrap();
        assert_eq!(product, aluminium(0.0));
        let compressed = 2.703 / 0.8;
        let ratio = constant.gamma_density(compressed) / product.gamma_density(compressed);
        assert_relative_eq!(ratio, 1.25, max_relative = 1e-14);
        assert!(MieGruneisen::steinberg(hugoniot, 1.97, 2.0).is_err());
        assert!(product.pressure(9.5, 0.0).is_err() && product.pressure(0.0, 0.0).is_err());
        assert!(product.temperature(0.1, 300.0, 0.0).is_err());
    }

    /// Steinberg's cubic, `rho0 c0^2 mu [1 + (1 - gamma0/2) mu - b mu^2/2]/[1 - (s - 1) mu]^2`.
    #[test]
    fn agrees_with_the_printed_cubic() {
        let solid = aluminium(0.48);
        for mu in [1e-3, 0.1, 0.4, 0.8] {
            let cubic = 1.0 + (1.0 - 0.985) * mu - 0.24 * mu * mu;
            let cold = 2.703 * 0.524_f64.powi(2) * mu * cubic / (1.0 - 0.4 * mu).powi(2);
            let pressure = solid.pressure(2.703 * (1.0 + mu), 0.01).unwrap();
            let expected = cold + (1.97 + 0.48 * mu) * 2.703 * 0.01;
            assert_relative_eq!(pressure, expected, max_relative = 1e-12);
        }
    }

    #[test]
    fn weak_shocks_heat_isentropically() {
        let solid = aluminium(0.48);
        let shock = solid.hugoniot().at_particle_speed(1e-3).unwrap();
        let heated = solid.temperature(1e-3, 300.0, 0.885e-5).unwrap();
        let isentropic = 300.0 * solid.isentropic_heating(2.703, shock.density).unwrap();
        assert_relative_eq!(heated, isentropic, max_relative = 1e-4);
        assert_eq!(solid.temperature(0.0, 300.0, 0.885e-5).unwrap(), 300.0);
    }

    /// Temperature also follows from the energy above the isentrope through the initial state.
    #[test]
    fn temperature_agrees_with_the_energy_above_the_isentrope() {
        for solid in [aluminium(0.0), aluminium(0.48), aluminium(1.97)] {
            let shock = solid.hugoniot().at_particle_speed(0.25).unwrap();
            let steps = 2000_u32;
            let step = (shock.density / 2.703).ln() / f64::from(steps);
            let rate = |[x, e]: [f64; 2]| {
                let density = x.exp();
                [1.0, solid.raw_pressure(density, e) / density]
            };
            let start = [2.703_f64.ln(), 0.0];
            let [_, cold] = (0..steps).fold(start, |s, _| runge_kutta(s, step, rate));
            let isentropic = 300.0 * solid.isentropic_heating(2.703, shock.density).unwrap();
            let expected = isentropic + (shock.energy - cold) / 0.885e-5;
            let heated = solid.temperature(0.25, 300.0, 0.885e-5).unwrap();
            assert_relative_eq!(heated, expected, max_relative = 1e-8);
        }
    }

    /// Any solid of ordinary constants.
    pub(crate) fn any() -> impl Strategy<Value = MieGruneisen> {
        (1.0..20.0, 0.1..0.6, 1.1..1.9, 0.2..2.2, 0.0..1.0).prop_map(
            |(rho0, c0, s, gamma, part)| {
                let hugoniot = Hugoniot::new(rho0, c0, s).unwrap();
                MieGruneisen::steinberg(hugoniot, gamma, part * gamma).unwrap()
            },
        )
    }

    proptest! {
        #![proptest_config(cases(96))]

        #[test]
        fn passes_through_the_hugoniot(solid in any(), up in 1e-4..0.6) {
            let shock = solid.hugoniot().at_particle_speed(up).unwrap();
            let pressure = solid.pressure(shock.density, shock.energy).unwrap();
            prop_assert!((pressure / shock.pressure - 1.0).abs() < 1e-9);
        }

        #[test]
        fn sound_speed_is_the_isentropic_slope(solid in any(), at in 0.6..1.5_f64, e in 0.0..0.02) {
            let rho0 = solid.hugoniot().density();
            let (density, h) = (rho0 * at, 1e-5 * rho0);
            prop_assume!((at - 1.0).abs() > 1e-4);
            prop_assume!(density + h < solid.hugoniot().limiting_density());
            let energy = |by: f64| e + by * solid.raw_pressure(density, e) / density.powi(2);
            let high = solid.pressure(density + h, energy(h)).unwrap();
            let low = solid.pressure(density - h, energy(-h)).unwrap();
            let sound2 = solid.sound_speed_squared(density, e).unwrap();
            let scale = sound2.abs() + solid.hugoniot().sound_speed().powi(2);
            prop_assert!(((high - low) / (2.0 * h) - sound2).abs() < 2e-6 * scale);
        }

    }
}
