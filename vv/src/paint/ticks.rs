//! Round numbers: ticks of a colour bar and the length of a scale bar.

/// Round values (1, 2 or 5 times a power of ten apart) in a range, at most `most` of them, with
/// the text for each.
pub(super) fn ticks((low, high): (f64, f64), most: usize) -> Vec<(f64, String)> {
    let step = round_up((high - low) / most.max(1) as f64);
    let first = (low / step - 1e-9).ceil();
    let count = ((high / step + 1e-9).floor() - first).max(0.0) as usize + 1;
    let values = (0..count.min(2 * most + 2)).map(|i| (first + i as f64) * step);
    values.map(|v| (v, number(v, step))).collect()
}

/// The smallest of 1, 2 or 5 times a power of ten that is not below a positive value.
pub(super) fn round_up(value: f64) -> f64 {
    let power = 10.0_f64.powi(value.log10().floor() as i32);
    let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * power >= value * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

/// The largest of 1, 2 or 5 times a power of ten that is not above a positive value.
pub(super) fn round_down(value: f64) -> f64 {
    let power = 10.0_f64.powi(value.log10().floor() as i32);
    let factor = [5.0, 2.0].into_iter().find(|f| f * power <= value * (1.0 + 1e-9));
    factor.unwrap_or(1.0) * power
}

/// A multiple of `step` with the decimals that step needs.
pub(super) fn number(value: f64, step: f64) -> String {
    let places = -step.abs().log10().floor();
    let largest = value.abs().max(step.abs());
    if !(-4.0..=5.0).contains(&largest.log10().floor()) {
        return exponent(&format!("{value:.1e}"));
    }
    let text = format!("{value:.*}", places.clamp(0.0, 9.0) as usize);
    // A negative zero or minus sign in typographic form.
    if text.trim_start_matches('-').chars().all(|c| "0.".contains(c)) {
        text.trim_start_matches('-').to_owned()
    } else {
        text.replace('-', "−")
    }
}

/// Turns `2.0e-7` into `2×10⁻⁷`.
fn exponent(text: &str) -> String {
    let Some((mantissa, power)) = text.split_once('e') else {
        return text.to_owned();
    };
    let raised = power.chars().map(|c| match c.to_digit(10) {
        Some(d) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][d as usize],
        None => '⁻',
    });
    let mantissa = mantissa.trim_end_matches(".0").replace('-', "−");
    if mantissa == "0" {
        return mantissa;
    }
    format!("{mantissa}×10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(range: (f64, f64)) -> String {
        ticks(range, 5).into_iter().map(|t| t.1).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(texts((300.0, 1700.0)), "500 1000 1500");
        assert_eq!(texts((0.0, 1.0)), "0.0 0.2 0.4 0.6 0.8 1.0");
        assert_eq!(texts((-2.0, 3.0)), "−2 −1 0 1 2 3");
        assert_eq!(texts((0.0, 4e-7)), "0 1×10⁻⁷ 2×10⁻⁷ 3×10⁻⁷ 4×10⁻⁷");
    }

    #[test]
    fn lengths_are_round() {
        assert!((round_down(0.37) - 0.2).abs() < 1e-12 && (round_down(5.0) - 5.0).abs() < 1e-12);
        assert!((round_up(0.37) - 0.5).abs() < 1e-12 && (round_up(0.2) - 0.2).abs() < 1e-12);
        assert!((round_up(7.0) - 10.0).abs() < 1e-12);
    }
}
