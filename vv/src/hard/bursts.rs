//! Energy in too small a place, and a shield of many foils.

use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Body, Shape};

use super::contact::brittle;
use super::measure::{RESIDUAL, energy, in_short_steps, largest, to_the_end};
use super::scenes::{ALUMINIUM, HEAT, STEEL, begin, block, body, scene};
use super::sheet::{Bound, Sheet, Trouble};

/// Edge of a cell in cm.
const EDGE: f64 = 0.1;

/// W07: a cell in a block of steel is given far more energy than vapour has. Once more in shorter steps, which tell how much
/// of the residual is an error of the integration over time.
pub(super) fn hot_spot(sheet: &mut Sheet) {
    let parts: &[f64] = sheet.size(&[1.0, 0.5, 0.25], &[1.0]);
    // Energy per mass: 10 and 1000 kJ/g.
    for heat in [0.1, 10.0] {
        for &part in parts {
            let steps = if part < 1.0 { format!(", {part} of the step") } else { String::new() };
            let name = format!("one cell of steel with {} kJ/g{steps}", 100.0 * heat);
            sheet.part(name, |sheet| hot_cell(sheet, heat, part));
        }
    }
}

/// A block whose middle cell has so much energy per mass, in such a part of the step; only the whole step is asked for.
fn hot_cell(sheet: &mut Sheet, heat: f64, part: f64) -> Result<(), Trouble> {
    let [density, _, _, gamma_0, _] = STEEL.constants;
    let n = sheet.size(15, 9);
    let metal = STEEL.ductile([0.0075, 5.67, 0.49, 1700.0]);
    let mut scene = scene(sheet.space(), vec![metal], vec![block("steel", [n; 3], EDGE)]);
    scene.method.cfl *= part;
    let hot = |p: &Particle| p.position.iter().all(|x| x.abs() < 0.51 * EDGE);
    let pressure = gamma_0 * density * heat;
    let given = |p: &Particle| if hot(p) { [heat, pressure, pressure] } else { [0.0; 3] };
    let mut simulation = begin(&scene, HEAT, given)?;
    let first = simulation.step(f64::INFINITY).map(|()| simulation.last_step())?;
    let mut shortest = first;
    while simulation.time() < 3.0 {
        simulation.step(f64::INFINITY)?;
        shortest = shortest.min(simulation.last_step());
    }
    sheet.shown("elements that have died", simulation.failed().1 as f64);
    if part < 1.0 {
        sheet.shown("shortest step over the first", shortest / first);
        sheet.shown(RESIDUAL, simulation.balance().relative_residual().abs());
        return Ok(());
    }
    let finite = |p: &Particle| (p.u + p.rho + p.pressure + p.theta).is_finite();
    let bad = simulation.all_particles().filter(|p| !finite(p)).count();
    sheet.at_most("particles that are no numbers", bad as f64, 0.0);
    sheet.at_least("shortest step over the first", shortest / first, 1e-3);
    sheet.at_most("error of the momentum", momentum(&simulation), 1e-12);
    energy(sheet, &simulation);
    Ok(())
}

/// Momentum that came of nothing, over the sum of the sizes of all.
fn momentum(simulation: &Simulation) -> f64 {
    let of = |p: &Particle| p.velocity.map(|v| p.mass * v);
    let sum = |d: usize| simulation.all_particles().map(|p| of(&p)[d]).sum::<f64>();
    let sizes: f64 = simulation.all_particles().flat_map(|p| of(&p)).map(f64::abs).sum();
    largest([sum(0), sum(1), sum(2)]) / sizes
}

/// W10: a sphere at 6 km/s through five foils of one cell each, a centimetre apart.
pub(super) fn foils(sheet: &mut Sheet) {
    sheet.part("aluminium sphere through five foils at 6 km/s", |sheet| {
        let n = sheet.size(6, 4);
        let foils = sheet.size(5, 2);
        let sphere = Body {
            name: "sphere".into(),
            centre: [0.013, 0.021, 0.5 * n as f64 * EDGE + 0.6 * EDGE],
            velocity: [0.0, 0.0, -0.6],
            ..body("aluminium", Shape::Sphere { diameter: n as f64 * EDGE }, [n; 3])
        };
        let foil = |k: usize| Body {
            name: format!("foil {}", k + 1),
            centre: [0.0, 0.0, -0.5 * EDGE - k as f64],
            ..block("aluminium", [4 * n, 4 * n, 1], EDGE)
        };
        let bodies = std::iter::once(sphere).chain((0..foils).map(foil)).collect();
        let mut scene = scene(sheet.space(), vec![brittle(&ALUMINIUM)], bodies);
        scene.stop_time = sheet.size(20.0, 6.0);
        let simulation = to_the_end(sheet, &scene)?;
        let balance = simulation.balance();
        let hot = largest(simulation.all_particles().map(|p| p.theta));
        sheet.enter("highest temperature", "K", hot, Bound::AtMost(f64::MAX));
        sheet.at_most("change of the mass", balance.mass_error(), 1e-15);
        sheet.at_most("error of the momentum", balance.momentum_drift(), 1e-12);
        let pushed = |body: usize| simulation.holdings()[body].momentum[2].abs();
        let least = (1..simulation.bodies()).map(pushed).fold(f64::INFINITY, f64::min);
        sheet.at_least(
            "momentum of every foil over that of the sphere",
            least / balance.initial.momentum[2].abs(),
            1e-3,
        );
        energy(sheet, &simulation);
        in_short_steps(sheet, &scene, scene.stop_time)
    });
}
