//! Elements that fail, the energy that they free, and what is left of them.

use whipple_solver::space::Simulation;
use whipple_solver::space::method::{Expansion, Release};
use whipple_solver::space::scene::{Body, Flow};

use super::scenes::{block, copper, march, scene, start, steel, strong};

/// A spinning block whose tensile strength is passed: all stored energy becomes heat, over the steps
/// of the release, and the books close.
#[test]
fn damage_turns_stored_energy_into_heat() {
    for release in [Release::Steps(20.0), Release::Crossings(5.0)] {
        let mut material = strong(steel(), 0.801, None);
        material.failure.plastic_strain = None;
        material.failure.melt = None;
        material.failure.spall = Some(2e-4);
        let body = Body { spin: [0.0, 0.0, 0.06], ..block("steel", [6, 4, 4], 0.1) };
        let mut scene = scene(vec![material], vec![body]);
        scene.method.release = release;
        let mut simulation = start(&scene);
        let mut partly = 0;
        for _ in 0..200 {
            march(&mut simulation, 1);
            let some =
                |e: &whipple_solver::space::output::Element| e.damage > 0.0 && e.damage < 1.0;
            partly += usize::from(simulation.all_elements().any(|e| some(&e)));
        }
        let b = simulation.balance();
        let ruined = simulation.all_elements().filter(|e| e.damage == 1.0).count();
        println!(
            "{release:?}: {ruined} of {} ruined, heat {:.1e} of {:.1e}, energy {:.1e}, residual {:.1e}",
            simulation.elements(),
            b.element_heat,
            b.initial.kinetic,
            b.energy_drift(),
            b.relative_residual()
        );
        assert!(ruined > 0 && partly > 5 && b.element_heat > 0.0);
        assert!(b.energy_drift() < 1e-12 && b.angular_drift() < 1e-12);
        for e in simulation.all_elements().filter(|e| e.damage == 1.0) {
            assert_eq!(e.equivalent_stress, 0.0);
        }
        if ruined == simulation.elements() {
            assert_eq!(b.now.shear + b.now.tension, 0.0);
        }
    }
}

/// Without the choice, a tensile strength fails nothing.
#[test]
fn spall_is_a_choice() {
    let mut material = strong(steel(), 0.801, None);
    material.failure.spall = Some(1e-9);
    let body = Body { spin: [0.0, 0.0, 0.05], ..block("steel", [6, 4, 4], 0.1) };
    let mut scene = scene(vec![material], vec![body]);
    scene.method.spall = false;
    let mut simulation = start(&scene);
    march(&mut simulation, 50);
    assert_eq!(simulation.failed(), (0, 0));
}

/// A block that bursts: its fragments, alone, neither stay compressed nor heat or cool, and do not
/// dictate the time step for ever.
#[test]
fn lonely_fragments_relax() {
    let mut material = copper();
    material.failure.melt = Some(310.0);
    let body = Body { energy: 0.02, ..block("copper", [3, 3, 3], 0.1) };
    let mut simulation = start(&scene(vec![material], vec![body]));
    let first = {
        march(&mut simulation, 1);
        simulation.last_step()
    };
    march(&mut simulation, 600);
    let b = simulation.balance();
    let (failed, dead) = simulation.failed();
    let alone: Vec<_> = simulation.all_particles().filter(|p| p.held == 0.0).collect();
    let dense = alone.iter().map(|p| p.rho / 8.93).fold(0.0, f64::max);
    let warm: Vec<f64> = alone.iter().map(|p| p.u).collect();
    println!(
        "{failed} failed, {dead} dead; densest fragment {dense:.3}, energy {:.1e}, step {:.3} of the first",
        b.energy_drift(),
        simulation.last_step() / first
    );
    assert_eq!((failed, dead), (27, 27));
    assert!(b.energy_drift() < 1e-12 && b.mass_error() < 1e-15);
    assert!(dense < 0.85 && simulation.last_step() > 0.5 * first);
    march(&mut simulation, 50);
    let after: Vec<f64> =
        simulation.all_particles().filter(|p| p.held == 0.0).map(|p| p.u).collect();
    assert_eq!(warm, after, "nothing works on what is alone");
}

/// Material that flows heats by what the elements lose: a yielding collision closes its books, with
/// the work of the elements against their energy and heat as the residual.
#[test]
fn plastic_work_is_heat() {
    let flow = Flow::Hardening {
        y_0: 0.005,
        kappa: 0.0,
        alpha: 0.0,
        eta: 0.0,
        reference: 300.0,
        melt: 2000.0,
    };
    let mut material = strong(copper(), 0.46, Some(flow));
    material.failure.compression = 0.1;
    let fast = Body { velocity: [0.02, 0.0, 0.0], ..block("copper", [8, 4, 4], 0.1) };
    let slow = Body { centre: [0.85, 0.0, 0.0], ..block("copper", [8, 4, 4], 0.1) };
    let scene = scene(vec![material], vec![fast, slow]);
    let mut simulation = start(&scene);
    march(&mut simulation, 120);
    let b = simulation.balance();
    let worst = simulation.all_elements().map(|e| e.strain).fold(0.0, f64::max);
    println!(
        "heat {:.3} of the kinetic energy, strain {worst:.3}, residual {:.1e}",
        b.element_heat / b.initial.kinetic,
        b.relative_residual()
    );
    assert!(b.element_heat > 0.01 * b.initial.kinetic && worst > 0.005);
    assert!(b.relative_residual().abs() < 5e-3 && b.energy_drift() < 1e-12);
    for e in simulation.all_elements() {
        // At small plastic strain the effective stress is the stress itself.
        assert!(e.equivalent_stress < 0.005 * (1.0 + 3.0 * e.strain) + 1e-9, "{e:?}");
    }
}

/// Warm copper that is at rest, expanded by its heat, stays there when it fails: its particles take over the cold tension
/// of their elements as fast as these lose it. Taken over at once, a hundredth of the bulk modulus would set off the surface.
#[test]
fn warm_material_that_fails_stays_at_rest() {
    let bulk = 8.93 * 0.394 * 0.394;
    let energy = 0.01 * bulk / (8.93 * 2.02);
    let warm = Body { energy, ..block("copper", [6; 3], 0.1) };
    let mut scene = scene(vec![strong(copper(), 0.477, None)], vec![warm]);
    let mut simulation = start(&scene);
    simulation.advance_to(40.0).unwrap();
    let fastest = |simulation: &Simulation| {
        let speeds = simulation.all_particles().map(|p| p.velocity.iter().map(|v| v * v).sum());
        speeds.fold(0.0, f64::max).sqrt() / 0.394
    };
    let before = fastest(&simulation);
    scene.materials[0].failure.melt = Some(301.0);
    let mut failing = start(&scene);
    failing.restore(&simulation.sections()).unwrap();
    let mut most = 0.0_f64;
    for _ in 0..20 {
        march(&mut failing, 5);
        most = most.max(fastest(&failing));
    }
    println!("fastest {before:.2e} of the speed of sound before, {most:.2e} after");
    assert!(failing.failed().0 == 216 && before < 1e-4, "{:?} {before}", failing.failed());
    assert!(most < 1e-3, "{most}");
}

/// A block of warm copper comes to rest where its equation of state has no pressure (decision 0025); with `whole` at half
/// of that expansion. It fails by no tensile strength that its heat makes up for.
#[test]
fn warm_material_expands_to_its_own_density() {
    let [warm, whole] = [Expansion::Thermal, Expansion::Whole].map(|expansion| {
        let bulk = 8.93 * 0.394 * 0.394;
        let thermal = 8.93 * 2.02;
        // An expansion of 1 %, whose cold tension is more than the strength.
        let energy = 0.01 * bulk / thermal;
        let strength = 0.009 * bulk;
        let mut scene = scene(
            vec![strong(copper(), 0.477, None)],
            vec![Body { energy, ..block("copper", [6; 3], 0.1) }],
        );
        scene.method.expansion = expansion;
        let mut simulation = start(&scene);
        simulation.advance_to(40.0).unwrap();
        let mass = simulation.holdings()[0].mass;
        let per_mass = |of: &dyn Fn(&whipple_solver::space::output::Particle) -> f64| {
            simulation.all_particles().map(|p| p.mass * of(&p)).sum::<f64>() / mass
        };
        let own = thermal * per_mass(&|p| p.u) / bulk;
        let found = per_mass(&|p| 8.93 / p.rho) - 1.0;
        println!("{expansion:?}: expansion {found:.5}, that without pressure {own:.5}");

        // At rest its elements would pass the strength by their own tension alone.
        scene.materials[0].failure.spall = Some(strength);
        let mut weak = start(&scene);
        weak.restore(&simulation.sections()).unwrap();
        march(&mut weak, 20);
        assert_eq!(weak.failed(), (0, 0));
        found / own
    });
    assert!((warm - 1.0).abs() < 0.005, "{warm}");
    assert!((whole - 0.5).abs() < 0.005, "{whole}");
}
