//! Root finding, quadrature and integration in time shared by the semi-analytic solutions.

/// A zero of `f` between `a` and `b` by bisection to the last bit.
///
/// If `f` has the same sign at both ends one of the ends is returned.
pub(crate) fn root(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (mut low, mut high) = (a, b);
    let rising = f(low) < f(high);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low.min(high) || middle >= low.max(high) || !middle.is_finite() {
            return middle;
        }
        if (f(middle) > 0.0) == rising {
            high = middle;
        } else {
            low = middle;
        }
    }
}

/// Abscissae in `(0, 1)` and weights of the eight-point Gauss-Legendre rule on `[-1, 1]`.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
];

/// Integral of a smooth `f` from `a` to `b` by the eight-point Gauss-Legendre rule on `panels`.
pub(crate) fn integrate(f: impl Fn(f64) -> f64, a: f64, b: f64, panels: u32) -> f64 {
    let half = 0.5 * (b - a) / f64::from(panels);
    let panel = |i: u32| {
        let centre = a + f64::from(2 * i + 1) * half;
        let pair = |[x, w]: [f64; 2]| w * (f(centre - half * x) + f(centre + half * x));
        GAUSS.into_iter().map(pair).sum::<f64>()
    };
    half * (0..panels).map(panel).sum::<f64>()
}

/// Integral from 0 to 1 of an `f` that may be singular, but integrable, at 0, by the
/// double-exponential rule `x = 1/(1 + exp(pi sinh(-s)))` of H. Takahasi and M. Mori (1974).
pub(crate) fn integrate_singular(f: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1.0 / 32.0;
    let node = |i: i32| {
        let s = STEP * f64::from(i);
        let tail = (-std::f64::consts::PI * s.sinh()).exp();
        let x = 1.0 / (1.0 + tail);
        let weight = std::f64::consts::PI * s.cosh() * tail * x * x;
        if x > 0.0 && weight > 0.0 { weight * f(x) } else { 0.0 }
    };
    STEP * (-192..=192).map(node).sum::<f64>()
}

/// One step of the classical fourth-order Runge-Kutta method for `d state/d t = rate(state)`.
pub(crate) fn runge_kutta<const N: usize>(
    state: [f64; N],
    step: f64,
    rate: impl Fn([f64; N]) -> [f64; N],
) -> [f64; N] {
    let along = |k: [f64; N], by: f64| std::array::from_fn(|i| state[i] + by * k[i]);
    let first = rate(state);
    let second = rate(along(first, 0.5 * step));
    let third = rate(along(second, 0.5 * step));
    let fourth = rate(along(third, step));
    std::array::from_fn(|i| {
        state[i] + step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn roots_are_exact_whichever_way_the_function_goes() {
        assert_relative_eq!(root(|x| x * x - 2.0, 0.0, 2.0), 2f64.sqrt(), max_relative = 1e-15);
        assert_relative_eq!(root(|x| 2.0 - x * x, 0.0, 2.0), 2f64.sqrt(), max_relative = 1e-15);
        assert_relative_eq!(root(|x| x * x - 2.0, 2.0, 0.0), 2f64.sqrt(), max_relative = 1e-15);
        assert!(root(|_| f64::NAN, 0.0, 1.0).is_finite());
    }

    #[test]
    fn quadrature_meets_closed_forms() {
        let power = integrate(|x| x.powi(15), 0.0, 2.0, 1);
        assert_relative_eq!(power, 2f64.powi(16) / 16.0, max_relative = 1e-14);
        assert_relative_eq!(integrate(f64::exp, 1.0, -1.0, 4), (-1f64).exp() - 1f64.exp());
        for exponent in [-0.9, -0.5, 0.3, 4.0] {
            let value = integrate_singular(|x| x.powf(exponent));
            assert_relative_eq!(value, 1.0 / (1.0 + exponent), max_relative = 1e-12);
        }
    }

    #[test]
    fn runge_kutta_is_of_fourth_order() {
        let error = |steps: u32| {
            let step = 1.0 / f64::from(steps);
            let end = (0..steps).fold([1.0, 0.0], |s, _| runge_kutta(s, step, |[c, d]| [-d, c]));
            (end[0] - 1f64.cos()).abs()
        };
        let order = (error(10) / error(20)).log2();
        assert!((order - 4.0).abs() < 0.2, "order {order}");
    }
}
