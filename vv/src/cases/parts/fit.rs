//! Straight lines through measured points.

/// Slope of a straight line through points, by least squares.
pub(in crate::cases) fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xy, xx) = points
        .iter()
        .fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - x) * (p.1 - y), xx + (p.0 - x) * (p.0 - x)));
    xy / xx
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_line_is_found() {
        let line: Vec<(f64, f64)> =
            (0..9).map(|i| (f64::from(i), 2.0 - 0.5 * f64::from(i))).collect();
        assert_relative_eq!(slope(&line), -0.5, max_relative = 1e-12);
    }
}
