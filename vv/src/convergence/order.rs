//! Orders of errors that are known: between two levels, and fitted to three or more.

use serde::{Deserialize, Serialize};

use super::{ConvergenceError, Level, check_levels, positive};

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
    /// Whether the errors have an order at all: not where its interval is wider than itself.
    #[must_use]
    pub fn is_order(&self) -> bool {
        self.interval.1 - self.interval.0 <= self.order.abs()
    }

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

/// `(ln h, ln e)` of `wanted` or more levels of error norms.
fn log_log(errors: &[Level], wanted: usize) -> Result<Vec<(f64, f64)>, ConvergenceError> {
    check_levels(errors, wanted)?;
    let log = |level: &Level| {
        positive(|| format!("the error at spacing {}", level.spacing), level.value)?;
        Ok((level.spacing.ln(), level.value.ln()))
    };
    errors.iter().map(log).collect()
}
