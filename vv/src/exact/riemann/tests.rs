use super::super::testing::{cases, close};
use super::*;
use approx::assert_relative_eq;
use proptest::prelude::*;

fn gas(density: f64, velocity: f64, pressure: f64, gamma: f64) -> Gas {
    Gas { density, velocity, pressure, gamma }
}

fn solve(left: Gas, right: Gas) -> Riemann {
    Riemann::new(left, right).unwrap()
}

fn star(solution: &Riemann) -> (Gas, Gas) {
    match solution.middle() {
        Middle::Star { left, right } => (left, right),
        vacuum @ Middle::Vacuum { .. } => panic!("{vacuum:?}"),
    }
}

fn sod() -> Riemann {
    solve(gas(1.0, 0.0, 1.0, 1.4), gas(0.125, 0.0, 0.1, 1.4))
}

/// A row of `riemann_exact.csv`.
struct Row {
    left: [f64; 3],
    right: [f64; 3],
    gamma: f64,
    /// Pressure, velocity, density on the left and on the right of the contact.
    star: [f64; 4],
    /// Left head and tail, right tail and head.
    speeds: [f64; 4],
}

const ROWS: [Row; 6] = [
    Row {
        left: [1.0, 0.0, 1.0],
        right: [0.125, 0.0, 0.1],
        gamma: 1.4,
        star: [0.30313017805065, 0.92745262004895, 0.4263194281785, 0.26557371170531],
        speeds: [-1.1832159566199, -0.070272812561183, 1.7521557320302, 1.7521557320302],
    },
    Row {
        left: [1.0, -2.0, 0.4],
        right: [1.0, 2.0, 0.4],
        gamma: 1.4,
        star: [0.0018938734200548, 0.0, 0.021852118206813, 0.021852118206813],
        speeds: [-2.7483314773548, -0.34833147735479, 0.34833147735479, 2.7483314773548],
    },
    Row {
        left: [1.0, 0.0, 1000.0],
        right: [1.0, 0.0, 0.01],
        gamma: 1.4,
        star: [460.89378749138, 19.597451388723, 0.57506229847656, 5.9992407047962],
        speeds: [-37.416573867739, -13.899632201272, 23.517536966903, 23.517536966903],
    },
    Row {
        left: [1.0, -19.59745, 1000.0],
        right: [1.0, -19.59745, 0.01],
        gamma: 1.4,
        star: [460.89378749138, 1.3887230529974e-6, 0.57506229847656, 5.9992407047962],
        speeds: [-57.014023867739, -33.497082201272, 3.9200869669032, 3.9200869669032],
    },
    Row {
        left: [1.0, 0.0, 0.06666666666666667],
        right: [0.01, 0.0, 6.666666666666667e-11],
        gamma: 1.6666666666666667,
        star: [0.0028952132326552, 0.46598388512817, 0.1522870901732, 0.039999996546023],
        speeds: [-0.33333333333333, 0.28797851350422, 0.62131186472087, 0.62131186472087],
    },
    Row {
        left: [1.0, 0.0, 0.06666666666666667],
        right: [0.001, 0.0, 6.666666666666667e-11],
        gamma: 1.6666666666666667,
        star: [0.00051557792765097, 0.62183867139173, 0.054079335349316, 0.00399999806043],
        speeds: [-0.33333333333333, 0.49578489518898, 0.82911836253347, 0.82911836253347],
    },
];

#[test]
fn reproduces_the_reference_table() {
    for row in &ROWS {
        let state =
            |[density, velocity, pressure]: [f64; 3]| gas(density, velocity, pressure, row.gamma);
        let solution = solve(state(row.left), state(row.right));
        let (left, right) = star(&solution);
        let [pressure, velocity, density_left, density_right] = row.star;
        assert_relative_eq!(left.pressure, pressure, max_relative = 2e-13);
        assert_relative_eq!(left.density, density_left, max_relative = 2e-13);
        assert_relative_eq!(right.density, density_right, max_relative = 2e-13);
        // Velocities carry the rounding of the fastest wave.
        let (outer, inner) = (solution.left_wave().unwrap(), solution.right_wave().unwrap());
        let got = [outer.head(), outer.tail(), inner.tail(), inner.head()];
        let fastest = row.speeds.iter().fold(0.0_f64, |max, s| max.max(s.abs()));
        assert!((left.velocity - velocity).abs() < 2e-14 * fastest);
        for (got, expected) in got.iter().zip(row.speeds) {
            assert!((got - expected).abs() < 2e-14 * fastest, "{got} {expected}");
        }
    }
}

/// Lines of `sod_profile_t0.2.csv` (x, rho, u, p, e) on both sides of every wave; the membrane is at
/// x = 0.5. All 201 lines agree to 1e-9.
const SOD_PROFILE: [[f64; 5]; 13] = [
    [0.25, 1.0, 0.0, 1.0, 2.5],
    [0.265, 0.9942269188, 0.006846630517, 0.9919270291, 2.494216889],
    [0.3, 0.8774525328, 0.1526799638, 0.832747015, 2.372626963],
    [0.37, 0.6767907839, 0.4443466305, 0.5789435377, 2.138561692],
    [0.45, 0.4942758115, 0.7776799638, 0.3728697065, 1.885939479],
    [0.485, 0.4280053272, 0.9235132972, 0.3048097427, 1.78040858],
    [0.49, 0.4263194282, 0.92745262, 0.3031301781, 1.777600069],
    [0.6, 0.4263194282, 0.92745262, 0.3031301781, 1.777600069],
    [0.685, 0.4263194282, 0.92745262, 0.3031301781, 1.777600069],
    [0.69, 0.2655737117, 0.92745262, 0.3031301781, 2.853540888],
    [0.85, 0.2655737117, 0.92745262, 0.3031301781, 2.853540888],
    [0.855, 0.125, 0.0, 0.1, 2.0],
    [1.0, 0.125, 0.0, 0.1, 2.0],
];

#[test]
fn reproduces_the_sod_profile() {
    for [x, density, velocity, pressure, energy] in SOD_PROFILE {
        let gas = sod().sample((x - 0.5) / 0.2).gas;
        assert_relative_eq!(gas.density, density, max_relative = 1e-9);
        assert_relative_eq!(gas.velocity, velocity, max_relative = 1e-8);
        assert_relative_eq!(gas.pressure, pressure, max_relative = 1e-9);
        assert_relative_eq!(gas.energy(), energy, max_relative = 1e-9);
    }
}

#[test]
fn converges_for_extreme_ratios() {
    for exponent in [-300, -100, -12, 12, 100] {
        let solution = solve(gas(1.0, 0.0, 1.0, 1.4), gas(1.0, 0.0, 10_f64.powi(exponent), 1.4));
        assert_jumps(&solution, 1e-11);
    }
    // Two cold streams: the Noh shock, p = (g+1)/2 rho u^2.
    let solution = solve(gas(1.0, 1.0, 0.0, 1.4), gas(1.0, -1.0, 0.0, 1.4));
    assert_relative_eq!(star(&solution).0.pressure, 1.2, max_relative = 1e-14);
    assert_relative_eq!(star(&solution).1.density, 6.0, max_relative = 1e-14);
    // The vacuum limit of the symmetric expansion is approached from below: p* -> 0.
    let escape = 2.0 / 0.4 * 1.4_f64.sqrt();
    for (deficit, exponent) in [(1e-3, 7.0), (1e-8, 7.0)] {
        let u = escape * (1.0 - deficit);
        let solution = solve(gas(1.0, -u, 1.0, 1.4), gas(1.0, u, 1.0, 1.4));
        let expected = f64::powf(deficit, exponent);
        assert_relative_eq!(star(&solution).0.pressure, expected, max_relative = 1e-6);
    }
}

#[test]
fn forms_and_fills_vacuum() {
    let hot = |u: f64| gas(1.0, u, 1.0, 1.4);
    let (sound, escape) = (1.4_f64.sqrt(), 5.0 * 1.4_f64.sqrt());
    let split = solve(hot(-7.0), hot(7.0));
    let Middle::Vacuum { left, right } = split.middle() else { panic!("{split:?}") };
    assert_relative_eq!(left, escape - 7.0, max_relative = 1e-14);
    assert_relative_eq!(right, 7.0 - escape, max_relative = 1e-14);
    assert_eq!(split.sample(0.0).origin, Origin::Vacuum);
    assert_eq!(split.sample(-7.0).origin, Origin::Left);
    let jet = solve(hot(0.0), Gas::vacuum(1.4));
    let Some(Wave::Rarefaction { head, tail }) = jet.left_wave() else { panic!("{jet:?}") };
    assert_relative_eq!(head, -sound, max_relative = 1e-14);
    assert_relative_eq!(tail, escape, max_relative = 1e-14);
    assert_eq!(jet.middle(), Middle::Vacuum { left: tail, right: f64::INFINITY });
    assert_eq!(jet.right_wave(), None);
    assert_eq!(jet.sample(escape + 1e-9).origin, Origin::Vacuum);
    assert!(jet.sample(escape - 1e-9).gas.density < 1e-40);
    let empty = solve(Gas::vacuum(1.4), Gas::vacuum(1.4));
    assert_eq!(empty.sample(0.3).origin, Origin::Vacuum);
    let cold = solve(gas(1.0, -1.0, 0.0, 1.4), gas(1.0, 1.0, 0.0, 1.4));
    assert_eq!(cold.middle(), Middle::Vacuum { left: -1.0, right: 1.0 });
    assert_eq!(cold.sample(2.0).gas.density, 1.0);
    assert!(Riemann::new(gas(1.0, 0.0, -1.0, 1.4), hot(0.0)).is_err());
}

#[test]
fn equal_states_stay_and_weak_waves_are_acoustic() {
    let base = gas(2.0, 0.3, 5.0, 1.7);
    let still = solve(base, base);
    for xi in [-9.0, 0.0, 0.3, 1.0, 9.0] {
        let gas = still.sample(xi).gas;
        assert_relative_eq!(gas.pressure, base.pressure, max_relative = 1e-15);
        assert_relative_eq!(gas.velocity, base.velocity, max_relative = 1e-15);
    }
    let push = 1e-7;
    let solution = solve(base, gas(2.0, 0.3, 5.0 * (1.0 + push), 1.7));
    let (left, _) = star(&solution);
    let impedance = 2.0 * base.sound_speed();
    assert_relative_eq!(left.pressure - 5.0, 0.5 * 5.0 * push, max_relative = 1e-6);
    assert_relative_eq!(left.velocity - 0.3, -2.5 * push / impedance, max_relative = 1e-6);
}

/// The waves of a solution with the states ahead of them, seen as right-going ones.
fn waves(solution: &Riemann) -> Vec<(Wave, Gas, f64)> {
    let left = solution.left_wave().map(|wave| (wave.mirrored(), solution.left.gas, -1.0));
    let right = solution.right_wave().map(|wave| (wave, solution.right.gas, 1.0));
    left.into_iter().chain(right).collect()
}

/// Rankine-Hugoniot conditions across shocks, isentropy, the Riemann invariant and `u + c = xi`
/// in fans, and continuity of pressure and velocity across the contact.
fn assert_jumps(solution: &Riemann, tolerance: f64) {
    for (wave, ahead, sign) in waves(solution) {
        let sample = |xi: f64| {
            let gas = solution.sample(sign * xi).gas;
            if sign < 0.0 { gas.mirrored() } else { gas }
        };
        match (wave, solution.middle()) {
            (Wave::Shock { speed }, Middle::Star { left, right }) => {
                let behind = if sign < 0.0 { left.mirrored() } else { right };
                assert!(behind.pressure > ahead.pressure && behind.density > ahead.density);
                let size = behind.velocity.abs() + speed.abs() + behind.sound_speed();
                let scale = [1.0, size, size * size].map(|s| s * behind.density * size);
                let (inflow, outflow) = (ahead.flux(speed), behind.flux(speed));
                assert!(close(inflow, outflow, scale, tolerance), "{inflow:?} {outflow:?}");
            }
            (Wave::Shock { .. }, Middle::Vacuum { .. }) => panic!("shock next to vacuum"),
            (Wave::Rarefaction { head, tail }, _) => {
                let power = 2.0 / (ahead.gamma - 1.0);
                let invariant = ahead.velocity - power * ahead.sound_speed();
                let size = ahead.velocity.abs() + power * ahead.sound_speed();
                for i in 1..8 {
                    let xi = head + (tail - head) * f64::from(i) / 8.0;
                    let gas = sample(xi);
                    if head - tail < 1e-6 * size || gas.density < 1e-200 {
                        continue;
                    }
                    let sound = gas.sound_speed();
                    let entropy = (gas.pressure / ahead.pressure).ln()
                        - ahead.gamma * (gas.density / ahead.density).ln();
                    assert!(entropy.abs() < 1e2 * tolerance, "{entropy}");
                    assert!((gas.velocity + sound - xi).abs() < tolerance * size);
                    assert!((gas.velocity - power * sound - invariant).abs() < tolerance * size);
                }
            }
        }
    }
    if let Middle::Star { left, right } = solution.middle() {
        assert!(left.pressure == right.pressure && left.velocity == right.velocity);
        let (outer, inner) = (solution.left_wave(), solution.right_wave());
        assert!(outer.is_some_and(|w| w.tail() <= left.velocity));
        assert!(inner.is_some_and(|w| w.tail() >= right.velocity));
    }
}

fn side() -> impl Strategy<Value = Gas> {
    (-3.0..3.0_f64, -6.0..6.0_f64, -4.0..4.0_f64, 1.05..3.0_f64)
        .prop_map(|(density, u, p, gamma)| gas(10_f64.powf(density), u, 10_f64.powf(p), gamma))
}

/// Integral of the conserved densities at `t = 1` over `[-size, size]`: Simpson's rule between
/// the edges of the waves.
fn contents(solution: &Riemann, size: f64) -> [f64; 3] {
    let edges = |wave: Option<Wave>| wave.map_or([-size; 2], |w| [w.head(), w.tail()]);
    let middle = match solution.middle() {
        Middle::Star { left, right } => [left.velocity, right.velocity],
        Middle::Vacuum { left, right } => [left, right],
    };
    let mut cuts = [edges(solution.left_wave()), middle, edges(solution.right_wave())].concat();
    cuts.extend([-size, size]);
    cuts.iter_mut().for_each(|cut| *cut = cut.clamp(-size, size));
    cuts.sort_by(f64::total_cmp);
    let mut sum = [0.0; 3];
    let intervals = 800;
    for pair in cuts.windows(2).filter(|pair| pair[1] - pair[0] > 1e-12 * size) {
        let h = (pair[1] - pair[0]) / f64::from(intervals);
        for i in 0..=intervals {
            let inset = f64::from(i).clamp(1e-9, f64::from(intervals) - 1e-9);
            let weight = if i == 0 || i == intervals { 1 } else { 2 + 2 * (i % 2) };
            let value = solution.sample(pair[0] + inset * h).gas.conserved();
            (0..3).for_each(|k| sum[k] += f64::from(weight) * h / 3.0 * value[k]);
        }
    }
    sum
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn obeys_the_wave_relations(left in side(), right in side()) {
        assert_jumps(&solve(left, right), 1e-12);
    }

    #[test]
    fn follows_mirror_and_boost(left in side(), right in side(), boost in -20.0..20.0_f64) {
        let solution = solve(left, right);
        let mirrored = solve(right.mirrored(), left.mirrored());
        let shift = |gas: Gas| Gas { velocity: gas.velocity + boost, ..gas };
        let boosted = solve(shift(left), shift(right));
        let size = 30.0 + left.sound_speed() + right.sound_speed();
        for i in -10..=10 {
            // Off the waves and away from their edges, where rounding may choose the side.
            let xi = f64::from(i) * 0.731 + 0.001;
            let edges = waves(&solution).into_iter()
                .flat_map(|(w, _, sign)| [sign * w.head(), sign * w.tail()]);
            let middle = match solution.middle() {
                Middle::Star { left, .. } => [left.velocity; 2],
                Middle::Vacuum { left, right } => [left, right],
            };
            if edges.chain(middle).any(|edge| (edge - xi).abs() < 1e-9 * size) {
                continue;
            }
            let (a, b, c) = (solution.sample(xi), mirrored.sample(-xi), boosted.sample(xi + boost));
            prop_assert_eq!(a.gas.mirrored().conserved()[0], b.gas.conserved()[0]);
            prop_assert_eq!(a.gas.velocity, -b.gas.velocity);
            prop_assert_eq!(a.origin, c.origin);
            if a.gas.density > 1e-12 {
                prop_assert!((a.gas.pressure / c.gas.pressure).ln().abs() < 1e-6);
                prop_assert!((a.gas.velocity + boost - c.gas.velocity).abs() < 1e-11 * size);
            }
        }
    }

    #[test]
    fn strong_shocks_compress_to_the_limit(target in side(), ratio in 1e8..1e12_f64) {
        let still = Gas { velocity: 0.0, ..target };
        let solution = solve(Gas { pressure: ratio * target.pressure, ..still }, still);
        let limit = (target.gamma + 1.0) / (target.gamma - 1.0);
        let (_, right) = star(&solution);
        let deficit = 2.0 * limit * target.gamma / (target.gamma - 1.0)
            * target.pressure / right.pressure;
        prop_assert!((right.density / target.density - limit).abs() < deficit * 2.0 + 1e-10);
    }

    /// A particle moves with the velocity of the gas where it is, and particles keep their order.
    #[test]
    fn particles_follow_the_flow(
        left in side(), right in side(), label in -3.0..3.0_f64, t in 0.1..2.0_f64,
    ) {
        let solution = solve(left, right);
        let x = |t: f64| solution.position(label, t).unwrap();
        let here = solution.sample(x(t) / t);
        prop_assert_eq!(here.origin, if label < 0.0 { Origin::Left } else { Origin::Right });
        let h = 1e-6 * t;
        let (before, after) = (solution.sample(x(t - h) / (t - h)), solution.sample(x(t + h) / (t + h)));
        let size = 10.0 + left.sound_speed() + right.sound_speed();
        prop_assume!((before.gas.velocity - after.gas.velocity).abs() < 1e-4 * size);
        let velocity = (x(t + h) - x(t - h)) / (2.0 * h);
        prop_assert!((velocity - here.gas.velocity).abs() < 1e-4 * size);
        prop_assert!(solution.position(label + 0.1, t).unwrap() > x(t));
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn conserves_mass_momentum_and_energy(
        left in side(), right in side(), empty in 0..6_u8,
    ) {
        let left = if empty == 0 { Gas::vacuum(1.4) } else { left };
        let right = if empty == 1 { Gas::vacuum(1.4) } else { right };
        let solution = solve(left, right);
        let reach = |wave: Option<Wave>| wave.map_or(0.0, |w| w.head().abs().max(w.tail().abs()));
        let size = 1.0 + reach(solution.left_wave()).max(reach(solution.right_wave()));
        let (a, b, f, g) = (left.conserved(), right.conserved(), left.flux(0.0), right.flux(0.0));
        let expected = [0, 1, 2].map(|k| size * (a[k] + b[k]) + f[k] - g[k]);
        let scale = [1.0, size, size * size]
            .map(|s| s * size * (left.density + right.density));
        let got = contents(&solution, size);
        prop_assert!(close(got, expected, scale, 1e-7), "{:?} {:?} {:?}", got, expected, scale);
    }
}
