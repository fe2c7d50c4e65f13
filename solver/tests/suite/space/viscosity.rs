//! The printed viscosity (51)-(53) of the `paper` preset.

use whipple_solver::method::Preset;
use whipple_solver::space::scene::Body;

use super::scenes::{block, copper, march, scene, start};

/// Viscous force between two cells that run into each other, with particles of this energy.
fn viscous_force(energy: f64) -> f64 {
    let pushed = |visc_linear: f64| {
        let left = Body { energy, velocity: [0.01, 0.0, 0.0], ..block("copper", [1, 1, 1], 0.1) };
        let right = Body { centre: [0.15, 0.0, 0.0], velocity: [0.0; 3], ..left.clone() };
        let mut scene = scene(vec![copper()], vec![left, right]);
        scene.method = Preset::Paper.space();
        scene.method.visc_linear = visc_linear;
        scene.method.heat_coeff = 0.0;
        let mut simulation = start(&scene);
        march(&mut simulation, 1);
        // The first kick is half a step.
        simulation.holdings()[1].momentum[0] / (0.5 * simulation.last_step())
    };
    pushed(0.3) - pushed(0.0)
}

/// Its sound speed is that of the reference state (gap G17): the force does not depend on the pressure.
#[test]
fn printed_viscosity_has_the_reference_sound_speed() {
    let [cold, hot] = [0.0, 0.02].map(viscous_force);
    println!("viscous force {cold:.4e} {hot:.4e}");
    assert!(cold > 0.0 && (hot / cold - 1.0).abs() < 1e-9, "{cold} {hot}");
}
