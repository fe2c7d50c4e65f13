//! Order, limit and grid convergence index of values whose errors are not known.

use serde::{Deserialize, Serialize};

use super::{ConvergenceError, Level, check_levels, positive};

/// Safety factor of the grid convergence index: three or more levels, observed order near formal.
pub const SAFETY_THREE_LEVELS: f64 = 1.25;
/// Safety factor of the grid convergence index in every other case.
pub const SAFETY_OTHERWISE: f64 = 3.0;
/// The quoted band never uses a lower order than this.
pub const LOWEST_ORDER: f64 = 0.5;
/// Largest distance between the observed and the formal order that counts as near; below the formal
/// order also no more than half of it.
pub const ORDER_TOLERANCE: f64 = 0.5;

/// How the values of the three finest levels move under refinement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Behaviour {
    /// Changes of one sign that shrink: `p > 0` exists.
    Monotone,
    /// Changes of alternating sign that shrink: no order, the range is reported.
    Oscillatory,
    /// Changes that do not shrink.
    Diverging,
    /// The two finest values are equal: no order can be seen.
    Flat,
    /// Two levels only: nothing can be said.
    Unknown,
}

/// The observed order beside the formal one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OrderCheck {
    /// Within [`ORDER_TOLERANCE`] of the formal order.
    NearFormal,
    /// Higher than that: not in the asymptotic range.
    NotAsymptotic,
    /// Lower than that, or not above zero.
    BelowFormal,
    /// No order was observed.
    Unobserved,
}

/// Extrapolation and error bands at one order.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The order `p` used.
    pub order: f64,
    /// The safety factor `Fs` used.
    pub safety_factor: f64,
    /// Richardson's limit `(r21^p f1 - f2) / (r21^p - 1)`, unit of the quantity.
    pub extrapolated: f64,
    /// Band about the finest value, `Fs |f2 - f1| / (r21^p - 1)`, unit of the quantity.
    pub band: f64,
    /// Grid convergence index of the finest pair, `band / |f1|`; `None` where `f1 = 0`.
    pub gci12: Option<f64>,
    /// The same of the next pair; `None` with two levels or where `f2 = 0`.
    pub gci23: Option<f64>,
    /// `r21^p GCI12 / GCI23`, near 1 in the asymptotic range; the form that NASA's `verify` prints,
    /// the inverse of `GCI23 / (r21^p GCI12)`. At the *observed* order it is `|f2 / f1|` by
    /// construction and shows nothing; at a *fixed* order it is a real check.
    pub asymptotic_ratio: Option<f64>,
}

impl Estimate {
    /// Evaluates the formulas for two or three `levels`, finest first.
    fn new(levels: &[Level], order: f64, safety_factor: f64) -> Self {
        // Richardson's estimate of the error of the finer of two levels.
        let error = |pair: &[Level]| {
            let growth = (order * log_ratio(pair)).exp_m1();
            (pair[0].value - pair[1].value) / growth
        };
        let gci = |pair: &[Level]| {
            let index = safety_factor * (error(pair) / pair[0].value).abs();
            (pair[0].value != 0.0).then_some(index)
        };
        let gci12 = gci(levels);
        let gci23 = levels.get(1..3).and_then(gci);
        let growth = (order * log_ratio(levels)).exp();
        Self {
            order,
            safety_factor,
            extrapolated: levels[0].value + error(levels),
            band: safety_factor * error(levels).abs(),
            gci12,
            gci23,
            asymptotic_ratio: gci12
                .zip(gci23)
                .filter(|&(_, coarse)| coarse > 0.0)
                .map(|(fine, coarse)| growth * fine / coarse),
        }
    }
}

/// Solution verification of one quantity, made by [`grid_study`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GridStudy {
    /// The levels used: the finest two or three, finest first.
    pub levels: Vec<Level>,
    /// Order the method should have.
    pub formal_order: f64,
    /// How the values move.
    pub behaviour: Behaviour,
    /// Order seen in three levels whose changes have one sign; not above zero when diverging.
    pub observed_order: Option<f64>,
    /// The observed order beside the formal one.
    pub order_check: OrderCheck,
    /// Estimate at the observed order with safety factor 1.25, as usually printed; monotone only.
    pub observed: Option<Estimate>,
    /// Estimate to be quoted: order limited to `[0.5, formal]`
    /// (to `formal` where that is below 0.5), safety factor 1.25 only for an order
    /// near the formal one, otherwise 3. With two levels the formal order, when diverging 0.5.
    /// `None` for oscillatory and flat values: quote the range.
    pub quoted: Option<Estimate>,
    /// Least and largest value of the levels used.
    pub range: (f64, f64),
}

impl GridStudy {
    /// The band to quote, unit of the quantity: that of [`GridStudy::quoted`], else the width of
    /// the range. Read as a 95 % band, the standard uncertainty `u_num` is half of it.
    #[must_use]
    pub fn band(&self) -> f64 {
        self.quoted.map_or(self.range.1 - self.range.0, |estimate| estimate.band)
    }

    /// Whether the finest three levels look asymptotic: monotone with an order near the formal one.
    #[must_use]
    pub fn is_asymptotic(&self) -> bool {
        self.order_check == OrderCheck::NearFormal
    }
}

/// Order, limit and band of a quantity from its values at two or more levels (in any order); the
/// finest three count. `formal_order` is what the method should show for this quantity.
///
/// # Errors
/// [`ConvergenceError`] for fewer than two levels, a spacing or formal order that is not a finite
/// number above zero, a value that is not finite, or levels of equal spacing.
pub fn grid_study(levels: &[Level], formal_order: f64) -> Result<GridStudy, ConvergenceError> {
    positive(|| "the formal order".into(), formal_order)?;
    let levels = finest(levels)?;
    let (behaviour, observed_order) = classify(&levels);
    let order_check = match observed_order {
        None => OrderCheck::Unobserved,
        Some(p) if p > formal_order + ORDER_TOLERANCE => OrderCheck::NotAsymptotic,
        Some(p) if p >= formal_order - ORDER_TOLERANCE.min(0.5 * formal_order) => {
            OrderCheck::NearFormal
        }
        Some(_) => OrderCheck::BelowFormal,
    };
    let limited = |p: f64| p.max(LOWEST_ORDER).min(formal_order);
    let estimate = |order, safety_factor| Some(Estimate::new(&levels, order, safety_factor));
    let monotone_order = observed_order.filter(|_| behaviour == Behaviour::Monotone);
    let quoted = match behaviour {
        Behaviour::Oscillatory | Behaviour::Flat => None,
        Behaviour::Unknown => estimate(formal_order, SAFETY_OTHERWISE),
        Behaviour::Monotone | Behaviour::Diverging => {
            let near = order_check == OrderCheck::NearFormal;
            let safety = if near { SAFETY_THREE_LEVELS } else { SAFETY_OTHERWISE };
            estimate(limited(monotone_order.unwrap_or(LOWEST_ORDER)), safety)
        }
    };
    let fold = |pick: fn(f64, f64) -> f64| levels.iter().map(|l| l.value).reduce(pick);
    Ok(GridStudy {
        formal_order,
        behaviour,
        observed_order,
        order_check,
        observed: monotone_order.and_then(|p| estimate(p, SAFETY_THREE_LEVELS)),
        quoted,
        range: fold(f64::min).zip(fold(f64::max)).unwrap_or_default(),
        levels,
    })
}

/// The finest three (or two) levels, finest first, checked.
fn finest(levels: &[Level]) -> Result<Vec<Level>, ConvergenceError> {
    check_levels(levels, 2)?;
    let mut sorted = levels.to_vec();
    sorted.sort_by(|a, b| a.spacing.total_cmp(&b.spacing));
    sorted.truncate(3);
    for pair in sorted.windows(2) {
        if log_ratio(pair) <= 0.0 {
            return Err(ConvergenceError::EqualSpacing { spacing: pair[0].spacing });
        }
        if !(pair[1].value - pair[0].value).is_finite() {
            let Level { spacing, value } = pair[if pair[0].value.is_finite() { 1 } else { 0 }];
            return Err(ConvergenceError::NonFinite { spacing, value });
        }
    }
    Ok(sorted)
}

/// Behaviour of two or three levels, finest first, and the order if the changes have one sign.
fn classify(levels: &[Level]) -> (Behaviour, Option<f64>) {
    let &[fine, medium, coarse] = levels else {
        return (Behaviour::Unknown, None);
    };
    let (eps21, eps32) = (medium.value - fine.value, coarse.value - medium.value);
    if eps21 == 0.0 {
        (Behaviour::Flat, None)
    } else if eps32 == 0.0 {
        (Behaviour::Diverging, None)
    } else if (eps21 > 0.0) == (eps32 > 0.0) {
        let growth = eps32.abs().ln() - eps21.abs().ln();
        let order = solve_order(growth, log_ratio(levels), log_ratio(&levels[1..]));
        // A smaller order is rounding about zero.
        let shrinks = order > f64::EPSILON.sqrt();
        (if shrinks { Behaviour::Monotone } else { Behaviour::Diverging }, Some(order))
    } else if eps21.abs() < eps32.abs() {
        (Behaviour::Oscillatory, None)
    } else {
        (Behaviour::Diverging, None)
    }
}

/// The order `p` with `p ln r21 = ln(eps32 / eps21) + q(p)`, `q = ln[(r21^p - 1) / (r32^p - 1)]`;
/// `growth = ln(eps32 / eps21)`, `fine = ln r21`, `coarse = ln r32`, both above zero.
///
/// The left minus the right side rises with `p` from minus to plus infinity, so one root exists and
/// bisection finds it; the usual fixed-point iteration diverges where `r32` is far above `r21`.
fn solve_order(growth: f64, fine: f64, coarse: f64) -> f64 {
    // ln |e^x - 1| without overflow or cancellation.
    let ln_abs_exp_m1 = |x: f64| x.max(0.0) + (-(-x.abs()).exp_m1()).ln();
    let surplus = |p: f64| {
        let q = if p == 0.0 {
            (fine / coarse).ln()
        } else {
            ln_abs_exp_m1(p * fine) - ln_abs_exp_m1(p * coarse)
        };
        p * fine - q - growth
    };
    let mut reach = 1.0;
    while surplus(reach) < 0.0 || surplus(-reach) > 0.0 {
        reach *= 2.0;
    }
    let (mut low, mut high) = (-reach, reach);
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            return middle;
        }
        if surplus(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// `ln(h2 / h1)` of the first two levels, finest first.
fn log_ratio(levels: &[Level]) -> f64 {
    (levels[1].spacing / levels[0].spacing).ln()
}
