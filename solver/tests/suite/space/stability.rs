//! Noise must not grow, whatever the cells: the time step is safe inside a body and on its surface, with
//! viscosity and without, in cells that are longer or shorter along one axis than along the others.

use whipple_solver::space::mapping::Mapping;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Body, Scene, Shape, Side};

use super::scenes::{block, body, copper, gas, march, mirror, push, scene, start, steel, strong};

/// Cells along each axis.
const CELLS: [usize; 3] = [6, 5, 4];

/// A block of cells with these edges, of particles that move at random, slowly.
fn noisy(material: &str, edges: [f64; 3]) -> Body {
    let size = std::array::from_fn(|d| edges[d] * CELLS[d] as f64);
    let nothing = Mapping::Skew { along: 0, across: 1, zero: 0.0, length: 1.0, slope: 0.0 };
    Body {
        centre: size.map(|size| 0.5 * size),
        noise: 1e-6,
        energy: if material == "gas" { 1.0 } else { 0.0 },
        // Unequal edges are for mapped cells alone.
        mapping: Some(nothing),
        ..body(material, Shape::Box { size }, CELLS)
    }
}

/// Largest kinetic energy in the last of three parts of a run, over that in the first.
fn growth(scene: &Scene) -> f64 {
    let mut simulation = start(scene);
    let mut parts = [0.0f64; 3];
    for part in &mut parts {
        for _ in 0..100 {
            march(&mut simulation, 1);
            *part = part.max(simulation.balance().now.kinetic);
        }
    }
    parts[2] / parts[0]
}

/// The six mirrors of a box from zero to here.
fn closed(scene: &mut Scene, high: [f64; 3]) {
    for (axis, high) in high.into_iter().enumerate() {
        scene.walls.push(mirror(axis, 0.0, Side::Above));
        scene.walls.push(mirror(axis, high, Side::Below));
    }
}

#[test]
fn noise_dies_out_in_long_and_flat_cells() {
    let metal = strong(steel(), 0.801, None);
    let mut grown = vec![];
    for edges in [[0.1; 3], [0.29, 0.1, 0.1], [0.1, 0.29, 0.29], [0.1, 0.17, 0.29]] {
        for (material, free) in [
            (&metal, true),
            (&metal, false),
            (&copper(), true),
            (&copper(), false),
            (&gas(), false),
        ] {
            // Stiffness decides with the first two, damping with the last.
            for visc_linear in [0.0, 0.1, 0.7, 5.0] {
                let mut scene = scene(vec![material.clone()], vec![noisy(&material.name, edges)]);
                scene.method.visc_linear = visc_linear;
                if !free {
                    closed(&mut scene, std::array::from_fn(|d| edges[d] * CELLS[d] as f64));
                }
                let growth = growth(&scene);
                println!("{} {edges:?} free {free} c0 {visc_linear}: {growth:.3}", material.name);
                if growth.is_nan() || growth >= 0.9 {
                    grown.push((material.name.clone(), edges, free, visc_linear, growth));
                }
            }
        }
    }
    assert!(grown.is_empty(), "{grown:#?}");
}

/// The lightest particle of a body has one bond alone, and the whole viscosity of that: pushed in, it is
/// stopped, and not thrown back, in the first step.
#[test]
fn a_corner_that_is_pushed_in_is_not_thrown_back() {
    for visc_linear in [0.7, 5.0] {
        for speed in [1e-3, 0.1, 1.0] {
            let mut scene = scene(vec![copper()], vec![block("copper", [4; 3], 0.1)]);
            scene.method.visc_linear = visc_linear;
            let mut simulation = start(&scene);
            let corner = simulation
                .all_particles()
                .min_by(|p, q| {
                    let sum = |p: &Particle| p.position.iter().sum::<f64>();
                    sum(p).total_cmp(&sum(q))
                })
                .expect("particles")
                .id;
            push(&mut simulation, |p| [if p.id == corner { speed * 0.394 } else { 0.0 }; 3]);
            march(&mut simulation, 1);
            let [after, ..] = simulation.particle(corner).velocity;
            println!("c0 {visc_linear}, {speed} c: {:.3}", after / (speed * 0.394));
            assert!(after >= 0.0, "{after}");
        }
    }
}
