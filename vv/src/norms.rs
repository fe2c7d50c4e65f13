//! Error norms: one number from the errors of all particles.
//!
//! An error is `computed - exact` at one particle; a norm has its unit. Which mean is taken decides
//! the order a shock can show (see [`Norm::shock_order`]), so each norm is quoted with its name.

use serde::{Deserialize, Serialize};

/// Why a norm cannot be computed. The slice at fault is named by `what`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NormError {
    /// Fewer values than the norm needs.
    #[error("{what}: {found} values given, at least {wanted} needed")]
    TooFew {
        /// The slice at fault.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The least length.
        wanted: usize,
    },
    /// Two slices that go together have different lengths.
    #[error("{what}: {found} values given, {wanted} needed, one for each error")]
    LengthsDiffer {
        /// The slice at fault.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The number of errors.
        wanted: usize,
    },
    /// A value is infinite or not a number.
    #[error("{what}: value {index} (counted from 0) is {value}, not a finite number")]
    NonFinite {
        /// The slice at fault.
        what: &'static str,
        /// Position in the slice.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A weight, length or norm is below zero.
    #[error("{what}: value {index} (counted from 0) is {value}, below zero")]
    Negative {
        /// The slice at fault.
        what: &'static str,
        /// Position in the slice.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// The divisor is zero: no weight, no particle in the window, or a constant exact field.
    #[error("no {what}: the norm is undefined")]
    NoMeasure {
        /// What should be above zero.
        what: &'static str,
    },
    /// Finite values whose sum is too large for a double.
    #[error("the sum of the errors or of their weights is too large for a double")]
    Overflow,
}

/// The three ways to take one number from many errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Norm {
    /// Root of the mean square, eqs (81), (82).
    Rms,
    /// Mean of the absolute value.
    L1,
    /// Largest absolute value.
    Linf,
}

impl Norm {
    /// Order of convergence of this norm for a shock smeared over a fixed number of particles,
    /// which no method can exceed: 1/2 for RMS, 1 for L1, 0 for the largest error.
    #[must_use]
    pub fn shock_order(self) -> f64 {
        match self {
            Self::Rms => 0.5,
            Self::L1 => 1.0,
            Self::Linf => 0.0,
        }
    }

    /// The norm of `errors`, each particle counting the same.
    ///
    /// # Errors
    /// [`NormError`] if `errors` is empty or holds a non-finite value.
    pub fn of(self, errors: &[f64]) -> Result<f64, NormError> {
        match self {
            Self::Rms => rms(errors),
            Self::L1 => {
                check("errors", errors, 1)?;
                weighted_mean("errors", errors.iter().map(|&error| (1.0, error)))
            }
            Self::Linf => linf(errors),
        }
    }

    /// Average of this norm over the phases of a shock inside one particle spacing: root mean
    /// square for RMS, mean for L1, maximum for the largest error; `values` holds the norm at
    /// equally spaced stop times over one crossing of a spacing.
    ///
    /// # Errors
    /// [`NormError`] if `values` is empty or holds a non-finite or negative value.
    pub fn phase_average(self, values: &[f64]) -> Result<f64, NormError> {
        check_measure("norms of the phases", values, values.len())?;
        self.of(values)
    }
}

/// Root of the particle mean of the squared error, eqs (81), (82):
/// `sqrt(1/n * sum_i e_i^2)`. With equal particle masses this is a mass-weighted norm.
///
/// # Errors
/// [`NormError`] if `errors` is empty or holds a non-finite value.
pub fn rms(errors: &[f64]) -> Result<f64, NormError> {
    let largest = linf(errors)?;
    if largest == 0.0 {
        return Ok(0.0);
    }
    // Dividing by the largest error keeps the squares from overflow and underflow.
    let squares = errors.iter().map(|error| (1.0, (error / largest).powi(2)));
    Ok(largest * weighted_mean("errors", squares)?.sqrt())
}

/// Largest absolute error, `max_i |e_i|`.
///
/// # Errors
/// [`NormError`] if `errors` is empty or holds a non-finite value.
pub fn linf(errors: &[f64]) -> Result<f64, NormError> {
    check("errors", errors, 1)?;
    Ok(errors.iter().fold(0.0, |largest, error| error.abs().max(largest)))
}

/// Weighted mean of the absolute error, `sum_i w_i |e_i| / sum_i w_i`. With particle masses as
/// weights: the mass-weighted L1 norm.
///
/// # Errors
/// [`NormError`] if a slice is empty, the lengths differ, a value is not finite, a weight is
/// negative, or all weights are zero.
pub fn l1_weighted(errors: &[f64], weights: &[f64]) -> Result<f64, NormError> {
    check("errors", errors, 1)?;
    check_measure("weights", weights, errors.len())?;
    weighted_mean("weight above zero", weights.iter().copied().zip(errors.iter().copied()))
}

/// L1 norm inside a window, `sum L_i |e_i| / sum L_i` over the particles with `a < x_i < b`;
/// `lengths` are the particle lengths `L_i`, `window` is `(a, b)`, both in the unit of `x`.
///
/// # Errors
/// [`NormError`] if a slice is empty, the lengths differ, a value is not finite, a particle length
/// is negative, or the window holds no particle.
pub fn window_l1(
    x: &[f64],
    errors: &[f64],
    lengths: &[f64],
    window: (f64, f64),
) -> Result<f64, NormError> {
    check("errors", errors, 1)?;
    check("window", &[window.0, window.1], 2)?;
    check_paired("positions", x, errors.len())?;
    check_measure("particle lengths", lengths, errors.len())?;
    let inside = |&(&x, _): &(&f64, _)| window.0 < x && x < window.1;
    let particles = x.iter().zip(lengths.iter().copied().zip(errors.iter().copied()));
    weighted_mean("particle length in the window", particles.filter(inside).map(|(_, pair)| pair))
}

/// Weighted L1 norm divided by the range of the exact field, `max - min` of `exact` (at the
/// particles); no unit.
///
/// # Errors
/// As [`l1_weighted`], and if `exact` has another length or is constant.
pub fn relative_l1(errors: &[f64], weights: &[f64], exact: &[f64]) -> Result<f64, NormError> {
    let norm = l1_weighted(errors, weights)?;
    check_paired("exact field", exact, errors.len())?;
    let (low, high) =
        exact.iter().fold((f64::MAX, f64::MIN), |(low, high), &f| (low.min(f), high.max(f)));
    if low == high {
        return Err(NormError::NoMeasure { what: "range in the exact field" });
    }
    // Halves, because `high - low` itself may overflow.
    Ok(0.5 * norm / (0.5 * high - 0.5 * low))
}

/// Amplitude of the odd-even mode in a chain of values (positions, velocities, densities in the
/// order of the chain), in their unit: the RMS of the fourth difference
/// `(f_{i-2} - 4 f_{i-1} + 6 f_i - 4 f_{i+1} + f_{i+2}) / 16`.
///
/// It is `a` for `f_i = a (-1)^i`, zero for any cubic, and of order `(k dx / 2)^4` for a wave that
/// is resolved.
///
/// # Errors
/// [`NormError`] for fewer than five values or a non-finite one.
pub fn roughness(values: &[f64]) -> Result<f64, NormError> {
    check("values", values, 5)?;
    let fourth = |f: &[f64]| (f[0] + f[4]) / 16.0 - (f[1] + f[3]) / 4.0 + 0.375 * f[2];
    rms(&values.windows(5).map(fourth).collect::<Vec<_>>())
}

/// `sum w |f| / sum w` over pairs `(w, f)`; `what` says what is missing if all weights are zero.
fn weighted_mean(
    what: &'static str,
    pairs: impl Iterator<Item = (f64, f64)>,
) -> Result<f64, NormError> {
    let (weight, sum) =
        pairs.fold((0.0, 0.0), |(weight, sum), (w, f)| (weight + w, sum + w * f.abs()));
    if weight == 0.0 {
        return Err(NormError::NoMeasure { what });
    }
    let mean = sum / weight;
    if mean.is_finite() { Ok(mean) } else { Err(NormError::Overflow) }
}

/// At least `wanted` values, all finite.
fn check(what: &'static str, values: &[f64], wanted: usize) -> Result<(), NormError> {
    if values.len() < wanted {
        return Err(NormError::TooFew { what, found: values.len(), wanted });
    }
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(NormError::NonFinite { what, index, value: values[index] }),
        None => Ok(()),
    }
}

/// Exactly `wanted` values, all finite.
fn check_paired(what: &'static str, values: &[f64], wanted: usize) -> Result<(), NormError> {
    if values.len() != wanted {
        return Err(NormError::LengthsDiffer { what, found: values.len(), wanted });
    }
    check(what, values, 1)
}

/// Exactly `wanted` values, all finite and none below zero.
fn check_measure(what: &'static str, values: &[f64], wanted: usize) -> Result<(), NormError> {
    check_paired(what, values, wanted)?;
    match values.iter().position(|&value| value < 0.0) {
        Some(index) => Err(NormError::Negative { what, index, value: values[index] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Norm, NormError, l1_weighted, linf, relative_l1, rms, roughness, window_l1};
    use proptest::prelude::{ProptestConfig, prop, prop_assert, proptest};

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-13 * (a.abs() + b.abs())
    }

    #[test]
    fn norms_by_hand() -> Result<(), NormError> {
        let errors = [3.0, -4.0, 0.0, 0.0];
        assert!(near(rms(&errors)?, 2.5));
        assert!(near(linf(&errors)?, 4.0));
        assert!(near(Norm::L1.of(&errors)?, 1.75));
        assert!(near(l1_weighted(&errors, &[1.0, 2.0, 0.0, 1.0])?, 2.75));
        assert!(near(relative_l1(&errors, &[1.0; 4], &[1.0, 4.5, 2.0, 1.0])?, 0.5));
        assert!(near(rms(&[1e200, -1e200])?, 1e200));
        assert!(rms(&[0.0; 3])? == 0.0);
        Ok(())
    }

    #[test]
    fn window_is_open_and_divides_by_the_length_inside() -> Result<(), NormError> {
        let (x, errors, lengths) =
            ([0.0, 1.0, 2.0, 3.0], [9.0, 1.0, -4.0, 9.0], [1.0, 2.0, 1.0, 1.0]);
        assert!(near(window_l1(&x, &errors, &lengths, (0.0, 3.0))?, 2.0));
        let empty = window_l1(&x, &errors, &lengths, (0.2, 0.8));
        assert_eq!(empty, Err(NormError::NoMeasure { what: "particle length in the window" }));
        Ok(())
    }

    #[test]
    fn phase_average_follows_the_norm() -> Result<(), NormError> {
        let values = [1.0, 7.0];
        assert!(near(Norm::Rms.phase_average(&values)?, 5.0));
        assert!(near(Norm::L1.phase_average(&values)?, 4.0));
        assert!(near(Norm::Linf.phase_average(&values)?, 7.0));
        let negative = Norm::L1.phase_average(&[1.0, -1.0]);
        assert!(matches!(negative, Err(NormError::Negative { index: 1, .. })));
        Ok(())
    }

    #[test]
    fn roughness_sees_the_odd_even_mode_alone() -> Result<(), NormError> {
        let chain = |f: fn(f64) -> f64| (0..32).map(|i| f(f64::from(i))).collect::<Vec<_>>();
        let odd_even = |i: f64| if i % 2.0 == 0.0 { 0.25 } else { -0.25 };
        assert!(near(roughness(&chain(odd_even))?, 0.25));
        assert!(roughness(&chain(|i| 7.0 + i * (1.0 - i * (2.0 - i))))? < 1e-10);
        assert!(roughness(&chain(|i| (0.2 * i).sin()))? < 1e-4);
        assert!(matches!(roughness(&[1.0; 4]), Err(NormError::TooFew { wanted: 5, .. })));
        Ok(())
    }

    #[test]
    fn bad_input_is_named() {
        let text = |result: Result<f64, NormError>| result.unwrap_err().to_string();
        assert_eq!(text(rms(&[])), "errors: 0 values given, at least 1 needed");
        assert_eq!(
            text(linf(&[0.0, f64::NAN])),
            "errors: value 1 (counted from 0) is NaN, not a finite number"
        );
        assert_eq!(
            text(l1_weighted(&[1.0, 2.0], &[1.0])),
            "weights: 1 values given, 2 needed, one for each error"
        );
        assert_eq!(
            text(l1_weighted(&[1.0, 2.0], &[1.0, -1.0])),
            "weights: value 1 (counted from 0) is -1, below zero"
        );
        assert_eq!(
            text(l1_weighted(&[1.0], &[0.0])),
            "no weight above zero: the norm is undefined"
        );
        assert_eq!(
            text(relative_l1(&[1.0], &[1.0], &[2.0])),
            "no range in the exact field: the norm is undefined"
        );
        assert_eq!(
            text(Norm::L1.of(&[f64::MAX, f64::MAX])),
            "the sum of the errors or of their weights is too large for a double"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

        #[test]
        fn norms_are_ordered_and_scale(
            errors in prop::collection::vec(-1e3..1e3_f64, 1..40),
            scale in 1e-6..1e6_f64,
        ) {
            let [mean, root, largest] =
                [Norm::L1, Norm::Rms, Norm::Linf].map(|norm| norm.of(&errors).unwrap());
            prop_assert!(mean <= root * (1.0 + 1e-12) && root <= largest * (1.0 + 1e-12));
            let scaled: Vec<f64> = errors.iter().map(|error| -scale * error).collect();
            prop_assert!((rms(&scaled).unwrap() - scale * root).abs() <= 1e-12 * scale * root);
            let weights = vec![scale; errors.len()];
            prop_assert!((l1_weighted(&errors, &weights).unwrap() - mean).abs() <= 1e-9 * mean);
        }
    }
}
