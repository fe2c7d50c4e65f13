//! Observed order of convergence, Richardson extrapolation and the grid convergence index.
//!
//! Two questions, two entries. With an exact solution the *errors* are known: [`pairwise_orders`]
//! and [`fitted_order`]. Without one, only the *values* are: [`grid_study`] estimates the order,
//! the limit and a band (Roache; rules and worked numbers in the dossier, section 5.1).

use serde::{Deserialize, Serialize};

/// Safety factor of the grid convergence index: three or more levels, observed order near formal.
pub const SAFETY_THREE_LEVELS: f64 = 1.25;
/// Safety factor of the grid convergence index in every other case.
pub const SAFETY_OTHERWISE: f64 = 3.0;
/// The quoted band never uses a lower order than this.
pub const LOWEST_ORDER: f64 = 0.5;
/// Largest distance between the observed and the formal order that counts as near; below the formal
/// order also no more than half of it.
pub const ORDER_TOLERANCE: f64 = 0.5;

/// One resolution: particle spacing and what was computed with it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// Particle spacing `h`, above zero, any unit (only ratios count).
    pub spacing: f64,
    /// An error norm (above zero) or a computed quantity, any unit.
    pub value: f64,
}

impl Level {
    /// A level of `particles` in `dimension` dimensions, with `h = N^(-1/d)`. Fair only where cells
    /// were refined by integers, so that particle number and cell number go together.
    #[must_use]
    pub fn from_count(particles: u32, dimension: u8, value: f64) -> Self {
        Self { spacing: f64::from(particles).powf(-1.0 / f64::from(dimension)), value }
    }
}

/// Why no order can be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConvergenceError {
    /// Fewer levels than the method needs.
    #[error("{found} levels given, at least {wanted} needed")]
    TooFewLevels {
        /// Levels given.
        found: usize,
        /// Least number.
        wanted: usize,
    },
    /// A spacing, an error or the formal order is not a finite number above zero.
    #[error("{what} is {value}, not a finite number above zero")]
    NotPositive {
        /// What is at fault, with its level.
        what: String,
        /// The value found.
        value: f64,
    },
    /// A computed quantity (or a difference of two) is infinite or not a number.
    #[error("the value at spacing {spacing} is {value}, or too large to subtract")]
    NonFinite {
        /// Spacing of the level.
        spacing: f64,
        /// The value found.
        value: f64,
    },
    /// Two levels that are compared have the same spacing.
    #[error("two levels have the spacing {spacing}: no refinement between them")]
    EqualSpacing {
        /// The spacing found twice.
        spacing: f64,
    },
}

/// Orders between successive levels of error norms, `p_k = ln(e_k / e_{k+1}) / ln(h_k / h_{k+1})`,
/// one fewer than levels, in the order given.
///
/// # Errors
/// [`ConvergenceError`] for fewer than two levels, a spacing or error that is not a finite number
/// above zero, or neighbours of equal spacing.
pub fn pairwise_orders(errors: &[Level]) -> Result<Vec<f64>, ConvergenceError> {
    let logs = log_log(errors, 2)?;
    let order = |(pair, levels): (&[(f64, f64)], &[Level])| {
        let run = pair[0].0 - pair[1].0;
        let equal = ConvergenceError::EqualSpacing { spacing: levels[0].spacing };
        if run == 0.0 { Err(equal) } else { Ok((pair[0].1 - pair[1].1) / run) }
    };
    logs.windows(2).zip(errors.windows(2)).map(order).collect()
}

/// The law `e = C h^p` fitted to error norms by [`fitted_order`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OrderFit {
    /// Fitted order `p`.
    pub order: f64,
    /// Fitted coefficient `C`: the error at spacing 1.
    pub coefficient: f64,
    /// Standard error of the order.
    pub standard_error: f64,
    /// 95 % interval of the order, Student's t with `levels - 2` degrees of freedom. It speaks of
    /// the scatter about a straight line, not of terms of higher order.
    pub interval: (f64, f64),
    /// Number of levels.
    pub levels: usize,
}

impl OrderFit {
    /// Whether `order` lies in the 95 % interval.
    #[must_use]
    pub fn contains(&self, order: f64) -> bool {
        self.interval.0 <= order && order <= self.interval.1
    }
}

/// Least-squares line through `(ln h, ln e)` of three or more levels of error norms.
///
/// # Errors
/// [`ConvergenceError`] for fewer than three levels, a spacing or error that is not a finite number
/// above zero, or if all spacings are equal.
pub fn fitted_order(errors: &[Level]) -> Result<OrderFit, ConvergenceError> {
    let logs = log_log(errors, 3)?;
    let count = logs.len() as f64;
    let sum = |f: &dyn Fn(&(f64, f64)) -> f64| logs.iter().map(f).sum::<f64>();
    let (x_mean, y_mean) = (sum(&|p| p.0) / count, sum(&|p| p.1) / count);
    let spread = sum(&|p| (p.0 - x_mean).powi(2));
    if logs.iter().all(|p| p.0 == logs[0].0) || spread == 0.0 {
        return Err(ConvergenceError::EqualSpacing { spacing: errors[0].spacing });
    }
    let order = sum(&|p| (p.0 - x_mean) * (p.1 - y_mean)) / spread;
    let scatter = sum(&|p| (p.1 - y_mean - order * (p.0 - x_mean)).powi(2));
    let standard_error = (scatter / (count - 2.0) / spread).sqrt();
    let half_width = student_t95(logs.len() - 2) * standard_error;
    Ok(OrderFit {
        order,
        coefficient: (y_mean - order * x_mean).exp(),
        standard_error,
        interval: (order - half_width, order + half_width),
        levels: logs.len(),
    })
}

/// Two-sided 95 % quantile of Student's t for one or more degrees of `freedom`: a table up to ten,
/// then the expansion about the normal quantile (Abramowitz and Stegun 26.7.5, error below 1e-5).
#[must_use]
pub fn student_t95(freedom: usize) -> f64 {
    const TABLE: [f64; 10] = [
        12.706_205, 4.302_653, 3.182_446, 2.776_445, 2.570_582, 2.446_912, 2.364_624, 2.306_004,
        2.262_157, 2.228_139,
    ];
    const EXPANSION: [f64; 5] = [1.959_963_985, 2.372_272, 2.822_498, 2.555_850, 1.589_536];
    match TABLE.get(freedom.saturating_sub(1)) {
        Some(&quantile) => quantile,
        None => EXPANSION.iter().rev().fold(0.0, |sum, term| sum / freedom as f64 + term),
    }
}

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

/// `(ln h, ln e)` of `wanted` or more levels of error norms.
fn log_log(errors: &[Level], wanted: usize) -> Result<Vec<(f64, f64)>, ConvergenceError> {
    check_levels(errors, wanted)?;
    let log = |level: &Level| {
        positive(|| format!("the error at spacing {}", level.spacing), level.value)?;
        Ok((level.spacing.ln(), level.value.ln()))
    };
    errors.iter().map(log).collect()
}

/// At least `wanted` levels, every spacing above zero.
fn check_levels(levels: &[Level], wanted: usize) -> Result<(), ConvergenceError> {
    if levels.len() < wanted {
        return Err(ConvergenceError::TooFewLevels { found: levels.len(), wanted });
    }
    let spacing = |(i, level): (usize, &Level)| {
        positive(|| format!("the spacing of level {i} (counted from 0)"), level.spacing)
    };
    levels.iter().enumerate().try_for_each(spacing)
}

/// `value` is a finite number above zero.
fn positive(what: impl Fn() -> String, value: f64) -> Result<(), ConvergenceError> {
    let good = value.is_finite() && value > 0.0;
    if good { Ok(()) } else { Err(ConvergenceError::NotPositive { what: what(), value }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::{ProptestConfig, prop, prop_assert, prop_assert_eq, proptest};

    fn levels(data: &[(f64, f64)]) -> Vec<Level> {
        data.iter().map(|&(spacing, value)| Level { spacing, value }).collect()
    }

    fn near(value: f64, wanted: f64, tolerance: f64) {
        assert!((value - wanted).abs() <= tolerance, "{value}, wanted {wanted} +- {tolerance}");
    }

    /// The worked example of NASA's tutorial on spatial convergence (dossier 5.1).
    #[test]
    fn nasa_worked_example() {
        let study =
            grid_study(&levels(&[(2.0, 0.96854), (1.0, 0.97050), (4.0, 0.96178)]), 2.0).unwrap();
        let estimate = study.observed.unwrap();
        near(estimate.order, 1.786_17, 1e-5);
        near(estimate.extrapolated, 0.971_30, 5e-6);
        near(estimate.gci12.unwrap(), 0.001_031, 5e-7);
        near(estimate.gci23.unwrap(), 0.003_562, 5e-7);
        near(estimate.asymptotic_ratio.unwrap(), 0.998, 5e-5);
        assert_eq!(study.behaviour, Behaviour::Monotone);
        assert_eq!(study.quoted, study.observed);
        assert!(study.is_asymptotic());
        near(study.band(), 0.97050 * 0.001_031, 1e-6);
    }

    /// Residual rod length of the paper's Table 5: the honest band is ten times the printed kind.
    #[test]
    fn table5_is_not_asymptotic() {
        let rows = [(35_992, 6.08), (92_498, 6.47), (187_826, 6.59)];
        let study =
            grid_study(&rows.map(|(n, length)| Level::from_count(n, 3, length)), 1.0).unwrap();
        let observed = study.observed.unwrap();
        near(observed.order, 3.17, 5e-3);
        near(observed.extrapolated, 6.698, 5e-4);
        near(observed.gci12.unwrap(), 0.0204, 5e-5);
        assert_eq!(study.order_check, OrderCheck::NotAsymptotic);
        assert!(!study.is_asymptotic());
        let quoted = study.quoted.unwrap();
        assert_eq!((quoted.order, quoted.safety_factor), (1.0, SAFETY_OTHERWISE));
        near(quoted.extrapolated, 7.04, 5e-3);
        near(quoted.gci12.unwrap(), 0.205, 5e-4);
        near(quoted.asymptotic_ratio.unwrap(), 0.5, 0.1);
    }

    /// Observed orders of the paper's Table 2 (velocity), `paper_table2_observed_order.csv`.
    #[test]
    fn table2_orders() {
        let rows = [(100, 0.17116), (200, 0.12141), (400, 0.08635), (800, 0.06081)];
        let errors = rows.map(|(n, error)| Level::from_count(n, 1, error));
        let orders = pairwise_orders(&errors).unwrap();
        for (order, wanted) in orders.iter().zip([0.4955, 0.4916, 0.5059]) {
            near(*order, wanted, 5e-5);
        }
        let fit = fitted_order(&errors).unwrap();
        near(fit.order, 0.4971, 5e-5);
        assert!(fit.contains(0.5) && !fit.contains(0.6) && fit.levels == 4);
    }

    #[test]
    fn fit_by_hand() {
        // ln h = -1, 0, 1 and ln e = -1, 0.3, 1: slope 1, residuals -0.1, 0.2, -0.1.
        let points =
            [(-1.0, -1.0), (0.0, 0.3), (1.0, 1.0)].map(|(x, y): (f64, f64)| (x.exp(), y.exp()));
        let fit = fitted_order(&levels(&points)).unwrap();
        near(fit.order, 1.0, 1e-12);
        near(fit.standard_error, 0.03_f64.sqrt(), 1e-12);
        near(fit.interval.1, 1.0 + 12.706_205 * 0.03_f64.sqrt(), 1e-9);
        near(fit.coefficient, 0.1_f64.exp(), 1e-12);
    }

    #[test]
    fn student_quantiles() {
        for (freedom, wanted) in [
            (1, 12.7062),
            (2, 4.30265),
            (10, 2.22814),
            (11, 2.20099),
            (30, 2.04227),
            (120, 1.97993),
        ] {
            near(student_t95(freedom), wanted, 1e-4 * 0.5);
        }
    }

    #[test]
    fn behaviours() {
        let study = |f: [f64; 3]| {
            grid_study(&levels(&[(1.0, f[0]), (2.0, f[1]), (4.0, f[2])]), 2.0).unwrap()
        };
        let oscillatory = study([1.0, 1.1, 0.7]);
        assert_eq!(oscillatory.behaviour, Behaviour::Oscillatory);
        assert!(oscillatory.quoted.is_none() && oscillatory.observed_order.is_none());
        near(oscillatory.band(), 0.4, 1e-12);

        let flat = study([1.42, 1.42, 1.42]);
        assert_eq!((flat.behaviour, flat.band()), (Behaviour::Flat, 0.0));

        for (values, order) in [([1.0, 3.0, 4.0], Some(-1.0)), ([1.0, 2.0, 3.0], Some(0.0))] {
            let diverging = study(values);
            assert_eq!(diverging.behaviour, Behaviour::Diverging);
            near(diverging.observed_order.unwrap(), order.unwrap(), 1e-12);
            assert!(diverging.observed.is_none() && !diverging.is_asymptotic());
            assert_eq!(diverging.quoted.unwrap().order, LOWEST_ORDER);
            assert_eq!(diverging.quoted.unwrap().safety_factor, SAFETY_OTHERWISE);
        }
        assert_eq!(study([1.0, 2.0, 2.0]).behaviour, Behaviour::Diverging);
        assert_eq!(study([1.0, 3.0, 2.0]).behaviour, Behaviour::Diverging);

        let slow = study([1.0, 1.1, 1.21]);
        assert_eq!(slow.order_check, OrderCheck::BelowFormal);
        assert_eq!(slow.quoted.unwrap().order, LOWEST_ORDER);

        let through_zero = study([0.0, 1.0, 5.0]);
        assert_eq!(through_zero.observed.unwrap().gci12, None);
        near(through_zero.band(), SAFETY_THREE_LEVELS / 3.0, 1e-12);
    }

    #[test]
    fn two_levels_use_the_formal_order() {
        let study = grid_study(&levels(&[(2.0, 5.0), (1.0, 2.0)]), 2.0).unwrap();
        let quoted = study.quoted.unwrap();
        assert_eq!((study.behaviour, quoted.gci23), (Behaviour::Unknown, None));
        near(quoted.extrapolated, 1.0, 1e-14);
        near(quoted.band, 3.0, 1e-14);
    }

    #[test]
    fn bad_input_is_named() {
        let study = |data: &[(f64, f64)], formal| grid_study(&levels(data), formal).unwrap_err();
        let text = |error: ConvergenceError| error.to_string();
        assert_eq!(text(study(&[(1.0, 1.0)], 1.0)), "1 levels given, at least 2 needed");
        assert_eq!(
            text(study(&[(1.0, 1.0), (0.0, 2.0)], 1.0)),
            "the spacing of level 1 (counted from 0) is 0, not a finite number above zero"
        );
        assert_eq!(
            text(study(&[(1.0, 1.0), (2.0, f64::NAN)], 1.0)),
            "the value at spacing 2 is NaN, or too large to subtract"
        );
        assert_eq!(
            text(study(&[(1.0, 1.0), (1.0, 2.0)], 1.0)),
            "two levels have the spacing 1: no refinement between them"
        );
        assert_eq!(
            text(study(&[(1.0, 1.0), (2.0, 2.0)], 0.0)),
            "the formal order is 0, not a finite number above zero"
        );
        let errors = levels(&[(1.0, 0.0), (2.0, 1.0), (4.0, 2.0)]);
        assert_eq!(
            text(fitted_order(&errors).unwrap_err()),
            "the error at spacing 1 is 0, not a finite number above zero"
        );
        let same = levels(&[(1.0, 3.0), (1.0, 1.0), (1.0, 2.0)]);
        assert!(matches!(fitted_order(&same), Err(ConvergenceError::EqualSpacing { .. })));
        assert!(matches!(pairwise_orders(&same), Err(ConvergenceError::EqualSpacing { .. })));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

        #[test]
        fn manufactured_limit_and_order_are_recovered(
            (p, limit, size) in (0.3..4.0_f64, -1.0..1.0_f64, 0.1..10.0_f64),
            (r21, r32) in (1.2..3.0_f64, 1.2..3.0_f64),
            falls in prop::bool::ANY,
        ) {
            let c = if falls { -size } else { size };
            let value = |h: f64| limit + c * h.powf(p);
            let level = |spacing| Level { spacing, value: value(spacing) };
            let data = [1.0, r21, r21 * r32].map(level);
            let observed = grid_study(&data, p).unwrap().observed.unwrap();
            prop_assert!((observed.order - p).abs() < 1e-8, "{} {p}", observed.order);
            prop_assert!((observed.extrapolated - limit).abs() < 1e-7 * size);
        }

        #[test]
        fn order_ignores_units(
            errors in prop::collection::vec(0.1..10.0, 3..7),
            (h_unit, e_unit) in (1e-3..1e3, 1e-3..1e3),
        ) {
            let at = |h: f64, e: f64| -> Vec<Level> {
                let level = |(i, &error): (i32, &f64)| {
                    Level { spacing: h * 1.5_f64.powi(i), value: e * error }
                };
                (0..).zip(&errors).map(level).collect()
            };
            let (plain, scaled) = (at(1.0, 1.0), at(h_unit, e_unit));
            let (a, b) = (fitted_order(&plain).unwrap(), fitted_order(&scaled).unwrap());
            prop_assert!((a.order - b.order).abs() < 1e-9);
            prop_assert!((a.standard_error - b.standard_error).abs() < 1e-9);
            let (a, b) = (pairwise_orders(&plain).unwrap(), pairwise_orders(&scaled).unwrap());
            for (a, b) in a.iter().zip(b) {
                prop_assert!((a - b).abs() < 1e-9);
            }
        }

        #[test]
        fn any_finite_values_give_a_study(
            values in prop::array::uniform3(-1e300..1e300),
            formal in 0.1..8.0,
        ) {
            let data = [1.0, 1.01, 9.0].into_iter().zip(values);
            let data: Vec<Level> = data.map(|(spacing, value)| Level { spacing, value }).collect();
            let study = grid_study(&data, formal).unwrap();
            prop_assert!(study.band() >= 0.0);
            prop_assert_eq!(study.observed.is_some(), study.behaviour == Behaviour::Monotone);
        }

        #[test]
        fn errors_of_a_power_law_fit_exactly(p in 0.1..5.0_f64, c in 1e-3..1e3_f64) {
            let at = |h: f64| Level { spacing: h, value: c * h.powf(p) };
            let fit = fitted_order(&[1.0, 0.5, 0.3, 0.1].map(at)).unwrap();
            prop_assert!((fit.order - p).abs() < 1e-10 && fit.standard_error < 1e-10);
            prop_assert!((fit.coefficient / c - 1.0).abs() < 1e-10);
        }
    }
}
