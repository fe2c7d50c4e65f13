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
    let study = grid_study(&rows.map(|(n, length)| Level::from_count(n, 3, length)), 1.0).unwrap();
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
    for (freedom, wanted) in
        [(1, 12.7062), (2, 4.30265), (10, 2.22814), (11, 2.20099), (30, 2.04227), (120, 1.97993)]
    {
        near(student_t95(freedom), wanted, 1e-4 * 0.5);
    }
}

#[test]
fn behaviours() {
    let study =
        |f: [f64; 3]| grid_study(&levels(&[(1.0, f[0]), (2.0, f[1]), (4.0, f[2])]), 2.0).unwrap();
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
    assert_eq!(text(study(&[(1.0, 1.0)], 1.0)), "1 level given, at least 2 needed");
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
