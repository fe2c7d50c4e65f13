//! Straight lines and oscillations through measured points.

/// Slope of a straight line through points, by least squares.
pub(in crate::cases) fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xy, xx) = points
        .iter()
        .fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - x) * (p.1 - y), xx + (p.0 - x) * (p.0 - x)));
    xy / xx
}

/// Frequency and decay rate of a damped oscillation about zero that is sampled at equal times
/// `step`: the roots of the recurrence `f_{i+1} + f_{i-1} = a f_i + b f_{i-1}`, by least squares.
///
/// Samples should be a twentieth of a period apart or so: less, and noise decides.
pub(in crate::cases) fn oscillation(values: &[f64], step: f64) -> (f64, f64) {
    // Normal equations of f_{i+1} = a f_i + b f_{i-1}.
    let [mut aa, mut ab, mut bb, mut ya, mut yb] = [0.0; 5];
    for w in values.windows(3) {
        aa += w[1] * w[1];
        ab += w[1] * w[0];
        bb += w[0] * w[0];
        ya += w[2] * w[1];
        yb += w[2] * w[0];
    }
    let determinant = aa * bb - ab * ab;
    let (a, b) = ((ya * bb - yb * ab) / determinant, (yb * aa - ya * ab) / determinant);
    // Roots are exp((-decay +- i omega) step): their product is -b, their sum a.
    let modulus = (-b).sqrt();
    let omega = (0.5 * a / modulus).clamp(-1.0, 1.0).acos() / step;
    (omega / std::f64::consts::TAU, -modulus.ln() / step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_line_and_an_oscillation_are_found() {
        let line: Vec<(f64, f64)> =
            (0..9).map(|i| (f64::from(i), 2.0 - 0.5 * f64::from(i))).collect();
        assert_relative_eq!(slope(&line), -0.5, max_relative = 1e-12);
        let wave = |t: f64| (-0.02 * t).exp() * (0.7 * t + 0.4).sin();
        let values: Vec<f64> = (0..60).map(|i| wave(0.4 * f64::from(i))).collect();
        let (frequency, decay) = oscillation(&values, 0.4);
        assert_relative_eq!(frequency, 0.7 / std::f64::consts::TAU, max_relative = 1e-9);
        assert_relative_eq!(decay, 0.02, max_relative = 1e-7);
    }
}
