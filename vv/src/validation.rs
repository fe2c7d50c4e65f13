//! Validation against a measurement: the comparison error and its uncertainty (ASME V&V 20-2009).
//!
//! The comparison error is `E = S - D`, simulation less data. Its standard uncertainty is
//! `u_val = sqrt(u_num^2 + u_input^2 + u_D^2)`: of the numerical solution, of what goes into it, and of
//! the data. The error of the model lies within `E +- k u_val`, with `k = 2` for 95 % if errors are
//! normally distributed. While `|E| <= k u_val` the comparison shows no error of the model, and no
//! agreement better than that either.

/// Standard uncertainties that a 95 % band extends to either side.
pub const EXPANSION: f64 = 2.0;

/// A simulated and a measured number with standard uncertainties, all in the unit of the quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// What the simulation gives, `S`.
    pub simulated: f64,
    /// What was measured, `D`.
    pub measured: f64,
    /// Of the numerical solution, `u_num`.
    pub numerical: f64,
    /// Of the inputs, `u_input`.
    pub input: f64,
    /// Of the measurement, `u_D`.
    pub data: f64,
}

impl Comparison {
    /// The comparison error `E = S - D`.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.simulated - self.measured
    }

    /// The validation uncertainty `u_val`.
    #[must_use]
    pub fn uncertainty(&self) -> f64 {
        combined(&[self.numerical, self.input, self.data])
    }

    /// Where the error of the model lies: `E - k u_val` and `E + k u_val`.
    #[must_use]
    pub fn model_error(&self) -> [f64; 2] {
        let half = EXPANSION * self.uncertainty();
        [self.error() - half, self.error() + half]
    }

    /// Whether the comparison shows an error of the model: `|E| > k u_val`.
    #[must_use]
    pub fn resolves(&self) -> bool {
        self.error().abs() > EXPANSION * self.uncertainty()
    }
}

/// Standard uncertainty of independent ones: the root of the sum of their squares.
#[must_use]
pub fn combined(parts: &[f64]) -> f64 {
    parts.iter().map(|u| u * u).sum::<f64>().sqrt()
}

/// Standard uncertainty of a number with this 95 % band to either side.
#[must_use]
pub fn of_band(band: f64) -> f64 {
    band / EXPANSION
}

/// Standard uncertainty of a number of which only is known that it lies between the least and the
/// greatest of some: their range over `2 sqrt(3)` (JCGM 100:2008, GUM, 4.3.7). NaN where there are none.
#[must_use]
pub fn of_range(numbers: &[f64]) -> f64 {
    let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if numbers.is_empty() { f64::NAN } else { (greatest - least) / 12.0_f64.sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::{ProptestConfig, prop, prop_assert, proptest};

    #[test]
    fn comparison_by_hand() {
        let comparison = Comparison {
            simulated: 6.59,
            measured: 6.38,
            numerical: 0.02,
            input: 0.03,
            data: 0.06,
        };
        assert_relative_eq!(comparison.error(), 0.21, max_relative = 1e-12);
        assert_relative_eq!(comparison.uncertainty(), 0.07, max_relative = 1e-12);
        assert_relative_eq!(comparison.model_error()[0], 0.07, max_relative = 1e-12);
        assert_relative_eq!(comparison.model_error()[1], 0.35, max_relative = 1e-12);
        assert!(comparison.resolves());
        assert!(!Comparison { numerical: 0.68, ..comparison }.resolves());
    }

    /// A rectangle from 0 to 1 has the variance 1/12.
    #[test]
    fn ranges_are_rectangles() {
        assert_relative_eq!(of_range(&[1.0, 0.0, 0.3]).powi(2), 1.0 / 12.0, max_relative = 1e-12);
        assert_relative_eq!(of_range(&[7.0]), 0.0);
        assert!(of_range(&[]).is_nan());
        assert_relative_eq!(of_band(0.4), 0.2);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

        /// An uncertainty is no less than its largest part and no more than their sum.
        #[test]
        fn parts_combine(parts in prop::collection::vec(0.0..1e3_f64, 1..5)) {
            let all = combined(&parts);
            let most = parts.iter().copied().fold(0.0, f64::max);
            prop_assert!(all >= most * (1.0 - 1e-12));
            prop_assert!(all <= parts.iter().sum::<f64>() * (1.0 + 1e-12));
        }
    }
}
