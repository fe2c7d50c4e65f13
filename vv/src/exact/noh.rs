//! The Noh implosion: cold gas of uniform inward speed stopped by a wall, an axis or a centre.
//!
//! Source: W. F. Noh, J. Comput. Phys. 72 (1987) 78-120. For dimension `k` and `D = (g-1) U/2`,
//! behind the shock at `r = D t` the gas is at rest with `rho = rho0 ((g+1)/(g-1))^k`,
//! `e = U^2/2` and `p = (g-1) rho e`; ahead of it `rho = rho0 (1 + U t/r)^(k-1)`, `u = -U`,
//! `p = 0`. (The form `p = 4^k rho0 U^2/3` found elsewhere holds for `g = 5/3` only.)

use super::{Gas, Geometry, InputError, above, at_least};

/// Parameters of a Noh problem; see the [module](self) for the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noh {
    geometry: Geometry,
    gamma: f64,
    density: f64,
    speed: f64,
}

impl Noh {
    /// A gas of initial `density` moving inwards at `speed > 0`.
    ///
    /// # Errors
    /// `gamma <= 1`, `density <= 0` or `speed <= 0`.
    pub fn new(
        geometry: Geometry,
        gamma: f64,
        density: f64,
        speed: f64,
    ) -> Result<Self, InputError> {
        Ok(Self {
            geometry,
            gamma: above("gamma", gamma, 1.0)?,
            density: above("density", density, 0.0)?,
            speed: above("speed", speed, 0.0)?,
        })
    }

    /// Speed of the shock, `(gamma - 1) U / 2`, constant in every geometry.
    #[must_use]
    pub fn shock_speed(&self) -> f64 {
        0.5 * (self.gamma - 1.0) * self.speed
    }

    /// Radius of the shock at time `t`.
    #[must_use]
    pub fn shock_position(&self, t: f64) -> f64 {
        self.shock_speed() * t
    }

    /// The constant state behind the shock.
    #[must_use]
    pub fn behind(&self) -> Gas {
        let density = self.density * self.compression().powi(self.geometry.dimension());
        let energy = 0.5 * self.speed * self.speed;
        self.gas(density, 0.0, (self.gamma - 1.0) * density * energy)
    }

    /// The state just ahead of the shock, also constant in time.
    #[must_use]
    pub fn ahead(&self) -> Gas {
        let density = self.density * self.compression().powi(self.geometry.dimension() - 1);
        self.gas(density, -self.speed, 0.0)
    }

    /// State at radius `r` and time `t`; the shock itself counts as behind.
    ///
    /// # Errors
    /// Negative or non-finite `r` or `t`.
    pub fn sample(&self, r: f64, t: f64) -> Result<Gas, InputError> {
        let (r, t) = (at_least("r", r, 0.0)?, at_least("t", t, 0.0)?);
        if t > 0.0 && r <= self.shock_position(t) {
            return Ok(self.behind());
        }
        let convergence = if t > 0.0 { 1.0 + self.speed * t / r } else { 1.0 };
        let density = self.density * convergence.powi(self.geometry.dimension() - 1);
        Ok(self.gas(density, -self.speed, 0.0))
    }

    /// Radius at time `t` of the particle that started at radius `label`.
    ///
    /// # Errors
    /// Negative or non-finite `label` or `t`.
    pub fn position(&self, label: f64, t: f64) -> Result<f64, InputError> {
        let (label, t) = (at_least("label", label, 0.0)?, at_least("t", t, 0.0)?);
        Ok((label - self.speed * t).max(label / self.compression()))
    }

    /// Initial radius of the particle that is at radius `r` at time `t`, the inverse of
    /// [`Self::position`].
    ///
    /// # Errors
    /// Negative or non-finite `r` or `t`.
    pub fn label(&self, r: f64, t: f64) -> Result<f64, InputError> {
        let (r, t) = (at_least("r", r, 0.0)?, at_least("t", t, 0.0)?);
        Ok((r + self.speed * t).min(r * self.compression()))
    }

    /// Flux of mass, momentum and energy through the moving shock, `[rho w, rho u w + p,
    /// E w + p u]` with `w = u - D`, ahead of it and behind it: equal by the jump conditions.
    #[must_use]
    pub fn shock_fluxes(&self) -> [[f64; 3]; 2] {
        [self.ahead(), self.behind()].map(|gas| gas.flux(self.shock_speed()))
    }

    /// Density ratio of a strong shock, `(gamma + 1)/(gamma - 1)`.
    fn compression(&self) -> f64 {
        (self.gamma + 1.0) / (self.gamma - 1.0)
    }

    fn gas(&self, density: f64, velocity: f64, pressure: f64) -> Gas {
        Gas { density, velocity, pressure, gamma: self.gamma }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{cases, close};
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn starts_from_the_uniform_state_and_refuses_nonsense() {
        let noh = Noh::new(Geometry::Spherical, 1.4, 2.0, 3.0).unwrap();
        let start = noh.sample(0.0, 0.0).unwrap();
        assert_eq!((start.density, start.velocity), (2.0, -3.0));
        assert!(noh.sample(-1.0, 0.1).is_err() && noh.sample(1.0, f64::NAN).is_err());
        assert!(Noh::new(Geometry::Planar, 1.0, 1.0, 1.0).is_err());
    }

    fn problem() -> impl Strategy<Value = Noh> {
        (0..3_usize, 1.01..4.0, 0.01..100.0, 0.01..100.0)
            .prop_map(|(k, g, rho, u)| Noh::new(Geometry::ALL[k], g, rho, u).unwrap())
    }

    proptest! {
        #![proptest_config(cases(64))]

        #[test]
        fn satisfies_the_jump_conditions(noh in problem(), t in 0.01..10.0) {
            let (d, r) = (noh.shock_speed(), noh.shock_position(t));
            let behind = noh.sample(r * (1.0 - 1e-14), t).unwrap();
            let ahead = noh.sample(r * (1.0 + 1e-14), t).unwrap();
            let scale = ahead.flux(d).map(f64::abs);
            prop_assert!(close(behind.flux(d), ahead.flux(d), scale, 1e-10));
            prop_assert!((ahead.density / noh.ahead().density - 1.0).abs() < 1e-10);
            let [before, after] = noh.shock_fluxes();
            prop_assert!(close(before, after, scale, 1e-12));
        }

        /// Mass inside the label `R` is `rho0 R^k` (per angle and per `1/k`) at all times.
        #[test]
        fn particles_carry_their_mass(noh in problem(), label in 0.1..2.0, t in 0.0..3.0) {
            let k = noh.geometry.dimension();
            let (r, shock) = (noh.position(label, t).unwrap(), noh.shock_position(t));
            let inner = noh.behind().density * r.min(shock).powi(k);
            // Midpoint rule is exact after the substitution s = r + U t, in which
            // rho r^(k-1) dr = rho0 s^(k-1) ds.
            let outer = if r > shock {
                let lag = noh.speed * t;
                noh.density * ((r + lag).powi(k) - (shock + lag).powi(k))
            } else {
                0.0
            };
            let mass = noh.density * label.powi(k);
            prop_assert!(((inner + outer) / mass - 1.0).abs() < 1e-10);
            prop_assert!(noh.sample(r, t).unwrap().density >= noh.density);
            prop_assert!((noh.label(r, t).unwrap() / label - 1.0).abs() < 1e-10);
        }
    }
}
