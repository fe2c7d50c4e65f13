//! Artificial viscosity, Eqs. (51)-(53), and the limited form of the default preset.

use crate::chain::{Contact, Side};
use crate::eos::Eos;
use crate::method::{Method, Viscosity};

/// Motion of a pair and what its viscosity needs to know.
#[derive(Debug, Clone, Copy)]
pub struct Closing {
    /// The part of the closing speed `v = -dr/dt`, Eq. (52), that the viscosity acts on: positive
    /// when converging.
    pub jump: f64,
    /// Densities of the two sides in this contact, `rho_o / zeta`, whatever the density scheme.
    pub rho: [f64; 2],
    /// Sound speeds of the two sides.
    pub sound: [f64; 2],
}

/// The viscosity of a run.
#[derive(Debug, Clone, Copy)]
pub struct ViscousLaw {
    form: Viscosity,
    linear: f64,
    quadratic: f64,
    expansion: f64,
    steepness: f64,
}

impl ViscousLaw {
    pub(crate) fn new(method: &Method) -> Self {
        Self {
            form: method.viscosity,
            linear: method.visc_linear,
            quadratic: method.visc_quad,
            expansion: method.visc_expansion,
            steepness: method.limiter,
        }
    }

    /// The law of a run in which only nearest neighbours act: the limited form.
    #[inline(always)]
    pub(crate) fn near(self) -> Self {
        Self { form: Viscosity::Limited, ..self }
    }

    /// The law of a run with pairs beyond the nearest: mostly the paper's form.
    #[inline(always)]
    pub(crate) fn far(self) -> Option<Self> {
        let pairwise = self.form == Viscosity::Pairwise;
        pairwise.then_some(Self { form: Viscosity::Pairwise, ..self })
    }

    /// Largest zeta at which pairs beyond the nearest feel it.
    pub(crate) fn support(&self) -> f64 {
        match self.form {
            Viscosity::Pairwise => 1.0,
            Viscosity::Limited => 0.0,
        }
    }

    /// The part of a velocity jump that the viscosity acts on, of the jumps before, of and after
    /// the pair.
    #[inline(always)]
    pub(crate) fn seen(&self, jumps: [f64; 3]) -> f64 {
        match self.form {
            Viscosity::Pairwise => jumps[1],
            Viscosity::Limited => unexplained(jumps, self.steepness),
        }
    }

    /// Coefficient `nu` of the viscous force `nu * jump`.
    #[inline(always)]
    pub fn coefficient<E: Eos>(
        &self,
        contact: &Contact,
        closing: &Closing,
        sides: [(&Side, &E); 2],
    ) -> f64 {
        match self.form {
            Viscosity::Pairwise => self.pairwise(contact, closing, sides),
            Viscosity::Limited if contact.nearest => {
                let compression = self.compression(closing, sides);
                let recession = if contact.bonded { self.recession(closing) } else { 0.0 };
                if closing.jump > 0.0 { compression } else { recession }
            }
            Viscosity::Limited => 0.0,
        }
    }

    /// Largest coefficient that a pair may meet at this closing speed, for the time step. The
    /// limiter has no say: round-off in it would reach the time step.
    #[inline(always)]
    pub fn bound<E: Eos>(
        &self,
        contact: &Contact,
        closing: &Closing,
        sides: [(&Side, &E); 2],
    ) -> f64 {
        match self.form {
            Viscosity::Pairwise => self.pairwise(contact, closing, sides),
            Viscosity::Limited if contact.nearest => {
                self.compression(closing, sides).max(self.recession(closing))
            }
            Viscosity::Limited => 0.0,
        }
    }

    /// Eqs. (51)-(53) with area 1 for `V_o^(2/3)`:
    ///
    /// `nu = c_o / 2 (rho_o c + rho_o c) (1 + 2 c_1 |v| / (c + c))`
    ///
    /// for converging pairs with `zeta < 1`. Repulsive, where the signs of Eqs. (51) and (74)
    /// together attract (decision 0001).
    #[inline(always)]
    fn pairwise<E: Eos>(
        &self,
        contact: &Contact,
        closing: &Closing,
        sides: [(&Side, &E); 2],
    ) -> f64 {
        if closing.jump <= 0.0 || contact.zeta >= 1.0 {
            return 0.0;
        }
        let [c_i, c_j] = closing.sound;
        let impedance = sides[0].0.rho_0 * c_i + sides[1].0.rho_0 * c_j;
        if self.quadratic == 0.0 || c_i + c_j == 0.0 {
            return 0.5 * self.linear * impedance;
        }
        self.linear * impedance * (0.5 + self.quadratic * closing.jump / (c_i + c_j))
    }

    /// Kuropatenko's form for a converging pair with the unexplained jump `j` (decision 0006):
    ///
    /// `nu = rho (b + sqrt(b^2 + (c_o c)^2))`, `b = c_1 s j`,
    ///
    /// with `s` the slope of the shock speed. Cold gas, in which `c = 0`, has viscosity too.
    #[inline(always)]
    fn compression<E: Eos>(&self, closing: &Closing, sides: [(&Side, &E); 2]) -> f64 {
        let slope = 0.5 * (sides[0].1.shock_slope() + sides[1].1.shock_slope());
        let b = self.quadratic * slope * closing.jump.max(0.0);
        let c = self.linear * closing.sound[0].min(closing.sound[1]);
        0.5 * (closing.rho[0] + closing.rho[1]) * (b + (b * b + c * c).sqrt())
    }

    /// An acoustic damper for a receding pair, `nu = c_e rho c`: it acts where the jumps around the
    /// pair do not explain its own, which is the ringing behind a shock.
    #[inline(always)]
    fn recession(&self, closing: &Closing) -> f64 {
        let rho = 0.5 * (closing.rho[0] + closing.rho[1]);
        self.expansion * rho * closing.sound[0].min(closing.sound[1])
    }
}

/// The part of a pair's velocity jump `d` that the jumps before and after it do not explain:
/// `d (1 - phi)` with
///
/// `phi = min(1, B d_L d_R / ((d_L + d_R) d))`
///
/// where all three have one sign, and 0 elsewhere. A linear velocity field is explained wholly, a
/// front or a zigzag not at all.
#[inline(always)]
#[must_use]
pub fn unexplained([before, own, after]: [f64; 3], steepness: f64) -> f64 {
    // Both sides are computed and one is taken, so that many pairs can be looked at at once.
    let product = before * after;
    let alike = (product > 0.0) & (before * own > 0.0);
    let phi = (steepness * product / ((before + after) * own)).min(1.0);
    own - if alike { own * phi } else { 0.0 }
}
