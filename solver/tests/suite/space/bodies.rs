//! Lattices of bodies, their masses, and the equations of state of their particles.

use whipple_solver::space::eos::Eos;
use whipple_solver::space::lanes::F8;
use whipple_solver::space::scene::{
    Body, EosData, Failure, GammaLaw, Material, Scene, Shape, Turn,
};

use super::scenes::{block, body, copper, scene, start, steel, tungsten};

/// The long rod of Table 5 at five cells through the plate, in a plate of 7 x 4 x 0.5 cm.
fn long_rod() -> Scene {
    let rod = body("tungsten", Shape::Cylinder { diameter: 0.5, length: 7.5 }, [5, 5, 75]);
    let rod = Body { turn: Turn { axis: [-0.5, 0.75f64.sqrt(), 0.0], degrees: 90.0 }, ..rod };
    let plate = block("steel", [70, 5, 40], 0.1);
    scene(vec![tungsten(), steel()], vec![rod, Body { centre: [0.0, 9.0, 0.0], ..plate }])
}

#[test]
fn the_long_rod_has_the_particles_of_table_5() {
    let simulation = start(&long_rod());
    // A disc of 21 cells has 32 nodes; the paper has 35,992 particles in all.
    let rod = 76 * 32 + 75 * 21;
    let plate = 71 * 6 * 41 + 70 * 5 * 40;
    assert_eq!(simulation.particles(), rod + plate);
    assert_eq!(simulation.particles(), 35_473);
    assert_eq!(simulation.elements(), 75 * 21 + 70 * 5 * 40);
    assert_eq!(simulation.all_particles().count(), 35_473);
}

/// The mass is that of the shape, whatever its lattice, and lies where the shape does.
#[test]
fn masses_are_exact() {
    let shapes = [
        (Shape::Box { size: [0.7, 0.5, 0.4] }, [7, 5, 4]),
        (Shape::Cylinder { diameter: 0.5, length: 0.95 }, [5, 5, 9]),
        (Shape::Cylinder { diameter: 0.9, length: 0.4 }, [9, 9, 4]),
        (Shape::Sphere { diameter: 0.9 }, [9, 9, 9]),
        (Shape::Sphere { diameter: 0.8 }, [8, 8, 8]),
        (Shape::Ring { outer: 0.9, inner: 0.5, length: 0.4 }, [9, 9, 4]),
        (skewed([0.0, 0.0, 1.0], 45.0), [10, 10, 5]),
        (skewed([1.0, -1.0, 0.0], 54.7), [9, 11, 10]),
    ];
    let turn = Turn { axis: [1.0, -2.0, 0.7], degrees: 40.0 };
    for (shape, cells) in shapes {
        let centre = [3.0, -1.0, 0.5];
        let one = Body { centre, turn, ..body("copper", shape.clone(), cells) };
        let simulation = start(&scene(vec![copper()], vec![one]));
        let mass = simulation.holdings()[0].mass;
        assert!((mass / (8.93 * shape.volume()) - 1.0).abs() < 1e-12, "{shape:?}");
        for (d, centre) in centre.into_iter().enumerate() {
            let first: f64 = simulation.all_particles().map(|p| p.mass * p.position[d]).sum();
            assert!((first / mass - centre).abs() < 1e-12, "{shape:?}");
        }
        let (length, size) = simulation.sizes(0);
        let volume: f64 = size.iter().product();
        assert!((length / (0.75f64.sqrt() * volume.cbrt()) - 1.0).abs() < 1e-14);
        assert!((volume * simulation.elements() as f64 / shape.volume() - 1.0).abs() < 1e-12);
    }
}

/// A box of 0.7 x 0.6 x 0.5 cm with a turned lattice.
fn skewed(axis: [f64; 3], degrees: f64) -> Shape {
    Shape::Skewed { size: [0.7, 0.6, 0.5], lattice: Turn { axis, degrees } }
}

/// A cone has the mass of its shape, with its centre of mass where that of the cone is to a tenth of a cell; a shape given by
/// its cells is the shape that has them.
#[test]
fn cones_and_filled_shapes() {
    let (lower, upper, length) = (1.0, 0.4, 1.2);
    let cone = Shape::Cone { lower, upper, length };
    let cells = [20, 20, 24];
    let simulation = start(&scene(vec![copper()], vec![body("copper", cone.clone(), cells)]));
    let mass = simulation.holdings()[0].mass;
    assert!((mass / (8.93 * cone.volume()) - 1.0).abs() < 1e-12);
    let height: f64 =
        simulation.all_particles().map(|p| p.mass * p.position[2]).sum::<f64>() / mass;
    let first = lower * lower + 2.0 * lower * upper + 3.0 * upper * upper;
    let wanted = length * (0.25 * first / (lower * lower + lower * upper + upper * upper) - 0.5);
    assert!((height - wanted).abs() < 0.1 * 0.05, "{height} {wanted}");

    let ball = Shape::Sphere { diameter: 0.7 };
    let n = 7;
    let mut runs: Vec<[u16; 4]> = Vec::new();
    for (k, j) in (0..n).flat_map(|k| (0..n).map(move |j| (k, j))) {
        let row: Vec<usize> = (0..n).filter(|&i| ball.has([i, j, k], [n; 3])).collect();
        if let Some(&first) = row.first() {
            runs.push([first, row.len(), j, k].map(|x| x as u16));
        }
    }
    let filled = Shape::Filled { size: ball.extent(), volume: ball.volume(), runs };
    let [one, other] = [ball, filled].map(|shape| {
        let simulation = start(&scene(vec![copper()], vec![body("copper", shape, [n; 3])]));
        simulation.all_particles().map(|p| p.position.map(f64::to_bits)).collect::<Vec<_>>()
    });
    assert_eq!(one, other);
    let small = Shape::Ring { outer: 2.0, inner: 1.0, length: 3.0 }.scaled(0.5);
    assert_eq!(small, Shape::Ring { outer: 1.0, inner: 0.5, length: 1.5 });
}

/// A turned lattice fills its box as far as cells go, whichever of its axes is the longest; one that is not turned is that of
/// a box.
#[test]
fn turned_lattices_fill_their_boxes() {
    for (axis, degrees, cells) in [
        ([0.0, 0.0, 1.0], 30.0, [11, 10, 5]),
        ([0.0, 0.0, 1.0], 30.0, [10, 11, 5]),
        ([0.3, -0.5, 0.8], 20.0, [9, 10, 11]),
    ] {
        let shape = skewed(axis, degrees);
        let turn = Turn { axis: [0.0, 1.0, 0.0], degrees: 90.0 };
        let simulation =
            start(&scene(vec![copper()], vec![Body { turn, ..body("copper", shape, cells) }]));
        let edge = simulation.sizes(0).1.into_iter().fold(0.0, f64::max);
        // Turned, the first axis of the box runs along -z and the third along x.
        let reach =
            |d: usize| simulation.all_particles().map(|p| p.position[d].abs()).fold(0.0, f64::max);
        for (d, half) in [(0, 0.25), (1, 0.3), (2, 0.35)] {
            let off = reach(d) - half;
            assert!(off.abs() < 0.9 * edge, "{degrees} {d}: {off} of {edge}");
        }
    }
    let own = |shape: Shape| start(&scene(vec![copper()], vec![body("copper", shape, [7, 6, 5])]));
    let [a, b] = [skewed([0.0, 0.0, 1.0], 0.0), Shape::Box { size: [0.7, 0.6, 0.5] }].map(own);
    let places = |s: &whipple_solver::space::Simulation| -> Vec<[f64; 3]> {
        s.all_particles().map(|p| p.position).collect()
    };
    for (p, q) in places(&a).into_iter().zip(places(&b)) {
        assert!((0..3).all(|d| (p[d] - q[d]).abs() < 1e-12), "{p:?} {q:?}");
    }
}

/// Elements name their corners as the lattice has them: bits of the slot along the axes.
#[test]
fn elements_name_their_particles() {
    let turn = Turn { axis: [0.2, 1.0, 0.7], degrees: 25.0 };
    let simulation =
        start(&scene(vec![steel()], vec![Body { turn, ..block("steel", [5, 4, 3], 0.1) }]));
    for e in simulation.all_elements() {
        let corners = e.corners.map(|id| simulation.particle(id).position);
        let centre = simulation.particle(e.centre).position;
        for d in 0..3 {
            let mean = corners.iter().map(|x| x[d]).sum::<f64>() / 8.0;
            assert!((mean - centre[d]).abs() < 1e-14);
        }
        for (slot, corner) in corners.iter().enumerate() {
            for axis in (0..3).filter(|axis| slot >> axis & 1 == 0) {
                let other = corners[slot | 1 << axis];
                let edge: f64 = (0..3).map(|d| (other[d] - corner[d]).powi(2)).sum();
                assert!((edge.sqrt() - 0.1).abs() < 1e-14);
            }
        }
    }
}

/// Pressure, square of the sound speed and temperature.
fn respond(material: &Material, rho: f64, u: f64) -> [f64; 3] {
    let loose = || F8([1.0; 8]);
    let r = Eos::new(material).respond((F8([rho; 8]), F8([1.0 / rho; 8])), F8([u; 8]), loose);
    [r.pressure, r.sound_squared, r.theta].map(|lanes| lanes.0[5])
}

#[test]
fn equations_of_state() {
    let gas = Material {
        name: "gas".into(),
        density: 1.0,
        eos: EosData::IdealGas { adiabatic_index: 1.4, c_v: 2.0 },
        strength: None,
        failure: Failure::default(),
    };
    let [p, c2, theta] = respond(&gas, 0.5, 3.0);
    assert!((p - 0.6).abs() < 1e-15 && (c2 - 1.4 * p / 0.5).abs() < 1e-14);
    assert_eq!(theta, 1.5);
    // Tension belongs to the elements; heat presses also in expansion.
    assert_eq!(respond(&copper(), 8.5, 0.0)[0], 0.0);
    let hot = respond(&copper(), 8.93, 1e-3);
    assert!((hot[0] - 8.93 * 2.02 * 1e-3).abs() < 1e-15);
    assert!((hot[2] - (300.0 + 1e-3 / 0.383e-5)).abs() < 1e-9);
}

/// On the isentrope through the reference state the temperature is `theta_0 exp(integral of Gamma over
/// ln rho)`, and at any density heat raises it by `1 / c_v`.
#[test]
fn isentropes_heat() {
    for b in [0.0, 0.47] {
        let mut material = copper();
        if let EosData::MieGruneisen { law, .. } = &mut material.eos {
            *law = if b > 0.0 { GammaLaw::Steinberg(b) } else { GammaLaw::ConstantProduct };
        }
        for end in [1.02, 1.1, 1.25, 1.43, 1.67] {
            let (mut rho, mut u, steps) = (8.93, 0.0, 20_000);
            let step = 8.93 * (end - 1.0) / f64::from(steps);
            for _ in 0..steps {
                let half = u + respond(&material, rho, u)[0] / (rho * rho) * 0.5 * step;
                let middle = rho + 0.5 * step;
                u += respond(&material, middle, half)[0] / (middle * middle) * step;
                rho += step;
            }
            let eta: f64 = 1.0 - 1.0 / end;
            let exact = 300.0 * ((2.02 - b) * eta - b * (1.0 - eta).ln()).exp();
            let found = respond(&material, rho, u)[2];
            let share = (found - exact) * 0.383e-5 / u;
            println!("b {b}, rho/rho_o {end}: {found:.1} K, exact {exact:.1} K, {share:.1e} of u");
            assert!(share.abs() < 0.01, "{b} {end}: {found} {exact}");
            let hotter = respond(&material, rho, u + 1e-3)[2];
            assert!((hotter - found - 1e-3 / 0.383e-5).abs() < 1e-8);
        }
    }
}
