//! Noise must not grow, whatever the cells: the time step is safe inside a body and on its surface, with
//! viscosity and without, in cells that are longer or shorter along one axis than along the others.

use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;
use whipple_solver::space::mapping::Mapping;
use whipple_solver::space::method::Method;
use whipple_solver::space::output::Particle;
use whipple_solver::space::restart::{Section, Values};
use whipple_solver::space::scene::{Body, Hold, Scene, Shape, Side, Wall};
use whipple_solver::space::votes::{Voter, Votes};

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
fn growth(mut simulation: Simulation) -> f64 {
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
                let growth = growth(start(&scene));
                println!("{} {edges:?} free {free} c0 {visc_linear}: {growth:.3}", material.name);
                if growth.is_nan() || growth >= 0.9 {
                    grown.push((material.name.clone(), edges, free, visc_linear, growth));
                }
            }
        }
    }
    assert!(grown.is_empty(), "{grown:#?}");
}

/// The corner of a block at the lowest positions.
fn first_corner(simulation: &Simulation) -> u32 {
    let sum = |p: &Particle| p.position.iter().sum::<f64>();
    let first = simulation.all_particles().min_by(|p, q| sum(p).total_cmp(&sum(q)));
    first.expect("particles").id
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
            let corner = first_corner(&simulation);
            push(&mut simulation, |p| [if p.id == corner { speed * 0.394 } else { 0.0 }; 3]);
            march(&mut simulation, 1);
            let [after, ..] = simulation.particle(corner).velocity;
            println!("c0 {visc_linear}, {speed} c: {:.3}", after / (speed * 0.394));
            assert!(after >= 0.0, "{after}");
        }
    }
}

/// Largest kinetic energy of 300 steps over that at the start: what grows fast is over before a third of them.
fn risen(mut simulation: Simulation) -> f64 {
    let first = simulation.balance().now.kinetic;
    let mut most = 0.0f64;
    for _ in 0..300 {
        march(&mut simulation, 1);
        most = most.max(simulation.balance().now.kinetic);
    }
    most / first
}

/// A block that has flowed to this stretch along the first axis, unloaded.
fn stretched(scene: &Scene, stretch: f64) -> Simulation {
    let mut simulation = start(scene);
    let across = stretch.powf(-0.5);
    let strain = [stretch, across, across].map(|stretch| 0.5 * (stretch * stretch - 1.0));
    let places: Vec<_> = simulation.all_particles().map(|p| (p.id as usize, p.position)).collect();
    let mut sections = simulation.sections();
    for Section { name, values } in &mut sections {
        let axis = ["state.dx", "state.dy", "state.dz"].iter().position(|own| own == name);
        match (values, axis) {
            (Values::F64(column), Some(axis)) => {
                let by = [stretch, across, across][axis] - 1.0;
                places.iter().for_each(|(i, place)| column[*i] = by * place[axis]);
            }
            (Values::F64(plastic), None) if name == "group.plastic" => {
                let each = plastic.len() / 6;
                for (component, strain) in plastic.chunks_mut(each).zip(strain) {
                    component.fill(strain);
                }
            }
            _ => {}
        }
    }
    simulation.restore(&sections).expect("its own sections");
    simulation.start_books();
    simulation
}

/// Strain that flow has undone leaves the stiffness of a stretched cell: along its short axes too, since a
/// change of the volume by itself shears what is stretched.
#[test]
fn noise_does_not_grow_in_what_flow_has_stretched() {
    let metal = strong(steel(), 0.801, None);
    let mut grown = vec![];
    for stretch in [0.25, 2.0, 4.0] {
        for visc_linear in [0.0, 0.7] {
            let mut scene = scene(vec![metal.clone()], vec![noisy("steel", [0.1; 3])]);
            scene.method.visc_linear = visc_linear;
            scene.method.visc_expansion = 0.0;
            let risen = risen(stretched(&scene, stretch));
            println!("stretched by {stretch}, c0 {visc_linear}: {risen:.3}");
            if risen.is_nan() || risen >= 1.1 {
                grown.push((stretch, visc_linear, risen));
            }
        }
    }
    assert!(grown.is_empty(), "{grown:#?}");
}

/// Stiffness and damping at once: the bounds of both are not met in one motion, and so not added up whole. What damps
/// the noise hides what feeds it, but for steps that leapfrog does not bear.
#[test]
fn noise_dies_out_in_what_flow_has_stretched_whatever_the_viscosity() {
    let metal = strong(steel(), 0.801, None);
    let mut grown = vec![];
    for stretch in [0.25, 0.5, 1.5, 2.0, 3.0] {
        for visc_linear in [0.2, 0.7, 1.5, 4.0] {
            let mut scene = scene(vec![metal.clone()], vec![noisy("steel", [0.1; 3])]);
            scene.method.visc_linear = visc_linear;
            let growth = growth(stretched(&scene, stretch));
            println!("stretched by {stretch}, c0 {visc_linear}: {growth:.3}");
            if growth.is_nan() || growth >= 0.9 {
                grown.push((stretch, visc_linear, growth));
            }
        }
    }
    assert!(grown.is_empty(), "{grown:#?}");
}

/// Particles that no element holds damp each other by contact alone: of a lattice without volumes each has eight.
#[test]
fn noise_dies_out_in_loose_particles_with_much_viscosity() {
    for visc_linear in [0.3, 5.0, 20.0] {
        let body = Body { noise: 1e-6, ..block("copper", [5, 4, 4], 0.1) };
        let mut scene = scene(vec![copper()], vec![body]);
        scene.method = Method { visc_linear, ..Preset::Paper.space() };
        let risen = risen(start(&scene));
        println!("c0 {visc_linear}: {risen:.3}");
        assert!(risen < 1.1, "c0 {visc_linear}: {risen}");
    }
}

/// A step that is much shorter than the one before it: the kick between them is the mean of both.
#[test]
fn a_corner_that_is_pushed_in_late_is_not_thrown_back_faster() {
    for visc_linear in [0.1, 0.2, 0.3] {
        for speed in [0.1, 0.15] {
            let mut scene = scene(vec![copper()], vec![block("copper", [4; 3], 0.1)]);
            scene.bodies[0].noise = 1e-9;
            scene.method.visc_linear = visc_linear;
            let mut simulation = start(&scene);
            march(&mut simulation, 20);
            let before = simulation.last_step();
            let corner = first_corner(&simulation);
            push(&mut simulation, |p| [if p.id == corner { speed * 0.394 } else { 0.0 }; 3]);
            march(&mut simulation, 1);
            let [after, ..] = simulation.particle(corner).velocity;
            let part = simulation.last_step() / before;
            println!("c0 {visc_linear}, {speed} c: {:.3}, step {part:.3}", after / (speed * 0.394));
            assert!(after >= -speed * 0.394 && part < 0.9, "{after}");
        }
    }
}

/// Debris that closes at several times its sound speed: its viscosity neither throws it back nor shortens the step.
#[test]
fn debris_that_closes_fast_is_not_thrown_back() {
    let mut material = copper();
    material.failure.melt = Some(310.0);
    let body = Body { energy: 0.02, ..block("copper", [3, 3, 3], 0.1) };
    let mut simulation = start(&scene(vec![material], vec![body]));
    march(&mut simulation, 40);
    assert_eq!(simulation.failed(), (27, 27));
    let speed = 3.0 * 0.394;
    push(&mut simulation, |p| p.position.map(|x| -speed * x.signum()));
    let kinetic = |simulation: &Simulation| simulation.holdings()[0].kinetic;
    let (before, votes) = (kinetic(&simulation), *simulation.votes());
    let mut most = 0.0f64;
    for _ in 0..60 {
        march(&mut simulation, 1);
        most = most.max(kinetic(&simulation) / before);
    }
    let lessened = simulation.counters().lessened;
    let left = kinetic(&simulation) / before;
    println!("at most {most:.6} of the energy before, {left:.3} at the end, {lessened} lessened");
    assert!(most < 1.001 && left < 0.9 && lessened > 0);
    let by_contacts = |votes: &Votes| votes.decided[Voter::Contacts as usize];
    assert_eq!(by_contacts(simulation.votes()), by_contacts(&votes));
}

/// A run that lands an ulp after a time, as one that is made longer may, and goes on: volumes do not change by what
/// round-off is over the length of that step.
#[test]
fn a_step_of_an_ulp_leaves_no_trace_in_the_density() {
    let run = |landings: &[f64]| {
        let mut body = block("copper", [4; 3], 0.1);
        body.noise = 1e-6;
        let mut simulation = start(&scene(vec![copper()], vec![body]));
        // Displacements of a cell's size, for round-off to be seen.
        push(&mut simulation, |_| [0.3, 0.2, 0.1]);
        for &time in landings {
            simulation.advance_to(time).expect("the scene of a test runs");
        }
        march(&mut simulation, 1);
        let apart = simulation.all_particles().map(|p| (p.rho / copper().density - 1.0).abs());
        apart.fold(0.0, f64::max)
    };
    let time = 1.0f64;
    let (plain, ulp) = (run(&[time]), run(&[time, time.next_up()]));
    println!("largest change of density {plain:.1e}, after a step of an ulp {ulp:.1e}");
    assert!(ulp < 1e-5 && plain < 1e-5, "{plain} {ulp}");
}

/// Share of the density that a step may change, of the edge of a cell.
const DENSEST: f64 = 0.08;

/// A block of copper that flies at 50 against a wall, whose cells have an edge of 0.1, from this gap.
fn against_a_wall(gap: f64, hold: Hold) -> Simulation {
    let fast = Body { velocity: [-50.0, 0.0, 0.0], ..block("copper", [6, 3, 3], 0.1) };
    let fast = Body { centre: [0.3 + gap, 0.0, 0.0], ..fast };
    let mut scene = scene(vec![copper()], vec![fast]);
    scene.walls = vec![Wall { hold, ..mirror(0, 0.0, Side::Above) }];
    start(&scene)
}

/// No step has found a rate of density before the first: that is as long as the speeds of the start allow.
#[test]
fn the_first_step_knows_the_speeds_of_the_start() {
    let still = block("copper", [3, 3, 3], 0.1);
    let fast = Body { centre: [-0.32, 0.0, 0.0], velocity: [50.0, 0.0, 0.0], ..still.clone() };
    let met = start(&scene(vec![copper()], vec![still, fast]));
    let apart = Body { noise: 1.0, ..block("copper", [3, 3, 3], 0.1) };
    let within = start(&scene(vec![copper()], vec![apart]));
    let all = [
        (against_a_wall(0.0, Hold::Mirror), DENSEST * 0.1 / 50.0, 1.0),
        (against_a_wall(0.0, Hold::Rest), DENSEST * 0.1 / 50.0, 1.0),
        (met, DENSEST * 0.1 / 50.0, 1.0),
        // Noise of this size has most of its rate along all axes at once: no less than a quarter of three times two.
        (within, DENSEST * 0.1 / 6.0, 4.0),
    ];
    for (mut simulation, most, least) in all {
        march(&mut simulation, 1);
        let allowed = simulation.votes().of(Voter::Density);
        let within = allowed > most * (1.0 - 1e-12) && allowed < most * least * (1.0 + 1e-12);
        assert!(within && simulation.last_step() <= allowed, "{allowed} {most}");
    }
}

/// Whatever the gap to a wall, no more of a cell is beyond it after the step of the impact than a step may change a density.
#[test]
fn steps_shorten_before_a_wall_is_met() {
    let landings = [0.0, 0.5, 0.9, 0.95, 0.99];
    for (gap, landing) in
        [0.01, 0.13, 3.3, 20.7].into_iter().flat_map(|gap| landings.map(|l| (gap, l)))
    {
        let mut simulation = against_a_wall(gap, Hold::Rest);
        // Steps before that are shortened to land on a time, those after are not.
        simulation.advance_to(landing * gap / 50.0).expect("nothing is met before");
        while simulation.balance().wall_impulse[0] == 0.0 {
            march(&mut simulation, 1);
        }
        let time = simulation.time();
        println!("gap {gap}: met at {time:.5}, {} steps", simulation.counters().steps);
        assert!((-1e-12..DENSEST * 0.1 * (1.0 + 1e-12)).contains(&(50.0 * time - gap)), "{time}");
    }
}
