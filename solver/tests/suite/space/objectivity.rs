//! Rigid motion strains nothing, and a turned scene is the same scene.

use whipple_solver::space::lattice::rotation;
use whipple_solver::space::scene::{Body, Scene, Turn};

use super::reference::{norm, sub};
use super::scenes::{after, block, march, scene, start, steel, strong, tungsten};

/// Not a bit moves in the frame of a body that translates.
#[test]
fn translation_is_exactly_free_of_force() {
    let turn = Turn { axis: [1.0, 2.0, -0.5], degrees: 33.0 };
    let body = Body { velocity: [0.3, -0.1, 0.7], turn, ..block("steel", [9, 4, 5], 0.13) };
    let mut simulation = start(&scene(vec![steel()], vec![body]));
    simulation.keep_awake();
    march(&mut simulation, 100);
    for p in simulation.all_particles() {
        assert_eq!(simulation.displacement(p.id as usize), [0.0; 3]);
    }
    assert!(simulation.all_elements().all(|e| e.equivalent_stress == 0.0));
}

/// One turn of an elastic block: the energy stays, the angular momentum too, and the stress is that
/// of the centrifugal force, not of the turn.
#[test]
fn one_turn_of_a_block() {
    let omega = 0.02;
    let elastic = strong(steel(), 0.801, None);
    let body = Body { spin: [0.0, 0.0, omega], ..block("steel", [6, 4, 4], 0.1) };
    let mut simulation = start(&scene(vec![elastic], vec![body]));
    simulation.advance_to(2.0 * std::f64::consts::PI / omega).expect("a turn");
    let b = simulation.balance();
    let stress = simulation.all_elements().map(|e| e.equivalent_stress).fold(0.0, f64::max);
    let energy = b.now.energy() / b.initial.energy() - 1.0;
    let centrifugal = 7.87 * (omega * 0.3).powi(2);
    println!(
        "energy {energy:.1e}, angular {:.1e}, stress over rho v^2 {:.2}, {} steps",
        b.angular_drift(),
        stress / centrifugal,
        simulation.counters().steps
    );
    assert!(energy.abs() < 1e-4 && b.angular_drift() < 1e-12);
    assert!(b.relative_residual().abs() < 1e-4);
    assert!(stress < 3.0 * centrifugal);
}

/// Two blocks that collide.
fn collision() -> Scene {
    let fast = Body { velocity: [0.06, -0.02, 0.01], ..block("tungsten", [6, 5, 4], 0.1) };
    let slow = Body { centre: [0.83, 0.06, 0.03], ..block("steel", [5, 7, 6], 0.1) };
    scene(vec![tungsten(), steel()], vec![fast, slow])
}

#[test]
fn a_turned_scene_is_the_same_scene() {
    let (axis, degrees) = ([0.3, -0.5, 0.8], 71.0);
    let turned = rotation(axis, f64::to_radians(degrees));
    let rotate = |v: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|d| (0..3).map(|k| v[k] * turned[k][d]).sum())
    };
    let straight = collision();
    let mut other = straight.clone();
    for body in &mut other.bodies {
        body.centre = rotate(body.centre);
        body.velocity = rotate(body.velocity);
        body.turn = Turn { axis, degrees };
    }
    let (a, b) = (after(&straight, 80), after(&other, 80));
    let length = a.sizes(0).0;
    let apart = a.all_particles().zip(b.all_particles()).map(|(p, q)| {
        assert_eq!(p.id, q.id);
        norm(sub(rotate(p.position), q.position)) / length
    });
    let apart = apart.fold(0.0, f64::max);
    let (h, g) = (a.holdings(), b.holdings());
    println!("apart {apart:.1e} lengths after 80 steps; failed {:?}", a.failed());
    assert!(h[1].momentum[0] > 0.0, "they meet");
    assert!(apart < 1e-7);
    assert!((h[0].kinetic / g[0].kinetic - 1.0).abs() < 1e-7);
}
