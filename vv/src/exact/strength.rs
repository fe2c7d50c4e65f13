//! Elastic laws and yield readings of an isotropic, perfectly plastic solid in uniaxial strain.
//!
//! Uniaxial strain with the axial stretch `lambda = rho0/rho < 1`, `F = diag(lambda, 1, 1)`. Every
//! law gives the compressive axial stress deviator `s`, so that the axial stress is `p + s`.
//!
//! The first three laws are those of H. S. Udaykumar et al. (2003) and E. J. Lieberman et al.
//! (2019), as in `ExactPack`; all yield in the von Mises sense at `s = 2 Y/3` and keep that value:
//! * hypoelastic: `s = -(4/3) G ln lambda`;
//! * infinitesimal hyperelastic: `s = (4/3) G (1 - lambda)`;
//! * finite hyperelastic: `s = (2/3) G (lambda^(-5/3) - lambda^(7/3) + lambda - 1/lambda)`.
//!
//! The isochoric Green law has the shear energy `psi = G tr(Ee^2)` per reference volume with
//! `Ee = (C - I)/2 - Ep` and `C = J^(-2/3) F^T F = diag(lambda^(4/3), lambda^(-2/3),
//! lambda^(-2/3))`, Eq. (24) of Park and Fahrenthold. Then `S = 2 G Ee`, the Kirchhoff stress
//! deviator is `dev(J^(-2/3) F S F^T)` and `s = (2/3) (C2 S2 - C1 S1)/lambda`. Plastic flow by
//! their Eqs. (38)-(43) keeps `det Cp = 1` for `Cp = I + 2 Ep`, so `Cp = diag(q, q^(-1/2),
//! q^(-1/2))`, `S1 = G (C1 - q)`, `S2 = G (C2 - q^(-1/2))`; and yield means
//! `n (q^(-1/2) S2 - q S1)/sqrt(3) = Y'`, with `norm(T) = sqrt(tr(T^2)/2)` and, by reading,
//! `n = sqrt(3/2)/norm(Cp)`, `Y' = Y/sqrt(3)` (Mises) or `Y` (shear); `n = 1/norm(Cp)`, `Y' = Y`
//! (as printed). At first yield `q = 1` these say `S2 - S1 = Y`, `sqrt(3) Y` and `(3/sqrt 2) Y`.
//! Before it, `s = (2/3) G (lambda^(-7/3) - lambda^(-5/3) + lambda^(1/3) - lambda^(5/3))`, the
//! finite hyperelastic law over `lambda^(2/3)`.

use super::numerics::root;
use super::{InputError, above, below};

/// Largest fraction of the shear modulus a uniaxial yield stress may be.
const STRONGEST: f64 = 0.5;
/// Stretches below this are beyond the use of these laws.
const SMALLEST: f64 = 0.05;

/// What the yield stress of the isochoric Green law means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum YieldReading {
    /// Stress at yield in uniaxial stress.
    Mises,
    /// Stress at yield in pure shear, the square root of the second invariant.
    Shear,
    /// The printed invariant and projection, Eqs. (39)-(43) of Park and Fahrenthold.
    AsPrinted,
}

impl YieldReading {
    /// The three readings.
    pub const ALL: [Self; 3] = [Self::Mises, Self::Shear, Self::AsPrinted];

    /// Yield stress in small uniaxial stress over `Y`: 1, `sqrt(3)`, `3/sqrt(2)`.
    #[must_use]
    pub fn factor(self) -> f64 {
        match self {
            Self::Mises => 1.0,
            Self::Shear => 3f64.sqrt(),
            Self::AsPrinted => 4.5f64.sqrt(),
        }
    }
}

/// Elastic law; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Elasticity {
    /// Logarithmic strain.
    Hypoelastic,
    /// Engineering strain.
    Infinitesimal,
    /// Finite hyperelastic strain after Lieberman et al.
    Finite,
    /// Isochoric Green strain with one of three yield readings.
    IsochoricGreen(YieldReading),
}

/// An elastic law with its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strength {
    elasticity: Elasticity,
    shear_modulus: f64,
    yield_stress: f64,
}

/// Deviatoric response at one stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviator {
    /// Compressive axial stress deviator `s`.
    pub stress: f64,
    /// Elastic shear energy per reference volume that the law keeps apart from the internal
    /// energy of the equation of state; zero but for the isochoric Green law.
    pub stored_energy: f64,
}

impl Strength {
    /// Law with `shear_modulus` `G` and `yield_stress` `Y`, both stresses.
    ///
    /// # Errors
    /// `G <= 0`, `Y <= 0`, or a uniaxial yield stress of half the shear modulus or more.
    pub fn new(
        elasticity: Elasticity,
        shear_modulus: f64,
        yield_stress: f64,
    ) -> Result<Self, InputError> {
        let shear_modulus = above("shear modulus", shear_modulus, 0.0)?;
        let yield_stress = above("yield stress", yield_stress, 0.0)?;
        let law = Self { elasticity, shear_modulus, yield_stress };
        below("uniaxial yield stress", law.uniaxial_yield(), STRONGEST * shear_modulus)?;
        Ok(law)
    }

    /// Shear modulus `G`.
    #[must_use]
    pub const fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    /// Yield stress in small uniaxial stress.
    #[must_use]
    pub fn uniaxial_yield(&self) -> f64 {
        match self.elasticity {
            Elasticity::IsochoricGreen(reading) => reading.factor() * self.yield_stress,
            _ => self.yield_stress,
        }
    }

    /// Axial stretch `rho0/rho` at first yield.
    #[must_use]
    pub fn yield_stretch(&self) -> f64 {
        let strain = 0.5 * self.uniaxial_yield() / self.shear_modulus;
        match self.elasticity {
            Elasticity::Hypoelastic => (-strain).exp(),
            Elasticity::Infinitesimal => 1.0 - strain,
            Elasticity::Finite => {
                root(|l| self.elastic(l).stress - 2.0 / 3.0 * self.yield_stress, 0.3, 1.0)
            }
            Elasticity::IsochoricGreen(_) => {
                root(|l| l.powf(-2.0 / 3.0) - l.powf(4.0 / 3.0) - 2.0 * strain, 0.3, 1.0)
            }
        }
    }

    /// Response at the axial `stretch`, reached by monotonic compression from the rest state.
    ///
    /// # Errors
    /// A `stretch` above one or not above 1/20.
    pub fn at(&self, stretch: f64) -> Result<Deviator, InputError> {
        let stretch = above("stretch", stretch, SMALLEST)?;
        super::at_least("1 - stretch", 1.0 - stretch, 0.0)?;
        Ok(self.response(stretch, self.yield_stretch()))
    }

    /// [`Self::at`] without its checks, given the [`Self::yield_stretch`].
    pub(crate) fn response(&self, stretch: f64, yield_stretch: f64) -> Deviator {
        if stretch >= yield_stretch {
            return self.elastic(stretch);
        }
        match self.elasticity {
            Elasticity::IsochoricGreen(reading) => {
                // Between the relaxed state q = C1 and the purely elastic q = 1.
                let overstress = |q: f64| self.overstress(stretch, q, reading);
                self.green(stretch, root(overstress, stretch.powf(4.0 / 3.0), 1.0))
            }
            _ => Deviator { stress: 2.0 / 3.0 * self.yield_stress, stored_energy: 0.0 },
        }
    }

    fn elastic(&self, l: f64) -> Deviator {
        let strain = match self.elasticity {
            Elasticity::Hypoelastic => -l.ln(),
            Elasticity::Infinitesimal => 1.0 - l,
            Elasticity::Finite => 0.5 * (l.powf(-5.0 / 3.0) - l.powf(7.0 / 3.0) + l - l.recip()),
            Elasticity::IsochoricGreen(_) => return self.green(l, 1.0),
        };
        Deviator { stress: 4.0 / 3.0 * self.shear_modulus * strain, stored_energy: 0.0 }
    }

    /// `[C1, C2, S1, S2]` of the isochoric Green law at the axial plastic metric `q`.
    fn components(&self, stretch: f64, q: f64) -> [f64; 4] {
        let (c1, c2) = (stretch.powf(4.0 / 3.0), stretch.powf(-2.0 / 3.0));
        [c1, c2, self.shear_modulus * (c1 - q), self.shear_modulus * (c2 - q.powf(-0.5))]
    }

    fn green(&self, stretch: f64, q: f64) -> Deviator {
        let [c1, c2, s1, s2] = self.components(stretch, q);
        Deviator {
            stress: 2.0 / 3.0 * (c2 * s2 - c1 * s1) / stretch,
            stored_energy: (s1 * s1 + 2.0 * s2 * s2) / (4.0 * self.shear_modulus),
        }
    }

    /// Yield function of the isochoric Green law.
    fn overstress(&self, stretch: f64, q: f64, reading: YieldReading) -> f64 {
        let [_, _, s1, s2] = self.components(stretch, q);
        let metric_norm = (0.5 * q * q + 1.0 / q).sqrt();
        let effective = (s2 / q.sqrt() - q * s1) / (3f64.sqrt() * metric_norm);
        let limit = reading.factor() / 4.5f64.sqrt() * self.yield_stress;
        effective - limit
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::cases;
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    const LAWS: [Elasticity; 6] = [
        Elasticity::Hypoelastic,
        Elasticity::Infinitesimal,
        Elasticity::Finite,
        Elasticity::IsochoricGreen(YieldReading::Mises),
        Elasticity::IsochoricGreen(YieldReading::Shear),
        Elasticity::IsochoricGreen(YieldReading::AsPrinted),
    ];

    #[test]
    fn refuses_nonsense() {
        assert!(Strength::new(Elasticity::Finite, 0.0, 1.0).is_err());
        assert!(Strength::new(LAWS[5], 1.0, 0.3).is_err());
        let law = Strength::new(LAWS[3], 1.0, 0.01).unwrap();
        assert!(law.at(1.1).is_err() && law.at(0.0).is_err());
        assert_relative_eq!(law.at(1.0).unwrap().stress, 0.0);
    }

    /// The printed flow rule and return, Eqs. (38)-(46), followed in small steps.
    #[test]
    fn plastic_flow_follows_the_printed_rule() {
        let (to, steps) = (0.8, 4000_u32);
        let law = Strength::new(LAWS[5], 1.0, 0.02).unwrap();
        let pair = |v: [f64; 2]| (0.5 * v[0] * v[0] + v[1] * v[1]).sqrt();
        let mut strain = [0.0; 2];
        for step in 1..=steps {
            let l = 1.0 - (1.0 - to) * f64::from(step) / f64::from(steps);
            for _ in 0..4 {
                let metric = strain.map(|e: f64| 1.0 + 2.0 * e);
                let size = pair(metric);
                let cauchy_green = [l.powf(4.0 / 3.0), l.powf(-2.0 / 3.0)];
                let t = [0, 1].map(|i| metric[i] * (cauchy_green[i] - metric[i]) / size);
                let effective = t.map(|x| x - (t[0] + 2.0 * t[1]) / 3.0);
                let flow = [0, 1].map(|i| metric[i] * effective[i] / size);
                let (norm, scale) = (pair(effective), 2.0 * pair(flow).powi(2));
                if norm > 0.02 {
                    strain = [0, 1].map(|i| strain[i] + (norm - 0.02) * norm / scale * flow[i]);
                }
            }
        }
        let metric = strain.map(|e| 1.0 + 2.0 * e);
        assert_relative_eq!(metric[0] * metric[1] * metric[1], 1.0, max_relative = 1e-3);
        let expected = law.at(to).unwrap().stress;
        assert_relative_eq!(law.green(to, metric[0]).stress, expected, max_relative = 1e-3);
    }

    proptest! {
        #![proptest_config(cases(64))]

        #[test]
        fn the_finite_laws_differ_by_a_power_of_the_stretch(l in 0.9..0.999_f64) {
            let stress = |law| Strength::new(law, 1.0, 0.2).unwrap().elastic(l).stress;
            let ratio = stress(LAWS[2]) / stress(LAWS[3]);
            prop_assert!((ratio / l.powf(2.0 / 3.0) - 1.0).abs() < 1e-10);
        }

        #[test]
        fn small_strains_are_linear(law in 0..6_usize, g in 0.01..10.0, e in 1e-7..1e-6_f64) {
            let law = Strength::new(LAWS[law], g, 0.01 * g).unwrap();
            let stress = law.at(1.0 - e).unwrap().stress;
            prop_assert!((stress / (4.0 / 3.0 * g * e) - 1.0).abs() < 1e-5);
        }

        /// Yield is continuous, and for weak solids at the uniaxial stress of the reading.
        #[test]
        fn yield_is_continuous(law in 0..6_usize, g in 0.01..10.0, y in 1e-6..0.01) {
            let law = Strength::new(LAWS[law], g, y * g).unwrap();
            let l = law.yield_stretch();
            let (before, after) = (law.at(l + 1e-12).unwrap(), law.at(l - 1e-12).unwrap());
            prop_assert!((before.stress - after.stress).abs() < 1e-5 * before.stress);
            let mises = 1.5 * before.stress / law.uniaxial_yield();
            prop_assert!((mises - 1.0).abs() < 5.0 * y + 1e-5);
        }

        /// Elastic Green law: the deviator's work is the stored energy, `d psi = -s d lambda`.
        /// In plastic flow the difference is dissipated and never negative.
        #[test]
        fn shear_work_is_stored_or_dissipated(
            reading in 0..3_usize, y in 1e-4..0.02, to in 0.5..0.999,
        ) {
            let reading = YieldReading::ALL[reading];
            let law = Strength::new(Elasticity::IsochoricGreen(reading), 1.0, y).unwrap();
            let h = 1e-6;
            let (a, b) = (law.at(to + h).unwrap(), law.at(to - h).unwrap());
            let stored = (b.stored_energy - a.stored_energy) / (2.0 * h);
            let work = law.at(to).unwrap().stress;
            if to > law.yield_stretch() + h {
                prop_assert!((stored - work).abs() < 1e-7);
            } else {
                prop_assert!(stored < work + 1e-9);
            }
        }
    }
}
