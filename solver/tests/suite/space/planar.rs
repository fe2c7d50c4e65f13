//! A plane shock in copper behind a wall, on the Hugoniot.

use whipple_solver::space::scene::{Body, Side};

use super::scenes::{block, copper, mirror, scene, start};

#[test]
fn a_shock_has_the_pressure_of_the_hugoniot() {
    let (n, lateral, a, up) = (20, 3, 0.1, 0.05);
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
    let front = (us - up) * time;
    let behind = 5.0 * a..front - 5.0 * a;
    let of = |p: &whipple_solver::space::output::Particle| behind.contains(&p.position[0]);
    let pressures: Vec<f64> = simulation.all_particles().filter(of).map(|p| p.pressure).collect();
    let mean = pressures.iter().sum::<f64>() / pressures.len() as f64;
    let error = mean / (8.93 * us * up) - 1.0;
    println!("pressure {:+.2} % of {} particles", 100.0 * error, pressures.len());
    assert!(error.abs() < 0.01 && pressures.len() > 50);
    assert_eq!(simulation.failed(), (0, 0));
}
