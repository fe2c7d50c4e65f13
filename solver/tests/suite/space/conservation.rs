//! What no run may lose: mass, momentum, angular momentum and energy.

use whipple_solver::space::Simulation;
use whipple_solver::space::scene::{Body, Hold, Side, Wall};

use super::scenes::{after, block, copper, rod, scene, steel, tungsten};

/// Prints and bounds what a run has lost: momentum, angular momentum, energy, and the residual of the
/// elements.
fn lost(simulation: &Simulation, [momentum, angular, energy, residual]: [f64; 4]) {
    let b = simulation.balance();
    let (p, l, e) = (b.momentum_drift(), b.angular_drift(), b.energy_drift());
    let r = b.relative_residual();
    println!("momentum {p:.1e} angular {l:.1e} energy {e:.1e} residual {r:.1e}");
    println!("steps {} failed, dead {:?}", simulation.counters().steps, simulation.failed());
    assert!(p <= momentum && l <= angular && e <= energy && r.abs() <= residual);
    assert!(b.mass_error() <= 1e-15);
}

#[test]
fn colliding_fluid() {
    let fast = Body { velocity: [0.05, 0.01, 0.0], ..block("copper", [8, 5, 4], 0.1) };
    let slow = Body { centre: [0.83, 0.12, 0.07], ..block("copper", [8, 5, 4], 0.1) };
    let simulation = after(&scene(vec![copper()], vec![fast, slow]), 150);
    assert!(simulation.holdings()[1].momentum[0] > 0.0, "they meet");
    lost(&simulation, [1e-13, 1e-12, 1e-13, 1e-2]);
}

#[test]
fn rod_on_a_plate() {
    let simulation = after(&rod(4, 16, [14, 4, 8]), 250);
    assert!(simulation.failed().1 > 5, "elements die");
    lost(&simulation, [1e-13, 1e-12, 1e-12, 1e-2]);
}

/// Walls give impulse, its moment and, since they rest, no work beyond round-off.
#[test]
fn blocks_at_walls() {
    for hold in [Hold::Rest, Hold::Mirror] {
        let body = Body {
            centre: [0.4, 0.9, 0.3],
            velocity: [-0.05, 0.01, 0.0],
            spin: [0.0, 0.0, 0.01],
            ..block("steel", [8, 5, 4], 0.1)
        };
        let mut scene = scene(vec![steel()], vec![body]);
        scene.walls.push(Wall { axis: 0, position: 0.0, material: Side::Above, hold });
        let simulation = after(&scene, 150);
        let given = simulation.balance().wall_impulse;
        assert!(given[0] > 0.0 && given[1] == 0.0 && given[2] == 0.0, "{given:?}");
        lost(&simulation, [1e-13, 1e-12, 1e-12, 1e-2]);
        for p in simulation.all_particles() {
            assert!(p.position[0] >= -1e-12, "{hold:?}: {p:?}");
        }
    }
}

/// Pairs of unequal contact lengths, densities and materials push with equal and opposite forces
/// along their line.
#[test]
fn unequal_blocks() {
    let fast = Body { velocity: [0.06, -0.01, 0.0], ..block("tungsten", [6, 6, 6], 0.1) };
    let slow = Body { centre: [0.8, 0.06, 0.03], ..block("steel", [3, 4, 5], 0.17) };
    let simulation = after(&scene(vec![tungsten(), steel()], vec![fast, slow]), 120);
    assert!(simulation.holdings()[1].momentum[0] > 0.0, "they meet");
    lost(&simulation, [1e-13, 1e-12, 1e-12, 1e-2]);
}
