//! Lattices of unequal cells: their volumes, their motion, and what is refused.

use std::f64::consts::{FRAC_PI_2, TAU};

use whipple_solver::method::{Density, Viscosity};
use whipple_solver::space::mapping::Mapping;
use whipple_solver::space::scene::{Body, Flow, Scene, Shape, Side, Turn};

use super::scenes::{block, body, gas, march, mirror, push, scene, start, steel, strong};

/// A box between two corners, of these cells, mapped.
fn mapped(material: &str, [low, high]: [[f64; 3]; 2], cells: [usize; 3], by: Mapping) -> Body {
    let size = std::array::from_fn(|d| high[d] - low[d]);
    let centre = std::array::from_fn(|d| 0.5 * (low[d] + high[d]));
    Body { centre, mapping: Some(by), ..body(material, Shape::Box { size }, cells) }
}

/// Saltzman's lattice, of half of the cells.
fn skewed(material: &str) -> Body {
    let by = Mapping::Skew { along: 0, across: 1, zero: 0.1, length: 1.0, slope: 1.0 };
    mapped(material, [[0.0; 3], [1.0, 0.1, 0.06]], [50, 5, 3], by)
}

/// Cells through the wall of a quarter of a tube, and round it.
const TUBE: [usize; 2] = [6, 22];

/// A quarter of a tube of radii 1 and 1.5.
fn tube(material: &str) -> Body {
    let by = Mapping::Wrap { radius: 1.25 };
    let ends = [[1.0, 0.0, 0.0], [1.5, FRAC_PI_2 * 1.25, 0.18]];
    mapped(material, ends, [TUBE[0], TUBE[1], 2], by)
}

fn without_viscosity(scene: &mut Scene) {
    scene.method.visc_linear = 0.0;
    scene.method.visc_quad = 0.0;
    scene.method.visc_expansion = 0.0;
    scene.method.heat_coeff = 0.0;
}

#[test]
fn volumes_are_exact() {
    let facets = {
        let angle = FRAC_PI_2 / TUBE[1] as f64;
        0.5 * (1.5f64 * 1.5 - 1.0) * TUBE[1] as f64 * angle.sin() * 0.18
    };
    for (body, volume) in [(skewed("gas"), 0.006), (tube("gas"), facets)] {
        let exact = body.volume();
        let simulation = start(&scene(vec![gas()], vec![body]));
        let mass = simulation.holdings()[0].mass;
        assert!((mass / volume - 1.0).abs() < 1e-13, "{mass} {volume}");
        assert!((mass / exact - 1.0).abs() < 1e-3, "{mass} {exact}");
        assert!(simulation.all_particles().all(|p| p.mass > 0.0));
    }
}

/// A gas with hardly a pressure and no viscosity flies freely: an affine motion of its particles is one of its
/// cells, and every particle has the density of the whole.
#[test]
fn affine_motions_have_one_density() {
    let rate = [[-0.3, 0.2, 0.1], [0.0, 0.25, -0.1], [0.05, 0.1, -0.4]];
    for own in [skewed("gas"), tube("gas")] {
        // Almost no pressure, but some: it sets the first step.
        let body = Body { energy: 1e-8, ..own };
        let mut scene = scene(vec![gas()], vec![body]);
        without_viscosity(&mut scene);
        let mut simulation = start(&scene);
        let along = |x: [f64; 3]| rate.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
        push(&mut simulation, |p| along(p.position));
        let end = 0.5;
        // Nothing else limits the steps of cold gas.
        for k in 1..=400 {
            simulation.advance_to(end * f64::from(k) / 400.0).expect("free flight");
        }
        let f: [[f64; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| f64::from(u8::from(i == j)) + end * rate[i][j])
        });
        let minor = |a: usize, b: usize| f[1][a] * f[2][b] - f[1][b] * f[2][a];
        let j = f[0][0] * minor(1, 2) - f[0][1] * minor(0, 2) + f[0][2] * minor(0, 1);
        let worst = simulation.all_particles().map(|p| (p.rho * j - 1.0).abs()).fold(0.0, f64::max);
        println!("density over that of det F = {j:.3}: {worst:.1e}, {:?}", simulation.counters());
        assert!(worst < 2e-4, "{worst}");
        assert_eq!(simulation.failed(), (0, 0));
    }
}

/// Not a bit moves in the frame of a body that translates.
#[test]
fn translation_is_exactly_free_of_force() {
    for own in [skewed("steel"), tube("steel")] {
        let body = Body { velocity: [0.3, -0.1, 0.7], ..own };
        let mut simulation = start(&scene(vec![steel()], vec![body]));
        simulation.keep_awake();
        march(&mut simulation, 50);
        for p in simulation.all_particles() {
            assert_eq!(simulation.displacement(p.id as usize), [0.0; 3]);
        }
        assert!(simulation.all_elements().all(|e| e.equivalent_stress == 0.0));
    }
}

/// A uniform strain of an elastic solid leaves its inner particles in equilibrium, whatever the cells:
/// their velocities are those of the strain until waves come in from the surface.
#[test]
fn uniform_stress_is_in_equilibrium() {
    let elastic = strong(steel(), 0.801, None);
    let rate = 1e-4;
    let by = Mapping::Wrap { radius: 1.25 };
    let wedge = mapped("steel", [[1.0, 0.0, 0.0], [1.8, 1.0, 0.8]], [9, 11, 9], by);
    let mut scene = scene(vec![elastic], vec![wedge]);
    without_viscosity(&mut scene);
    let mut simulation = start(&scene);
    let along = |x: [f64; 3]| [rate * x[1], -2.0 * rate * x[1], rate * (x[0] + 0.5 * x[2])];
    let wanted: Vec<_> =
        simulation.all_particles().map(|p| (p.id, p.position, along(p.position))).collect();
    push(&mut simulation, |p| along(p.position));
    march(&mut simulation, 3);
    let (mut inner, mut outer) = (0.0_f64, 0.0_f64);
    for (id, x, v) in wanted {
        let p = simulation.particle(id);
        let off = (0..3).map(|d| (p.velocity[d] - v[d]).abs()).fold(0.0, f64::max) / rate;
        let (r, angle) = (x[0].hypot(x[1]), x[1].atan2(x[0]));
        let depth = (r - 1.0).min(1.8 - r).min(r * angle).min(r * (0.8 - angle));
        if depth.min(x[2]).min(0.8 - x[2]) > 0.35 {
            inner = inner.max(off);
        }
        outer = outer.max(off);
    }
    println!(
        "change of the velocity over the rate: inside {inner:.1e}, at the surface {outer:.1e}"
    );
    assert!(inner < 1e-9 && outer > 1e-2);
}

/// One turn: the stress is that of the centrifugal force.
#[test]
fn a_turn_is_free_of_stress() {
    let omega = 0.02;
    let elastic = strong(steel(), 0.801, None);
    let by = Mapping::Wrap { radius: 0.6 };
    let own = mapped("steel", [[0.4, 0.0, 0.0], [0.8, 0.6, 0.4]], [4, 6, 4], by);
    let body = Body { spin: [0.0, 0.0, omega], centre: [0.6, 0.3, 0.2], ..own };
    let mut simulation = start(&scene(vec![elastic], vec![body]));
    simulation.advance_to(TAU / omega).expect("a turn");
    let b = simulation.balance();
    let stress = simulation.all_elements().map(|e| e.equivalent_stress).fold(0.0, f64::max);
    let energy = b.now.energy() / b.initial.energy() - 1.0;
    let centrifugal = 7.87 * (omega * 0.4).powi(2);
    println!("energy {energy:.1e}, stress over rho v^2 {:.2}", stress / centrifugal);
    assert!(energy.abs() < 1e-4 && b.angular_drift() < 1e-12);
    assert!(b.relative_residual().abs() < 1e-4);
    assert!(stress < 3.0 * centrifugal);
}

/// A mapping that moves nothing gives the answer of the regular lattice.
#[test]
fn the_identity_is_the_regular_lattice() {
    let nothing = Mapping::Skew { along: 0, across: 1, zero: 0.0, length: 1.0, slope: 0.0 };
    let flow = Flow::Hardening {
        y_0: 0.0075,
        kappa: 5.67,
        alpha: 0.49,
        eta: 1.0,
        reference: 300.0,
        melt: 1700.0,
    };
    for viscosity in [Viscosity::Limited, Viscosity::Pairwise] {
        let run = |mapping: Option<Mapping>| {
            let metal = strong(steel(), 0.801, Some(flow));
            let one = Body {
                centre: [0.6, 0.0, 0.0],
                velocity: [-0.08, 0.0, 0.0],
                spin: [0.0, 0.01, 0.02],
                mapping,
                ..block("steel", [12, 5, 4], 0.1)
            };
            let mut scene = scene(vec![metal], vec![one]);
            scene.method.viscosity = viscosity;
            if viscosity == Viscosity::Pairwise {
                // As printed, Eq. (53).
                scene.method.visc_quad = 0.0;
                scene.method.heat_coeff = 0.1;
            }
            scene.method.centring = 0.05;
            scene.method.visc_volume = 1.0;
            scene.walls.push(mirror(0, 0.0, Side::Above));
            let mut simulation = start(&scene);
            march(&mut simulation, 60);
            simulation
        };
        let (regular, mapped) = (run(None), run(Some(nothing)));
        let (length, _) = regular.sizes(0);
        let apart = regular.all_particles().zip(mapped.all_particles()).map(|(p, q)| {
            let way = (0..3).map(|d| (p.position[d] - q.position[d]).abs() / length);
            way.chain([(p.rho / q.rho - 1.0).abs()]).fold(0.0, f64::max)
        });
        let apart = apart.fold(0.0, f64::max);
        let strain = mapped.all_elements().map(|e| e.strain).fold(0.0, f64::max);
        println!("{viscosity:?}: apart {apart:.1e}, largest plastic strain {strain:.2}");
        assert!(apart < 1e-9 && strain > 0.02);
        assert_eq!(regular.failed(), mapped.failed());
    }
}

/// A quarter of a tube of hot gas between mirrors stays as round as a tube.
#[test]
fn mirrors_close_a_quarter_of_a_tube() {
    let mut body = tube("gas");
    body.energy = 1.0;
    let mut scene = scene(vec![gas()], vec![body]);
    without_viscosity(&mut scene);
    scene.walls = [0, 1, 2].map(|axis| mirror(axis, 0.0, Side::Above)).into();
    scene.walls.push(mirror(2, 0.18, Side::Below));
    let mut simulation = start(&scene);
    simulation.advance_to(0.15).expect("it expands");
    let mut inner: Vec<f64> =
        simulation.all_particles().map(|p| p.position[0].hypot(p.position[1])).collect();
    inner.sort_by(f64::total_cmp);
    // The nodes of the inner surface, three deep along the axis.
    let inner = &inner[..3 * (TUBE[1] + 1)];
    let spread = inner[inner.len() - 1] - inner[0];
    let sideways = simulation.all_particles().map(|p| {
        let [x, y, _] = p.position;
        (x * p.velocity[1] - y * p.velocity[0]).abs()
    });
    let sideways = sideways.fold(0.0, f64::max);
    println!("inner radius {:.4}, apart {spread:.1e}, sideways {sideways:.1e}", inner[0]);
    assert!(inner[0] < 0.95 && spread < 1e-10 && sideways < 1e-10);
    assert!(simulation.balance().energy_drift() < 1e-12);
}

#[test]
fn what_is_no_lattice_is_refused() {
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = scene(vec![gas()], vec![tube("gas")]);
        assert_eq!(scene.validate(), Ok(()));
        change(&mut scene);
        scene.validate().expect_err("a bad mapping").to_string()
    };
    let skew =
        |along, across, slope, length| Mapping::Skew { along, across, zero: 0.0, length, slope };
    let by = |mapping: Mapping| refused(&move |s| s.bodies[0].mapping = Some(mapping));
    let messages = [
        by(Mapping::Wrap { radius: 0.0 }),
        // Beyond the axis all is inside out.
        refused(&|s| s.bodies[0].centre[0] = -1.25),
        by(skew(0, 0, 1.0, 1.0)),
        by(skew(0, 3, 1.0, 1.0)),
        by(skew(0, 1, f64::NAN, 1.0)),
        by(skew(0, 1, 1.0, -1.0)),
        by(skew(0, 1, 3.0, 0.3)),
        by(skew(0, 2, 100.0, 100.0)),
        // Cells as wedges.
        refused(&|s| {
            s.bodies[0].shape = Shape::Box { size: [0.45, FRAC_PI_2 * 0.475, 0.3] };
            s.bodies[0].centre = [0.475, 0.0, 0.0];
            s.bodies[0].cells = [1, 2, 1];
            s.bodies[0].mapping = Some(Mapping::Wrap { radius: 0.475 });
        }),
        refused(&|s| s.method.density = Density::Nonholonomic),
        refused(&|s| {
            *s = scene(vec![steel()], vec![tube("steel")]);
            s.method.hourglass = 0.05;
        }),
        refused(&|s| s.bodies[0].turn = Turn { axis: [0.0, 0.0, 1.0], degrees: 30.0 }),
        refused(&|s| s.bodies[0].shape = Shape::Sphere { diameter: 1.0 }),
    ];
    insta::assert_snapshot!(messages.join("\n"));
}
