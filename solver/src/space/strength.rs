//! Resistance to shear: plastic flow, Eqs. (38)-(46), and what makes elements fail, Eq. (47).

use super::lanes::{F8, LANES, Lanes, Mask, each};
use super::method::{Expansion, Method, Release, YieldNorm};
use super::scene::{Flow, Material};

/// A symmetric tensor: 11, 22, 33, 12, 13, 23.
pub type Sym<F> = [F; 6];

/// Smallest pyramid of an element of a solid, over its reference volume.
const CRUSHED: f64 = 0.2;

/// Smallest thickness of a sound and of a failed element of a solid, over its shortest edge.
const FLAT: [f64; 2] = [0.2, 0.35];

/// Largest stretch of an element of a solid that counts as a volume.
const TORN: f64 = 4.0;

/// Smallest volume of an element of a gas, which has no largest compression, and its thickness: what
/// is thinner would set the time step.
const GAS: [f64; 2] = [1e-3, 0.005];

/// Sweeps of the return map after which it gives up; two are enough nearly always.
const SWEEPS: usize = 20;

/// Distance from the yield surface over the yield stress at which the return map stops.
const LANDED: f64 = 1e-10;

/// Plastic strain below which the slope of the hardening is not evaluated: a power of zero has none.
const LEAST_STRAIN: f64 = 1e-5;

/// Strength and failure of the elements of a body.
#[derive(Debug, Clone, Copy)]
pub struct Solid {
    /// Shear modulus `mu`; zero for a fluid.
    pub mu: f64,
    /// Bulk modulus `K` in tension.
    pub bulk: f64,
    /// Yield stress; none if elastic.
    flow: Option<Flow>,
    norm: YieldNorm,
    /// Failure strain `eps_f`, infinite if there is none.
    strain: f64,
    /// Melt temperature `theta_m`.
    pub melt: f64,
    /// Smallest Jacobian `J_c`.
    pub compression: f64,
    /// Tensile strength.
    pub spall: f64,
    /// Pressure of warm material at rest density per temperature, as far as it makes up for tension, and the temperature
    /// without any.
    thermal: [f64; 2],
    release: Release,
    /// Smallest pyramid, over its reference volume, of an element that counts as a volume.
    pub crushed: f64,
    /// Smallest volume of such an element, over its reference volume.
    pub least: f64,
    /// Largest stretch of such an element.
    pub torn: f64,
    /// Thickness, over the shortest edge at the start, below which a sound and a failed element cease
    /// to count as volumes.
    pub flat: [f64; 2],
    /// Longitudinal sound speed of the reference state.
    pub sound: f64,
    /// Shortest edge of a cell.
    pub edge: f64,
}

impl Solid {
    /// The strength of a material in cells of this shortest edge.
    #[must_use]
    pub fn new(material: &Material, method: &Method, edge: f64) -> Self {
        let or_never = |value: Option<f64>| value.unwrap_or(f64::INFINITY);
        let mu = material.strength.map_or(0.0, |s| s.shear_modulus);
        let eos = super::eos::Eos::new(material);
        let bulk = eos.bulk();
        let thermal = if method.expansion == Expansion::Thermal { eos.thermal() } else { 0.0 };
        Self {
            mu,
            bulk,
            flow: material.strength.and_then(|s| s.flow),
            norm: method.yield_norm,
            strain: or_never(material.failure.plastic_strain),
            melt: or_never(material.failure.melt),
            compression: material.failure.compression,
            spall: or_never(material.failure.spall.filter(|_| method.spall)),
            thermal: [thermal, eos.theta_0()],
            release: method.release,
            crushed: if bulk > 0.0 { CRUSHED } else { f64::NEG_INFINITY },
            least: if bulk > 0.0 { CRUSHED } else { GAS[0] },
            torn: if bulk > 0.0 { TORN } else { f64::INFINITY },
            flat: if bulk > 0.0 { FLAT } else { [GAS[1]; 2] },
            sound: ((bulk + 4.0 / 3.0 * mu) / material.density).sqrt(),
            edge,
        }
    }

    /// Yield stress of virgin material, softening apart; infinite if it never yields.
    #[must_use]
    pub fn first_flow(&self) -> f64 {
        match self.flow {
            Some(Flow::Hardening { y_0, .. }) => y_0,
            Some(Flow::JohnsonCook { a, .. }) => a,
            None => f64::INFINITY,
        }
    }

    /// Whether it ever yields.
    #[must_use]
    pub fn yields(&self) -> bool {
        self.flow.is_some()
    }

    /// Increase of the damage over a step of length `dt`, Eq. (47).
    #[must_use]
    pub fn damage_step(&self, dt: f64) -> f64 {
        match self.release {
            Release::Steps(n) => 1.0 / n,
            Release::Crossings(n) => dt * self.sound / (n * self.edge),
        }
    }

    /// Pressure that heat alone gives material at rest density.
    #[inline(always)]
    pub fn thermal<F: Lanes>(&self, theta: F) -> F {
        let [slope, cold] = self.thermal;
        (theta - cold).max(F::zero()) * slope
    }

    /// Factor of the yield stress at a temperature.
    #[inline(always)]
    fn softening<F: Lanes>(&self, theta: F) -> F {
        let one = F::splat(1.0);
        match self.flow {
            Some(Flow::Hardening { eta, reference, melt, .. }) => {
                (one - homologous(theta, reference, melt) * eta).max(F::zero())
            }
            Some(Flow::JohnsonCook { m, reference, melt, .. }) => {
                let h = homologous(theta, reference, melt);
                one - if m == 1.0 { h } else { F::of(h.pack().map(|h| h.powf(m))) }
            }
            None => one,
        }
    }

    /// Yield stress without softening and its slope over the plastic strain.
    fn harden(&self, strain: f64, rate: f64) -> (f64, f64) {
        match self.flow {
            Some(Flow::Hardening { y_0, kappa, alpha, .. }) => {
                let base = 1.0 + kappa * strain;
                let y = y_0 * base.powf(alpha);
                (y, y * alpha * kappa / base)
            }
            Some(Flow::JohnsonCook { a, b, n, c, rate_0, .. }) => {
                let factor = 1.0 + c * (rate / rate_0).max(1.0).ln();
                let slope = b * n * strain.max(LEAST_STRAIN).powf(n - 1.0);
                ((a + b * strain.max(0.0).powf(n)) * factor, slope * factor)
            }
            None => (f64::INFINITY, 0.0),
        }
    }

    /// Squared factor between the norm of the effective stress and the yield stress.
    #[inline(always)]
    fn reading<F: Lanes>(&self, c_plastic: &Sym<F>) -> F {
        match self.norm {
            YieldNorm::Mises => F::splat(1.0),
            YieldNorm::J2 => half_square(c_plastic) * (2.0 / 3.0),
            YieldNorm::AsPrinted => half_square(c_plastic),
        }
    }

    /// Yield stress in the norm (40) over `Y`.
    fn level(&self) -> f64 {
        match self.norm {
            YieldNorm::Mises => 1.0 / 3f64.sqrt(),
            YieldNorm::J2 | YieldNorm::AsPrinted => 1.0,
        }
    }

    /// Flow of up to eight elements, Eqs. (38)-(46): the constraint (48) as a step that brings the
    /// effective stress back to the yield surface.
    ///
    /// The elastic strain is `total - plastic`; `modulus` is `2 (1 - d) mu` and `theta` the elements'
    /// temperature. Only lanes of `live` flow. Returns the stress.
    #[inline(always)]
    pub fn flow<F: Lanes>(
        &self,
        total: &Sym<F>,
        plastic: &mut Sym<F>,
        own: &mut Flowing<'_>,
        load: &Load<F>,
    ) -> Sym<F> {
        let stress = stress_of(total, plastic, load.modulus);
        let soft = self.softening(load.theta) * load.intact * self.level();
        let c_plastic = c_of(plastic);
        let driver = effective(&c_plastic, &stress);
        let limit = F::of(*own.flow) * soft;
        let over = half_square(&driver).gt(limit * limit * self.reading(&c_plastic));
        let yielding = over & load.live;
        if yielding == 0 {
            return stress;
        }
        self.land(total, plastic, own, (load, soft, yielding));
        stress_of(total, plastic, load.modulus)
    }

    /// Newton sweeps of the yielding lanes.
    #[inline(always)]
    fn land<F: Lanes>(
        &self,
        total: &Sym<F>,
        plastic: &mut Sym<F>,
        own: &mut Flowing<'_>,
        (load, soft, yielding): (&Load<F>, F, Mask),
    ) {
        let (before, rate) = (F::of(*own.strain), F::of(*own.rate));
        let tiny = F::splat(1e-300);
        for _ in 0..SWEEPS {
            let stress = stress_of(total, plastic, load.modulus);
            let c_plastic = c_of(plastic);
            let scale = F::splat(1.0) / self.reading(&c_plastic).sqrt();
            let driver = scaled(&effective(&c_plastic, &stress), scale);
            let size = half_square(&driver).sqrt().max(tiny);
            let slope = F::of(self.update(own, (&rate.pack(), yielding))) * soft;
            let limit = F::of(*own.flow) * soft;
            let gap = size - limit;
            let near = limit * LANDED + load.modulus * 1e-13;
            if gap.abs().gt(near) & yielding == 0 {
                break;
            }
            let flow = scaled(&symmetric_product(&c_plastic, &driver), scale);
            let normal = half_square(&flow) / (size * size);
            let measure = self.measure(&flow, size);
            let step = gap / (load.modulus * normal + slope * measure).max(tiny);
            let step = step.keep(yielding);
            let flowed = isochoric(&each!(k in 6 => plastic[k] + step / size * flow[k]));
            for (strain, flowed) in plastic.iter_mut().zip(flowed) {
                *strain = F::select(yielding, flowed, *strain);
            }
            *own.strain = (F::of(*own.strain) + step * measure).max(before).pack();
        }
        let flowed = (F::of(*own.strain) - before) * (1.0 / load.dt.max(1e-300));
        *own.rate = F::select(yielding, (rate + flowed) * 0.5, rate).pack();
    }

    /// Effective plastic strain per increment of `lambda`: the equivalent strain for the von Mises
    /// reading, the norm (45) otherwise.
    #[inline(always)]
    fn measure<F: Lanes>(&self, flow: &Sym<F>, size: F) -> F {
        match self.norm {
            YieldNorm::Mises => F::splat(2.0 / 3f64.sqrt()),
            YieldNorm::J2 | YieldNorm::AsPrinted => half_square(flow).sqrt() / size,
        }
    }

    /// Sets the yield stress of the yielding lanes; its slope.
    #[inline(never)]
    fn update(&self, own: &mut Flowing<'_>, (rate, yielding): (&F8, Mask)) -> F8 {
        let mut slope = F8::ZERO;
        for k in (0..LANES).filter(|k| yielding >> k & 1 == 1) {
            (own.flow.0[k], slope.0[k]) = self.harden(own.strain.0[k], rate.0[k]);
        }
        slope
    }

    /// Lanes that meet a failure criterion of strain or temperature.
    #[inline(always)]
    #[must_use]
    pub fn spent<F: Lanes>(&self, strain: F, theta: F) -> Mask {
        strain.gt(F::splat(self.strain)) | theta.gt(F::splat(self.melt))
    }
}

/// Hardening of up to eight elements.
#[derive(Debug)]
pub struct Flowing<'a> {
    /// Effective plastic strain.
    pub strain: &'a mut F8,
    /// Yield stress, softening apart.
    pub flow: &'a mut F8,
    /// Plastic strain rate.
    pub rate: &'a mut F8,
}

/// What the flow sees of its surroundings.
#[derive(Debug, Clone, Copy)]
pub struct Load<F> {
    /// `2 (1 - d) mu`.
    pub modulus: F,
    /// `1 - d`.
    pub intact: F,
    /// Temperature.
    pub theta: F,
    /// Lanes that may flow.
    pub live: Mask,
    /// Length of the last step.
    pub dt: f64,
}

#[inline(always)]
fn scaled<F: Lanes>(t: &Sym<F>, factor: F) -> Sym<F> {
    each!(k in 6 => factor * t[k])
}

/// `S` of Eq. (30), of the elastic strain (16).
#[inline(always)]
fn stress_of<F: Lanes>(total: &Sym<F>, plastic: &Sym<F>, modulus: F) -> Sym<F> {
    each!(k in 6 => modulus * (total[k] - plastic[k]))
}

/// Temperature from the reference to the melt temperature, 0 to 1.
#[inline(always)]
fn homologous<F: Lanes>(theta: F, reference: f64, melt: f64) -> F {
    let h = (theta - reference) * (1.0 / (melt - reference));
    h.max(F::zero()).min(F::splat(1.0))
}

/// `C^p = I + 2 E^p`, Eq. (17).
#[inline(always)]
fn c_of<F: Lanes>(plastic: &Sym<F>) -> Sym<F> {
    each!(k in 6 => plastic[k] * 2.0 + if k < 3 { 1.0 } else { 0.0 })
}

/// The plastic strain with the determinant of `C^p` brought back to one, Eq. (17): the flow rule keeps it
/// but for the square of a finite step. The inverse cube root is its series about one: every sweep begins
/// near it, and the last at it.
#[inline(always)]
fn isochoric<F: Lanes>(plastic: &Sym<F>) -> Sym<F> {
    let c = c_of(plastic);
    let lost = F::splat(1.0) - determinant(&c);
    let scale = ((lost * (14.0 / 81.0) + 2.0 / 9.0) * lost + 1.0 / 3.0) * lost + 1.0;
    each!(k in 6 => (c[k] * scale - if k < 3 { 1.0 } else { 0.0 }) * 0.5)
}

#[inline(always)]
fn determinant<F: Lanes>(t: &Sym<F>) -> F {
    t[0] * (t[1] * t[2] - t[5] * t[5]) - t[3] * (t[3] * t[2] - t[5] * t[4])
        + t[4] * (t[3] * t[5] - t[1] * t[4])
}

/// `T : T / 2`, the square of the norm (40).
#[inline(always)]
#[must_use]
pub fn half_square<F: Lanes>(t: &Sym<F>) -> F {
    let diagonal = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
    diagonal * 0.5 + (t[3] * t[3] + t[4] * t[4] + t[5] * t[5])
}

/// `A : B` of symmetric tensors.
#[inline(always)]
#[must_use]
pub fn contract<F: Lanes>(a: &Sym<F>, b: &Sym<F>) -> F {
    (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]) * 2.0
}

/// `(A B + B A) / 2`.
#[inline(always)]
fn symmetric_product<F: Lanes>(a: &Sym<F>, b: &Sym<F>) -> Sym<F> {
    [
        a[0] * b[0] + a[3] * b[3] + a[4] * b[4],
        a[3] * b[3] + a[1] * b[1] + a[5] * b[5],
        a[4] * b[4] + a[5] * b[5] + a[2] * b[2],
        ((a[0] + a[1]) * b[3] + a[3] * (b[0] + b[1]) + a[4] * b[5] + a[5] * b[4]) * 0.5,
        ((a[0] + a[2]) * b[4] + a[4] * (b[0] + b[2]) + a[3] * b[5] + a[5] * b[3]) * 0.5,
        ((a[1] + a[2]) * b[5] + a[5] * (b[1] + b[2]) + a[3] * b[4] + a[4] * b[3]) * 0.5,
    ]
}

/// Deviator of the symmetric product: the effective stress (39) without its norm.
#[inline(always)]
fn effective<F: Lanes>(c_plastic: &Sym<F>, stress: &Sym<F>) -> Sym<F> {
    let mut t = symmetric_product(c_plastic, stress);
    let mean = (t[0] + t[1] + t[2]) * (1.0 / 3.0);
    for diagonal in &mut t[..3] {
        *diagonal -= mean;
    }
    t
}
