//! What keeps the surfaces of bodies apart is a function of the state, not of how it was come to.

use whipple_solver::space::Simulation;
use whipple_solver::space::mapping::Mapping;
use whipple_solver::space::restart::Values;
use whipple_solver::space::scene::{Body, Scene, Shape};
use whipple_solver::space::votes::Voter;

use super::scenes::{after, bits, block, body, copper, march, scene, start, steel, tungsten};

/// Edge of the cells of a plate.
const EDGE: f64 = 0.1;

/// The same simulation, with a list of pairs made at the present positions.
fn with_a_new_list(scene: &Scene, simulation: &Simulation) -> Simulation {
    let mut sections = simulation.sections();
    for section in sections.iter_mut().filter(|section| section.name == "list.stale") {
        section.values = Values::U8(vec![1]);
    }
    let mut anew = start(scene);
    anew.restore(&sections).expect("its own sections");
    anew
}

/// A block that slides over a plate, whose surface is stretched to these times what its cells were, with
/// their volumes.
fn sliding(stretch: f64) -> (Scene, Simulation) {
    let plate = block("copper", [10, 12, 8], EDGE);
    let thickness = 12.0 * EDGE / stretch.powi(2);
    let slider = Body {
        centre: [-0.013, 0.5 * thickness + 0.25 + 0.052, 0.021],
        velocity: [0.3, -0.02, 0.17],
        ..block("copper", [5; 3], EDGE)
    };
    let scene = scene(vec![copper()], vec![plate, slider]);
    let simulation = start(&scene);
    let stretched: Vec<_> = simulation.all_particles().filter(|p| p.body == 0).collect();
    let mut sections = simulation.sections();
    for section in &mut sections {
        let axis = ["state.dx", "state.dy", "state.dz"].iter().position(|n| *n == section.name);
        match (&mut section.values, axis) {
            (Values::F64(column), Some(axis)) => {
                let by = if axis == 1 { stretch.powi(-2) } else { stretch } - 1.0;
                stretched.iter().for_each(|p| column[p.id as usize] = by * p.position[axis]);
            }
            (Values::U8(flags), _) if section.name == "list.stale" => flags.fill(1),
            (Values::U8(flags), _) if section.name.ends_with("awake") => flags.fill(1),
            (Values::U8(flags), _) if section.name.ends_with("active") => flags.fill(1),
            _ => {}
        }
    }
    let mut simulation = start(&scene);
    simulation.restore(&sections).expect("its own sections");
    simulation.start_books();
    (scene, simulation)
}

/// Springs see what is in reach now, not what was when the list of pairs was made: at any step a list made
/// anew moves no bit, of faces so stretched too that no corner is in reach from their middle.
#[test]
fn springs_do_not_know_the_age_of_the_list() {
    let (scene, mut simulation) = sliding(2.2);
    let mut other_lists = 0;
    for step in 0..200 {
        let mut anew = with_a_new_list(&scene, &simulation);
        march(&mut anew, 1);
        march(&mut simulation, 1);
        other_lists += u32::from(anew.counters().pairs != simulation.counters().pairs);
        assert!(bits(&anew) == bits(&simulation), "step {step}");
    }
    println!("{other_lists} other lists, failed and dead {:?}", simulation.failed());
    assert!(other_lists > 150);
}

/// The nearest face is found however much larger the cells of one body are than those of another: two flat
/// faces that meet push every node of either alike.
#[test]
fn faces_of_unequal_cells_meet_flat() {
    for cells in [4, 12, 20] {
        let size = 4.0 * 0.4;
        let fine = size / cells as f64;
        let stand = 0.25 * (0.4 + fine);
        let coarse = block("copper", [4, 3, 4], 0.4);
        let fast = Body {
            centre: [0.0, 0.6 + 1.5 * fine + 1.02 * stand, 0.0],
            velocity: [0.0, -0.1, 0.0],
            ..block("copper", [cells, 3, cells], fine)
        };
        let mut simulation = start(&scene(vec![copper()], vec![coarse, fast]));
        let hit = |simulation: &Simulation| -> Vec<[f64; 3]> {
            let own = simulation.all_particles().filter(|p| p.body == 0);
            own.map(|p| p.velocity).filter(|v| *v != [0.0; 3]).collect()
        };
        while hit(&simulation).is_empty() {
            march(&mut simulation, 1);
        }
        let hit = hit(&simulation);
        assert_eq!(hit.len(), 25, "{cells} cells: the nodes of one face");
        for v in &hit {
            let apart = (v[1] / hit[0][1] - 1.0).abs();
            assert!(v[1] < 0.0 && apart < 1e-9, "{cells} cells: {hit:?}");
        }
    }
}

/// A mapped body may have cells so much larger than the mean that their corners are out of reach from the
/// middle of a face: alone it is fine, beside another it is refused.
#[test]
fn faces_too_wide_for_what_is_sought_are_refused() {
    let bent = |ends: [f64; 2], arc: f64, cells: [usize; 3]| {
        let size = [ends[1] - ends[0], arc, 0.1];
        Body {
            centre: [0.5 * (ends[0] + ends[1]), 0.0, 0.0],
            mapping: Some(Mapping::Wrap { radius: ends[0] }),
            ..body("copper", Shape::Box { size }, cells)
        }
    };
    let far = Body { centre: [9.0, 0.0, 0.0], ..block("copper", [2; 3], EDGE) };
    let start = |bodies: Vec<Body>| Simulation::new(&scene(vec![copper()], bodies));
    let even = bent([1.0, 1.3], 0.3, [3, 3, 1]);
    assert!(start(vec![even, far.clone()]).is_ok());
    // From less than half of the radial edge round the axis to three of it.
    let uneven = bent([0.4, 2.75], 0.348, [26, 9, 1]);
    assert!(start(vec![uneven.clone()]).is_ok());
    let refused = start(vec![far, uneven]).expect_err("corners out of reach").to_string();
    assert!(refused.starts_with("`bodies.1.mapping` is corners"), "{refused}");
}

/// However fast a block comes from beyond where blocks see each other, it meets the other and does not leap
/// through it.
#[test]
fn bodies_do_not_leap_through_each_other() {
    let still = block("copper", [3, 3, 3], 0.1);
    let fast = Body { centre: [-2.0, 0.0, 0.0], velocity: [100.0, 0.0, 0.0], ..still.clone() };
    let mut simulation = start(&scene(vec![copper()], vec![still, fast]));
    // They touch at 0.017.
    simulation.advance_to(0.016).expect("nothing is met before");
    assert!(simulation.votes().decided[Voter::Leap as usize] > 0);
    // Until the second would have passed the first by its own length, if nothing ends the run before.
    let met = simulation.advance_to(0.026).is_err() || simulation.holdings()[0].momentum[0] > 0.0;
    assert!(met, "{:?}", simulation.holdings()[0].momentum);
}

/// Blocks of unlike cells that begin close: a point of the larger face pushes few, light nodes, and steps are short enough
/// for them.
#[test]
fn unlike_cells_that_begin_close_keep_their_energy() {
    for (small, large) in [(0.1, 0.5), (0.1, 0.2), (0.05, 0.5)] {
        let cells = block("steel", [2, 2, 2], small);
        let gap = 0.07 * large / 0.5 + 0.01 * small;
        let centre = [small + gap, 0.13 * small, 0.07 * small];
        let fast = Body { centre, velocity: [-0.005, 0.0, 0.0], ..cells };
        let still = Body { centre: [-large, 0.0, 0.0], ..block("tungsten", [2, 2, 2], large) };
        let simulation = after(&scene(vec![steel(), tungsten()], vec![fast, still]), 150);
        let b = simulation.balance();
        println!(
            "{small} on {large}: residual {:.1e}, at {:.2}",
            b.relative_residual(),
            simulation.time()
        );
        assert!(
            b.relative_residual().abs() < 5e-3,
            "{small} on {large}: {}",
            b.relative_residual()
        );
        assert!(simulation.holdings()[1].momentum[0] < 0.0, "they meet");
    }
}
