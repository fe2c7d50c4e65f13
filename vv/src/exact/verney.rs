//! Verney's shell: a rigid, perfectly plastic shell moving inwards until its work is done.
//!
//! The shell is incompressible, so `u = -v (a/r)^(k-1)` with the speed `v` of the inner radius
//! `a`, and the plastic work per volume is `Y` times the equivalent strain, `2 |ln(r/r0)|` in
//! spheres and `(2/sqrt 3) |ln(r/r0)|` in cylinders (plane strain). With the inner and outer
//! radius `R0`, `R1` at first and `x = a/R0`:
//! * sphere: kinetic energy `2 pi rho v^2 a^3 (1 - a/b)`, work `(8 pi/3) Y R0^3 F(x)`,
//!   `F = int_x^1 y^2 ln(1 + c/y^3) dy`, `c = (R1/R0)^3 - 1`;
//! * cylinder, per length: `pi rho v^2 a^2 ln(b/a)`, `(2 pi/sqrt 3) Y R0^2 F(x)`,
//!   `F = int_x^1 y ln(1 + c/y^2) dy`, `c = (R1/R0)^2 - 1`.
//!
//! Sources: R. L. Verney (1968) as in LA-14379 (2008) and B. P. Howell and G. J. Ball, J. Comput.
//! Phys. 175 (2002) 128; `F` from the energy balance.

use super::numerics::{integrate, root};
use super::{Geometry, InputError, above, at_least, below, finite};
use std::f64::consts::PI;

/// Panels of the quadrature of the time.
const PANELS: u32 = 24;

/// A rigid-plastic shell at its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    geometry: Geometry,
    inner: f64,
    outer: f64,
    density: f64,
    yield_stress: f64,
}

impl Shell {
    /// Shell between the radii `inner` and `outer`, a cylinder or a sphere.
    ///
    /// `material` holds the density and the uniaxial yield stress `[rho, Y]`.
    ///
    /// # Errors
    /// A planar `geometry`, `inner <= 0`, `outer <= inner`, or a `material` that is not positive.
    pub fn new(
        geometry: Geometry,
        inner: f64,
        outer: f64,
        material: [f64; 2],
    ) -> Result<Self, InputError> {
        at_least("dimension", f64::from(geometry.dimension()), 2.0)?;
        let inner = above("inner radius", inner, 0.0)?;
        Ok(Self {
            geometry,
            inner,
            outer: above("outer radius", outer, inner)?,
            density: above("density", material[0], 0.0)?,
            yield_stress: above("yield stress", material[1], 0.0)?,
        })
    }

    /// Outer radius when the inner one is `inner`: the volume is constant.
    ///
    /// # Errors
    /// A negative or non-finite `inner`.
    pub fn outer_radius(&self, inner: f64) -> Result<f64, InputError> {
        let inner = at_least("inner radius", inner, 0.0)?;
        let k = self.k();
        Ok((inner.powi(k) + self.outer.powi(k) - self.inner.powi(k)).powf(1.0 / f64::from(k)))
    }

    /// The integral `F` from `stop/R0` to 1.
    ///
    /// # Errors
    /// A `stop` that is negative or above the initial inner radius.
    pub fn work_integral(&self, stop: f64) -> Result<f64, InputError> {
        let stop = at_least("stop radius", stop, 0.0)?;
        at_least("inner radius - stop radius", self.inner - stop, 0.0)?;
        Ok(self.work_between(stop, self.inner))
    }

    /// Plastic work done until the inner radius is `stop`, per length in cylinders.
    ///
    /// # Errors
    /// As for [`Self::work_integral`].
    pub fn plastic_work(&self, stop: f64) -> Result<f64, InputError> {
        Ok(self.work_scale() * self.work_integral(stop)?)
    }

    /// Kinetic energy when the inner radius is `inner` and moves at `speed`, per length in
    /// cylinders.
    ///
    /// # Errors
    /// `inner <= 0` or a `speed` that is not finite.
    pub fn kinetic_energy(&self, inner: f64, speed: f64) -> Result<f64, InputError> {
        let inner = above("inner radius", inner, 0.0)?;
        let speed = finite("speed", speed)?;
        Ok(self.inertia(inner) * speed * speed)
    }

    /// The collapse that comes to rest at the inner radius `stop`; its
    /// [`Collapse::initial_speed`] is the `u0` of the problem.
    ///
    /// # Errors
    /// A `stop` not between zero and the initial inner radius.
    pub fn stopping_at(self, stop: f64) -> Result<Collapse, InputError> {
        let stop = below("stop radius", above("stop radius", stop, 0.0)?, self.inner)?;
        Ok(Collapse { shell: self, stop })
    }

    /// The collapse that starts with the inner radius moving inwards at `speed`.
    ///
    /// # Errors
    /// `speed <= 0`, or a speed that closes the shell.
    pub fn starting_with(self, speed: f64) -> Result<Collapse, InputError> {
        let energy = self.inertia(self.inner) * above("speed", speed, 0.0)?.powi(2);
        let spare = self.work_scale() * self.work_between(0.0, self.inner) - energy;
        above("work to close the shell - kinetic energy", spare, 0.0)?;
        let rest = |a: f64| self.work_scale() * self.work_between(a, self.inner) - energy;
        Ok(Collapse { shell: self, stop: root(rest, 0.0, self.inner) })
    }

    const fn k(&self) -> i32 {
        self.geometry.dimension()
    }

    /// `F` between the inner radii `low` and `high`, without cancellation where they are close:
    /// with `w = x^k` it is the change of `((w + c) ln(w + c) - w ln w)/k`.
    fn work_between(&self, low: f64, high: f64) -> f64 {
        let k = self.k();
        let c = (self.outer / self.inner).powi(k) - 1.0;
        let (w, end) = ((low / self.inner).powi(k), (high / self.inner).powi(k));
        let step = end - w;
        let gain = |from: f64| if from > 0.0 { from * (step / from).ln_1p() } else { 0.0 };
        (step * (c / end).ln_1p() + gain(w + c) - gain(w)) / f64::from(k)
    }

    fn work_scale(&self) -> f64 {
        match self.geometry {
            Geometry::Spherical => 8.0 * PI / 3.0 * self.yield_stress * self.inner.powi(3),
            _ => 2.0 * PI / 3f64.sqrt() * self.yield_stress * self.inner.powi(2),
        }
    }

    /// Kinetic energy over the squared speed of the inner radius.
    fn inertia(&self, inner: f64) -> f64 {
        let k = self.k();
        let volume = (self.outer.powi(k) - self.inner.powi(k)) / inner.powi(k);
        let log_ratio = volume.ln_1p() / f64::from(k);
        match self.geometry {
            Geometry::Spherical => -2.0 * PI * self.density * inner.powi(3) * (-log_ratio).exp_m1(),
            _ => PI * self.density * inner.powi(2) * log_ratio,
        }
    }
}

/// A collapse that ends at a stop radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collapse {
    shell: Shell,
    stop: f64,
}

impl Collapse {
    /// Inner radius at rest.
    #[must_use]
    pub const fn stop_radius(&self) -> f64 {
        self.stop
    }

    /// Speed `u0` of the inner radius at the start.
    #[must_use]
    pub fn initial_speed(&self) -> f64 {
        self.raw_speed(self.shell.inner)
    }

    /// Speed of the inner radius when it is `inner`: the kinetic energy left is the work still
    /// to be done.
    ///
    /// # Errors
    /// An `inner` outside the range from the stop to the start.
    pub fn speed(&self, inner: f64) -> Result<f64, InputError> {
        let inner = at_least("inner radius", inner, self.stop)?;
        at_least("travel", self.shell.inner - inner, 0.0)?;
        Ok(self.raw_speed(inner))
    }

    /// Time when the inner radius is `inner`.
    ///
    /// # Errors
    /// As for [`Self::speed`].
    pub fn time_at(&self, inner: f64) -> Result<f64, InputError> {
        self.speed(inner)?;
        Ok(self.raw_time(inner))
    }

    /// Time of rest.
    #[must_use]
    pub fn stop_time(&self) -> f64 {
        self.raw_time(self.stop)
    }

    /// Inner radius at time `t`; the stop radius ever after rest.
    ///
    /// # Errors
    /// A negative or non-finite `t`.
    pub fn inner_radius(&self, t: f64) -> Result<f64, InputError> {
        let t = at_least("t", t, 0.0)?;
        if t >= self.stop_time() {
            return Ok(self.stop);
        }
        Ok(root(|a| self.raw_time(a) - t, self.stop, self.shell.inner))
    }

    fn raw_speed(&self, inner: f64) -> f64 {
        let left = self.shell.work_between(self.stop, inner);
        (self.shell.work_scale() * left / self.shell.inertia(inner)).sqrt()
    }

    /// `int da/v`; with `a = stop + (R0 - stop) s^2` the integrand is smooth at rest.
    fn raw_time(&self, inner: f64) -> f64 {
        let travel = self.shell.inner - self.stop;
        let low = ((inner - self.stop) / travel).max(0.0).sqrt();
        let slowness = |s: f64| 2.0 * travel * s / self.raw_speed(self.stop + travel * s * s);
        integrate(slowness, low, 1.0, PANELS)
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    fn beryllium(geometry: Geometry) -> Shell {
        Shell::new(geometry, 8.0, 10.0, [1.845, 0.0033]).unwrap()
    }

    #[test]
    fn reproduces_the_reference_shells() {
        let sphere = beryllium(Geometry::Spherical);
        assert_relative_eq!(sphere.work_integral(4.0).unwrap(), 0.322_150_43, max_relative = 2e-8);
        for shell in [sphere, beryllium(Geometry::Cylindrical)] {
            let (k, c) = (shell.k(), 1.25f64.powi(shell.k()) - 1.0);
            let sum = integrate(|x| x.powi(k - 1) * (c / x.powi(k)).ln_1p(), 0.5, 1.0, 8);
            assert_relative_eq!(shell.work_integral(4.0).unwrap(), sum, max_relative = 1e-13);
        }
        let speed = sphere.stopping_at(4.0).unwrap().initial_speed();
        assert_relative_eq!(speed, 0.061_978_7, max_relative = 1e-6);
        let speed = beryllium(Geometry::Cylindrical).stopping_at(4.0).unwrap().initial_speed();
        assert_relative_eq!(speed, 0.049_029_9, max_relative = 1e-6);
    }

    #[test]
    fn refuses_nonsense() {
        assert!(Shell::new(Geometry::Planar, 1.0, 2.0, [1.0, 1.0]).is_err());
        let shell = beryllium(Geometry::Spherical);
        assert!(shell.stopping_at(8.0).is_err() && shell.starting_with(1.0).is_err());
        let collapse = shell.stopping_at(4.0).unwrap();
        assert!(collapse.speed(3.9).is_err() && collapse.speed(8.1).is_err());
        assert!(collapse.inner_radius(-1.0).is_err());
    }

    proptest! {
        #![proptest_config(cases(24))]

        #[test]
        fn energy_and_motion_agree(
            sphere in any::<bool>(), thick in 0.02..1.0, stop in 0.2..0.95, part in 0.02..0.95,
        ) {
            let geometry = if sphere { Geometry::Spherical } else { Geometry::Cylindrical };
            let shell = Shell::new(geometry, 1.0, 1.0 + thick, [2.0, 0.01]).unwrap();
            let collapse = shell.stopping_at(stop).unwrap();
            let initial = shell.kinetic_energy(1.0, collapse.initial_speed()).unwrap();
            let work = shell.plastic_work(stop).unwrap();
            prop_assert!((work / initial - 1.0).abs() < 1e-12);
            let again = shell.starting_with(collapse.initial_speed()).unwrap();
            prop_assert!((again.stop_radius() / stop - 1.0).abs() < 1e-9);
            let t = part * collapse.stop_time();
            let inner = collapse.inner_radius(t).unwrap();
            prop_assert!((collapse.time_at(inner).unwrap() / t - 1.0).abs() < 1e-9);
            let h = 1e-4 * t;
            let radius = |t| collapse.inner_radius(t).unwrap();
            let speed = (radius(t - h) - radius(t + h)) / (2.0 * h);
            prop_assert!((speed / collapse.speed(inner).unwrap() - 1.0).abs() < 1e-5);
            prop_assert!(collapse.inner_radius(2.0 * collapse.stop_time()).unwrap() == stop);
            let volume = |a: f64, b: f64| b.powi(shell.k()) - a.powi(shell.k());
            let outer = shell.outer_radius(inner).unwrap();
            prop_assert!((volume(inner, outer) / volume(1.0, 1.0 + thick) - 1.0).abs() < 1e-12);
        }
    }
}
