//! Elastic waves in a bar: the Kolsky bar under an end load, and standing waves.
//!
//! Linear theory, stress positive in tension, particle velocity `v = du/dt`, wave speed `c`,
//! impedance `z = rho c`, modulus `rho c^2`. A front moving to the left carries `d sigma = z dv`,
//! one moving to the right `d sigma = -z dv`; a fixed end returns a front with its velocity jump
//! reversed, a free end with its velocity jump unchanged.
//! Source: d'Alembert's solution; H. Kolsky, *Stress Waves in Solids* (1963), ch. 3.

use super::{InputError, above, at_least, finite};
use std::f64::consts::PI;

/// Condition at the end `x = 0` of a bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum End {
    /// No displacement.
    Fixed,
    /// No stress.
    Free,
}

/// A uniform elastic bar on `0 <= x <= length`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    length: f64,
    wave_speed: f64,
    density: f64,
    end: End,
}

/// Displacement, velocity and axial stress at a point of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarState {
    /// Displacement from the unloaded position.
    pub displacement: f64,
    /// Particle velocity.
    pub velocity: f64,
    /// Axial stress, positive in tension.
    pub stress: f64,
}

impl Bar {
    /// A bar whose end at `x = 0` is supported as `end` says; the end at `x = length` is loaded
    /// or free.
    ///
    /// # Errors
    /// Any number that is not positive and finite.
    pub fn new(length: f64, wave_speed: f64, density: f64, end: End) -> Result<Self, InputError> {
        Ok(Self {
            length: above("length", length, 0.0)?,
            wave_speed: above("wave speed", wave_speed, 0.0)?,
            density: above("density", density, 0.0)?,
            end,
        })
    }

    /// Time `L/c` of one transit of the bar.
    #[must_use]
    pub fn transit_time(&self) -> f64 {
        self.length / self.wave_speed
    }

    /// Impedance `rho c`, stress per velocity.
    #[must_use]
    pub fn impedance(&self) -> f64 {
        self.density * self.wave_speed
    }

    /// Elastic modulus `rho c^2`.
    #[must_use]
    pub fn modulus(&self) -> f64 {
        self.impedance() * self.wave_speed
    }
}

/// A bar at rest whose end `x = length` is pulled by a constant stress from `t = 0` on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLoad {
    bar: Bar,
    stress: f64,
}

impl StepLoad {
    /// The load `stress` (negative for a push) on `bar`.
    ///
    /// # Errors
    /// A `stress` that is not finite.
    pub fn new(bar: Bar, stress: f64) -> Result<Self, InputError> {
        Ok(Self { bar, stress: finite("stress", stress)? })
    }

    /// Velocity jump `sigma/(rho c)` of the first front.
    #[must_use]
    pub fn front_velocity(&self) -> f64 {
        self.stress / self.bar.impedance()
    }

    /// State at `x` and time `t`, a front counting as arrived; the bar is at rest for `t < 0`.
    ///
    /// The load sends out a front to the left, which returns with factor `r` (`-1` from a fixed
    /// end, `1` from a free one) and starts again: the fronts to the left arrive at
    /// `(L - x + 2 j L)/c` with the jump `r^j sigma/z`, those to the right at `(L + x + 2 j L)/c`
    /// with the jump `r^(j+1) sigma/z`.
    ///
    /// # Errors
    /// `x` outside the bar, or `t` not finite.
    pub fn sample(&self, x: f64, t: f64) -> Result<BarState, InputError> {
        let Bar { length, wave_speed, .. } = self.bar;
        let x = length - at_least("length - x", length - at_least("x", x, 0.0)?, 0.0)?;
        let t = finite("t", t)?;
        let (leftward, left_travel) = self.arrivals(t - (length - x) / wave_speed);
        let (rightward, right_travel) = self.arrivals(t - (length + x) / wave_speed);
        let factor = self.reflection();
        let jump = self.front_velocity();
        Ok(BarState {
            displacement: jump * (left_travel + factor * right_travel),
            velocity: jump * (leftward + factor * rightward),
            stress: self.stress * (leftward - factor * rightward),
        })
    }

    /// Velocity factor of a reflection at `x = 0`.
    fn reflection(&self) -> f64 {
        match self.bar.end {
            End::Fixed => -1.0,
            End::Free => 1.0,
        }
    }

    /// Sums over the fronts `j` of one direction that have arrived, `since` being the time since
    /// the first of them: `sum r^j` and `sum r^j (since - j P)` with the period `P = 2 L/c`.
    fn arrivals(&self, since: f64) -> (f64, f64) {
        if since < 0.0 {
            return (0.0, 0.0);
        }
        let period = 2.0 * self.bar.transit_time();
        let last = (since / period).floor();
        let count = last + 1.0;
        match self.bar.end {
            End::Free => (count, count * (since - 0.5 * last * period)),
            End::Fixed if last % 2.0 == 0.0 => (1.0, since - 0.5 * last * period),
            End::Fixed => (0.0, 0.5 * count * period),
        }
    }
}

/// A standing wave of a bar whose end `x = length` is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingWave {
    bar: Bar,
    wavenumber: f64,
    amplitude: f64,
}

impl StandingWave {
    /// Mode `number` (from 1) of the displacement `amplitude`, released from rest.
    ///
    /// The wavenumber is `(2 m - 1) pi/(2 L)` if the end `x = 0` is fixed, `m pi/L` if free.
    ///
    /// # Errors
    /// `number = 0` or a non-finite `amplitude`.
    pub fn new(bar: Bar, number: u32, amplitude: f64) -> Result<Self, InputError> {
        let m = above("number", f64::from(number), 0.0)?;
        let half_waves = match bar.end {
            End::Fixed => m - 0.5,
            End::Free => m,
        };
        let wavenumber = half_waves * PI / bar.length;
        Ok(Self { bar, wavenumber, amplitude: finite("amplitude", amplitude)? })
    }

    /// Frequency in cycles per time: `(2 m - 1) c/(4 L)` fixed-free, `m c/(2 L)` free-free.
    #[must_use]
    pub fn frequency(&self) -> f64 {
        self.wavenumber * self.bar.wave_speed / (2.0 * PI)
    }

    /// State at `x` and `t`.
    #[must_use]
    pub fn sample(&self, x: f64, t: f64) -> BarState {
        let (sin, cos) = (self.wavenumber * x).sin_cos();
        let (shape, slope) = match self.bar.end {
            End::Fixed => (sin, cos),
            End::Free => (cos, -sin),
        };
        let angular = self.wavenumber * self.bar.wave_speed;
        let (swing, phase) = (angular * t).sin_cos();
        BarState {
            displacement: self.amplitude * shape * phase,
            velocity: -self.amplitude * angular * shape * swing,
            stress: self.bar.modulus() * self.amplitude * self.wavenumber * slope * phase,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};
    use proptest::prelude::*;

    /// `kolsky_bar_midpoint.csv`: start of each interval, midpoint velocity for a fixed and for a
    /// free end, with c = 202721.21 in/s, L = 100 in, P/(rho c) = 337.868689 in/s.
    const TABLE: [(f64, f64, f64); 5] = [
        (0.0, 0.0, 0.0),
        (0.000_246_644_143, 337.868_689, 337.868_689),
        (0.000_739_932_429, 0.0, 675.737_378),
        (0.001_233_220_72, -337.868_689, 1_013.606_07),
        (0.001_726_509, 0.0, 1_351.474_76),
    ];

    fn step_load(end: End) -> StepLoad {
        let (c, density) = (202_721.21, 7.3e-4);
        let bar = Bar::new(100.0, c, density, end).unwrap();
        StepLoad::new(bar, 337.868_689 * density * c).unwrap()
    }

    #[test]
    fn reproduces_the_kolsky_midpoint() {
        for (start, fixed, free) in TABLE {
            for (end, velocity) in [(End::Fixed, fixed), (End::Free, free)] {
                let state = step_load(end).sample(50.0, start * (1.0 + 1e-7)).unwrap();
                assert_relative_eq!(state.velocity, velocity, max_relative = 1e-8);
            }
        }
        assert!(step_load(End::Free).sample(100.1, 0.0).is_err());
        assert!(step_load(End::Free).sample(-0.1, 0.0).is_err());
    }

    fn any_load() -> impl Strategy<Value = StepLoad> {
        (0.1..10.0, 0.1..10.0, 0.1..10.0, -3.0..3.0, any::<bool>()).prop_map(
            |(length, c, density, stress, fixed)| {
                let end = if fixed { End::Fixed } else { End::Free };
                StepLoad::new(Bar::new(length, c, density, end).unwrap(), stress).unwrap()
            },
        )
    }

    /// Integral of `f` over the bar by the midpoint rule, exact for piecewise constants whose
    /// jumps lie at multiples of `L/cells`.
    fn integral(bar: &Bar, cells: u32, f: impl Fn(f64) -> f64) -> f64 {
        let dx = bar.length / f64::from(cells);
        (0..cells).map(|i| f((f64::from(i) + 0.5) * dx) * dx).sum()
    }

    proptest! {
        #![proptest_config(cases(48))]

        #[test]
        fn meets_the_end_conditions(load in any_load(), transits in 0.01..60.0) {
            let bar = load.bar;
            let t = transits * bar.transit_time();
            let (near, far) = (load.sample(0.0, t).unwrap(), load.sample(bar.length, t).unwrap());
            match bar.end {
                End::Fixed => prop_assert!(near.velocity == 0.0 && near.displacement.abs() < 1e-9),
                End::Free => prop_assert!(near.stress == 0.0),
            }
            prop_assert!((far.stress - load.stress).abs() <= 1e-12 * load.stress.abs());
        }

        /// Between fronts `v` and `sigma` are constant; across one, `|d sigma| = z |dv|`, with the
        /// sign of its direction.
        #[test]
        fn jumps_obey_the_impedance(load in any_load(), at in 0.01..0.99, j in 0..20_u32) {
            let Bar { length, wave_speed, .. } = load.bar;
            let x = at * length;
            for (path, sign) in [(length - x, 1.0), (length + x, -1.0)] {
                let arrival = (path + 2.0 * f64::from(j) * length) / wave_speed;
                let before = load.sample(x, arrival * (1.0 - 1e-9)).unwrap();
                let after = load.sample(x, arrival * (1.0 + 1e-9)).unwrap();
                let jump = load.bar.impedance() * (after.velocity - before.velocity);
                prop_assert!((after.stress - before.stress - sign * jump).abs() < 1e-12);
                prop_assert!((jump.abs() - load.stress.abs()).abs() < 1e-12);
            }
        }

        /// Velocity and strain are the derivatives of the displacement.
        #[test]
        fn fields_derive_from_the_displacement(
            load in any_load(), at in 0.05..0.95, transits in 0.0..40.0,
        ) {
            let bar = load.bar;
            let (x, t, h) = (at * bar.length, transits * bar.transit_time(), 1e-5);
            let s = |x: f64, t: f64| load.sample(x, t).unwrap();
            let (dx, dt) = (h * bar.length, h * bar.transit_time());
            let corners = [s(x, t), s(x + dx, t), s(x - dx, t), s(x, t + dt), s(x, t - dt)];
            prop_assume!(corners.iter().all(|c| c.stress == corners[0].stress));
            let velocity = (corners[3].displacement - corners[4].displacement) / (2.0 * dt);
            let strain = (corners[1].displacement - corners[2].displacement) / (2.0 * dx);
            let scale = load.stress.abs() * 1e-7;
            prop_assert!((velocity - corners[0].velocity).abs() * bar.impedance() < scale);
            prop_assert!((strain * bar.modulus() - corners[0].stress).abs() < scale);
        }

        /// Kinetic and strain energy equal the work of the load.
        #[test]
        fn energy_equals_the_work(load in any_load(), step in 1..160_u32) {
            let bar = load.bar;
            let t = f64::from(step) * bar.transit_time() / 8.0 * (1.0 + 1e-12);
            let energy = integral(&bar, 16, |x| {
                let s = load.sample(x, t).unwrap();
                0.5 * (bar.density * s.velocity.powi(2) + s.stress.powi(2) / bar.modulus())
            });
            let work = load.stress * load.sample(bar.length, t).unwrap().displacement;
            let scale = load.stress.powi(2) / bar.modulus() * bar.length;
            prop_assert!((energy - work).abs() < 1e-9 * (scale + work.abs()));
        }

        #[test]
        fn standing_waves_solve_the_wave_equation(
            load in any_load(), number in 1..12_u32, at in 0.0..1.0, cycles in 0.0..3.0,
        ) {
            let bar = load.bar;
            let wave = StandingWave::new(bar, number, 0.3).unwrap();
            let (x, t) = (at * bar.length, cycles / wave.frequency());
            let h = 1e-4 / wave.wavenumber;
            let dt = h / bar.wave_speed;
            // rho dv/dt = d sigma/dx and d sigma/dt = rho c^2 dv/dx
            let s = |i: f64, j: f64| wave.sample(x + i * h, t + j * dt);
            let z = bar.impedance();
            let inertia = z * (s(0.0, 1.0).velocity - s(0.0, -1.0).velocity);
            let force = s(1.0, 0.0).stress - s(-1.0, 0.0).stress;
            let rate = s(0.0, 1.0).stress - s(0.0, -1.0).stress;
            let strain = z * (s(1.0, 0.0).velocity - s(-1.0, 0.0).velocity);
            let scale = 0.3 * bar.modulus() * wave.wavenumber * 1e-9;
            prop_assert!((inertia - force).abs() < scale && (rate - strain).abs() < scale);
            let period = 1.0 / wave.frequency();
            prop_assert!((s(0.0, 0.0).displacement - wave.sample(x, t + period).displacement).abs() < 1e-10);
            prop_assert!(wave.sample(bar.length, t).stress.abs() < 1e-3 * scale * 1e9);
        }
    }

    #[test]
    fn frequencies_follow_the_textbook() {
        let frequency = |end, m| {
            let bar = Bar::new(2.0, 3.0, 1.0, end).unwrap();
            StandingWave::new(bar, m, 1.0).unwrap().frequency()
        };
        assert_abs_diff_eq!(frequency(End::Fixed, 2), 3.0 * 3.0 / 8.0, epsilon = 1e-14);
        assert_abs_diff_eq!(frequency(End::Free, 2), 2.0 * 3.0 / 4.0, epsilon = 1e-14);
        let bar = Bar::new(2.0, 3.0, 1.0, End::Free).unwrap();
        assert!(StandingWave::new(bar, 0, 1.0).is_err());
        let (left, right) = (StandingWave::new(bar, 3, 1.0).unwrap(), bar.length);
        assert!(left.sample(0.0, 0.1).stress.abs() < 1e-12);
        assert!(left.sample(right, 0.1).stress.abs() < 1e-12);
    }
}
