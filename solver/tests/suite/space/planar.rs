//! Plane shocks in copper, behind a wall and between two bodies, on the Hugoniot.

use std::ops::Range;

use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Body, Side};

use super::scenes::{block, copper, mirror, scene, start};

/// A column of copper of this many cells of a tenth that has run into a mirror at this speed until the shock has gone
/// through three quarters of it, the pressure of the Hugoniot, and where the front is.
fn shocked(n: usize, up: f64) -> (Simulation, f64, f64) {
    let (lateral, a) = (3, 0.1);
    let us = 0.394 + 1.489 * up;
    let [l, w] = [n, lateral].map(|n| n as f64 * a);
    let body = Body {
        centre: [0.5 * l, 0.0, 0.0],
        velocity: [-up, 0.0, 0.0],
        noise: 0.005 * up,
        ..block("copper", [n, lateral, lateral], a)
    };
    let mut scene = scene(vec![copper()], vec![body]);
    scene.walls.push(mirror(0, 0.0, Side::Above));
    for axis in 1..3 {
        scene.walls.push(mirror(axis, -0.5 * w, Side::Above));
        scene.walls.push(mirror(axis, 0.5 * w, Side::Below));
    }
    let mut simulation = start(&scene);
    let time = 0.75 * l / us;
    simulation.advance_to(time).expect("the shock runs");
    (simulation, 8.93 * us * up, (us - up) * time)
}

/// Mean pressure of the particles between two planes, and their number.
fn between(simulation: &Simulation, planes: Range<f64>) -> (f64, usize) {
    let of = |p: &Particle| planes.contains(&p.position[0]);
    let pressures: Vec<f64> = simulation.all_particles().filter(of).map(|p| p.pressure).collect();
    (pressures.iter().sum::<f64>() / pressures.len() as f64, pressures.len())
}

#[test]
fn a_shock_has_the_pressure_of_the_hugoniot() {
    let (simulation, wanted, front) = shocked(20, 0.05);
    let (mean, particles) = between(&simulation, 0.5..front - 0.5);
    let error = mean / wanted - 1.0;
    println!("pressure {:+.2} % of {particles} particles", 100.0 * error);
    assert!(error.abs() < 0.01 && particles > 50);
    assert_eq!(simulation.failed(), (0, 0));
}

/// What a mirror stops in the first step has moved for half of it: densities are those of the volumes, there too.
#[test]
fn a_mirror_leaves_no_trace_in_the_pressure() {
    let (simulation, wanted, _) = shocked(20, 0.2);
    let (mean, particles) = between(&simulation, -0.01..0.01);
    let error = mean / wanted - 1.0;
    println!("pressure {:+.2} % of {particles} particles at the mirror", 100.0 * error);
    assert!(error.abs() < 0.01 && particles == 16);
}

/// Without strength nothing but the contact keeps their surfaces flat (decision 0016).
#[test]
fn pressed_surfaces_stay_flat() {
    let (n, lateral, a, speed) = (24, 4, 0.1, 0.4);
    let l = n as f64 * a;
    let w = lateral as f64 * a;
    let body = |centre: f64, velocity: f64| Body {
        centre: [centre, 0.0, 0.0],
        velocity: [velocity, 0.0, 0.0],
        noise: 0.0025 * speed,
        ..block("copper", [n, lateral, lateral], a)
    };
    let bodies = vec![body(-0.5 * l - a, speed), body(0.5 * l, 0.0)];
    let mut scene = scene(vec![copper()], bodies);
    for axis in 1..3 {
        scene.walls.push(mirror(axis, -0.5 * w, Side::Above));
        scene.walls.push(mirror(axis, 0.5 * w, Side::Below));
    }
    let mut simulation = start(&scene);
    let at_surface = |p: &Particle| p.body == 1 && p.position[0].abs() < 1e-9;
    let surface: Vec<u32> = simulation.all_particles().filter(at_surface).map(|p| p.id).collect();
    assert_eq!(surface.len(), (lateral + 1) * (lateral + 1));
    let us = 0.394 + 1.489 * 0.5 * speed;
    simulation.advance_to(l / us).expect("the shock runs");
    let places: Vec<f64> = surface.iter().map(|&i| simulation.particle(i).position[0]).collect();
    let mean = places.iter().sum::<f64>() / places.len() as f64;
    let height = places.iter().map(|x| (x - mean).abs()).fold(0.0, f64::max);
    println!("height {:.1e} cells", height / a);
    assert!(height < 0.01 * a);
    assert_eq!(simulation.failed(), (0, 0));
}
