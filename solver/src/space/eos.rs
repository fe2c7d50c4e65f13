//! Equations of state, Eq. (22), eight particles at a time.

use super::lanes::Lanes;
use super::scene::{EosData, GammaLaw, Material};

/// Pressure and what follows from it.
#[derive(Debug, Clone, Copy)]
pub struct Response<F> {
    /// Pressure `P`; not negative, since tension is carried by the elements.
    pub pressure: F,
    /// Square of the sound speed `c_s`.
    pub sound_squared: F,
    /// Temperature `theta`.
    pub theta: F,
}

/// An equation of state. Which one is decided once a piece of particles.
#[derive(Debug, Clone, Copy)]
pub enum Eos {
    /// Solids.
    MieGruneisen(MieGruneisen),
    /// Gases.
    IdealGas(IdealGas),
}

/// `P = P_H + Gamma rho (u - u_H)` on the Hugoniot `U_s = c0 + s u_p`, linear in expansion.
#[derive(Debug, Clone, Copy)]
pub struct MieGruneisen {
    rho_0: f64,
    /// `rho_o c0^2`, the bulk modulus.
    bulk: f64,
    s: f64,
    /// `Gamma rho` at the reference density.
    product: f64,
    /// Its increase per density.
    steepness: f64,
    /// Coefficients of `theta_s - theta_0 - u_s / c_v` from `eta` on: `theta_s` and `u_s` on the isentrope
    /// through the reference state.
    isentrope: [f64; TERMS],
    c_v: f64,
    theta_0: f64,
    /// Compression beyond which the Hugoniot goes on straight.
    eta_cap: f64,
}

/// Eq. (80) with `u_o = 0`.
#[derive(Debug, Clone, Copy)]
pub struct IdealGas {
    index: f64,
    c_v: f64,
}

/// Share of the compression at which the Hugoniot ends, `eta = 1/s`, from where on it goes on
/// straight.
const LAST: f64 = 0.85;

/// The same of a flat Hugoniot, which has none: a tenth of the volume.
const TENFOLD: f64 = 0.9;

/// Terms of the series of the isentrope: enough for one per cent of its energy at `s eta = 0.6`.
const TERMS: usize = 10;

/// Lowest density of a solid over its reference density.
const THINNEST: f64 = 0.3;

/// Lowest sound speed over the reference one, squared.
const LEAST_SOUND: f64 = 0.25;

impl Eos {
    /// The equation of state of a material.
    #[must_use]
    pub fn new(material: &Material) -> Self {
        let rho_0 = material.density;
        match material.eos {
            EosData::MieGruneisen { c0, s, gamma_0, law, c_v, theta_0 } => {
                let b = match law {
                    GammaLaw::ConstantProduct => 0.0,
                    GammaLaw::Steinberg(b) => b,
                };
                Self::MieGruneisen(MieGruneisen {
                    rho_0,
                    bulk: rho_0 * c0 * c0,
                    s,
                    product: rho_0 * gamma_0,
                    steepness: b,
                    isentrope: isentrope([c0, s], [gamma_0, b], [c_v, theta_0]),
                    c_v,
                    theta_0,
                    eta_cap: (LAST / s.max(1e-3)).min(TENFOLD),
                })
            }
            EosData::IdealGas { adiabatic_index, c_v } => {
                Self::IdealGas(IdealGas { index: adiabatic_index, c_v })
            }
        }
    }

    /// Bulk modulus `K` of the elements in tension, Eq. (25): none for a gas.
    #[must_use]
    pub fn bulk(&self) -> f64 {
        match self {
            Self::MieGruneisen(solid) => solid.bulk,
            Self::IdealGas(_) => 0.0,
        }
    }

    /// Pressure per temperature at the reference density: none that counts for a gas, which bears no tension.
    #[must_use]
    pub fn thermal(&self) -> f64 {
        match self {
            Self::MieGruneisen(solid) => solid.product * solid.c_v,
            Self::IdealGas(_) => 0.0,
        }
    }

    /// Specific heat `c_v`.
    #[must_use]
    pub fn c_v(&self) -> f64 {
        match self {
            Self::MieGruneisen(solid) => solid.c_v,
            Self::IdealGas(gas) => gas.c_v,
        }
    }

    /// Lowest density, over the reference density, that particles are given. A solid is debris there,
    /// and its law is none of a vapour; a gas law holds at any density, which only has to stay positive.
    #[must_use]
    pub fn rarest(&self) -> f64 {
        match self {
            Self::MieGruneisen(_) => THINNEST,
            Self::IdealGas(_) => f64::EPSILON,
        }
    }

    /// Factor of the density rates (36) of contacts at a density over the reference density: as printed
    /// they are those of a solid, and would take a thin gas through zero.
    #[inline(always)]
    #[must_use]
    pub fn thinning(&self, ratio: f64) -> f64 {
        match self {
            Self::MieGruneisen(_) => 1.0,
            Self::IdealGas(_) => ratio.min(1.0),
        }
    }

    /// Slope of the shock speed over the jump of velocity.
    #[must_use]
    pub fn slope(&self) -> f64 {
        match self {
            Self::MieGruneisen(solid) => solid.s,
            Self::IdealGas(gas) => 0.5 * (gas.index + 1.0),
        }
    }

    /// Temperature of the reference state.
    #[must_use]
    pub fn theta_0(&self) -> f64 {
        match self {
            Self::MieGruneisen(solid) => solid.theta_0,
            Self::IdealGas(_) => 0.0,
        }
    }

    /// Pressure, sound speed and temperature at a density, with its inverse, and an internal energy per mass. Of the cold
    /// tension of an expanded solid its particles feel the part that `loose` is, asked for if any is expanded: elements
    /// carry the rest (decision 0025).
    #[inline(always)]
    #[must_use]
    pub fn respond<F: Lanes>(
        &self,
        (rho, inverse): (F, F),
        u: F,
        loose: impl FnOnce() -> F,
    ) -> Response<F> {
        match self {
            Self::MieGruneisen(solid) => solid.respond((rho, inverse), u, loose),
            Self::IdealGas(gas) => gas.respond(rho, u),
        }
    }
}

impl MieGruneisen {
    #[inline(always)]
    fn respond<F: Lanes>(
        &self,
        (rho, inverse): (F, F),
        u: F,
        loose: impl FnOnce() -> F,
    ) -> Response<F> {
        let (zero, one) = (F::zero(), F::splat(1.0));
        // Written so that both are exactly zero at the reference density.
        let mu = (rho - self.rho_0) * (1.0 / self.rho_0);
        let eta = (rho - self.rho_0) * inverse;
        let capped = eta.min(F::splat(self.eta_cap)).max(zero);
        let gap = one / (one - capped * self.s);
        let product = (rho - self.rho_0) * self.steepness + self.product;
        // Half of eta Gamma rho / rho_o.
        let release = product * capped * (0.5 / self.rho_0);
        let hugoniot = capped * self.bulk * gap * gap;
        let slope = (capped * self.s + 1.0) * self.bulk * gap * gap * gap;
        let compressed = slope * (one - release) - hugoniot * product * (0.5 / self.rho_0);
        // Beyond the cap the cold pressure is linear in the density, with the slope that it has there.
        let last = self.rho_0 / (1.0 - self.eta_cap);
        let beyond = (rho - last).max(zero);
        let cap_slope = self.rho_0 / (last * last);
        let d_eta = inverse * inverse * self.rho_0;
        let d_eta = F::select(beyond.gt(zero), F::splat(cap_slope), d_eta);
        let cold = hugoniot * (one - release) + compressed * cap_slope * beyond;
        let expanded = mu.lt(zero);
        let cold =
            if expanded == 0 { cold } else { F::select(expanded, mu * self.bulk * loose(), cold) };
        let d_cold = F::select(expanded, F::splat(self.bulk / self.rho_0), compressed * d_eta);
        let d_cold = d_cold + (u - hugoniot * capped * (0.5 / self.rho_0)) * self.steepness;
        let pressure = (cold + product * u).max(zero);
        let sound = d_cold + pressure * product * inverse * inverse;
        let least = LEAST_SOUND * self.bulk / self.rho_0;
        // In powers of the square: half as long a chain of operations.
        let (square, mut isentrope) = (capped * capped, zero);
        for &[odd, even] in self.isentrope.as_chunks().0.iter().rev() {
            isentrope = isentrope * square + (capped * even + odd);
        }
        let theta = (u * (1.0 / self.c_v) + isentrope * capped).max(zero) + self.theta_0;
        Response { pressure, sound_squared: sound.max(F::splat(least)), theta }
    }
}

/// Series of [`MieGruneisen::isentrope`].
///
/// With `g = Gamma rho / rho_o = gamma_0 + b (eta + eta^2 + ...)` the isentrope obeys
/// `u' = P/rho_o = c0^2 p (1 - g eta/2) + g u` and `theta' = g theta`, where `p = eta / (1 - s eta)^2`.
/// For a constant `c_v`, `theta - theta_s = (u - u_s) / c_v` at any density.
fn isentrope([c0, s]: [f64; 2], [gamma_0, b]: [f64; 2], [c_v, theta_0]: [f64; 2]) -> [f64; TERMS] {
    let g = |k: usize| if k == 0 { gamma_0 } else { b };
    let hugoniot = |k: usize| if k == 0 { 0.0 } else { k as f64 * s.powi(k as i32 - 1) };
    let (mut u, mut theta) = ([0.0; TERMS + 1], [0.0; TERMS + 1]);
    theta[0] = theta_0;
    for n in 1..=TERMS {
        // Coefficients of the order n - 1 on the right-hand sides.
        let sum = |f: &dyn Fn(usize) -> f64, to: usize| (0..to).map(f).sum::<f64>();
        let release = sum(&|k| g(k) * hugoniot(n - 2 - k), n - 1);
        let work = c0 * c0 * (hugoniot(n - 1) - 0.5 * release);
        u[n] = (work + sum(&|k| g(k) * u[n - 1 - k], n)) / n as f64;
        theta[n] = sum(&|k| g(k) * theta[n - 1 - k], n) / n as f64;
    }
    std::array::from_fn(|k| theta[k + 1] - u[k + 1] / c_v)
}

impl IdealGas {
    #[inline(always)]
    fn respond<F: Lanes>(&self, rho: F, u: F) -> Response<F> {
        let u = u.max(F::zero());
        Response {
            pressure: rho * u * (self.index - 1.0),
            sound_squared: u * (self.index * (self.index - 1.0)),
            theta: u * (1.0 / self.c_v),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::lanes::F8;
    use crate::space::scene::Failure;

    fn copper(law: GammaLaw) -> Eos {
        metal(1.489, law)
    }

    fn metal(s: f64, law: GammaLaw) -> Eos {
        Eos::new(&Material {
            name: "copper".into(),
            density: 8.93,
            eos: EosData::MieGruneisen {
                c0: 0.394,
                s,
                gamma_0: 2.02,
                law,
                c_v: 0.383e-5,
                theta_0: 300.0,
            },
            strength: None,
            failure: Failure::default(),
        })
    }

    fn at(eos: &Eos, rho: f64, u: f64) -> (f64, f64) {
        let loose = || F8::splat(1.0);
        let r = eos.respond((F8::splat(rho), F8::splat(1.0 / rho)), F8::splat(u), loose);
        (r.pressure.0[0], r.sound_squared.0[0])
    }

    #[test]
    fn the_hugoniot_lies_on_the_surface() {
        for law in [GammaLaw::ConstantProduct, GammaLaw::Steinberg(0.47)] {
            let eos = copper(law);
            for up in [0.01, 0.05, 0.1, 0.2, 0.35] {
                let us = 0.394 + 1.489 * up;
                let (pressure, rho) = (8.93 * us * up, 8.93 * us / (us - up));
                let (found, _) = at(&eos, rho, 0.5 * up * up);
                assert!((found / pressure - 1.0).abs() < 1e-12, "{up}: {found} {pressure}");
            }
        }
    }

    #[test]
    fn the_sound_speed_is_the_isentropic_slope() {
        for law in [GammaLaw::ConstantProduct, GammaLaw::Steinberg(0.47)] {
            let eos = copper(law);
            for (rho, u) in [(9.5, 1e-3), (11.0, 5e-3), (14.0, 0.05), (8.5, 2e-2)] {
                let (p, c2) = at(&eos, rho, u);
                let h = 1e-5 * rho;
                let along = |rho_1: f64| {
                    // One Heun step along du = P / rho^2 drho.
                    let du = p / (rho * rho) * (rho_1 - rho);
                    let (p1, _) = at(&eos, rho_1, u + du);
                    at(
                        &eos,
                        rho_1,
                        u + 0.5 * (p / rho.powi(2) + p1 / rho_1.powi(2)) * (rho_1 - rho),
                    )
                    .0
                };
                let slope = (along(rho + h) - along(rho - h)) / (2.0 * h);
                assert!((slope / c2 - 1.0).abs() < 1e-6, "{rho} {u}: {slope} {c2}");
            }
        }
    }

    #[test]
    fn the_reference_state_is_exactly_free_of_pressure() {
        let eos = copper(GammaLaw::ConstantProduct);
        assert_eq!(at(&eos, 8.93, 0.0).0, 0.0);
    }

    #[test]
    fn a_flat_hugoniot_has_a_sane_pressure() {
        let eos = metal(0.25, GammaLaw::ConstantProduct);
        for compression in [1.1_f64, 2.0, 5.0, 9.0] {
            let eta = 1.0 - 1.0 / compression;
            let shocked = 8.93 * 0.394 * 0.394 * eta / (1.0 - 0.25 * eta).powi(2);
            let found = at(&eos, 8.93 * compression, 0.5 * shocked * eta / 8.93).0;
            assert!((found / shocked - 1.0).abs() < 1e-12, "{compression}: {found} {shocked}");
        }
    }

    #[test]
    fn pressure_is_continuous_at_the_cap_and_rises_beyond() {
        let eos = copper(GammaLaw::ConstantProduct);
        let last = 8.93 / (1.0 - 0.85 / 1.489);
        let [(a, _), (b, _), (c, _)] =
            [last * (1.0 - 1e-9), last * (1.0 + 1e-9), 1.1 * last].map(|rho| at(&eos, rho, 0.0));
        assert!((a / b - 1.0).abs() < 1e-6 && c > b);
    }
}
