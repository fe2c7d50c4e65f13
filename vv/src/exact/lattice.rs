//! The density rule of contacts on an infinite, affinely deformed body-centred cubic lattice.
//!
//! With `zeta` the distance of a neighbour over `(sqrt 3/2) a`, Eq. (34) of Park and Fahrenthold
//! is `d(rho/rho0) = (1/8) sum W d(zeta^-3)`, a sum over all neighbours in contact, which is exact
//! for uniform compression (Eq. (33)). The contact gate of Eq. (35), with a tolerance `delta`, is
//! `zeta (rho/rho0)^(1/3) < 1 + delta` and `zeta < 1.12`. Paths on which all neighbours stay
//! equivalent lie on the threshold of the printed gate, `delta = 0`: there it matters whether the
//! unit step is zero at zero, as printed, or one. In affine deformation all particles have the
//! same density, and between changes of contact the sum is integrated exactly; a change is found
//! to one step.

use super::{InputError, above, at_least, below};

/// Largest `zeta` of a contact.
pub const REACH: f64 = 1.12;
/// Room for rounding in the gate: uniform compression lies on its threshold.
const ROUNDING: f64 = 1e-10;
/// Deformation gradients looked at to find the neighbours a path may bring into reach.
const SURVEY: u32 = 64;

/// Deformation gradient.
type Matrix = [[f64; 3]; 3];

/// A path of affine deformations from the undeformed lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Path {
    /// All three axes stretched to the factor given.
    Uniform(f64),
    /// One cube axis stretched to the factor given.
    Uniaxial(f64),
    /// Simple shear of the amount given, along a cube axis in a cube plane.
    SimpleShear(f64),
    /// One cube axis stretched to the factor given at constant volume.
    Upset(f64),
}

/// The gate of Eq. (35).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    limit: f64,
}

impl Gate {
    /// Gate whose unit step is zero at zero, as printed, with the tolerance `delta`.
    ///
    /// # Errors
    /// A negative `delta`.
    pub fn open(delta: f64) -> Result<Self, InputError> {
        Ok(Self { limit: 1.0 + at_least("gate tolerance", delta, 0.0)? })
    }

    /// Gate whose unit step is one at zero, to rounding, with the tolerance `delta`.
    ///
    /// # Errors
    /// A negative `delta`.
    pub fn closed(delta: f64) -> Result<Self, InputError> {
        Ok(Self { limit: Self::open(delta)?.limit * (1.0 + ROUNDING) })
    }

    fn passes(&self, zeta: f64, ratio: f64) -> bool {
        zeta < REACH && zeta * ratio.cbrt() < self.limit
    }
}

/// Where a path leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LatticeState {
    /// Density ratio `rho/rho0` of the rule.
    pub ratio: f64,
    /// Exact ratio `1/J`.
    pub exact: f64,
    /// Number of neighbours in contact at the end.
    pub contacts: usize,
}

impl Path {
    /// The exact density ratio `1/J` at the end of the path.
    #[must_use]
    pub fn exact(&self) -> f64 {
        match *self {
            Self::Uniform(stretch) => stretch.powi(-3),
            Self::Uniaxial(stretch) => stretch.recip(),
            Self::SimpleShear(_) | Self::Upset(_) => 1.0,
        }
    }

    fn validated(self) -> Result<Self, InputError> {
        match self {
            Self::Uniform(stretch) | Self::Uniaxial(stretch) | Self::Upset(stretch) => {
                above("stretch", stretch, 0.1)?;
                below("stretch", stretch, 10.0)?;
            }
            Self::SimpleShear(amount) => {
                below("amount of shear", at_least("amount of shear", amount, -5.0)?, 5.0)?;
            }
        }
        Ok(self)
    }

    /// Deformation gradient after the `part` of the path between 0 and 1; stretches change at a
    /// constant rate.
    fn gradient(&self, part: f64) -> Matrix {
        let at = |stretch: f64| 1.0 + part * (stretch - 1.0);
        let diagonal = |x: f64, y: f64| [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, y]];
        match *self {
            Self::Uniform(stretch) => diagonal(at(stretch), at(stretch)),
            Self::Uniaxial(stretch) => diagonal(at(stretch), 1.0),
            Self::SimpleShear(amount) => {
                [[1.0, part * amount, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            }
            Self::Upset(stretch) => diagonal(at(stretch), at(stretch).sqrt().recip()),
        }
    }
}

/// `zeta` of the lattice vector `site`, in units of half the cell, under the deformation `f`.
fn zeta(f: &Matrix, site: [f64; 3]) -> f64 {
    let component = |row: &[f64; 3]| row[0] * site[0] + row[1] * site[1] + row[2] * site[2];
    (f.iter().map(|row| component(row).powi(2)).sum::<f64>() / 3.0).sqrt()
}

/// All lattice vectors, in units of half the cell, that come into reach on the `path`.
fn neighbours(path: &Path) -> Vec<[f64; 3]> {
    // Coordinates along a cube axis of the reference lattice that may be brought into reach by
    // the largest contraction allowed.
    let survey: Vec<Matrix> =
        (0..=SURVEY).map(|i| path.gradient(f64::from(i) / f64::from(SURVEY))).collect();
    let bound = survey.iter().map(shrinkage).fold(1.0, f64::max);
    let extent = (1.02 * REACH * 3f64.sqrt() * bound).ceil();
    let axis = || (0_u32..).map(move |i| f64::from(i) - extent).take_while(move |&x| x <= extent);
    let mut sites = Vec::new();
    for x in axis() {
        for y in axis().filter(|y| (x - y) % 2.0 == 0.0) {
            for z in axis().filter(|z| (x - z) % 2.0 == 0.0) {
                let site = [x, y, z];
                let near = survey.iter().map(|f| zeta(f, site)).fold(f64::INFINITY, f64::min);
                if near > 0.0 && near < 1.02 * REACH {
                    sites.push(site);
                }
            }
        }
    }
    sites
}

/// An upper bound of the factor by which the inverse of `f` lengthens vectors, for the
/// upper-triangular gradients of [`Path`].
fn shrinkage(f: &Matrix) -> f64 {
    let inverse = [f[0][0].recip(), f[1][1].recip(), f[2][2].recip()];
    let shear = f[0][1] * inverse[0] * inverse[1];
    inverse.into_iter().fold(0.0, f64::max) + shear.abs()
}

/// Density ratio at the end of `path`, by `steps` steps.
///
/// # Errors
/// `steps = 0`, stretches outside `0.1..10` or shears of 5 and more.
pub fn integrate(path: Path, gate: Gate, steps: u32) -> Result<LatticeState, InputError> {
    let path = path.validated()?;
    let count = at_least("steps", f64::from(steps), 1.0)?;
    let sites = neighbours(&path);
    let distances = |part: f64| {
        let f = path.gradient(part);
        sites.iter().map(|&site| zeta(&f, site)).collect::<Vec<f64>>()
    };
    let mut now = distances(0.0);
    let mut ratio: f64 = 1.0;
    for step in 1..=steps {
        let next = distances(f64::from(step) / count);
        let change: f64 = now
            .iter()
            .zip(&next)
            .filter(|&(&zeta, _)| gate.passes(zeta, ratio))
            .map(|(from, to)| to.powi(-3) - from.powi(-3))
            .sum();
        ratio = (ratio + change / 8.0).max(0.0);
        now = next;
    }
    let contacts = now.iter().filter(|&&zeta| gate.passes(zeta, ratio)).count();
    Ok(LatticeState { ratio, exact: path.exact(), contacts })
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    fn ratio(path: Path, gate: Gate, steps: u32) -> f64 {
        integrate(path, gate, steps).unwrap().ratio
    }

    /// The first shell alone, `((2 + x^2)/3)^(-3/2)`, up to the contact of the second.
    #[test]
    fn the_first_shell_is_exact_before_the_second_meets() {
        for x in [0.99_f64, 0.9, 0.8166] {
            let shell = ((2.0 + x * x) / 3.0).powf(-1.5);
            let found = ratio(Path::Uniaxial(x), Gate::closed(0.0).unwrap(), 1000);
            assert_relative_eq!(found, shell, max_relative = 1e-10);
        }
    }

    /// Density ratio and contacts of the prototype's table: printed gate, tolerances 0.06, 0.1.
    #[test]
    fn reproduces_the_table_of_the_prototype() {
        let log_upset = |strain: f64| Path::Upset((-strain).exp());
        let rows = [
            (Path::Uniform(0.8), [1.953, 1.953, 1.953]),
            (Path::Uniaxial(0.95), [1.051, 1.051, 1.051]),
            (Path::Uniaxial(0.85), [1.157, 1.186, 1.220]),
            (Path::Uniaxial(0.8), [1.212, 1.293, 1.328]),
            (Path::Uniaxial(0.7), [1.368, 1.561, 1.595]),
            (Path::Uniaxial(0.6), [1.647, 1.848, 1.957]),
            (Path::SimpleShear(0.05), [1.025, 1.001, 1.001]),
            (Path::SimpleShear(0.2), [1.106, 1.029, 1.013]),
            (Path::SimpleShear(0.4), [1.216, 1.140, 1.100]),
            (log_upset(0.28), [1.126, 1.069, 1.089]),
            (log_upset(0.49), [1.456, 1.397, 1.370]),
            (log_upset(0.70), [2.076, 2.016, 1.989]),
        ];
        for (path, expected) in rows {
            for (delta, expected) in [0.0, 0.06, 0.1].into_iter().zip(expected) {
                let found = ratio(path, Gate::open(delta).unwrap(), 20_000);
                assert_relative_eq!(found, expected, epsilon = 8e-4);
            }
        }
        let contacts =
            |path, delta| integrate(path, Gate::open(delta).unwrap(), 5000).unwrap().contacts;
        assert_eq!(contacts(Path::Uniaxial(0.8), 0.0), 2);
        assert_eq!(contacts(Path::Uniaxial(0.8), 0.06), 10);
        assert_eq!(contacts(Path::Uniaxial(0.6), 0.06), 2);
        assert_eq!(contacts(Path::SimpleShear(0.2), 0.06), 4);
        assert_eq!(contacts(Path::SimpleShear(0.2), 0.1), 8);
    }

    #[test]
    fn refuses_nonsense() {
        let gate = Gate::open(0.0).unwrap();
        assert!(Gate::open(-0.1).is_err() && Gate::closed(f64::NAN).is_err());
        assert!(integrate(Path::Uniform(0.0), gate, 10).is_err());
        assert!(integrate(Path::SimpleShear(9.0), gate, 10).is_err());
        assert!(integrate(Path::Uniform(0.9), gate, 0).is_err());
        assert_eq!(neighbours(&Path::Uniform(1.0)).len(), 8);
    }

    proptest! {
        #![proptest_config(cases(48))]

        #[test]
        fn uniform_compression_is_exact(stretch in 0.75..1.03, delta in 0.0..0.1) {
            let gate = Gate::closed(delta).unwrap();
            let state = integrate(Path::Uniform(stretch), gate, 500).unwrap();
            prop_assert!((state.ratio / state.exact - 1.0).abs() < 1e-12 && state.contacts == 8);
        }

        /// With a tolerance the response to small strain is that of the trace; the printed gate
        /// makes shear dilatant, `rho/rho0 = 1 + |g|/2`.
        #[test]
        fn small_strains_follow_the_trace(e in -0.004..0.004_f64) {
            let gate = Gate::open(0.06).unwrap();
            let squares = 3.0 * e * e + 1e-12;
            prop_assert!((ratio(Path::Uniaxial(1.0 + e), gate, 100) - 1.0 + e).abs() < squares);
            prop_assert!((ratio(Path::Upset(1.0 + e), gate, 100) - 1.0).abs() < squares);
            prop_assert!((ratio(Path::SimpleShear(e), gate, 100) - 1.0).abs() < squares);
            let printed = ratio(Path::SimpleShear(e), Gate::open(0.0).unwrap(), 2000);
            prop_assert!((printed - 1.0 - 0.5 * e.abs()).abs() < squares + 2e-3 * e.abs());
        }
    }
}
