//! Gases: elements that live on however they are deformed, and densities without a floor.

use whipple_solver::error::StepError;
use whipple_solver::method::Viscosity;
use whipple_solver::space::Simulation;
use whipple_solver::space::restart::{Section, Values};
use whipple_solver::space::scene::{Body, Side};

use super::scenes::{block, copper, gas, march, mirror, scene, start};

/// Changes a section of numbers.
fn change(sections: &mut [Section], name: &str, with: impl FnOnce(&mut [f64])) {
    let section = sections.iter_mut().find(|section| section.name == name).expect("that section");
    let Values::F64(values) = &mut section.values else { panic!("{name} holds no numbers") };
    with(values);
}

/// Least density over all particles, over a reference density.
fn thinnest(simulation: &Simulation, rho_0: f64) -> f64 {
    simulation.all_particles().map(|p| p.rho / rho_0).fold(f64::INFINITY, f64::min)
}

/// Where a dead element's centroid lies on one of its corners, as in a corner of mirrors, the bonds
/// of the element have no direction.
#[test]
fn a_centroid_on_a_corner_of_its_dead_element() {
    for viscosity in [Viscosity::Limited, Viscosity::Pairwise] {
        let body = Body { energy: 1.0, ..block("gas", [2, 2, 2], 1.0) };
        let mut scene = scene(vec![gas()], vec![body]);
        scene.method.viscosity = viscosity;
        let mut simulation = start(&scene);
        let dead = simulation.all_elements().next().expect("an element");
        let mut sections = simulation.sections();
        for section in &mut sections {
            if let ("group.live", Values::U8(live)) = (section.name.as_str(), &mut section.values) {
                live[0] &= !1;
            }
        }
        let centre = dead.centre as usize;
        change(&mut sections, "mesh.ratio", |ratio| ratio[centre] = 0.0);
        let corner = simulation.particle(dead.corners[0]).position;
        let own = simulation.particle(dead.centre).position;
        for (d, name) in ["state.dx", "state.dy", "state.dz"].into_iter().enumerate() {
            change(&mut sections, name, |column| column[centre] = corner[d] - own[d]);
        }
        simulation.restore(&sections).expect("sections of its own");
        assert_eq!(simulation.particle(dead.centre).position, corner);
        march(&mut simulation, 3);
        assert!(simulation.all_particles().all(|p| p.u.is_finite() && p.rho > 0.0));
    }
}

/// A hot block of gas flies apart: its density falls with its volume, far below any of a solid, and
/// its elements stay volumes.
#[test]
fn gas_thins_without_a_floor() {
    let body = Body { energy: 1.0, ..block("gas", [4, 4, 4], 0.25) };
    let mut scene = scene(vec![gas()], vec![body]);
    scene.method.hourglass = 1.0;
    let mut simulation = start(&scene);
    march(&mut simulation, 400);
    let least = thinnest(&simulation, 1.0);
    println!("t = {}: least density {least:.2e}", simulation.time());
    assert!(least < 0.05, "{least}");
    assert_eq!(simulation.counters().floored, 0);
    assert_eq!(simulation.failed(), (0, 0));
    assert!(simulation.balance().energy_drift() < 1e-12);
}

/// A density that no volume of a live cell can have is held at the greatest one, and counted.
#[test]
fn a_density_without_volume_is_held_and_counted() {
    let scene = scene(vec![gas()], vec![Body { energy: 1.0, ..block("gas", [4, 4, 4], 0.25) }]);
    let mut simulation = start(&scene);
    march(&mut simulation, 3);
    assert_eq!(simulation.counters().packed, 0);
    let mut sections = simulation.sections();
    change(&mut sections, "state.rho", |column| column[0] = 1e12);
    simulation.restore(&sections).expect("sections of its own");
    march(&mut simulation, 3);
    let densest = simulation.all_particles().map(|p| p.rho).fold(0.0, f64::max);
    assert!(simulation.counters().packed > 0 && densest <= 2000.0, "{densest}");
}

/// What is no number ends the step that meets it, densities too, which have bounds.
#[test]
fn what_is_no_number_is_told() {
    for (name, value) in [
        ("state.rho", f64::NAN),
        ("state.rho", f64::INFINITY),
        ("state.u", f64::NAN),
        ("state.vx", f64::NAN),
    ] {
        // Material at rest is not looked at.
        let body = Body { noise: 1e-6, ..block("copper", [4, 4, 4], 0.25) };
        let mut simulation = start(&scene(vec![copper()], vec![body]));
        march(&mut simulation, 3);
        let mut sections = simulation.sections();
        change(&mut sections, name, |column| column[0] = value);
        simulation.restore(&sections).expect("sections of its own");
        let told = simulation.step(f64::INFINITY).expect_err("no number");
        assert!(matches!(told, StepError::NotFinite { .. }), "{name} {value}: {told}");
    }
}

/// What the least density of a solid holds is counted.
#[test]
fn the_floor_of_a_solid_is_counted() {
    let body = Body { energy: 4.0, ..block("copper", [4, 4, 4], 0.25) };
    let mut simulation = start(&scene(vec![copper()], vec![body]));
    march(&mut simulation, 2000);
    let least = thinnest(&simulation, 8.93);
    println!("t = {}: least density {least:.2}", simulation.time());
    assert!((least - 0.3).abs() < 1e-9, "{least}");
    assert!(simulation.counters().floored > 0);
}

/// A first step that nothing limits, in cold gas, says nothing of how short a step may be: only a billionth of the
/// run does.
#[test]
fn cold_gas_may_step_shorter_than_a_millionth_of_the_run() {
    let body = Body { energy: 1e-6, velocity: [-1.0, 0.0, 0.0], ..block("gas", [8, 2, 2], 0.25) };
    let mut scene = scene(vec![gas()], vec![body]);
    scene.walls.push(mirror(0, -1.0, Side::Above));
    scene.stop_time = 1e5;
    let mut simulation = start(&scene);
    // As cases look soon after the start, from where the wave is known.
    simulation.advance_to(1e-2).expect("the first step");
    for _ in 0..20 {
        simulation.step(scene.stop_time).expect("a step of the run");
    }
    assert!(simulation.last_step() < 1e-6 * scene.stop_time, "{}", simulation.last_step());
}
