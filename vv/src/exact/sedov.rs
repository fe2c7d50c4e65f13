//! The Sedov blast: energy released at a plane, line or point of a uniform cold gas.
//!
//! With the dimension `k`, the shock is at `R = (E t^2/(alpha rho0))^(1/(k+2))`. The closed form
//! of L. I. Sedov, *Similarity and Dimensional Methods in Mechanics* (1959), ch. 4, in the
//! notation of J. R. Kamm and F. X. Timmes, LA-UR-07-2849 (2007), uses `V = t u/r` as parameter,
//! from `2/((k+2) gamma)` at the origin to `4/((k+2)(gamma+1))` at the shock; their four factors
//! are one at the shock. It holds where the gas fills the origin, `(k-2) gamma < 3 k - 2`: the
//! standard case, any `gamma` but in spheres `gamma < 7`. The exponents of the density have the
//! divisor `2 - gamma`, which is taken out here, so that `gamma = 2` is not special.
//!
//! `E` is the energy of one side of the plane, of unit length of the line, or of the whole point
//! blast.

use super::numerics::{integrate_singular, root};
use super::{Gas, Geometry, InputError, above, at_least, below};
use std::f64::consts::PI;

/// A Sedov blast; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sedov {
    geometry: Geometry,
    gamma: f64,
    density: f64,
    energy: f64,
    alpha: f64,
}

/// Solution at one value of the parameter, in units of the values behind the shock.
#[derive(Clone, Copy)]
struct Similar {
    radius: f64,
    velocity: f64,
    density: f64,
    pressure: f64,
    /// `d ln(radius)/d ln(x2)`.
    stretch: f64,
}

/// `ln(1 + a e)/e`, continued to `e = 0`.
fn log_quotient(a: f64, e: f64) -> f64 {
    if e.abs() < f64::MIN_POSITIVE { a } else { (a * e).ln_1p() / e }
}

impl Sedov {
    /// Blast of `energy` in a gas of initial `density`.
    ///
    /// # Errors
    /// `gamma <= 1`, a spherical blast with `gamma >= 7`, `density <= 0` or `energy <= 0`.
    pub fn new(
        geometry: Geometry,
        gamma: f64,
        density: f64,
        energy: f64,
    ) -> Result<Self, InputError> {
        let gamma = above("gamma", gamma, 1.0)?;
        if geometry == Geometry::Spherical {
            below("gamma", gamma, 7.0)?;
        }
        let density = above("density", density, 0.0)?;
        let energy = above("energy", energy, 0.0)?;
        let blast = Self { geometry, gamma, density, energy, alpha: 1.0 };
        Ok(Self { alpha: blast.energy_integral(), ..blast })
    }

    /// The constant `alpha = E t^2/(rho0 R^(k+2))`.
    #[must_use]
    pub const fn alpha(&self) -> f64 {
        self.alpha
    }

    /// Radius of the shock at time `t`.
    ///
    /// # Errors
    /// A negative or non-finite `t`.
    pub fn shock_position(&self, t: f64) -> Result<f64, InputError> {
        let t = at_least("t", t, 0.0)?;
        Ok((self.energy * t * t / (self.alpha * self.density)).powf(1.0 / (self.k() + 2.0)))
    }

    /// Speed `2 R/((k + 2) t)` of the shock at time `t`.
    ///
    /// # Errors
    /// `t <= 0`.
    pub fn shock_speed(&self, t: f64) -> Result<f64, InputError> {
        let t = above("t", t, 0.0)?;
        Ok(2.0 * self.shock_position(t)? / ((self.k() + 2.0) * t))
    }

    /// State just behind the shock at time `t`: that of a strong shock.
    ///
    /// # Errors
    /// `t <= 0`.
    pub fn behind(&self, t: f64) -> Result<Gas, InputError> {
        let speed = self.shock_speed(t)?;
        let plus = self.gamma + 1.0;
        Ok(Gas {
            density: self.density * plus / (self.gamma - 1.0),
            velocity: 2.0 * speed / plus,
            pressure: 2.0 * self.density * speed * speed / plus,
            gamma: self.gamma,
        })
    }

    /// State at radius `r` and time `t`; the shock itself counts as behind.
    ///
    /// At the origin the density is zero and the pressure is not.
    ///
    /// # Errors
    /// `r < 0` or `t <= 0`.
    pub fn sample(&self, r: f64, t: f64) -> Result<Gas, InputError> {
        let r = at_least("r", r, 0.0)?;
        let (behind, radius) = (self.behind(t)?, self.shock_position(t)?);
        if r > radius {
            let cold = Gas { density: self.density, velocity: 0.0, pressure: 0.0, ..behind };
            return Ok(cold);
        }
        let state = self.similar(self.parameter(r / radius));
        Ok(Gas {
            density: behind.density * state.density,
            velocity: behind.velocity * state.velocity,
            pressure: behind.pressure * state.pressure,
            gamma: self.gamma,
        })
    }

    fn k(&self) -> f64 {
        f64::from(self.geometry.dimension())
    }

    /// `ln x2` at the scaled radius `target <= 1`.
    fn parameter(&self, target: f64) -> f64 {
        let reach = |z: f64| self.similar(z).radius - target;
        let mut low = -1.0;
        while reach(low) > 0.0 {
            low *= 2.0;
        }
        root(reach, low, 0.0)
    }

    /// The closed form at `z = ln x2 <= 0`.
    fn similar(&self, z: f64) -> Similar {
        let (k, gamma) = (self.k(), self.gamma);
        let (minus, k2, excess) = (gamma - 1.0, k + 2.0, 2.0 - gamma);
        let (d1, d2) = (2.0 + k * minus, 2.0 * minus + k);
        let jump = (gamma + 1.0) / minus;
        let x2 = z.exp();
        let v = 2.0 * (1.0 + x2 / jump) / (k2 * gamma);
        let v_slope = 2.0 * x2 / (jump * k2 * gamma);
        let half = 0.5 * k2 * v;
        let x1 = 0.5 * half * (gamma + 1.0);
        let d3 = k2 + (k - 2.0) * excess;
        let x3 = k2 * (gamma + 1.0) / d3 * (1.0 - 0.5 * d1 * v);
        let x4 = jump * (1.0 - half);
        let a0 = 2.0 / k2;
        let a2 = -minus / d2;
        let a1 = k2 * gamma / d1 * (2.0 * k * excess / (gamma * k2 * k2) - a2);
        let radius = (-a0 * x1.ln() - a2 * z - a1 * x3.ln()).exp();
        // (a1 (k + 2) - 2)/(2 - gamma) and ln(x3/x4)/(2 - gamma) without the division.
        let exponent = 2.0 * k / d1 + (k2 * k2 * (excess - 1.0) - 4.0 * k * excess) / (d1 * d2);
        let ratio = log_quotient(-2.0 * k / d3, excess)
            + log_quotient(half * k / (k2 * (1.0 - half)), excess);
        let common = exponent * x3.ln() + 2.0 * ratio;
        Similar {
            radius,
            velocity: x1 * radius,
            density: (k / d2 * z + common).exp(),
            pressure: (a0 * k * x1.ln() + common - 2.0 * a1 * x3.ln() + x4.ln()).exp(),
            stretch: -a0 * v_slope / v - a2 + a1 * 0.5 * d1 * v_slope / (1.0 - 0.5 * d1 * v),
        }
    }

    /// Integral over the blast at `R = t = rho0 = 1` of `density`, a function of the solution in
    /// those units.
    fn integral(&self, density: impl Fn(Gas) -> f64) -> f64 {
        let (k, gamma) = (self.k(), self.gamma);
        let area = match self.geometry {
            Geometry::Planar => 1.0,
            Geometry::Cylindrical => 2.0 * PI,
            Geometry::Spherical => 4.0 * PI,
        };
        let speed = 2.0 / (k + 2.0);
        // The volume element r^(k-1) dr falls off as a power of x2: integrate in that power.
        let power = k * (gamma - 1.0) / (2.0 * (gamma - 1.0) + k);
        area * integrate_singular(|q| {
            let state = self.similar(q.ln() / power);
            let gas = Gas {
                density: (gamma + 1.0) / (gamma - 1.0) * state.density,
                velocity: 2.0 * speed / (gamma + 1.0) * state.velocity,
                pressure: 2.0 * speed * speed / (gamma + 1.0) * state.pressure,
                gamma,
            };
            density(gas) * state.radius.powf(k) * state.stretch / (power * q)
        })
    }

    /// Kinetic and internal energy in the units of [`Self::integral`].
    fn energy_integral(&self) -> f64 {
        self.integral(|gas| gas.conserved()[2])
    }
}

#[cfg(test)]
mod tests {
    use super::super::numerics::integrate;
    use super::super::testing::{cases, close};
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    /// Energies of the reference: gamma, planar (one side), cylindrical, spherical.
    const ALPHA: [[f64; 4]; 2] = [
        [1.4, 0.538_742_792_3, 0.984_074_016_9, 0.851_071_854_8],
        [5.0 / 3.0, 0.301_467_619_0, 0.564_283_436_9, 0.493_590_149_6],
    ];

    #[test]
    fn reproduces_the_energies_of_the_reference() {
        for [gamma, rest @ ..] in ALPHA {
            for (geometry, alpha) in Geometry::ALL.into_iter().zip(rest) {
                let blast = Sedov::new(geometry, gamma, 1.0, 1.0).unwrap();
                assert_relative_eq!(blast.alpha(), alpha, max_relative = 3e-10);
            }
        }
        let blast = Sedov::new(Geometry::Spherical, 1.4, 1.0, 0.851_072).unwrap();
        assert_relative_eq!(blast.shock_position(1.0).unwrap(), 1.0, max_relative = 1e-6);
    }

    #[test]
    fn gamma_two_is_not_special() {
        for geometry in Geometry::ALL {
            let at = |gamma| Sedov::new(geometry, gamma, 1.0, 1.0).unwrap();
            let mean = 0.5 * (at(2.0 - 1e-5).alpha() + at(2.0 + 1e-5).alpha());
            assert_relative_eq!(at(2.0).alpha(), mean, max_relative = 1e-9);
            assert_relative_eq!(at(2.0 + 1e-13).alpha(), at(2.0).alpha(), max_relative = 1e-11);
        }
    }

    #[test]
    fn refuses_nonsense() {
        assert!(Sedov::new(Geometry::Spherical, 7.0, 1.0, 1.0).is_err());
        assert!(Sedov::new(Geometry::Planar, 7.0, 1.0, 1.0).is_ok());
        assert!(Sedov::new(Geometry::Planar, 1.0, 1.0, 1.0).is_err());
        let blast = Sedov::new(Geometry::Planar, 1.4, 1.0, 1.0).unwrap();
        assert!(blast.sample(-1.0, 1.0).is_err() && blast.sample(1.0, 0.0).is_err());
        assert!(blast.sample(1e9, 1.0).unwrap().pressure == 0.0);
        assert!(blast.sample(0.0, 1.0).unwrap().pressure > 0.0);
    }

    fn any() -> impl Strategy<Value = Sedov> {
        (0..3_usize, 1.1..5.0, 0.1..10.0, 0.1..10.0)
            .prop_map(|(k, g, rho, e)| Sedov::new(Geometry::ALL[k], g, rho, e).unwrap())
    }

    proptest! {
        #![proptest_config(cases(48))]

        /// The blast holds the mass it has swept up.
        #[test]
        fn conserves_mass(blast in any()) {
            let area = [1.0, PI, 4.0 * PI / 3.0][(blast.geometry.dimension() - 1) as usize];
            let mass = blast.integral(|gas| gas.density);
            prop_assert!((mass / area - 1.0).abs() < 1e-10);
        }

        /// Energy between two radii changes by the flux through them: sampled, at two times.
        #[test]
        fn satisfies_the_conservation_laws(blast in any(), t in 0.1..2.0, at in 0.5..0.8) {
            let k = blast.geometry.dimension();
            let radius = blast.shock_position(t).unwrap();
            let (a, b) = (at * radius, 0.95 * radius);
            let content = |t: f64, i: usize| {
                let shell = |r: f64| blast.sample(r, t).unwrap().conserved()[i] * r.powi(k - 1);
                integrate(shell, a, b, 16)
            };
            let h = 1e-4 * t;
            let outflow = |i: usize| {
                let flux = |r: f64| blast.sample(r, t).unwrap().flux(0.0)[i] * r.powi(k - 1);
                flux(b) - flux(a)
            };
            for i in [0, 2] {
                let growth = (content(t + h, i) - content(t - h, i)) / (2.0 * h);
                let scale = content(t, i) / t + outflow(i).abs();
                prop_assert!((growth + outflow(i)).abs() < 1e-6 * scale);
            }
        }

        #[test]
        fn satisfies_the_jump_conditions(blast in any(), t in 0.1..2.0) {
            let (speed, radius) = (blast.shock_speed(t).unwrap(), blast.shock_position(t).unwrap());
            let behind = blast.sample(radius * (1.0 - 1e-14), t).unwrap();
            let ahead = blast.sample(radius * (1.0 + 1e-14), t).unwrap();
            let scale = [blast.density * speed, behind.pressure, behind.pressure * speed];
            prop_assert!(close(behind.flux(speed), ahead.flux(speed), scale, 1e-9));
        }
    }
}
