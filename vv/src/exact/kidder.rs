//! Kidder's shell: a hollow cylinder or sphere of ideal gas compressed isentropically.
//!
//! With the dimension `k`, `gamma = 1 + 2/k` and suitable initial profiles, every particle moves
//! as `r = R h` with `h = sqrt(1 - t^2/tau^2)`, so that `rho = rho0 h^(-2/(gamma-1))`,
//! `p = p0 h^(-2 gamma/(gamma-1))` and `u = -R t/(tau^2 h)`; the focusing time is
//! `tau^2 = (gamma-1)/2 (R_e^2 - R_i^2)/(c_e^2 - c_i^2)`. Initially the squared sound speed is
//! linear in `R^2` and the entropy uniform. Sources: R. E. Kidder, Nucl. Fusion 16 (1976) 3; the
//! set-up of P.-H. Maire, J. Comput. Phys. 228 (2009) 2391.

use super::{Gas, Geometry, InputError, above, at_least, below};

/// Outer boundary of a shell and its inner radius and pressure; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// Inner radius at `t = 0`.
    pub inner_radius: f64,
    /// Outer radius at `t = 0`.
    pub outer_radius: f64,
    /// Pressure at the inner radius at `t = 0`.
    pub inner_pressure: f64,
    /// Pressure at the outer radius at `t = 0`, the larger one.
    pub outer_pressure: f64,
    /// Density at the outer radius at `t = 0`.
    pub outer_density: f64,
}

/// A Kidder shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kidder {
    geometry: Geometry,
    setup: Setup,
    gamma: f64,
    /// Squares of the initial sound speeds at the inner and outer radius.
    sound2: [f64; 2],
}

impl Kidder {
    /// The shell of `setup` in `geometry`, which fixes `gamma = 1 + 2/k`.
    ///
    /// # Errors
    /// Radii or pressures that are not positive and larger outside, or `outer_density <= 0`.
    pub fn new(geometry: Geometry, setup: Setup) -> Result<Self, InputError> {
        let inner_radius = above("inner radius", setup.inner_radius, 0.0)?;
        above("outer radius", setup.outer_radius, inner_radius)?;
        let inner_pressure = above("inner pressure", setup.inner_pressure, 0.0)?;
        let outer_pressure = above("outer pressure", setup.outer_pressure, inner_pressure)?;
        let density = above("outer density", setup.outer_density, 0.0)?;
        let gamma = 1.0 + 2.0 / f64::from(geometry.dimension());
        let outer = gamma * outer_pressure / density;
        let inner = outer * (inner_pressure / outer_pressure).powf(1.0 - 1.0 / gamma);
        Ok(Self { geometry, setup, gamma, sound2: [inner, outer] })
    }

    /// Focusing time `tau`, when the shell reaches the centre.
    #[must_use]
    pub fn focusing_time(&self) -> f64 {
        let Setup { inner_radius, outer_radius, .. } = self.setup;
        let [inner, outer] = self.sound2;
        let squares = outer_radius * outer_radius - inner_radius * inner_radius;
        (0.5 * (self.gamma - 1.0) * squares / (outer - inner)).sqrt()
    }

    /// Ratio of specific heats, `1 + 2/k`.
    #[must_use]
    pub const fn gamma(&self) -> f64 {
        self.gamma
    }

    /// Scale `h` of all radii at time `t`.
    ///
    /// # Errors
    /// `t < 0` or `t` at or beyond the focusing time.
    pub fn scale(&self, t: f64) -> Result<f64, InputError> {
        let tau = self.focusing_time();
        let part = below("t", at_least("t", t, 0.0)?, tau)? / tau;
        Ok(((1.0 - part) * (1.0 + part)).sqrt())
    }

    /// Inner and outer radius at time `t`.
    ///
    /// # Errors
    /// As for [`Self::scale`].
    pub fn radii(&self, t: f64) -> Result<[f64; 2], InputError> {
        let h = self.scale(t)?;
        Ok([h * self.setup.inner_radius, h * self.setup.outer_radius])
    }

    /// State at time `t` of the particle that started at radius `label`.
    ///
    /// # Errors
    /// A `label` outside the shell, or as for [`Self::scale`].
    pub fn particle(&self, label: f64, t: f64) -> Result<Gas, InputError> {
        let Setup { inner_radius, outer_radius, outer_pressure, outer_density, .. } = self.setup;
        let label = at_least("label", label, inner_radius)?;
        at_least("outer radius - label", outer_radius - label, 0.0)?;
        let h = self.scale(t)?;
        let part = (label - inner_radius) * (label + inner_radius)
            / ((outer_radius - inner_radius) * (outer_radius + inner_radius));
        let [inner, outer] = self.sound2;
        let initial = ((inner + part * (outer - inner)) / outer).powf(1.0 / (self.gamma - 1.0));
        let compression = initial * h.powi(-self.geometry.dimension());
        let tau = self.focusing_time();
        Ok(Gas {
            density: outer_density * compression,
            velocity: -label * t / (tau * tau * h),
            pressure: outer_pressure * compression.powf(self.gamma),
            gamma: self.gamma,
        })
    }

    /// State at radius `r` and time `t`.
    ///
    /// # Errors
    /// `r` outside the shell at that time, or as for [`Self::scale`].
    pub fn sample(&self, r: f64, t: f64) -> Result<Gas, InputError> {
        self.particle(r / self.scale(t)?, t)
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use proptest::prelude::*;

    const SETUP: Setup = Setup {
        inner_radius: 0.9,
        outer_radius: 1.0,
        inner_pressure: 0.1,
        outer_pressure: 10.0,
        outer_density: 0.01,
    };

    #[test]
    fn refuses_nonsense() {
        let shell = Kidder::new(Geometry::Spherical, SETUP).unwrap();
        assert!(shell.sample(0.5, 0.0).is_err() && shell.sample(1.1, 0.0).is_err());
        assert!(shell.scale(shell.focusing_time()).is_err() && shell.radii(-1.0).is_err());
        let swapped = Setup { inner_pressure: 20.0, ..SETUP };
        assert!(Kidder::new(Geometry::Spherical, swapped).is_err());
    }

    proptest! {
        #![proptest_config(cases(96))]

        /// `rho du/dt = -dp/dr` and `d rho/dt = -rho (du/dr + (k-1) u/r)` for a particle.
        #[test]
        fn satisfies_momentum_and_mass(k in 0..3_usize, at in 0.1..0.9_f64, part in 0.05..0.9_f64) {
            let shell = Kidder::new(Geometry::ALL[k], SETUP).unwrap();
            let (t, label) = (part * shell.focusing_time(), 0.9 + 0.1 * at);
            let (dt, dr) = (1e-6 * shell.focusing_time(), 1e-6);
            let h = shell.scale(t).unwrap();
            let state = |i: f64, j: f64| shell.particle(label + i * dr, t + j * dt).unwrap();
            let now = state(0.0, 0.0);
            let acceleration = (state(0.0, 1.0).velocity - state(0.0, -1.0).velocity) / (2.0 * dt);
            let gradient = (state(1.0, 0.0).pressure - state(-1.0, 0.0).pressure) / (2.0 * h * dr);
            prop_assert!((now.density * acceleration / -gradient - 1.0).abs() < 1e-5);
            let rate = (state(0.0, 1.0).density - state(0.0, -1.0).density) / (2.0 * dt);
            let spread = (state(1.0, 0.0).velocity - state(-1.0, 0.0).velocity) / (2.0 * h * dr);
            let around = f64::from(shell.geometry.dimension() - 1) * now.velocity / (label * h);
            prop_assert!((rate / (-now.density * (spread + around)) - 1.0).abs() < 1e-5);
        }
    }
}
