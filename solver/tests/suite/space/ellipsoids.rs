//! Particles that are ellipsoids: one that rotates freely, lattices of bricks, and what they keep.

use std::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};
use whipple_solver::method::{Density, Preset};
use whipple_solver::space::method::{Method, Particles};
use whipple_solver::space::output::{Ellipsoid, Particle};
use whipple_solver::space::scene::{Body, Scene, Shape, Side, Turn};
use whipple_solver::space::spin::Rigid;
use whipple_solver::space::{Simulation, lattice};

use super::reference::{norm, sub};
use super::scenes::{
    after, bits, body, copper, march, mirror, rod, scene, start, steel, strong, tungsten,
};

/// Angular velocities in own axes of a solid ellipsoid of half-lengths 3, 2 and 1: case, time, three components.
fn reference() -> Vec<(&'static str, f64, Vector3<f64>)> {
    let file = include_str!("../../../../references/rigid_ellipsoid_omega.csv");
    let rows = file.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|row| {
        let mut cells = row.split(',');
        let case = cells.next().expect("a case");
        let numbers: Vec<f64> = cells.map(|cell| cell.parse().expect("a number")).collect();
        (case, numbers[0], Vector3::new(numbers[1], numbers[2], numbers[3]))
    })
    .collect()
}

const INERTIA: [f64; 3] = [1.0, 2.0, 2.6];

/// Largest error of the angular velocity of a case, with steps of this length.
fn error(case: &str, dt: f64) -> f64 {
    let inertia = Vector3::from(INERTIA);
    let softness = inertia.map(|j| 1.0 / j);
    let rows: Vec<_> = reference().into_iter().filter(|row| row.0 == case).collect();
    let mut rigid = Rigid::spinning(UnitQuaternion::identity(), rows[0].2, &inertia);
    let mut worst = 0.0f64;
    for pair in rows.windows(2) {
        let steps = ((pair[1].1 - pair[0].1) / dt).round();
        for _ in 0..steps as usize {
            rigid.rotate(&softness, (pair[1].1 - pair[0].1) / steps);
        }
        worst = worst.max((rigid.momentum.component_div(&inertia) - pair[1].2).norm());
    }
    assert!(rows.len() > 20);
    worst
}

/// A 3:2:1 ellipsoid that spins about its longest, its shortest and its middle axis, against the Jacobi solution: second
/// order.
#[test]
fn free_rotation_converges_to_the_jacobi_solution() {
    for case in ["near_axis3", "near_axis1", "intermediate_flip"] {
        let errors = [0.1, 0.05, 0.025].map(|dt| error(case, dt));
        let orders = [0, 1].map(|k| (errors[k] / errors[k + 1]).log2());
        println!("{case}: {errors:?}, orders {orders:.3?}");
        assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.05), "{case}: {orders:?}");
        assert!(errors[2] < 0.02, "{case}: {errors:?}");
    }
}

/// However long it rotates, its energy, its angular momentum and the norm of its Euler parameters stay.
#[test]
fn free_rotation_keeps_energy_momentum_and_norm() {
    let inertia = Vector3::from(INERTIA);
    let spin = Vector3::new(0.01, 1.0, 0.01);
    let mut rigid =
        Rigid::spinning(UnitQuaternion::from_euler_angles(0.3, 1.0, -2.0), spin, &inertia);
    let (energy, momentum) = (rigid.energy(&inertia), rigid.turn * rigid.momentum);
    let softness = inertia.map(|j| 1.0 / j);
    for _ in 0..100_000 {
        rigid.rotate(&softness, 0.05);
    }
    let lost = [
        rigid.energy(&inertia) / energy - 1.0,
        (rigid.turn * rigid.momentum - momentum).norm() / momentum.norm(),
        rigid.turn.into_inner().norm() - 1.0,
    ];
    println!("energy, angular momentum, norm: {lost:?}");
    assert!(lost[0].abs() < 1e-11 && lost[1] < 1e-11 && lost[2].abs() < 1e-12);
}

/// A block of cells with these edges.
fn bricks(material: &str, cells: [usize; 3], edges: [f64; 3]) -> Body {
    let size = std::array::from_fn(|k| cells[k] as f64 * edges[k]);
    body(material, Shape::Box { size }, cells)
}

/// Two blocks of bricks that collide, turned against each other.
fn collision(density: Density) -> Scene {
    let fast = Body {
        velocity: [0.06, -0.02, 0.01],
        spin: [0.01, 0.0, 0.02],
        turn: Turn { axis: [0.1, 1.0, 0.2], degrees: 9.0 },
        ..bricks("tungsten", [3, 5, 6], [0.2, 0.1, 0.07])
    };
    let slow = Body { centre: [0.9, 0.06, 0.03], ..bricks("steel", [6, 3, 3], [0.1, 0.2, 0.2]) };
    let scene = scene(vec![tungsten(), steel()], vec![fast, slow]);
    let method = match density {
        Density::Hybrid => scene.method,
        _ => Method { density, ..Preset::Paper.space() },
    };
    Scene { method, ..scene }
}

const DENSITIES: [Density; 3] = [Density::Hybrid, Density::Nonholonomic, Density::Kernel];

/// Momentum, angular momentum and energy of colliding bricks.
#[test]
fn bricks_lose_nothing() {
    for density in DENSITIES {
        let simulation = after(&collision(density), 200);
        let b = simulation.balance();
        let lost = [b.momentum_drift(), b.angular_drift(), b.energy_drift(), b.relative_residual()];
        println!(
            "{density:?}: {lost:?}, failed {:?}, acting {}",
            simulation.failed(),
            simulation.acting()
        );
        assert!(simulation.holdings()[1].momentum[0] > 0.0, "they meet");
        assert!(lost[..3].iter().all(|lost| *lost < 1e-12), "{density:?}: {lost:?}");
        assert!(lost[3].abs() < 1e-2);
    }
}

/// Debris of bricks rotates: torques reach it, and nothing of them is lost.
#[test]
fn debris_of_bricks_rotates() {
    let mut scene = collision(Density::Hybrid);
    crumbling(&mut scene);
    let mut simulation = after(&scene, 590);
    let before = poses(&simulation);
    march(&mut simulation, 10);
    let free: Vec<bool> = simulation.all_particles().map(|p| p.held == 0.0).collect();
    let turned = before.iter().zip(poses(&simulation)).zip(free).filter(|(_, free)| *free);
    let turned = turned.map(|((a, b), _)| norm(sub(a[0], b[0]))).fold(0.0, f64::max);
    let b = simulation.balance();
    let lost = [b.momentum_drift(), b.angular_drift(), b.energy_drift(), b.relative_residual()];
    let dead = simulation.failed().1;
    println!("{lost:?}, dead {dead}, acting {}, turned {turned:.3}", simulation.acting());
    assert!(turned > 0.01, "{turned}");
    assert!(dead > 15 && simulation.acting() > 50);
    assert!(lost[..3].iter().all(|lost| *lost < 1e-12), "{lost:?}");
}

/// No particle turns on the spot when its last element dies: it goes on from how its live cells held it.
#[test]
fn what_is_let_go_lies_as_it_was_held() {
    let mut scene = collision(Density::Hybrid);
    crumbling(&mut scene);
    let mut simulation = start(&scene);
    let free = |simulation: &Simulation| -> Vec<bool> {
        simulation.all_particles().map(|p| p.held == 0.0).collect()
    };
    let (mut before, mut loose) = (poses(&simulation), free(&simulation));
    let (mut worst, mut count) = (0.0f64, 0);
    for _ in 0..400 {
        march(&mut simulation, 1);
        let (lie, now) = (poses(&simulation), free(&simulation));
        for k in (0..now.len()).filter(|&k| now[k] && !loose[k]) {
            let turned = (0..3).map(|axis| norm(sub(before[k][axis], lie[k][axis])));
            worst = turned.fold(worst, f64::max);
            count += 1;
        }
        (before, loose) = (lie, now);
    }
    println!("{count} let go; most that one turned in that step: {worst:.3}");
    assert!(count > 15 && worst < 0.05, "{count}, {worst}");
}

/// What lies on a mirror turns about its normal alone, as beside its images; what the mirror takes is booked.
#[test]
fn what_lies_on_a_mirror_turns_in_it() {
    for density in DENSITIES {
        let one = |material: &str, cells: [usize; 3], edges: [f64; 3]| {
            let middle = 0.5 * cells[2] as f64 * edges[2];
            Body { centre: [0.0, 0.0, middle], ..bricks(material, cells, edges) }
        };
        let fast = one("tungsten", [2, 5, 2], [0.2, 0.1, 0.07]);
        let fast = Body { velocity: [0.1, -0.03, 0.0], ..fast };
        let slow = one("steel", [4, 3, 1], [0.1, 0.2, 0.15]);
        let slow = Body { centre: [0.47, 0.06, slow.centre[2]], ..slow };
        let mut half = scene(vec![tungsten(), steel()], vec![fast, slow]);
        crumbling(&mut half);
        half.method = collision(density).method;
        half.walls.push(mirror(2, 0.0, Side::Above));
        let mut simulation = start(&half);
        let own = |p: &Particle| p.position[2].abs() < 1e-9;
        let on: Vec<u32> = simulation.all_particles().filter(own).map(|p| p.id).collect();
        march(&mut simulation, 150);
        let (mut out, mut within) = (0.0f64, 0.0f64);
        for &id in &on {
            let [_, _, _, xy, xz, yz] = shape(simulation.ellipsoid(id).expect("an ellipsoid"));
            (out, within) = (out.max(xz.abs()).max(yz.abs()), within.max(xy.abs()));
        }
        let b = simulation.balance();
        let lost = [b.momentum_drift(), b.angular_drift(), b.energy_drift()];
        println!(
            "{density:?}: {} on it turned {within:.2} in it, {out:.1e} out of it, {lost:?}, dead {}",
            on.len(),
            simulation.failed().1
        );
        assert!(within > 0.05 && out < 1e-12 && simulation.failed().1 > 2, "{density:?}");
        assert!(lost.iter().all(|lost| *lost < 1e-12), "{lost:?}");
    }
}

/// A block that spins and lies on a mirror with a face, an edge or a corner loses nothing but what is booked, and a
/// restart changes no bit of it.
#[test]
fn what_spins_on_a_mirror_loses_nothing() {
    for (density, degrees) in
        DENSITIES.into_iter().flat_map(|d| [0.0, 30.0].map(|angle| (d, angle)))
    {
        let turn = Turn { axis: [0.6, 0.8, 0.0], degrees };
        let tilted = Body { turn, ..bricks("tungsten", [2, 4, 3], [0.2, 0.1, 0.07]) };
        let mut scene = scene(vec![tungsten(), steel()], vec![tilted]);
        scene.method = collision(density).method;
        let alone = start(&scene);
        let lowest = alone.all_particles().map(|p| p.position[2]).fold(f64::INFINITY, f64::min);
        scene.bodies[0].spin = [0.02, -0.01, 0.03];
        let slow = Body {
            centre: [0.55, 0.03, 0.02],
            velocity: [-0.1, 0.0, 0.0],
            ..bricks("steel", [2; 3], [0.15; 3])
        };
        scene.bodies.push(slow);
        scene.walls.push(mirror(2, lowest, Side::Above));
        let whole = after(&scene, 120);
        let b = whole.balance();
        let lost = [b.momentum_drift(), b.angular_drift(), b.energy_drift()];
        println!("{density:?} at {degrees}: {lost:?}, acting {}", whole.acting());
        assert!(lost.iter().all(|lost| *lost < 1e-12), "{density:?} at {degrees}: {lost:?}");
        let first = after(&scene, 60);
        let mut second = start(&scene);
        second.restore(&first.sections()).expect("its own sections");
        march(&mut second, 60);
        assert!(bits(&whole) == bits(&second), "{density:?} at {degrees}");
    }
}

/// Makes elements die of little compression.
fn crumbling(scene: &mut Scene) {
    for material in &mut scene.materials {
        material.failure.compression = 0.93;
    }
    scene.bodies[0].velocity[0] = 0.2;
}

#[test]
fn a_turned_scene_of_bricks_is_the_same_scene() {
    let (axis, degrees) = ([0.3, -0.5, 0.8], 71.0);
    let turned = lattice::rotation(axis, f64::to_radians(degrees));
    let rotate = |v: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|d| (0..3).map(|k| v[k] * turned[k][d]).sum())
    };
    for density in DENSITIES {
        let mut straight = collision(density);
        straight.bodies[0].turn = Turn::default();
        let mut other = straight.clone();
        for body in &mut other.bodies {
            body.centre = rotate(body.centre);
            body.velocity = rotate(body.velocity);
            body.spin = rotate(body.spin);
            body.turn = Turn { axis, degrees };
        }
        // Contacts switch, and what is round-off on one side of a switch is not on the other.
        let steps = if density == Density::Hybrid { 80 } else { 40 };
        let (a, b) = (after(&straight, steps), after(&other, steps));
        let apart = a.all_particles().zip(b.all_particles());
        let apart = apart.map(|(p, q)| norm(sub(rotate(p.position), q.position)) / 0.1);
        let apart = apart.fold(0.0, f64::max);
        println!("{density:?}: apart {apart:.1e} edges after {steps} steps");
        assert!(apart < 1e-7, "{density:?}");
    }
}

/// Ellipsoids with equal axes do what spheres do. The viscosity of contacts begins at exactly their distance at the start,
/// (51), where round-off decides: those of all particles are without.
#[test]
fn ellipsoids_of_equal_axes_are_spheres() {
    for density in DENSITIES {
        let mut spheres = rod(3, 8, [8, 3, 6]);
        let edge = lattice::cell_size(&spheres.bodies[0])[0];
        // Cells of the rod are cubes too.
        spheres.bodies[0].shape = Shape::Cylinder { diameter: 0.5, length: 8.0 * edge };
        let steps = if density == Density::Hybrid {
            crumbling(&mut spheres);
            200
        } else {
            let none = Method { visc_linear: 0.0, heat_coeff: 0.0, ..Preset::Paper.space() };
            spheres.method = Method { density, ..none };
            30
        };
        let mut ellipsoids = spheres.clone();
        ellipsoids.method.particles = Particles::Ellipsoids;
        let (a, b) = (after(&spheres, steps), after(&ellipsoids, steps));
        assert!(a.ellipsoid(0).is_none() && b.ellipsoid(0).is_some());
        let apart = a.all_particles().zip(b.all_particles());
        let apart = apart.map(|(p, q)| norm(sub(p.position, q.position)) / edge);
        let apart = apart.fold(0.0, f64::max);
        println!(
            "{density:?}: apart {apart:.1e} edges after {steps} steps, {} contacts",
            b.acting()
        );
        assert!(apart < 1e-10 && b.acting() > 10, "{density:?}");
    }
}

/// One turn of an elastic block of 4:1 cells, the particles' spins started with it.
#[test]
fn one_turn_of_a_block_of_bricks() {
    let omega = 0.02;
    for density in [Density::Hybrid, Density::Nonholonomic] {
        let elastic = strong(steel(), 0.801, None);
        let body = Body { spin: [0.0, 0.0, omega], ..bricks("steel", [3, 8, 4], [0.2, 0.05, 0.1]) };
        let mut scene = scene(vec![elastic], vec![body]);
        scene.method = Method { density, ..scene.method };
        let mut simulation = start(&scene);
        let before = poses(&simulation);
        simulation.advance_to(TAU / omega).expect("a turn");
        let b = simulation.balance();
        let energy = b.now.energy() / b.initial.energy() - 1.0;
        let turned = before
            .iter()
            .zip(poses(&simulation))
            .map(|(a, b)| (0..3).map(|k| norm(sub(a[k], b[k]))).fold(0.0, f64::max));
        let turned = turned.fold(0.0, f64::max);
        println!(
            "{density:?}: energy {energy:.1e}, angular {:.1e}, axes off {turned:.1e}, {} steps",
            b.angular_drift(),
            simulation.counters().steps
        );
        assert!(energy.abs() < 1e-4 && b.angular_drift() < 1e-12);
        assert!(turned < 0.01, "{density:?}: {turned}");
    }
}

/// The tensor of an ellipsoid over the square of its longest contact length.
fn shape(ellipsoid: Ellipsoid) -> [f64; 6] {
    let Ellipsoid { axes, contact_lengths, .. } = ellipsoid;
    let longest = contact_lengths.into_iter().fold(0.0, f64::max);
    let part = |i: usize, j: usize| {
        (0..3).map(|k| (contact_lengths[k] / longest).powi(2) * axes[k][i] * axes[k][j]).sum()
    };
    [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(i, j)| part(i, j))
}

fn poses(simulation: &Simulation) -> Vec<[[f64; 3]; 3]> {
    let all =
        simulation.all_particles().map(|p| simulation.ellipsoid(p.id).expect("an ellipsoid").axes);
    all.collect()
}

/// A shock along each axis of bricks has the pressure of the Hugoniot, and rings no more along one than along another.
#[test]
fn shocks_cross_bricks_along_every_axis() {
    let up = 0.1;
    let us = 0.394 + 1.489 * up;
    for edges in [[0.1, 0.1, 0.4], [0.1, 0.4, 0.4], [0.4, 0.1, 0.1], [0.4, 0.4, 0.1]] {
        let n = if edges[0] == 0.1 { 40 } else { 20 };
        let cells = [n, 3, 3];
        let size: [f64; 3] = std::array::from_fn(|k| cells[k] as f64 * edges[k]);
        let body = Body {
            centre: [0.5 * size[0], 0.0, 0.0],
            velocity: [-up, 0.0, 0.0],
            noise: 0.005 * up,
            ..bricks("copper", cells, edges)
        };
        let mut scene = scene(vec![copper()], vec![body]);
        scene.walls.push(mirror(0, 0.0, Side::Above));
        for (axis, edge) in (1..).zip(&size[1..]) {
            scene.walls.push(mirror(axis, -0.5 * edge, Side::Above));
            scene.walls.push(mirror(axis, 0.5 * edge, Side::Below));
        }
        let mut simulation = start(&scene);
        let time = 0.75 * size[0] / us;
        simulation.advance_to(time).expect("the shock runs");
        let (wanted, front) = (8.93 * us * up, (us - up) * time);
        let behind = simulation
            .all_particles()
            .filter(|p| (3.0 * edges[0]..front - 5.0 * edges[0]).contains(&p.position[0]));
        let pressures: Vec<f64> = behind.map(|p| p.pressure / wanted).collect();
        let mean = pressures.iter().sum::<f64>() / pressures.len() as f64;
        let noise = pressures.iter().map(|p| (p / mean - 1.0).powi(2)).sum::<f64>();
        let noise = (noise / pressures.len() as f64).sqrt();
        println!(
            "{edges:?}: pressure {:+.2} %, noise {:.2} % of {} particles, {} steps",
            100.0 * (mean - 1.0),
            100.0 * noise,
            pressures.len(),
            simulation.counters().steps
        );
        assert!((mean - 1.0).abs() < 0.01 && noise < 0.02 && pressures.len() > 50);
    }
}

/// Particles ten times as long as wide, end on and flat on.
#[test]
fn slender_particles_collide() {
    for edges in [[0.5, 0.05, 0.05], [0.05, 0.5, 0.5]] {
        let fast = Body { velocity: [0.15, 0.02, 0.0], ..bricks("tungsten", [4, 4, 4], edges) };
        let centre = [4.0 * edges[0] + 0.06, 0.01, 0.02];
        let slow = Body { centre, ..bricks("steel", [4, 4, 4], edges) };
        let mut scene = scene(vec![tungsten(), steel()], vec![fast, slow]);
        scene.stop_time = 10.0;
        let mut simulation = start(&scene);
        simulation.advance_to(10.0).expect("it runs");
        let b = simulation.balance();
        let lost = [b.momentum_drift(), b.angular_drift(), b.energy_drift(), b.relative_residual()];
        println!(
            "{edges:?}: {lost:?}, failed {:?}, {} steps",
            simulation.failed(),
            simulation.counters().steps
        );
        assert!(lost[..3].iter().all(|lost| *lost < 1e-12), "{lost:?}");
        assert!(lost[3].abs() < 1e-2);
    }
}

#[test]
fn threads_and_restarts_give_the_same_bits() {
    for density in [Density::Hybrid, Density::Nonholonomic] {
        let scene = collision(density);
        let alone = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("a pool").install(|| bits(&after(&scene, 120)))
        };
        let whole = alone(1);
        assert!(whole == alone(2) && whole == alone(8), "{density:?}: threads");
        let first = after(&scene, 60);
        let mut second = start(&scene);
        second.restore(&first.sections()).expect("its own sections");
        march(&mut second, 60);
        assert!(whole == bits(&second), "{density:?}: restart");
    }
}
