//! Cosine modes of heat conduction along an insulated chain, discrete and in the continuum limit.
//!
//! In a chain of `n` equal particles that exchange heat with their neighbours at the rate `R`
//! (`d theta_i/dt = R (theta_(i-1) - 2 theta_i + theta_(i+1))`, insulated ends), the shape
//! `cos(pi m (i + 1/2)/n)` decays as `exp(-4 R sin^2(pi m/2n) t)`. With spacing `dx` the continuum
//! limit has diffusivity `kappa = R dx^2` and decay rate `kappa (pi m/(n dx))^2 = R (pi m/n)^2`.
//! For the particle method with conduction coefficient `k_o`, `R = k_o c_s/dx`.
//! Source: eigenvectors of the second-difference matrix with Neumann ends (type-II cosines).

use super::{InputError, above, below};
use std::f64::consts::PI;

/// One cosine mode of an insulated chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CosineMode {
    phase: f64,
    exchange_rate: f64,
}

impl CosineMode {
    /// Mode `number` (half waves along the chain, below `particles`) of a chain whose neighbours
    /// exchange heat at `exchange_rate` `R`, per time.
    ///
    /// # Errors
    /// No particles, `number >= particles` or `exchange_rate <= 0`.
    pub fn new(particles: u32, number: u32, exchange_rate: f64) -> Result<Self, InputError> {
        let n = above("particles", f64::from(particles), 0.0)?;
        let m = below("number", f64::from(number), n)?;
        Ok(Self { phase: PI * m / n, exchange_rate: above("exchange rate", exchange_rate, 0.0)? })
    }

    /// Mode shape at particle `i`, `cos(pi m (i + 1/2)/n)`, at the chain coordinate `i + 1/2`.
    #[must_use]
    pub fn shape(&self, i: u32) -> f64 {
        (self.phase * (f64::from(i) + 0.5)).cos()
    }

    /// Decay rate in the discrete chain, `4 R sin^2(pi m/2n)`, per time.
    #[must_use]
    pub fn discrete_rate(&self) -> f64 {
        4.0 * self.exchange_rate * (0.5 * self.phase).sin().powi(2)
    }

    /// Decay rate in the continuum, `R (pi m/n)^2`, per time.
    #[must_use]
    pub fn continuum_rate(&self) -> f64 {
        self.exchange_rate * self.phase.powi(2)
    }

    /// Temperature of particle `i` at time `t`, starting from unit amplitude, in the chain.
    #[must_use]
    pub fn discrete_temperature(&self, i: u32, t: f64) -> f64 {
        self.shape(i) * (-self.discrete_rate() * t).exp()
    }

    /// As [`Self::discrete_temperature`], in the continuum.
    #[must_use]
    pub fn continuum_temperature(&self, i: u32, t: f64) -> f64 {
        self.shape(i) * (-self.continuum_rate() * t).exp()
    }

    /// Largest stable explicit Euler step of the chain, `1/(2 R)`.
    #[must_use]
    pub fn stable_step(&self) -> f64 {
        0.5 / self.exchange_rate
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    /// `heat_chain_decay.csv` (n = 32, R = 0.1 `c_s/dx)`: mode, continuum rate, chain rate.
    const TABLE: [(u32, f64, f64); 5] = [
        (1, 0.000_963_828_55, 0.000_963_054_67),
        (2, 0.003_855_314_2, 0.003_842_943_9),
        (4, 0.015_421_257, 0.015_224_093),
        (8, 0.061_685_028, 0.058_578_644),
        (16, 0.246_740_11, 0.2),
    ];

    #[test]
    fn reproduces_the_reference_rates() {
        for (number, continuum, chain) in TABLE {
            let mode = CosineMode::new(32, number, 0.1).unwrap();
            assert_relative_eq!(mode.continuum_rate(), continuum, max_relative = 1e-7);
            assert_relative_eq!(mode.discrete_rate(), chain, max_relative = 1e-7);
        }
        assert!(CosineMode::new(8, 8, 0.1).is_err() && CosineMode::new(0, 0, 0.1).is_err());
        assert!(CosineMode::new(8, 1, 0.0).is_err());
    }

    proptest! {
        #![proptest_config(cases(32))]

        /// The shape is an eigenvector of the insulated chain with the stated eigenvalue.
        #[test]
        fn is_an_eigenmode(n in 2..60_u32, fraction in 0.0..1.0, rate in 0.01..10.0) {
            let number = (f64::from(n) * fraction) as u32;
            let mode = CosineMode::new(n, number, rate).unwrap();
            for i in 0..n {
                let (left, right) = (i.saturating_sub(1), (i + 1).min(n - 1));
                let change = mode.shape(left) - 2.0 * mode.shape(i) + mode.shape(right);
                let expected = -mode.discrete_rate() * mode.shape(i);
                prop_assert!((rate * change - expected).abs() < 1e-12 * rate);
            }
            prop_assert!(mode.discrete_rate() <= mode.continuum_rate());
            prop_assert!(mode.discrete_rate() * mode.stable_step() <= 2.0);
        }
    }
}
