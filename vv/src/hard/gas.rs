//! Gas along a line and in space: near vacuum, very strong shocks, and the heat of a wall.

use whipple_solver::method::{Conduction, Preset};
use whipple_solver::output::Snapshot;
use whipple_solver::scene::{EosData, Profile, Scene};
use whipple_solver::space::scene::Body;
use whipple_solver::units::Units;

use super::measure::mean;
use super::scenes::{VELOCITY, advance, begin, block, gas, scene, sleeve};
use super::sheet::{Bound, Sheet, Trouble};
use crate::cases::find;
use crate::scene::AnyScene;

/// A scene along a line of a case, with a density scheme.
pub(super) fn of_case(sheet: &Sheet, id: &str, n: usize) -> Result<Scene, Trouble> {
    let found = find(id).map(|case| case.scene(sheet.preset(), "", n));
    let Some(AnyScene::Line(mut scene)) = found else {
        return Err(Trouble::Other(format!("no case `{id}` along a line")));
    };
    scene.method = sheet.line();
    Ok(scene)
}

/// H13: gas that parts.
pub(super) fn near_vacuum(sheet: &mut Sheet) {
    // Of this gas the sound speed is sqrt(1.4 x 0.4), the streams of the case part at 2 each.
    let ten = 10.0 * (1.4f64 * 0.4).sqrt() / 2.0;
    for (name, factor) in [("Einfeldt's 123 problem", 1.0), ("streams at 10 c", ten)] {
        sheet.part(format!("{name}, along a line"), |sheet| {
            let mut scene = of_case(sheet, "einfeldt-123", 200)?;
            for body in &mut scene.bodies {
                if let Profile::Uniform(v) = body.velocity {
                    body.velocity = Profile::Uniform(factor * v);
                }
            }
            let mut solver = whipple_solver::build(&scene)?;
            solver.advance_to(scene.stop_time)?;
            let now = solver.snapshot();
            let least = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
            sheet.at_least("smallest density", least(&now.rho), f64::MIN_POSITIVE);
            sheet.at_least("smallest internal energy", least(&now.u), 0.0);
            let momentum: f64 = now.m.iter().zip(&now.v).map(|(m, v)| m * v).sum();
            let scale: f64 = now.m.iter().zip(&now.v).map(|(m, v)| m * v.abs()).sum();
            sheet.at_most("momentum over the sum of its sizes", momentum.abs() / scale, 1e-12);
            Ok(())
        });
    }
    for factor in [2.0, 10.0] {
        sheet.part(format!("halves of a column part at {factor} c, in space"), |sheet| {
            let [rho, u, first, along] = parting(sheet, factor, 0.0)?;
            sheet.at_least("smallest density", rho, f64::MIN_POSITIVE);
            sheet.at_least("smallest internal energy", u, 0.0);
            sheet.shown("steps until an energy is negative, 0 for never", first);
            sheet.at_most("momentum over the sum of its sizes", along, 1e-12);
            Ok(())
        });
    }
    // What a first step that knows no rates does to it.
    sheet.part("the same at 10 c after a step of 1e-6 units", |sheet| {
        let [rho, u, ..] = parting(sheet, 10.0, 1e-6)?;
        sheet.shown("smallest density", rho);
        sheet.shown("smallest internal energy", u);
        Ok(())
    });
}

/// Two halves of a column of gas that part, after a first step of this length if it is not zero: smallest density and
/// energy, the step of the first negative energy, and the momentum over the sum of its sizes.
fn parting(sheet: &Sheet, factor: f64, before: f64) -> Result<[f64; 4], Trouble> {
    let cells = sheet.size(40, 20);
    let energy = 1.0;
    let sound = (1.4f64 * 0.4 * energy).sqrt();
    let body = Body { energy, ..block("gas", [cells, 3, 3], 0.1) };
    let mut scene = scene(sheet.space(), vec![gas(1.4)], vec![body]);
    scene.units = Units::None;
    scene.walls = sleeve([0.3; 2]);
    let mut simulation = begin(&scene, VELOCITY, |p| {
        let side = if p.position[0].abs() < 1e-9 { 0.0 } else { p.position[0].signum() };
        [factor * sound * side, 0.0, 0.0]
    })?;
    advance(&mut simulation, before)?;
    let (mut rho, mut u, mut first) = (f64::INFINITY, f64::INFINITY, 0.0);
    while simulation.time() < 0.5 {
        simulation.step(0.5)?;
        rho = simulation.all_particles().map(|p| p.rho).fold(rho, f64::min);
        u = simulation.all_particles().map(|p| p.u).fold(u, f64::min);
        if u < 0.0 && first == 0.0 {
            first = simulation.counters().steps as f64;
        }
    }
    let now = simulation.balance().now;
    Ok([rho, u, first, now.momentum[0].abs() / now.momentum_scale])
}

/// Noh's problem along a line at a Mach number: the density behind the shock, its speed and the energy.
pub(super) fn noh_of_mach(sheet: &mut Sheet, mach: f64) -> Result<(), Trouble> {
    let n = 200;
    let mut scene = of_case(sheet, "noh", n)?;
    let gamma = 5.0 / 3.0;
    let energy = 1.0 / (mach * mach * gamma * (gamma - 1.0));
    for material in &mut scene.materials {
        if let EosData::IdealGas { u_0, .. } = &mut material.eos {
            *u_0 = 0.0;
        }
    }
    scene.bodies.iter_mut().for_each(|body| body.energy = Profile::Uniform(energy));
    let mut solver = whipple_solver::build(&scene)?;
    solver.advance_to(scene.stop_time)?;
    let now = solver.snapshot();
    // Exact: density 4, the shock at a third of the time.
    let behind = now.rho.iter().zip(&now.x).rfind(|(rho, _)| **rho > 2.5).map_or(0.0, |(_, x)| *x);
    sheet.at_most("error of the shock speed", (3.0 * behind / now.time - 1.0).abs(), 0.03);
    let plateau: Vec<f64> = now
        .rho
        .iter()
        .zip(&now.x)
        .filter(|(_, x)| (0.02..0.08).contains(*x))
        .map(|(rho, _)| *rho)
        .collect();
    sheet.shown("density behind the shock over the exact one", mean(&plateau) / 4.0);
    sheet.at_most("error of the energy balance", solver.ledger().energy_drift(), 1e-12);
    Ok(())
}

/// Norm of the temperature error of Noh's problem at n = 200 in Table 2 of the paper.
const TABLE_2: f64 = 0.06075;

/// H30: Noh's problem with conduction of several strengths.
pub(super) fn wall_heating(sheet: &mut Sheet) {
    let mut energies: Vec<f64> = Vec::new();
    for heat_coeff in [0.0, 0.1, 0.5] {
        sheet.part(format!("k_o {heat_coeff}"), |sheet| {
            let mut scene = of_case(sheet, "noh", 200)?;
            scene.method.heat_coeff = heat_coeff;
            if heat_coeff == 0.0 {
                scene.method.conduction = Conduction::None;
            }
            let mut solver = whipple_solver::build(&scene)?;
            solver.advance_to(scene.stop_time)?;
            let now = solver.snapshot();
            let [wall, rms] = temperature(&now);
            sheet.shown("temperature error at the wall, over the exact rise", wall);
            let paper = sheet.preset() == Preset::Paper && heat_coeff == 0.1;
            let off = (rms / TABLE_2 - 1.0).abs();
            if paper {
                sheet.at_most("norm of the temperature off Table 2", off, 0.25);
            } else {
                sheet.shown("norm of the temperature", rms);
            }
            let totals = solver.ledger().now;
            energies.push(totals.kinetic + totals.internal);
            Ok(())
        });
    }
    sheet.part("all k_o", |sheet| {
        let first = energies.first().copied().unwrap_or(f64::NAN);
        let complete = energies.len() == 3;
        let spread = energies.iter().map(|e| (e / first - 1.0).abs()).fold(0.0, f64::max);
        let spread = if complete { spread } else { f64::NAN };
        sheet.enter("change of the total energy with k_o", "", spread, Bound::AtMost(1e-12));
        Ok(())
    });
}

/// Error of the temperature of the particle at the wall over the exact rise of 1/2, and its root mean square over the
/// particles.
fn temperature(now: &Snapshot) -> [f64; 2] {
    let exact = |x: f64| if x < now.time / 3.0 { 1.5 } else { 1.0 };
    let errors: Vec<f64> = now.theta.iter().zip(&now.x).map(|(t, x)| t - exact(*x)).collect();
    let squares: Vec<f64> = errors.iter().map(|e| e * e).collect();
    [errors.first().copied().unwrap_or(f64::NAN) / 0.5, mean(&squares).sqrt()]
}
