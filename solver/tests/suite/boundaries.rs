//! The ends of a chain, and bodies that touch and part.

use whipple_solver::Solver;
use whipple_solver::method::{Density, Integrator, Method, Preset};
use whipple_solver::scene::{Body, Boundary, Interface, Layout, Profile, Scene};

use crate::common::{FREE, IDEAL_GAS, SOLID, after_steps, body, ends, scene, start, with_density};

/// A bar of 40 segments of unit length, nodes at both ends.
fn bar(preset: Preset, left: Boundary, right: Boundary) -> Scene {
    let nodes = Body { layout: Layout::Nodes, ..body(0.0, 1.0, 41) };
    scene(preset.method(), SOLID, ends(left, right), vec![nodes])
}

fn momentum(solver: &dyn Solver) -> f64 {
    solver.ledger().now.momentum
}

/// A pressure on a free bar: momentum is pressure times time, energy is the work of the load.
#[test]
fn pressure_gives_its_impulse_and_its_work() {
    for load in [1e-3, -1e-3] {
        for integrator in [Integrator::SinglePass, Integrator::Compatible] {
            let mut scene = bar(Preset::Default, Boundary::Free, Boundary::Pressure(load));
            scene.method.integrator = integrator;
            let mut solver = start(&scene);
            solver.advance_to(0.7).expect("the bar runs");
            let ledger = solver.ledger();
            let impulse = -load * 0.7;
            assert!((ledger.boundary_impulse / impulse - 1.0).abs() < 1e-12);
            assert!((momentum(solver.as_ref()) / impulse - 1.0).abs() < 1e-12);
            // The end moves at P / (rho c) = P, so that the load works P^2 t.
            assert!((ledger.boundary_work / (load * load * 0.7) - 1.0).abs() < 0.05);
            let gained = ledger.now.kinetic + ledger.now.internal + ledger.strain;
            let share = (gained / ledger.boundary_work - 1.0).abs();
            let tolerance = if integrator == Integrator::Compatible { 1e-12 } else { 0.02 };
            assert!(share < tolerance, "{integrator:?}: {share:e}");
            // What was integrated into the segments is what they hold.
            let strain = (ledger.strain - solver.strain_energy()).abs();
            assert!(strain < 0.01 * ledger.boundary_work, "{strain:e}");
        }
    }
}

/// A held end stays where it is, does no work, and takes the momentum of the load.
#[test]
fn fixed_end_holds() {
    for preset in Preset::ALL {
        let mut solver = start(&bar(preset, Boundary::Fixed, Boundary::Pressure(-1e-3)));
        solver.advance_to(3.0).expect("the bar runs");
        let s = solver.snapshot();
        assert_eq!((s.x[0].to_bits(), s.v[0].to_bits()), (0.0_f64.to_bits(), 0.0_f64.to_bits()));
        let ledger = solver.ledger();
        assert!(ledger.momentum_drift() < 1e-12, "{preset:?}: {:e}", ledger.momentum_drift());
        assert!((ledger.boundary_impulse - 3e-3).abs() > 1e-4, "the reaction is in the ledger");
        if preset == Preset::Default {
            assert!(ledger.energy_drift() < 1e-12);
        }
    }
}

/// A mirror turns a moving gas round: it gives impulse and no energy.
#[test]
fn mirror_gives_impulse_and_no_energy() {
    let gas = Body {
        velocity: Profile::Uniform(-0.2),
        energy: Profile::Uniform(1.0),
        ..body(0.0, 1.0, 50)
    };
    for density in Density::ALL {
        let walls = ends(Boundary::Mirror(0.0), Boundary::Free);
        let scene =
            scene(with_density(Preset::Default, density), IDEAL_GAS, walls, vec![gas.clone()]);
        let solver = after_steps(&scene, 100);
        let (ledger, s) = (solver.ledger(), solver.snapshot());
        assert!(ledger.boundary_impulse > 0.01, "the wall pushes");
        assert_eq!(ledger.boundary_work.to_bits(), 0.0_f64.to_bits());
        assert!(ledger.energy_drift() < 1e-12 && ledger.momentum_drift() < 1e-12);
        assert!(s.x[0] > 0.0, "no particle passes the wall");
    }
}

/// A free end does nothing: a cold body flies on, to the last bit of its velocity.
#[test]
fn free_ends_do_nothing() {
    let flying = Body { velocity: Profile::Uniform(0.25), ..body(0.0, 1.0, 20) };
    for eos in [SOLID, IDEAL_GAS] {
        let mut solver = start(&scene(Preset::Default.method(), eos, FREE, vec![flying.clone()]));
        solver.advance_to(2.0).expect("nothing acts");
        let (s, ledger) = (solver.snapshot(), solver.ledger());
        assert!(s.v.iter().all(|v| (v - 0.25).abs() < 1e-12));
        assert!((s.x[0] - 0.525).abs() < 1e-12);
        assert_eq!(ledger.boundary_impulse.to_bits(), 0.0_f64.to_bits());
    }
}

/// Two blocks at rest beside each other, and one that hits the other.
fn blocks(preset: Preset, density: Density, interface: Interface, speed: f64) -> Scene {
    let first = Body { velocity: Profile::Uniform(speed), ..body(0.0, 1.0, 40) };
    let second = Body { interface, ..body(1.0, 2.0, 40) };
    let method = Method { density, ..preset.method() };
    scene(method, SOLID, FREE, vec![first, second])
}

/// Bodies in contact push, then part and feel nothing of each other; momentum passes from one to
/// the other.
#[test]
fn bodies_in_contact_part() {
    for preset in Preset::ALL {
        for density in [Density::Nonholonomic, Density::Hybrid] {
            let mut solver = start(&blocks(preset, density, Interface::Contact, 1e-3));
            solver.advance_to(6.0).expect("the blocks collide");
            let s = solver.snapshot();
            let mean = |range: std::ops::Range<usize>| s.v[range].iter().sum::<f64>() / 40.0 / 1e-3;
            let gap = s.x[40] - s.x[39];
            assert!(gap > 1.0 / 40.0, "{preset:?} {density:?}: they part, gap {gap}");
            assert!(
                mean(0..40) < 0.1 && mean(40..80) > 0.9,
                "{preset:?} {density:?}: {}",
                mean(0..40)
            );
            assert!(solver.ledger().momentum_drift() < 1e-12);
            let before = mean(40..80);
            solver.advance_to(9.0).expect("the blocks fly on");
            let s = solver.snapshot();
            let after = s.v[40..80].iter().sum::<f64>() / 40.0 / 1e-3;
            assert!((after - before).abs() < 1e-9, "no force across a gap");
        }
    }
}

/// A joined body is pulled along: the same scene as one medium does not part.
#[test]
fn joined_bodies_pull() {
    let mut solver = start(&blocks(Preset::Default, Density::Hybrid, Interface::Joined, -1e-3));
    solver.advance_to(6.0).expect("the bar swings");
    let s = solver.snapshot();
    let speed = s.v[40..80].iter().sum::<f64>() / 40.0;
    assert!(speed < -1e-4, "tension passed the joint: {speed:e}");
    let mut apart = start(&blocks(Preset::Default, Density::Hybrid, Interface::Contact, -1e-3));
    apart.advance_to(6.0).expect("the blocks part");
    assert!(apart.snapshot().v[40..80].iter().all(|v| v.abs() < 1e-12), "contact never pulls");
}

/// A held end is held whatever velocity its body starts with: the wall does no work.
#[test]
fn fixed_end_holds_a_moving_body() {
    let mut scene = bar(Preset::Default, Boundary::Fixed, Boundary::Free);
    scene.bodies[0].velocity = Profile::Uniform(-1e-3);
    let solver = after_steps(&scene, 100);
    let s = solver.snapshot();
    assert_eq!((s.x[0].to_bits(), s.v[0].to_bits()), (0.0_f64.to_bits(), 0.0_f64.to_bits()));
    assert!(solver.ledger().energy_drift() < 1e-12, "{:e}", solver.ledger().energy_drift());
}

/// What is out of reach has no say: a body a hundred lengths away changes nothing of an expanding
/// gas whose surface faces it.
#[test]
fn far_body_changes_nothing() {
    let gas = |bodies| {
        let mut scene = scene(Preset::Default.method(), IDEAL_GAS, FREE, bodies);
        scene.stop_time = 0.1;
        let mut solver = start(&scene);
        solver.advance_to(0.1).expect("an expansion runs");
        solver.snapshot()
    };
    let velocity = Profile::Linear { at_origin: 0.0, slope: 1.0 };
    let near = Body { velocity, energy: Profile::Uniform(1.0), ..body(0.0, 1.0, 50) };
    let far = Body {
        interface: Interface::Contact,
        energy: Profile::Uniform(1.0),
        ..body(100.0, 101.0, 50)
    };
    let (alone, watched) = (gas(vec![near.clone()]), gas(vec![near, far]));
    // The far body votes on the time step as well: what remains is the integrator's.
    for i in 0..50 {
        assert!((alone.u[i] / watched.u[i] - 1.0).abs() < 1e-4, "{i}");
        assert!((alone.v[i] - watched.v[i]).abs() < 1e-4, "{i}");
    }
}

/// A solid in tension between walls: the strain energy of segments to images is counted once, and
/// the ledger closes.
#[test]
fn tension_at_a_wall_is_counted_once() {
    let velocity = Profile::Cosine { mean: 0.0, amplitude: 0.01, mode: 2.0 };
    let solid = Body { velocity, ..body(0.0, 1.0, 32) };
    let walls = ends(Boundary::Mirror(0.0), Boundary::Mirror(1.0));
    let scene = scene(Preset::Default.method(), SOLID, walls, vec![solid]);
    let solver = after_steps(&scene, 400);
    assert!(solver.ledger().strain > 0.0);
    assert!(solver.ledger().energy_drift() < 1e-12, "{:e}", solver.ledger().energy_drift());
    let (work, state) = (solver.ledger().strain, solver.strain_energy());
    assert!((work / state - 1.0).abs() < 0.01, "{work:e} {state:e}");
}
