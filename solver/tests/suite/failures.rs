//! Numerical failures: each is found in the step that makes it, named, and leaves the state before.

use whipple_solver::error::StepError;
use whipple_solver::method::{Conduction, Density, Method, Preset};
use whipple_solver::scene::{Body, EosData, Profile, Scene};

use crate::common::{FREE, IDEAL_GAS, PAPER_GAS, bits, body, ideal, scene, start};

/// The failure of a scene, after checking what holds for every failure: the state is that before
/// the step, it is finite, and trying again fails again in the same way.
fn failure(scene: &Scene) -> StepError {
    let mut solver = start(scene);
    for _ in 0..100_000 {
        let (time, before, counters) = (solver.time(), bits(&solver.snapshot()), solver.counters());
        let ledger = *solver.ledger();
        let Err(error) = solver.step(scene.stop_time) else {
            assert!(solver.time() < scene.stop_time, "the scene runs through");
            continue;
        };
        assert_eq!(solver.time().to_bits(), time.to_bits());
        let s = solver.snapshot();
        assert_eq!(bits(&s), before, "the state is the one before the step");
        assert_eq!((counters.steps, ledger), (solver.counters().steps, *solver.ledger()));
        let columns = [&s.x, &s.v, &s.rho, &s.u];
        assert!(columns.into_iter().flatten().all(|value| value.is_finite()));
        assert_eq!(solver.step(scene.stop_time).map_err(|e| e.kind()), Err(error.kind()));
        assert!(error.to_string().contains("t = "), "{error}");
        return error;
    }
    panic!("no failure in 100000 steps");
}

/// Two streams of cold gas that meet at x = 0.
fn streams(method: Method, eos: EosData, u: f64, boost: f64) -> Scene {
    let stream = |from, to, v| Body {
        velocity: Profile::Uniform(v + boost),
        energy: Profile::Uniform(u),
        ..body(from, to, 20)
    };
    scene(method, eos, FREE, vec![stream(-0.5, 0.0, 1.0), stream(0.0, 0.5, -1.0)])
}

/// The printed heating depends on the frame: in a moving one it cools a particle at the contact
/// below what its gas can represent.
#[test]
fn printed_heating_in_a_moving_frame() {
    match failure(&streams(Preset::Paper.method(), PAPER_GAS, 1.0, 100.0)) {
        StepError::Energy { particle, time, value, floor } => {
            assert!((19..=20).contains(&particle), "at the contact: {particle}");
            assert!(time > 0.0 && time < 0.1 && value < floor && value.is_finite());
        }
        other => panic!("{other}"),
    }
    let mut still = start(&streams(Preset::Paper.method(), PAPER_GAS, 1.0, 0.0));
    still.advance_to(0.1).expect("at rest the same scene runs");
}

/// Cold streams without viscosity: nothing holds them apart. Steps that never reach the meeting
/// shrink until they are refused; one that reaches it is refused for that.
#[test]
fn nothing_between_cold_streams() {
    let with = |cfl| streams(Method { cfl, ..ideal(Density::Hybrid) }, IDEAL_GAS, 0.0, 0.0);
    match failure(&with(0.5)) {
        StepError::TimeStep { particle, time, value, floor, limiter } => {
            assert_eq!((particle, limiter), (19, "closing speed"));
            assert!(value < floor && (time - 0.0125).abs() < 1e-6, "{time}");
        }
        other => panic!("{other}"),
    }
    match failure(&with(1.0)) {
        StepError::Crossed { particle, next, time, value } => {
            assert_eq!((particle, next), (19, 20));
            assert!(value <= 0.0 && (time - 0.0125).abs() < 1e-6, "{time}");
        }
        other => panic!("{other}"),
    }
}

/// More neighbours within zeta < 1 than a particle can have.
#[test]
fn too_many_neighbours_in_range() {
    let squeezed =
        Body { compression: 100.0, energy: Profile::Uniform(1.0), ..body(0.0, 1.0, 200) };
    match failure(&scene(Preset::Paper.method(), PAPER_GAS, FREE, vec![squeezed])) {
        StepError::Neighbours { particle, time, room } => {
            assert_eq!((particle, room), (0, 63));
            assert_eq!(time.to_bits(), 0.0_f64.to_bits());
        }
        other => panic!("{other}"),
    }
}

/// Numbers that leave the range of a double.
#[test]
fn positions_that_overflow() {
    let solid = EosData::Linear { bulk: 1.0, c_v: 1.0, theta_0: 0.0 };
    let flying = Body { velocity: Profile::Uniform(1e308), ..body(0.0, 1e4, 10) };
    let method = Method { conduction: Conduction::None, ..Preset::Default.method() };
    let mut scene = scene(method, solid, FREE, vec![flying]);
    scene.stop_time = 1e6;
    match failure(&scene) {
        StepError::NotFinite { quantity, particle, time, value } => {
            assert_eq!((quantity, particle), ("position", 0));
            assert!(time > 0.0 && time.is_finite() && !value.is_finite());
        }
        other => panic!("{other}"),
    }
}

/// Every kind has a name of its own, and says particle, value and time.
#[test]
fn messages_say_who_what_when() {
    let (particle, time, value, floor) = (7, 0.25, -1.5, 0.0);
    let errors = [
        StepError::NotFinite { quantity: "velocity", particle, time, value: f64::NAN },
        StepError::Density { particle, time, value },
        StepError::Energy { particle, time, value, floor },
        StepError::Crossed { particle, next: 8, time, value },
        StepError::TimeStep { particle, time, value: 1e-15, floor: 1e-12, limiter: "sound" },
        StepError::Neighbours { particle, time, room: 63 },
    ];
    let near = (1.0 - 4e-9, 1.0);
    let told = StepError::Energy { particle, time, value: near.0, floor: near.1 }.to_string();
    assert!(
        told.contains(" is 9.99999996e-1 at ") && told.contains(" floor 1.00000000e0 of"),
        "{told}"
    );
    let next =
        StepError::Energy { particle, time, value: 1.0f64.next_down(), floor: 1.0 }.to_string();
    assert!(next.contains(" is 9.999999999999999e-1 at "), "{next}");
    let text = errors.map(|e| format!("{}: {e}", e.kind())).join("\n");
    insta::assert_snapshot!(text, @r"
    not finite: velocity of particle 7 is NaN at t = 2.500000e-1
    density: density of particle 7 is -1.500e0 at t = 2.500000e-1: must be positive
    internal energy: internal energy of particle 7 is -1.500e0 at t = 2.500000e-1, below the floor 0.000e0 of its equation of state
    particles crossed: particles 7 and 8 crossed at t = 2.500000e-1: separation -1.500e0
    time step collapsed: time step 1.000e-15 at t = 2.500000e-1 is below 1.000e-12: limited by sound at particle 7
    too many neighbours: particle 7 has more neighbours in range than there is room for at t = 2.500000e-1 (63 on a side, or the images of a wall): the compression is too strong for pairs in contact range
    ");
}
