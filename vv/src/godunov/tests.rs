use super::*;
use crate::exact::Geometry;
use crate::exact::noh::Noh;
use crate::exact::riemann::Riemann;

fn gas(density: f64, velocity: f64, pressure: f64) -> Gas {
    Gas { density, velocity, pressure, gamma: 1.4 }
}

fn domain(start: f64, end: f64, [left, right]: [Boundary; 2]) -> Domain {
    Domain { start, end, left, right, cfl: 0.5 }
}

/// `n` cells on the unit interval, of one state left of `membrane` and another right of it.
fn tube(n: usize, membrane: f64, left: Gas, right: Gas) -> Vec<Gas> {
    (0..n).map(|i| if (i as f64 + 0.5) / (n as f64) < membrane { left } else { right }).collect()
}

/// Computed density error of a tube on the unit interval at `time`, L1 per length.
fn tube_error(n: usize, [left, right]: [Gas; 2], time: f64) -> f64 {
    let cells = tube(n, 0.5, left, right);
    let mut flow = Godunov::new(domain(0.0, 1.0, [Boundary::Outflow; 2]), &cells).unwrap();
    flow.advance_to(time).unwrap();
    assert_eq!(flow.time(), time);
    let exact = Riemann::new(left, right).unwrap();
    let error =
        |(gas, x): (Gas, f64)| (gas.density - exact.sample((x - 0.5) / time).gas.density).abs();
    flow.cells().zip(flow.centres()).map(error).sum::<f64>() / n as f64
}

/// Observed order between 100 and 800 cells.
fn tube_order(states: [Gas; 2], time: f64) -> f64 {
    (tube_error(100, states, time) / tube_error(800, states, time)).log2() / 3.0
}

#[test]
fn shock_tubes_converge() {
    let sod = [gas(1.0, 0.0, 1.0), gas(0.125, 0.0, 0.1)];
    assert!(tube_error(400, sod, 0.2) < 1.5e-3, "{}", tube_error(400, sod, 0.2));
    assert!(tube_order(sod, 0.2) > 0.8, "{}", tube_order(sod, 0.2));
    let expansion = [gas(1.0, -2.0, 0.4), gas(1.0, 2.0, 0.4)];
    assert!(tube_order(expansion, 0.15) > 0.8, "{}", tube_order(expansion, 0.15));
    let strong = [gas(1.0, 0.0, 1000.0), gas(1.0, 0.0, 0.01)];
    assert!(tube_order(strong, 0.012) > 0.7, "{}", tube_order(strong, 0.012));
}

#[test]
fn a_smooth_wave_converges_at_second_order() {
    // An entropy wave, advected once around a tube much longer than the wave.
    let error = |n: usize| {
        let bump = |x: f64| 1.0 + 0.5 * (-((x - 0.35) / 0.08).powi(2)).exp();
        let centre = |i: usize| (i as f64 + 0.5) / n as f64;
        let cells: Vec<Gas> = (0..n).map(|i| gas(bump(centre(i)), 1.0, 1.0)).collect();
        let inflow = Boundary::Inflow(gas(1.0, 1.0, 1.0));
        let mut flow = Godunov::new(domain(0.0, 1.0, [inflow, Boundary::Outflow]), &cells).unwrap();
        flow.advance_to(0.3).unwrap();
        let errors = flow.cells().zip(flow.centres());
        errors.map(|(gas, x)| (gas.density - bump(x - 0.3)).abs()).sum::<f64>() / n as f64
    };
    let order = (error(100) / error(400)).log2() / 2.0;
    assert!(order > 1.8, "{order}");
}

#[test]
fn noh_is_as_sharp_as_a_second_order_code_should_be() {
    let exact = Noh::new(Geometry::Planar, 1.4, 1.0, 1.0).unwrap();
    for (n, pressure) in [(100, 1e-12), (400, 1e-10)] {
        let incoming = gas(1.0, -1.0, pressure);
        let ends = [Boundary::Wall, Boundary::Inflow(incoming)];
        let mut flow = Godunov::new(domain(0.0, 0.5, ends), &vec![incoming; n]).unwrap();
        let before = flow.totals();
        flow.advance_to(0.6).unwrap();
        let wrong: f64 = flow
            .cells()
            .zip(flow.centres())
            .map(|(gas, x)| (gas.velocity - exact.sample(x, 0.6).unwrap().velocity).powi(2))
            .sum();
        assert!(wrong < 0.3, "{wrong} wrong cells");
        let plateau = flow.cells().nth(n / 8).unwrap().density;
        assert!((plateau / 6.0 - 1.0).abs() < 0.01, "{plateau}");
        assert_balance(&flow, before);
    }
}

/// The change of the totals equals what came in, to rounding.
fn assert_balance(flow: &Godunov, before: [f64; 3]) {
    for ((before, now), inflow) in before.into_iter().zip(flow.totals()).zip(flow.inflow()) {
        let scale = before.abs() + now.abs() + inflow.abs();
        assert!((now - before - inflow).abs() < 1e-12 * scale, "{before} {now} {inflow}");
    }
}

#[test]
fn the_balance_closes_at_every_kind_of_boundary() {
    let (left, right) = (gas(1.0, 0.3, 2.0), gas(0.2, -0.1, 0.1));
    let kinds = [Boundary::Wall, Boundary::Outflow, Boundary::Inflow(gas(2.0, 0.5, 3.0))];
    for a in kinds {
        for b in kinds {
            for n in [1, 2, 5, BLOCK - 1, BLOCK, BLOCK + 1, 3 * BLOCK] {
                let cells = tube(n, 0.4, left, right);
                let mut flow = Godunov::new(domain(0.0, 1.0, [a, b]), &cells).unwrap();
                let before = flow.totals();
                flow.advance_to(0.5).unwrap();
                assert_balance(&flow, before);
                assert_eq!(flow.work().cell_steps, flow.work().steps * n as u64);
            }
        }
    }
}

#[test]
fn walls_let_no_mass_and_no_energy_through() {
    let cells = tube(200, 0.3, gas(1.0, 0.0, 100.0), gas(1.0, 0.0, 0.01));
    let mut flow = Godunov::new(domain(0.0, 1.0, [Boundary::Wall; 2]), &cells).unwrap();
    flow.advance_to(0.5).unwrap();
    assert_eq!(flow.inflow()[0], 0.0);
    assert_eq!(flow.inflow()[2], 0.0);
}

#[test]
fn symmetric_problems_stay_symmetric() {
    let mut cells = tube(300, 0.2, gas(1.0, 0.5, 50.0), gas(0.5, 0.0, 0.02));
    for i in 150..300 {
        cells[i] = cells[299 - i].mirrored();
    }
    let mut flow = Godunov::new(domain(-1.0, 1.0, [Boundary::Wall; 2]), &cells).unwrap();
    flow.advance_to(0.6).unwrap();
    let states: Vec<Gas> = flow.cells().collect();
    for (a, b) in states.iter().zip(states.iter().rev()) {
        assert!((a.density - b.density).abs() < 1e-10 * a.density);
        assert!((a.velocity + b.velocity).abs() < 1e-10);
    }
}

#[test]
fn the_expansion_stays_positive_without_the_floor() {
    for speed in [2.0, 4.0] {
        let cells = tube(200, 0.5, gas(1.0, -speed, 0.4), gas(1.0, speed, 0.4));
        let mut flow = Godunov::new(domain(0.0, 1.0, [Boundary::Outflow; 2]), &cells).unwrap();
        flow.advance_to(0.6 / (speed + 1.0)).unwrap();
        assert!(flow.cells().all(|gas| gas.density > 0.0 && gas.energy() > 0.0));
        assert_eq!(flow.work().floored, 0);
    }
}

/// Woodward and Colella's blast waves. Until the rarefaction from the left wall catches the left
/// shock, at about `t = 0.012`, the inner part consists of two exact Riemann solutions.
#[test]
fn the_interacting_blast_waves_run() {
    let (hot, cold, warm) = (gas(1.0, 0.0, 1000.0), gas(1.0, 0.0, 0.01), gas(1.0, 0.0, 100.0));
    let mut cells = tube(400, 0.1, hot, cold);
    cells[360..].fill(warm);
    let mut flow = Godunov::new(domain(0.0, 1.0, [Boundary::Wall; 2]), &cells).unwrap();
    let before = flow.totals();
    let early = 0.01;
    flow.advance_to(early).unwrap();
    let (left, right) = (Riemann::new(hot, cold).unwrap(), Riemann::new(cold, warm).unwrap());
    let exact = |x: f64| match x {
        x if x < 0.6 => left.sample((x - 0.1) / early).gas.density,
        x => right.sample((x - 0.9) / early).gas.density,
    };
    let inner = flow.cells().zip(flow.centres()).filter(|(_, x)| (0.27..0.84).contains(x));
    let error: f64 = inner.map(|(gas, x)| (gas.density - exact(x)).abs()).sum();
    assert!(error / 400.0 < 0.1, "{}", error / 400.0);
    flow.advance_to(0.038).unwrap();
    assert_balance(&flow, before);
    let highest = |max: Gas, gas: Gas| if gas.density > max.density { gas } else { max };
    let peak = flow.cells().fold(Gas::vacuum(1.4), highest).density;
    let place = flow.cells().zip(flow.centres()).find(|(gas, _)| gas.density == peak).unwrap().1;
    assert!((5.2..6.6).contains(&peak) && (0.75..0.80).contains(&place), "{peak} at {place}");
    assert_eq!(flow.work().floored, 0);
}

#[test]
fn refuses_what_it_cannot_compute() {
    let fine = domain(0.0, 1.0, [Boundary::Wall; 2]);
    let one = gas(1.0, 0.0, 1.0);
    let refusal = |domain: Domain, cells: &[Gas]| Godunov::new(domain, cells).err();
    assert_eq!(refusal(fine, &[]), Some(GodunovError::NoCells));
    assert!(refusal(Domain { cfl: 1.0, ..fine }, &[one]).is_some());
    assert!(refusal(Domain { end: 0.0, ..fine }, &[one]).is_some());
    assert!(refusal(fine, &[Gas { pressure: 0.0, ..one }]).is_some());
    let other = Gas { gamma: 1.6, ..one };
    let mixed = GodunovError::MixedGamma { expected: 1.4, found: 1.6 };
    assert_eq!(refusal(fine, &[one, other]), Some(mixed));
    assert_eq!(refusal(Domain { left: Boundary::Inflow(other), ..fine }, &[one]), Some(mixed));
    let mut flow = Godunov::new(fine, &[one]).unwrap();
    assert!(flow.advance_to(f64::NAN).is_err() && flow.advance_to(-1.0).is_err());
    assert!(mixed.to_string().contains("1.6"));
}
