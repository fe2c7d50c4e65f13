//! The same bits: any number of threads, any instructions, with and without what is at rest.

use whipple_solver::space::Scene;
use whipple_solver::space::dispatch::Instructions;
use whipple_solver::space::scene::{Body, Failure, Side};

use super::scenes::{bits, block, march, mirror, rod, scene, start, steel};

fn on_threads(scene: &Scene, threads: usize, steps: usize) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let mut simulation = start(scene);
        march(&mut simulation, steps);
        bits(&simulation)
    })
}

#[test]
fn any_number_of_threads() {
    let scene = rod(5, 40, [30, 5, 20]);
    let one = on_threads(&scene, 1, 60);
    for threads in [2, 8] {
        assert!(on_threads(&scene, threads, 60) == one, "{threads} threads");
    }
}

#[test]
fn any_instructions() {
    let scene = rod(5, 40, [30, 5, 20]);
    let with = |instructions| {
        let mut simulation = start(&scene);
        simulation.compute_with(instructions);
        march(&mut simulation, 60);
        bits(&simulation)
    };
    let all: Vec<_> = Instructions::available().map(with).collect();
    assert!(all.iter().all(|bits| *bits == all[0]));
}

/// Steps both ways; the counts of particle updates.
fn skipping(scene: &Scene, steps: usize) -> [u64; 2] {
    let mut lazy = start(scene);
    let mut busy = start(scene);
    busy.keep_awake();
    for step in 0..steps {
        march(&mut lazy, 1);
        march(&mut busy, 1);
        assert!(bits(&lazy) == bits(&busy), "step {step}");
    }
    assert_eq!(busy.counters().particle_steps, (busy.particles() * steps) as u64);
    [lazy.counters().particle_steps, busy.counters().particle_steps]
}

/// Material at rest in the frame of its body costs nothing and counts for nothing.
#[test]
fn what_rests_is_skipped_without_a_trace() {
    let mut scene = rod(5, 60, [60, 5, 40]);
    scene.bodies[1].velocity = [0.03, -0.02, 0.01];
    let [lazy, busy] = skipping(&scene, 20);
    println!("{lazy} updates instead of {busy}");
    assert!(lazy < busy * 5 / 6);
}

/// A body that leaves its plane of symmetry is pulled at once.
#[test]
fn walls_wake_what_they_hold() {
    let body = Body {
        centre: [0.4, 0.0, 0.0],
        velocity: [0.01, 0.0, 0.0],
        ..block("steel", [8, 4, 4], 0.1)
    };
    let mut pulled = scene(vec![steel()], vec![body]);
    pulled.walls.push(mirror(0, 0.0, Side::Above));
    skipping(&pulled, 30);
    let mut simulation = start(&pulled);
    march(&mut simulation, 30);
    let held = simulation.all_particles().filter(|p| p.position[0].abs() < 1e-12).count();
    assert_eq!(held, 25, "the nodes of one plane stay on it");
}

/// The unit of mass changes nothing: densities below one are densities.
#[test]
fn any_unit_of_density() {
    let steps = |unit: f64| {
        let mut scene = rod(4, 16, [16, 4, 8]);
        for material in &mut scene.materials {
            material.density *= unit;
            material.failure = Failure::default();
            material.strength = None;
        }
        let mut simulation = start(&scene);
        march(&mut simulation, 20);
        (simulation.time(), simulation.counters().particle_steps)
    };
    let (whole, small) = (steps(1.0), steps(1.0 / 1024.0));
    assert!((whole.0 / small.0 - 1.0).abs() < 1e-9 && whole.1 == small.1, "{whole:?} {small:?}");
}

/// At a time that is reached there is no step: not of length zero, and not back.
#[test]
fn a_time_that_is_reached_is_no_step() {
    let mut simulation = start(&rod(5, 10, [12, 5, 8]));
    for reached in [0.0, 0.5] {
        simulation.advance_to(reached).expect("the rod runs");
        let before = (bits(&simulation), simulation.counters(), simulation.last_step().to_bits());
        for until in [reached, 0.5 * reached, -1.0, f64::NEG_INFINITY] {
            simulation.step(until).expect("nothing can fail");
            assert_eq!(simulation.time().to_bits(), reached.to_bits());
        }
        let after = (bits(&simulation), simulation.counters(), simulation.last_step().to_bits());
        assert_eq!(before, after);
    }
    simulation.step(1.0).expect("it goes on");
    assert!(simulation.time() > 0.5 && simulation.balance().energy_drift() < 1e-12);
}
