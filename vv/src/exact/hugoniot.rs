//! Shock states of a material with `Us = c0 + s up`, and the impact of two such materials.
//!
//! Rankine-Hugoniot relations for a material at rest with `P = e = 0`, in any consistent units:
//! `P = rho0 Us up`, `rho = rho0 Us/(Us - up)`, `e = up^2/2`.
//! Source: M. A. Meyers, *Dynamic Behavior of Materials* (1994), ch. 4. In a planar impact at
//! closing velocity `V` pressure and velocity are continuous at the interface, so
//! `rho_t (c_t + s_t u) u = rho_i (c_i + s_i (V - u)) (V - u)`, a quadratic equation in `u`.

use super::{InputError, above, at_least, below};

/// A linear shock Hugoniot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hugoniot {
    density: f64,
    sound_speed: f64,
    slope: f64,
}

/// The state behind a shock that runs into material at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShockState {
    /// Velocity `up` given to the material.
    pub particle_speed: f64,
    /// Speed `Us` of the shock through the unshocked material.
    pub shock_speed: f64,
    /// Pressure `P`.
    pub pressure: f64,
    /// Density `rho`, mass per volume.
    pub density: f64,
    /// Specific internal energy `e`, energy per mass.
    pub energy: f64,
    /// Volume ratio `V/V0 = rho0/rho`.
    pub volume_ratio: f64,
}

impl Hugoniot {
    /// Material of reference `density`, bulk `sound_speed` `c0` and dimensionless `slope` `s`.
    ///
    /// # Errors
    /// `density <= 0`, `sound_speed <= 0`, or `slope < 1`, for which strong shocks would compress
    /// without limit.
    pub fn new(density: f64, sound_speed: f64, slope: f64) -> Result<Self, InputError> {
        Ok(Self {
            density: above("density", density, 0.0)?,
            sound_speed: above("sound speed", sound_speed, 0.0)?,
            slope: at_least("slope", slope, 1.0)?,
        })
    }

    /// Reference density `rho0`.
    #[must_use]
    pub const fn density(&self) -> f64 {
        self.density
    }

    /// Bulk sound speed `c0`.
    #[must_use]
    pub const fn sound_speed(&self) -> f64 {
        self.sound_speed
    }

    /// Slope `s`.
    #[must_use]
    pub const fn slope(&self) -> f64 {
        self.slope
    }

    /// Density no shock can exceed, `rho0 s/(s - 1)`; infinite for `s = 1`.
    #[must_use]
    pub fn limiting_density(&self) -> f64 {
        self.density * self.slope / (self.slope - 1.0)
    }

    /// State behind the shock that gives the material the velocity `particle_speed`.
    ///
    /// # Errors
    /// A negative or non-finite `particle_speed`.
    pub fn at_particle_speed(&self, particle_speed: f64) -> Result<ShockState, InputError> {
        Ok(self.state(at_least("particle speed", particle_speed, 0.0)?))
    }

    /// State behind the shock to `pressure`:
    /// `up = 2 P/(rho0 c0 + sqrt((rho0 c0)^2 + 4 rho0 s P))`.
    ///
    /// # Errors
    /// A negative or non-finite `pressure`.
    pub fn at_pressure(&self, pressure: f64) -> Result<ShockState, InputError> {
        let pressure = at_least("pressure", pressure, 0.0)?;
        let impedance = self.density * self.sound_speed;
        let root = (impedance * impedance + 4.0 * self.density * self.slope * pressure).sqrt();
        Ok(self.state(2.0 * pressure / (impedance + root)))
    }

    /// State behind the shock to `density`: `up = c0 eta/(1 - s eta)` with `eta = 1 - rho0/rho`.
    ///
    /// # Errors
    /// A `density` below the reference one, or not below the limiting one.
    pub fn at_density(&self, density: f64) -> Result<ShockState, InputError> {
        let density = at_least("density", density, self.density)?;
        let density = below("density", density, self.limiting_density())?;
        let eta = 1.0 - self.density / density;
        Ok(self.state(self.sound_speed * eta / (1.0 - self.slope * eta)))
    }

    fn state(&self, particle_speed: f64) -> ShockState {
        let shock_speed = self.sound_speed + self.slope * particle_speed;
        let volume_ratio = (shock_speed - particle_speed) / shock_speed;
        ShockState {
            particle_speed,
            shock_speed,
            pressure: self.density * shock_speed * particle_speed,
            density: self.density / volume_ratio,
            energy: 0.5 * particle_speed * particle_speed,
            volume_ratio,
        }
    }
}

/// The planar impact of an impactor moving at `V` on a target at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarImpact {
    /// Velocity of the interface, in the direction of the impactor.
    pub interface_velocity: f64,
    /// Pressure at the interface.
    pub pressure: f64,
    /// State of the impactor; speeds are relative to the unshocked impactor.
    pub impactor: ShockState,
    /// State of the target.
    pub target: ShockState,
    /// Velocity in the laboratory of the shock in the impactor, `V - Us`; usually negative.
    pub impactor_shock_velocity: f64,
}

impl PlanarImpact {
    /// The impact at the closing `velocity`, by the stable root of the quadratic equation of the
    /// [module](self).
    ///
    /// # Errors
    /// A negative or non-finite `velocity`.
    pub fn new(impactor: &Hugoniot, target: &Hugoniot, velocity: f64) -> Result<Self, InputError> {
        let velocity = at_least("velocity", velocity, 0.0)?;
        let stiffness = impactor.density * impactor.slope;
        let quadratic = target.density * target.slope - stiffness;
        let linear = target.density * target.sound_speed
            + impactor.density * impactor.sound_speed
            + 2.0 * stiffness * velocity;
        let constant = impactor.density * impactor.state(velocity).shock_speed * velocity;
        // The left side less the right changes sign between 0 and V, so the root is real.
        let discriminant = (linear * linear + 4.0 * quadratic * constant).max(0.0);
        let interface_velocity = 2.0 * constant / (linear + discriminant.sqrt());
        let target = target.state(interface_velocity);
        let impactor = impactor.state((velocity - interface_velocity).max(0.0));
        Ok(Self {
            interface_velocity,
            pressure: target.pressure,
            impactor,
            target,
            impactor_shock_velocity: velocity - impactor.shock_speed,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn refuses_nonsense() {
        assert!(Hugoniot::new(1.0, 1.0, 0.9).is_err());
        let copper = Hugoniot::new(8.93, 0.394, 1.489).unwrap();
        assert!(copper.at_density(8.0).is_err() && copper.at_density(27.3).is_err());
        assert!(copper.at_pressure(-1e-9).is_err() && copper.at_particle_speed(-0.1).is_err());
        assert!(PlanarImpact::new(&copper, &copper, f64::NAN).is_err());
        let limit = Hugoniot::new(1.0, 1.0, 1.0).unwrap().limiting_density();
        assert!(limit.is_infinite());
    }

    fn any() -> impl Strategy<Value = Hugoniot> {
        (0.1..20.0, 0.05..1.0, 1.0..2.5)
            .prop_map(|(rho0, c0, s)| Hugoniot::new(rho0, c0, s).unwrap())
    }

    proptest! {
        #![proptest_config(cases(128))]

        #[test]
        fn states_conserve_mass_momentum_and_energy(material in any(), up in 1e-6..3.0) {
            let state = material.at_particle_speed(up).unwrap();
            let mass = state.density * (state.shock_speed - up);
            prop_assert!((mass / (material.density() * state.shock_speed) - 1.0).abs() < 1e-13);
            let work = 0.5 * state.pressure * (1.0 / material.density - 1.0 / state.density);
            prop_assert!((work / state.energy - 1.0).abs() < 1e-8);
            let again = material.at_pressure(state.pressure).unwrap();
            prop_assert!((again.particle_speed / up - 1.0).abs() < 1e-12);
            let again = material.at_density(state.density).unwrap();
            prop_assert!((again.particle_speed / up - 1.0).abs() < 1e-8);
        }

        #[test]
        fn interfaces_balance(a in any(), b in any(), velocity in 1e-4..2.0) {
            let impact = PlanarImpact::new(&a, &b, velocity).unwrap();
            prop_assert!((impact.impactor.pressure / impact.target.pressure - 1.0).abs() < 1e-9);
            prop_assert!((0.0..=velocity).contains(&impact.interface_velocity));
            let reversed = PlanarImpact::new(&b, &a, velocity).unwrap();
            let sum = impact.interface_velocity + reversed.interface_velocity;
            prop_assert!((sum / velocity - 1.0).abs() < 1e-10);
        }
    }
}
