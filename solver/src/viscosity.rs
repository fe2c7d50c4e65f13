//! Artificial viscosity, Eqs. (51)-(53), and the limited form of the default preset.

use crate::chain::{Contact, Side};
use crate::eos::Eos;
use crate::method::{Method, Viscosity};

/// Motion of a pair and what its viscosity needs to know.
#[derive(Debug, Clone, Copy)]
pub struct Closing {
    /// Closing speed `v = -dr/dt`, Eq. (52): positive when converging.
    pub speed: f64,
    /// The part of it that is not explained by the slopes of the neighbouring velocities.
    pub jump: f64,
    /// Densities of the two sides in this contact.
    pub rho: [f64; 2],
    /// Sound speeds of the two sides.
    pub sound: [f64; 2],
}

/// A viscous force `q`, repulsive when positive, and its coefficient `q / v` for the time step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Viscous {
    /// Force between the two.
    pub force: f64,
    /// Its coefficient.
    pub coefficient: f64,
}

/// The viscosity of a run.
#[derive(Debug, Clone, Copy)]
pub struct ViscousLaw {
    form: Viscosity,
    linear: f64,
    quadratic: f64,
}

impl ViscousLaw {
    pub(crate) fn new(method: &Method) -> Self {
        Self { form: method.viscosity, linear: method.visc_linear, quadratic: method.visc_quad }
    }

    /// Largest zeta at which pairs beyond the nearest feel it.
    pub(crate) fn support(&self) -> f64 {
        match self.form {
            Viscosity::Pairwise => 1.0,
            Viscosity::Limited => 0.0,
        }
    }

    /// Whether it looks at the velocities around a pair.
    #[inline(always)]
    pub(crate) fn limited(&self) -> bool {
        self.form == Viscosity::Limited
    }

    /// Viscous force of a pair.
    #[inline(always)]
    pub fn force<E: Eos>(&self, contact: &Contact, closing: &Closing, sides: [(&Side, &E); 2]) -> Viscous {
        match self.form {
            Viscosity::Pairwise => self.pairwise(contact, closing, sides),
            Viscosity::Limited => self.kuropatenko(contact, closing, sides),
        }
    }

    /// Eqs. (51)-(53) with area 1 for `V_o^(2/3)`:
    ///
    /// `q = nu max(0, v) u(1 - zeta)`,
    /// `nu = c_o / 2 (rho_o c + rho_o c) (1 + 2 c_1 |v| / (c + c))`.
    ///
    /// Repulsive, where the signs of Eqs. (51) and (74) together attract (decision 0001).
    #[inline(always)]
    fn pairwise<E: Eos>(&self, contact: &Contact, closing: &Closing, sides: [(&Side, &E); 2]) -> Viscous {
        if closing.speed <= 0.0 || contact.zeta >= 1.0 {
            return Viscous::default();
        }
        let [c_i, c_j] = closing.sound;
        let impedance = sides[0].0.rho_0 * c_i + sides[1].0.rho_0 * c_j;
        // nu = c_o/2 (rho c + rho c) + c_o c_1 |v| (rho c + rho c)/(c + c), which stays finite.
        let mean_rho = if c_i + c_j > 0.0 { impedance / (c_i + c_j) } else { 0.0 };
        let coefficient =
            self.linear * (0.5 * impedance + self.quadratic * closing.speed * mean_rho);
        Viscous { force: coefficient * closing.speed, coefficient }
    }

    /// Kuropatenko's form on the limited jump `j` of the closing speed (decision 0006):
    ///
    /// `q = rho j (b + sqrt(b^2 + (c_o c)^2))`, `b = c_1 s j`,
    ///
    /// with `s` the slope of the shock speed. Cold gas, in which `c = 0`, has viscosity too.
    #[inline(always)]
    fn kuropatenko<E: Eos>(&self, contact: &Contact, closing: &Closing, sides: [(&Side, &E); 2]) -> Viscous {
        if !contact.nearest || closing.jump <= 0.0 {
            return Viscous::default();
        }
        let mean = |pair: [f64; 2]| 0.5 * (pair[0] + pair[1]);
        let b = self.quadratic * mean(sides.map(|s| s.1.shock_slope())) * closing.jump;
        let c = self.linear * mean(closing.sound);
        let coefficient = mean(closing.rho) * (b + (b * b + c * c).sqrt());
        Viscous { force: coefficient * closing.jump, coefficient }
    }
}

/// The part of a pair's velocity slope that its neighbours' slopes do not explain, as a share of
/// the pair's own: `1 - phi` with
///
/// `phi = max(0, min((r_L + r_R) / 2, 2 r_L, 2 r_R, 1))`,
///
/// `r` the ratio of the neighbouring slope to the pair's. A linear velocity field has no jump.
/// Written with slopes, so that nothing is divided: returns the unexplained slope.
#[inline(always)]
#[must_use]
pub fn unexplained_slope(left: f64, own: f64, right: f64) -> f64 {
    let sign = if own < 0.0 { -1.0 } else { 1.0 };
    let (l, o, r) = (sign * left, sign * own, sign * right);
    let phi = (0.5 * (l + r)).min(2.0 * l).min(2.0 * r).min(o).max(0.0);
    sign * (o - phi)
}
