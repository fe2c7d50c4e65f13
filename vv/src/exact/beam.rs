//! Bending vibrations of a uniform beam: Euler-Bernoulli and, for free ends, Timoshenko.
//!
//! Euler-Bernoulli: `f = (beta L)^2/(2 pi) sqrt(E I/(rho A L^4))` with the roots of
//! `cos x cosh x = 1` (free-free), `cos x cosh x = -1` (clamped-free), `sin x = 0` (supported).
//! Timoshenko, with `B = rho A L^4 omega^2/(E I)`, `r^2 = I/(A L^2)`, `s^2 = E I/(kappa G A L^2)`:
//! the deflection is made of `cosh p x` or `sinh p x` and `cos q x` or `sin q x`, where
//! `q^4 - B (r^2 + s^2) q^2 - B (1 - B r^2 s^2) = 0` and likewise with `p^2 = -q^2`; no moment and
//! no shear force at `x = +-1/2` give, for even and odd modes,
//! `p (p^2 + B s^2) sin(q/2) + q (q^2 - B s^2) tanh(p/2) cos(q/2) = 0`,
//! `p (p^2 + B s^2) tanh(p/2) cos(q/2) - q (q^2 - B s^2) sin(q/2) = 0`.
//! Sources: S. Timoshenko, *Vibration Problems in Engineering*; T. C. Huang, J. Appl. Mech. 28
//! (1961) 579. Square section of side `h`: `I = h^4/12`, shear factor `kappa = 5/6`.

use super::numerics::root;
use super::{InputError, above, at_least, below};
use std::f64::consts::PI;

/// Shear factor of a rectangular section.
pub const SHEAR_FACTOR: f64 = 5.0 / 6.0;

/// How a beam is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Support {
    /// Clamped at `x = 0`, free at `x = L`.
    Cantilever,
    /// Both ends free.
    FreeFree,
    /// Both ends simply supported.
    SimplySupported,
}

/// A uniform beam of square section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    length: f64,
    side: f64,
    modulus: f64,
    poisson: f64,
    density: f64,
}

impl Support {
    /// Root `beta L` of bending mode `mode`, counted from 1 (rigid motions excluded).
    ///
    /// # Errors
    /// `mode = 0`.
    pub fn root(self, mode: u32) -> Result<f64, InputError> {
        let n = at_least("mode", f64::from(mode), 1.0)?;
        Ok(match self {
            Self::Cantilever => root(|x| x.cos() + x.cosh().recip(), (n - 1.0) * PI, n * PI),
            Self::FreeFree => root(|x| x.cos() - x.cosh().recip(), n * PI, (n + 1.0) * PI),
            Self::SimplySupported => n * PI,
        })
    }

    /// Deflection of the mode at `position = x/L`, with mean square 1 over the beam.
    ///
    /// # Errors
    /// `mode = 0`, or a `position` outside `0..=1`.
    pub fn shape(self, mode: u32, position: f64) -> Result<f64, InputError> {
        let b = self.root(mode)?;
        let x = at_least("position", position, 0.0)?;
        at_least("1 - position", 1.0 - x, 0.0)?;
        let ((sin, cos), decay) = ((b * x).sin_cos(), (-b).exp());
        let (end_sin, end_cos) = b.sin_cos();
        // cosh - c sinh = (1 - c) e^(b x)/2 + (1 + c) e^(-b x)/2, with 1 - c found as
        // 2 e^(-b) times a number of order one, which no root of any order overflows.
        let hyperbolic = |over: f64, under: f64| {
            let gap = over / under;
            [
                1.0 - 2.0 * decay * gap,
                gap * (b * (x - 1.0)).exp() + (1.0 - decay * gap) * (-b * x).exp(),
            ]
        };
        let square = decay * decay;
        Ok(match self {
            Self::SimplySupported => 2f64.sqrt() * sin,
            Self::FreeFree => {
                let (over, under) =
                    (end_cos - end_sin - decay, 1.0 - square - 2.0 * decay * end_sin);
                let [c, rising] = hyperbolic(over, under);
                rising + cos - c * sin
            }
            Self::Cantilever => {
                let (over, under) =
                    (end_cos + end_sin + decay, 1.0 + square + 2.0 * decay * end_cos);
                let [c, rising] = hyperbolic(over, under);
                rising - cos + c * sin
            }
        })
    }
}

impl Beam {
    /// Beam of `size` `[length, side of the section]` with the elastic `constants` `[E, nu]`.
    ///
    /// # Errors
    /// A length, side, modulus or `density` that is not positive; `nu` outside `-1 < nu <= 1/2`.
    pub fn new(size: [f64; 2], constants: [f64; 2], density: f64) -> Result<Self, InputError> {
        let poisson = above("Poisson ratio", constants[1], -1.0)?;
        at_least("1/2 - Poisson ratio", 0.5 - poisson, 0.0)?;
        Ok(Self {
            length: above("length", size[0], 0.0)?,
            side: above("side", size[1], 0.0)?,
            modulus: above("elastic modulus", constants[0], 0.0)?,
            poisson,
            density: above("density", density, 0.0)?,
        })
    }

    /// Euler-Bernoulli frequency of a mode, in cycles per time.
    ///
    /// # Errors
    /// `mode = 0`.
    pub fn euler_bernoulli(&self, support: Support, mode: u32) -> Result<f64, InputError> {
        Ok(support.root(mode)?.powi(2) * self.unit())
    }

    /// Timoshenko frequency of a mode of the free-free beam, in cycles per time.
    ///
    /// # Errors
    /// `mode = 0`, or a mode that may lie beyond the cut-off `B r^2 s^2 = 1`, where the second
    /// spectrum of the theory begins.
    pub fn timoshenko_free(&self, mode: u32) -> Result<f64, InputError> {
        let n = at_least("mode", f64::from(mode), 1.0)?;
        let [r2, s2] = self.slenderness();
        let (low, high) = (n * PI, (n + 1.0) * PI);
        below("(omega over cut-off)^2", r2 * s2 * frequency_number(high, [r2, s2]), 1.0)?;
        let condition = |q: f64| characteristic(mode % 2 == 1, q, [r2, s2]);
        let number = frequency_number(root(condition, low, high), [r2, s2]);
        Ok(number.sqrt() * self.unit())
    }

    /// `[r^2, s^2]` of the [module](self).
    #[must_use]
    pub fn slenderness(&self) -> [f64; 2] {
        let r2 = (self.side / self.length).powi(2) / 12.0;
        [r2, r2 * 2.0 * (1.0 + self.poisson) / SHEAR_FACTOR]
    }

    /// `sqrt(E I/(rho A L^4))/(2 pi)`.
    fn unit(&self) -> f64 {
        let radius = self.side / 12f64.sqrt();
        radius * (self.modulus / self.density).sqrt() / (2.0 * PI * self.length * self.length)
    }
}

/// The lower `B` that belongs to the wavenumber `q`.
fn frequency_number(q: f64, [r2, s2]: [f64; 2]) -> f64 {
    let q2 = q * q;
    let linear = 1.0 + (r2 + s2) * q2;
    2.0 * q2 * q2 / (linear + (linear * linear - 4.0 * r2 * s2 * q2 * q2).sqrt())
}

/// Condition of free ends for `even` or odd modes at the wavenumber `q`.
fn characteristic(even: bool, q: f64, [r2, s2]: [f64; 2]) -> f64 {
    let number = frequency_number(q, [r2, s2]);
    let p = (q * q - number * (r2 + s2)).max(0.0).sqrt();
    let hyperbolic = p * (p * p + number * s2);
    let circular = q * (q * q - number * s2);
    let (sin, cos) = (0.5 * q).sin_cos();
    let tanh = (0.5 * p).tanh();
    if even {
        hyperbolic * sin + circular * tanh * cos
    } else {
        hyperbolic * tanh * cos - circular * sin
    }
}

#[cfg(test)]
mod tests {
    use super::super::numerics::integrate;
    use super::super::testing::cases;
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    const ALL: [Support; 3] = [Support::Cantilever, Support::FreeFree, Support::SimplySupported];

    fn steel(side: f64) -> Beam {
        Beam::new([10.0, side], [2.07, 0.29], 7.83).unwrap()
    }

    /// The frequency equation of Huang (1961) for free ends, of which the even and odd conditions
    /// are the factors.
    #[test]
    fn timoshenko_modes_solve_the_unfactored_equation() {
        for mode in 1..6 {
            let beam = steel(1.0);
            let [r2, s2] = beam.slenderness();
            let number = (beam.timoshenko_free(mode).unwrap() / beam.unit()).powi(2);
            let huang = |number: f64| {
                let spread = ((r2 - s2).powi(2) + 4.0 / number).sqrt();
                let half = 0.5 * number;
                let (p, q) =
                    ((half * (spread - r2 - s2)).sqrt(), (half * (spread + r2 + s2)).sqrt());
                let factor = number.sqrt() / (1.0 - number * r2 * s2).sqrt()
                    * (number * r2 * (r2 - s2).powi(2) + 3.0 * r2 - s2);
                // Divided by cosh p.
                2.0 / p.cosh() - 2.0 * q.cos() + factor * p.tanh() * q.sin()
            };
            let slope = (huang(1.001 * number) - huang(0.999 * number)).abs();
            assert!(huang(number).abs() < 1e-9 * slope, "mode {mode}: {}", huang(number));
        }
    }

    #[test]
    fn shear_and_rotation_lower_the_frequencies() {
        let drop = |mode| {
            let bernoulli = steel(0.5).euler_bernoulli(Support::FreeFree, mode).unwrap();
            1.0 - steel(0.5).timoshenko_free(mode).unwrap() / bernoulli
        };
        assert!((0.005..0.02).contains(&drop(1)), "{}", drop(1));
        assert!(drop(2) > 2.0 * drop(1) && drop(3) > 1.5 * drop(2));
        let slender = steel(1e-4);
        let bernoulli = slender.euler_bernoulli(Support::FreeFree, 3).unwrap();
        assert_relative_eq!(slender.timoshenko_free(3).unwrap(), bernoulli, max_relative = 1e-8);
        assert!(steel(2.0).timoshenko_free(40).is_err() && steel(2.0).timoshenko_free(0).is_err());
        assert!(Beam::new([1.0, 1.0], [1.0, 0.6], 1.0).is_err());
        assert!(Support::FreeFree.shape(1, 1.1).is_err() && Support::FreeFree.root(0).is_err());
    }

    proptest! {
        #![proptest_config(cases(64))]

        #[test]
        fn shapes_are_orthonormal_and_solve_the_equation(
            support in 0..3_usize, a in 1..40_u32, b in 1..40_u32, x in 0.1..0.9_f64,
        ) {
            let shape = |mode, x| ALL[support].shape(mode, x).unwrap();
            let product = integrate(|x| shape(a, x) * shape(b, x), 0.0, 1.0, 64);
            let expected = if a == b { 1.0 } else { 0.0 };
            prop_assert!((product - expected).abs() < 1e-9);
            let beta = ALL[support].root(a).unwrap();
            let h = 0.05 / beta;
            let w = |i: f64| shape(a, x + i * h);
            let fourth = w(2.0) + w(-2.0) - 4.0 * (w(1.0) + w(-1.0)) + 6.0 * w(0.0);
            prop_assert!((fourth / (h * beta).powi(4) - w(0.0)).abs() < 3e-3);
        }

        #[test]
        fn shapes_meet_their_supports(mode in 1..30_u32) {
            let at = |support: Support, x| support.shape(mode, x).unwrap();
            prop_assert!(at(Support::Cantilever, 0.0).abs() < 1e-12);
            let slope = at(Support::Cantilever, 1e-7) / 1e-7;
            prop_assert!(slope.abs() < 1e-6 * f64::from(mode * mode * 200));
            let (free, clamped) = (Support::FreeFree, Support::Cantilever);
            for (support, end) in [(free, 0.0), (free, 1.0), (clamped, 1.0)] {
                prop_assert!((at(support, end).abs() - 2.0).abs() < 1e-9);
            }
            prop_assert!(at(Support::SimplySupported, 1.0).abs() < 1e-12);
        }
    }
}
