//! How deep a sphere goes into carbon-carbon, and the hole that it leaves: an equation fitted to tests.
//!
//! NASA/TM-2009-214785, Eqs. 5-30 and 5-32 to 5-34, in cm, g/cm3 and km/s. They rest on nine tests of
//! panels of 6.3 mm with a coating, at 2.5 to 7.3 km/s; thinner panels without one are an extrapolation.
//! The source states no scatter.

use super::{InputError, above, at_least};

/// A sphere that hits carbon-carbon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penetration {
    diameter: f64,
    density: f64,
    target: f64,
    /// Velocity along the normal.
    normal: f64,
}

impl Penetration {
    /// Sphere of a diameter in cm and density in g/cm3 on carbon-carbon of the density `target`, with a
    /// velocity in km/s that makes this angle in degrees with the normal.
    ///
    /// # Errors
    /// Any number that is not positive, or a grazing impact.
    pub fn new(
        diameter: f64,
        [density, target]: [f64; 2],
        velocity: f64,
        degrees: f64,
    ) -> Result<Self, InputError> {
        let cosine = at_least("cosine of the angle", degrees.to_radians().cos(), 0.0)?;
        Ok(Self {
            diameter: above("diameter", diameter, 0.0)?,
            density: above("density of the sphere", density, 0.0)?,
            target: above("density of the target", target, 0.0)?,
            normal: above("velocity", velocity, 0.0)? * cosine,
        })
    }

    /// Depth in a target without a rear face, Eq. 5-30.
    #[must_use]
    pub fn depth(&self) -> f64 {
        let heavy = (self.density / self.target).sqrt();
        0.61 * self.diameter * heavy * (self.normal * self.normal).cbrt()
    }

    /// Thickness that just is not perforated, Eq. 5-32.
    #[must_use]
    pub fn not_perforated(&self) -> f64 {
        2.3 * self.depth()
    }

    /// Thickness from whose rear face nothing comes off, Eq. 5-33.
    #[must_use]
    pub fn not_spalled(&self) -> f64 {
        4.5 * self.depth()
    }

    /// Diameter of the hole in a thin panel, Eq. 5-34; negative where the equation has none.
    #[must_use]
    pub fn hole(&self) -> f64 {
        2.20 * self.diameter * (self.density * self.normal).cbrt() - 0.36
    }
}
