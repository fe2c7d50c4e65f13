//! What no run may lose: mass, momentum, angular momentum and energy.

use whipple_solver::method::{Density, Integrator, Preset};
use whipple_solver::space::Simulation;
use whipple_solver::space::method::Method;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Body, EosData, Failure, Hold, Material, Scene, Side, Wall};

use super::scenes::{after, block, copper, rod, scene, start, steel, tungsten};

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
    let simulation = after(&rod(4, 16, [14, 4, 8]), 320);
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

/// A single pass, by contacts or by a kernel, keeps momentum, and energy as far as its steps are short.
#[test]
fn a_single_pass_errs_in_energy_alone() {
    for density in [Density::Nonholonomic, Density::Kernel] {
        let fast = Body { velocity: [0.05, 0.01, 0.0], ..block("copper", [8, 5, 4], 0.1) };
        let slow = Body { centre: [0.83, 0.12, 0.07], ..block("copper", [8, 5, 4], 0.1) };
        let scene = scene(vec![copper()], vec![fast, slow]);
        let integrator = Integrator::SinglePass;
        let drift = |cfl: f64| {
            let method = Method { density, integrator, cfl, ..Preset::Paper.space() };
            let mut simulation = start(&Scene { method, ..scene.clone() });
            simulation.advance_to(2.0).expect("they collide");
            let b = simulation.balance();
            assert!(b.momentum_drift() < 1e-13 && b.angular_drift() < 1e-12);
            b.energy_drift()
        };
        let drifts = [0.4, 0.2].map(drift);
        println!("{density:?}: energy {drifts:?}");
        assert!(drifts[0] < 0.1 && drifts[1] < 0.7 * drifts[0], "{density:?}: {drifts:?}");
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

/// A block of gas that expands into nothing keeps the entropy of every particle inside, far below the
/// density that it began with.
#[test]
fn gas_expands_along_its_isentrope() {
    let index = 1.4;
    let gas = Material {
        name: "gas".into(),
        density: 1.0,
        eos: EosData::IdealGas { adiabatic_index: index, c_v: 1.0 },
        strength: None,
        failure: Failure::default(),
    };
    let mut scene = scene(vec![gas], vec![Body { energy: 1.0, ..block("gas", [6, 6, 6], 0.1) }]);
    scene.method = Method {
        visc_linear: 0.0,
        visc_quad: 0.0,
        visc_expansion: 0.0,
        heat_coeff: 0.0,
        cfl: 0.02,
        ..scene.method
    };
    let mut simulation = start(&scene);
    simulation.advance_to(0.2).expect("gas expands");
    let inside: Vec<_> = simulation.all_particles().filter(|p| p.held == 1.0).collect();
    let thinnest = inside.iter().map(|p| p.rho).fold(f64::INFINITY, f64::min);
    let change = |p: &Particle| (p.u / p.rho.powf(index - 1.0) - 1.0).abs();
    let worst = inside.iter().map(change).fold(0.0, f64::max);
    println!("{} particles, down to {thinnest:.3}: entropy within {worst:.1e}", inside.len());
    assert!(inside.len() > 100 && thinnest < 0.1 && worst < 0.01);
}
