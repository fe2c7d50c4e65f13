//! Meetings of bodies that no lattice expects: thinner than a cell, corner on corner, in a row, in a wedge, round a void.

use whipple_solver::space::Simulation;
use whipple_solver::space::scene::{Body, Scene, Turn};

use super::measure::{RESIDUAL, energy, in_short_steps, largest, minus, norm, to_the_end};
use super::scenes::{ALUMINIUM, STEEL, advance, block, bricks, rod_metals, scene, sleeve};
use super::sheet::{Bound, Sheet, Trouble};

/// Edge of a cell in cm.
const EDGE: f64 = 0.1;
/// Edge of the cells of the needle in cm.
const FINE: f64 = 0.02;
/// Edge of a cube in cm.
const CUBE: f64 = 0.4;
/// What is measured of cubes.
const APART: &str = "speed apart over that of closing";
const OVERLAP: &str = "overlap over the edge of a cell";
/// Length of the diagonal of a cube over its edge.
const DIAGONAL: f64 = 1.732_050_807_568_877_2;

/// W01: a needle of a single cell meets cells five times as coarse, on a corner, a face, or between.
pub(super) fn needle(sheet: &mut Sheet) {
    let half = 0.5 * EDGE;
    for (aim, offset) in [("a node", half), ("the middle of a face", 0.0), ("neither", 0.031)] {
        sheet.part(format!("needle of tungsten on {aim} of steel, 1 km/s"), |sheet| {
            let needle = Body {
                centre: [offset, offset, 0.1 + 0.5 * EDGE],
                velocity: [0.0, 0.0, -0.1],
                ..block("tungsten", [1, 1, 10], FINE)
            };
            let plate = block("steel", [9, 9, 4], EDGE);
            let plate = Body { centre: [0.0, 0.0, -0.2], ..plate };
            let scene = scene(sheet.space(), rod_metals().into(), vec![needle, plate]);
            let mut simulation = Simulation::new(&scene)?;
            let before = simulation.holdings()[0].momentum[2];
            let (mut deepest, mut handed) = (f64::INFINITY, 0.0f64);
            for k in 1..=20 {
                advance(&mut simulation, 0.5 * f64::from(k))?;
                let own = simulation.all_particles().filter(|p| p.body == 0);
                deepest = own.map(|p| p.position[2]).fold(deepest, f64::min);
                handed = handed.max(simulation.holdings()[1].momentum[2] / before);
            }
            sheet.at_least("momentum handed over", handed, 0.5);
            sheet.at_least("tip above the far side of the plate, cm", deepest, -0.4);
            sheet.at_most("error of the momentum", simulation.balance().momentum_drift(), 1e-12);
            energy(sheet, &simulation);
            in_short_steps(sheet, &scene, 10.0)
        });
    }
}

/// W02: elastic cubes meet on faces, edges and corners, exactly in line. With 8 cells across; with 4 the viscosity of so
/// few cells takes up the vibration into which edges and corners turn the motion, which is shown.
pub(super) fn corners(sheet: &mut Sheet) {
    // With how far each reaches from its middle along the axis of the meeting, over its edge.
    let upright = (Turn::default(), 0.5);
    let edge = (Turn { axis: [0.0, 0.0, 1.0], degrees: 45.0 }, 0.5 * 2f64.sqrt());
    // From the diagonal of the cube to the x axis.
    let to_the_axis = (1.0 / DIAGONAL).acos().to_degrees();
    let corner = (Turn { axis: [0.0, 1.0, -1.0], degrees: to_the_axis }, 0.5 * DIAGONAL);
    let pairs = [
        ("face on face", [upright, upright]),
        ("edge on edge", [edge, edge]),
        ("corner on corner", [corner, corner]),
        ("corner on face", [corner, upright]),
        ("edge on face", [edge, upright]),
    ];
    let sizes = sheet.size(&[8, 4][..], &[4]);
    for (name, turns) in pairs {
        for aside in [0.0, 0.13] {
            for &n in sizes {
                let part = format!(
                    "cubes of steel of {n} cells across, {name}, {aside} of a cell aside, 100 m/s"
                );
                sheet.part(part, |sheet| cubes(sheet, turns, aside, (n, n == sizes[0])));
            }
        }
    }
}

/// Two cubes of so many cells across, turned so, and how far they reach; what is not asked for is shown.
fn cubes(
    sheet: &mut Sheet,
    turns: [(Turn, f64); 2],
    aside: f64,
    (n, asked): (usize, bool),
) -> Result<(), Trouble> {
    let size = CUBE;
    let cell = size / n as f64;
    let apart = 0.51 * cell;
    let reach = turns.map(|(_, reach)| size * reach);
    let cube = |side: f64, k: usize| Body {
        centre: [
            side * (reach[k] + 0.5 * apart),
            0.5 * side * aside * cell,
            0.3 * side * aside * cell,
        ],
        turn: turns[k].0,
        velocity: [-side * 0.005, 0.0, 0.0],
        ..block("steel", [n; 3], cell)
    };
    let bodies = vec![cube(-1.0, 0), cube(1.0, 1)];
    let scene = scene(sheet.space(), vec![STEEL.elastic()], bodies);
    let mut simulation = Simulation::new(&scene)?;
    let mut closest = f64::INFINITY;
    for k in 1..=120 {
        advance(&mut simulation, 0.5 * f64::from(k))?;
        let [a, b] = middles(&simulation);
        closest = closest.min(b[0] - a[0]);
    }
    let speed = |body: usize| {
        let held = simulation.holdings()[body];
        held.momentum[0] / held.mass
    };
    let apart = (speed(1) - speed(0)) / 0.01;
    let overlap = (reach[0] + reach[1] - closest) / cell;
    if !asked {
        sheet.shown(APART, apart);
        sheet.shown(OVERLAP, overlap);
        sheet.shown(RESIDUAL, simulation.balance().relative_residual().abs());
        return Ok(());
    }
    sheet.at_least(APART, apart, 0.1);
    sheet.at_most(OVERLAP, overlap, 1.0);
    sheet.at_most("error of the momentum", simulation.balance().momentum_drift(), 1e-12);
    energy(sheet, &simulation);
    Ok(())
}

/// Mean place of the particles of the first two bodies, by mass.
fn middles(simulation: &Simulation) -> [[f64; 3]; 2] {
    [0, 1].map(|body| {
        let own = simulation.all_particles().filter(|p| p.body == body);
        let (mass, sum) = own.fold((0.0, [0.0; 3]), |(mass, sum), p| {
            (mass + p.mass, std::array::from_fn(|d| sum[d] + p.mass * p.position[d]))
        });
        sum.map(|x| x / mass)
    })
}

/// W03: the first of five equal blocks in a row runs into the others; only the last flies on.
pub(super) fn cradle(sheet: &mut Sheet) {
    sheet.part("five blocks of steel in a row, 10 m/s", |sheet| {
        let n = sheet.size(20, 10);
        let long = n as f64 * EDGE;
        let apart = 0.55 * EDGE;
        let block = |k: usize| Body {
            name: format!("block {}", k + 1),
            centre: [k as f64 * (long + apart), 0.0, 0.0],
            velocity: [if k == 0 { 0.001 } else { 0.0 }, 0.0, 0.0],
            ..block("steel", [n, 3, 3], EDGE)
        };
        let mut scene = scene(sheet.space(), vec![STEEL.elastic()], (0..5).map(block).collect());
        scene.walls = sleeve([3.0 * EDGE; 2]);
        let mut simulation = Simulation::new(&scene)?;
        let whole = simulation.holdings()[0].momentum[0];
        // The wave runs through five blocks and waits for gaps that close at 10 m/s.
        let end = 5.0 * apart / 0.001 + 20.0 * long / STEEL.sound();
        advance(&mut simulation, end)?;
        let share = |body: usize| simulation.holdings()[body].momentum[0] / whole;
        sheet.at_least("momentum of the last over that of the first before", share(4), 0.9);
        sheet.at_most("momentum of the others", (1.0 - share(4)).abs(), 0.1);
        sheet.at_most("error of the momentum", simulation.balance().momentum_drift(), 1e-12);
        energy(sheet, &simulation);
        Ok(())
    });
}

/// W06: two plates meet in a narrow wedge, from whose end jets run.
pub(super) fn wedge(sheet: &mut Sheet) {
    for degrees in [5.0, 15.0] {
        sheet.part(
            format!("plates of aluminium in a wedge of {degrees} degrees, 2 km/s each"),
            |sheet| {
                let cells = sheet.size([30, 3, 10], [16, 3, 6]);
                let long = cells[0] as f64 * EDGE;
                let slope = 0.5f64 * f64::to_radians(degrees);
                let height = 0.5 * long * slope.sin()
                    + 0.5 * cells[1] as f64 * EDGE * slope.cos()
                    + 0.35 * EDGE;
                let plate = |side: f64| Body {
                    name: if side > 0.0 { "upper".into() } else { "lower".into() },
                    centre: [0.0, side * height, 0.0],
                    turn: Turn { axis: [0.0, 0.0, 1.0], degrees: side * 0.5 * degrees },
                    velocity: [0.0, -side * 0.2, 0.0],
                    ..block("aluminium", cells, EDGE)
                };
                let metal = ALUMINIUM.ductile([0.0029, 125.0, 0.1, 930.0]);
                let mut scene = scene(sheet.space(), vec![metal], vec![plate(1.0), plate(-1.0)]);
                scene.stop_time = sheet.size(10.0, 4.0);
                meet(sheet, &scene, 0.2)
            },
        );
    }
}

/// W08: four blocks close on a square void.
pub(super) fn collapse(sheet: &mut Sheet) {
    sheet.part("four blocks of aluminium close on a void at 2 km/s each", |sheet| {
        let n = sheet.size(10, 6);
        let size = n as f64 * EDGE;
        let sides = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        let far = 0.5 * size + 0.55 * size;
        let block = |(k, [x, y]): (usize, [f64; 2])| Body {
            name: format!("block {}", k + 1),
            centre: [far * x, far * y, 0.0],
            velocity: [-0.2 * x, -0.2 * y, 0.0],
            ..bricks("aluminium", [n, n, n], [EDGE; 3])
        };
        let metal = ALUMINIUM.ductile([0.0029, 125.0, 0.1, 930.0]);
        let bodies = sides.into_iter().enumerate().map(block).collect();
        let mut scene = scene(sheet.space(), vec![metal], bodies);
        scene.stop_time = sheet.size(10.0, 5.0);
        meet(sheet, &scene, 0.2)?;
        in_short_steps(sheet, &scene, scene.stop_time)
    });
}

/// A meeting of two pairs of bodies that is symmetric to half a turn: what holds of it.
fn meet(sheet: &mut Sheet, scene: &Scene, speed: f64) -> Result<(), Trouble> {
    let simulation = to_the_end(sheet, scene)?;
    let balance = simulation.balance();
    let scale = balance.now.mass * speed;
    let drift = norm(minus(balance.now.momentum, balance.initial.momentum)) / scale;
    sheet.at_most("momentum over the sum of its sizes", drift, 1e-12);
    let fastest = largest(simulation.all_particles().map(|p| norm(p.velocity) / speed));
    sheet.at_most("fastest particle over the speed of the bodies", fastest, 10.0);
    let hot = largest(simulation.all_particles().map(|p| p.theta));
    sheet.enter("highest temperature", "K", hot, Bound::AtMost(f64::MAX));
    energy(sheet, &simulation);
    Ok(())
}
