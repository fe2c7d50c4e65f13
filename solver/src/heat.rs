//! Artificial heat diffusion, Eqs. (56)-(57).

use crate::chain::{Contact, Side};
use crate::eos::Eos;
use crate::method::{Conduction, Method};
use crate::viscosity::Closing;

/// Whether, and how, pairs exchange heat.
pub trait Heat: Send + Sync + 'static {
    /// Whether there is any conduction.
    const CONDUCTS: bool;

    /// The law of a method.
    fn new(method: &Method) -> Self;

    /// Largest zeta at which pairs beyond the nearest exchange heat.
    fn support(&self) -> f64;

    /// Heat transfer coefficient `R` of Eq. (57), power per temperature difference.
    fn transfer<E: Eos>(
        &self,
        contact: &Contact,
        closing: &Closing,
        sides: [(&Side, &E); 2],
    ) -> f64;
}

/// No conduction: no code.
#[derive(Debug, Clone, Copy, Default)]
pub struct Adiabatic;

impl Heat for Adiabatic {
    const CONDUCTS: bool = false;

    fn new(_: &Method) -> Self {
        Self
    }

    fn support(&self) -> f64 {
        0.0
    }

    #[inline(always)]
    fn transfer<E: Eos>(&self, _: &Contact, _: &Closing, _: [(&Side, &E); 2]) -> f64 {
        0.0
    }
}

/// Conduction: the heat `R (theta_i - theta_j)` flows from i to j, Eq. (56).
#[derive(Debug, Clone, Copy)]
pub struct ArtificialConduction {
    /// `k_o` of Eq. (57); zero in the shock form.
    linear: f64,
    /// Its counterpart in the shock form; zero in the linear one.
    shock: f64,
}

impl Heat for ArtificialConduction {
    const CONDUCTS: bool = true;

    fn new(method: &Method) -> Self {
        let of = |form| {
            if method.conduction == form { method.heat_coeff } else { 0.0 }
        };
        Self { linear: of(Conduction::Linear), shock: of(Conduction::Shock) }
    }

    fn support(&self) -> f64 {
        if self.linear > 0.0 { 1.0 } else { 0.0 }
    }

    /// Eq. (57) with area 1 for `V_o^(2/3)`, for pairs with `zeta < 1`; or the shock form
    /// `k rho c_v j` with `j` the limited jump, which leaves contact discontinuities alone
    /// (decision 0006).
    #[inline(always)]
    fn transfer<E: Eos>(
        &self,
        contact: &Contact,
        closing: &Closing,
        sides: [(&Side, &E); 2],
    ) -> f64 {
        let mean = |pair: [f64; 2]| 0.5 * (pair[0] + pair[1]);
        let per_side = |k: usize| sides[k].0.rho_0 * closing.sound[k] * sides[k].1.c_v();
        let linear = if contact.zeta < 1.0 { mean([per_side(0), per_side(1)]) } else { 0.0 };
        let c_v = mean(sides.map(|s| s.1.c_v()));
        let jump = if contact.nearest { closing.jump.max(0.0) } else { 0.0 };
        self.linear * linear + self.shock * mean(closing.rho) * c_v * jump
    }
}
