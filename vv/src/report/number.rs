//! Numbers for readers.

use crate::plots::superscript;

/// A number rounded to `digits` significant digits: `0.04481`, `2.954`, `1.3×10⁻¹⁵`.
///
/// Trailing zeros are significant and kept. Numbers below 10⁻⁴ and from 10⁶ on take an exponent.
pub fn sig(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return if value.is_nan() { "NaN".into() } else { signed(value, "∞".into()) };
    }
    let decimals = digits.clamp(1, 17) - 1;
    // Rounding first: 9.9996 to four digits is 10.00.
    let rounded = format!("{:.decimals$e}", value.abs());
    let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let text = if (-4..6).contains(&exponent) {
        let number: f64 = rounded.parse().unwrap_or(value.abs());
        format!("{number:.*}", usize::try_from(decimals as i32 - exponent).unwrap_or(0))
    } else {
        format!("{mantissa}×10{}", superscript(exponent))
    };
    signed(value, text)
}

fn signed(value: f64, text: String) -> String {
    if value < 0.0 { format!("−{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::sig;

    #[test]
    fn significant_digits() {
        let cases = [
            (0.044_812, 4, "0.04481"),
            (2.9541, 4, "2.954"),
            (1.3e-15, 2, "1.3×10⁻¹⁵"),
            (-0.5, 3, "−0.500"),
            (9.9996, 4, "10.00"),
            (999_999.7, 4, "1.000×10⁶"),
            (123_456.0, 3, "123000"),
            (1e-4, 1, "0.0001"),
            (-6.02e23, 3, "−6.02×10²³"),
            (0.0, 3, "0"),
            (f64::NEG_INFINITY, 3, "−∞"),
            (f64::NAN, 3, "NaN"),
            (f64::MIN_POSITIVE, 0, "2×10⁻³⁰⁸"),
        ];
        for (value, digits, text) in cases {
            assert_eq!(sig(value, digits), text, "{value} to {digits} digits");
        }
    }
}
