//! Elements that invert, fail, and a particle that is far too fast.

use whipple_solver::space::Simulation;
use whipple_solver::space::method::Release;
use whipple_solver::space::output::Particle;

use super::measure::{largest, minus};
use super::scenes::{
    ALUMINIUM, COPPER, DISPLACEMENT, STEEL, VELOCITY, begin, block, march, scene, shift,
};
use super::sheet::{Bound, Sheet, Trouble};

/// Edge of a cell in cm.
const EDGE: f64 = 0.1;
/// Part of the step before an event that counts as recovered.
const RECOVERED: f64 = 0.5;

/// H23: a corner of a cell flies at the opposite face.
pub(super) fn inverted(sheet: &mut Sheet) {
    for (speed, cells) in [(0.1, 1), (0.1, 3), (1.0, 1), (1.0, 3)] {
        sheet.part(format!("corner of {cells} cells across at {} km/s", 10.0 * speed), |sheet| {
            let metal = STEEL.ductile([0.0075, 5.67, 0.49, 1700.0]);
            let body = block("steel", [cells; 3], EDGE);
            let mut scene = scene(sheet.space(), vec![metal], vec![body]);
            scene.stop_time = 1000.0;
            let still = Simulation::new(&scene)?;
            let sum = |p: &Particle| p.position.iter().sum::<f64>();
            let corner =
                still.all_particles().min_by(|p, q| sum(p).total_cmp(&sum(q))).map(|p| p.id);
            let push = |p: &Particle| [if Some(p.id) == corner { speed } else { 0.0 }; 3];
            let mut simulation = shift(&scene, &still, VELOCITY, push)?;
            let mut least = f64::INFINITY;
            for _ in 0..300 {
                simulation.step(f64::INFINITY)?;
                least = least.min(flattest(&simulation));
            }
            let finite =
                simulation.all_particles().filter(|p| !(p.u + p.rho + p.pressure).is_finite());
            sheet.at_most("particles that are no numbers", finite.count() as f64, 0.0);
            sheet.at_least("smallest volume ratio of a live element", least, f64::MIN_POSITIVE);
            sheet.shown("elements that have failed", simulation.failed().0 as f64);
            Ok(())
        });
    }
}

/// Smallest volume of a live element over that of a cell, by the deformation gradient at its centroid.
fn flattest(simulation: &Simulation) -> f64 {
    let of = |corners: [u32; 8]| {
        let x = corners.map(|id| simulation.particle(id).position);
        // Mean edges along the three axes: the deformation gradient at the centroid.
        let edge = |bit: usize| -> [f64; 3] {
            let ends = |on: usize| -> [f64; 3] {
                let own: Vec<[f64; 3]> =
                    (0..8).filter(|slot| slot >> bit & 1 == on).map(|slot| x[slot]).collect();
                std::array::from_fn(|d| 0.25 * own.iter().map(|x| x[d]).sum::<f64>())
            };
            minus(ends(1), ends(0))
        };
        let [a, b, c] = [edge(0), edge(1), edge(2)];
        let cross =
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        (0..3).map(|d| cross[d] * c[d]).sum::<f64>() / EDGE.powi(3)
    };
    let live = simulation.all_elements().filter(|e| e.live);
    live.map(|e| of(e.corners)).fold(f64::INFINITY, f64::min)
}

/// H24: a sheared block whose elements all fail at once loses its strength over 1, 5 and 100 steps.
pub(super) fn ramp(sheet: &mut Sheet) {
    let mut released = Vec::new();
    for (steps, cfl) in [(1.0, 1.0), (5.0, 1.0), (100.0, 1.0), (5.0, 0.5), (100.0, 0.5)] {
        sheet.part(format!("n_hat {steps}, step {cfl} of its own"), |sheet| {
            let [heat, burst] = failing(sheet, steps, cfl)?;
            sheet.shown("heat of damage over the stored energy", heat);
            sheet.at_most("largest kinetic energy over the stored energy", burst, 1.0);
            released.push(heat);
            Ok(())
        });
    }
    sheet.part("all ramps", |sheet| {
        let complete = released.len() == 5;
        let first = released.first().copied().unwrap_or(f64::NAN);
        let spread = largest(released.iter().map(|heat| heat / first - 1.0));
        let spread = if complete { spread } else { f64::NAN };
        sheet.at_most("change of the heat of damage", spread, 0.01);
        Ok(())
    });
}

/// A block of elastic copper in uniform shear, all of which fails in the next step, over so many steps of this part of
/// their length.
fn melting(sheet: &Sheet, steps: f64, cfl: f64) -> Result<Simulation, Trouble> {
    let [.., c_v] = COPPER.constants;
    let still = [0.0; 3];
    let mut metal = COPPER.elastic();
    let mut scene = scene(sheet.space(), vec![metal.clone()], vec![block("copper", [6; 3], EDGE)]);
    scene.bodies[0].energy = 0.02 * c_v;
    scene.method.release = Release::Steps(steps);
    scene.method.cfl *= cfl;
    let mut simulation = begin(&scene, DISPLACEMENT, |p| [0.01 * p.position[1], 0.0, 0.0])?;
    // The stress that stores the energy is there after a step.
    march(&mut simulation, 1)?;
    // It is at 300.02 K.
    metal.failure.melt = Some(300.01);
    scene.materials = vec![metal];
    shift(&scene, &simulation, DISPLACEMENT, |_| still)
}

/// Heat of damage and the largest kinetic energy, over the energy that was stored in shear.
fn failing(sheet: &Sheet, steps: f64, cfl: f64) -> Result<[f64; 2], Trouble> {
    let mut simulation = melting(sheet, steps, cfl)?;
    let stored = simulation.holdings()[0].shear;
    let mut most = 0.0f64;
    for _ in 0..300 {
        simulation.step(f64::INFINITY)?;
        most = most.max(simulation.holdings()[0].kinetic);
    }
    Ok([simulation.balance().element_heat / stored, most / stored])
}

/// H14: a strained block that is as hot as its melt temperature from the start, since no scene has a source of heat; and
/// aluminium that melts in a shock.
pub(super) fn melted(sheet: &mut Sheet) {
    sheet.part("sheared block at the melt temperature", |sheet| {
        let mut simulation = melting(sheet, 20.0, 1.0)?;
        let strongest = |simulation: &Simulation| {
            largest(simulation.all_elements().map(|e| e.equivalent_stress))
        };
        let first = strongest(&simulation);
        let mut most = 0.0f64;
        for _ in 0..300 {
            simulation.step(f64::INFINITY)?;
            most = most.max(strongest(&simulation));
        }
        sheet.at_most("largest stress over the initial one", most / first, 2.0);
        sheet.at_most(
            "stress at the end over the initial one",
            strongest(&simulation) / first,
            1e-9,
        );
        sheet.at_most("error of the energy balance", simulation.balance().energy_drift(), 1e-10);
        Ok(())
    });
    for speed in [5.0, 6.0, 7.0] {
        sheet.part(format!("plates of aluminium at {speed} km/s"), |sheet| {
            let up = 0.05 * speed;
            let exact = ALUMINIUM.hugoniot()?.at_particle_speed(up)?;
            let n = sheet.size(60, 30);
            let size = ([n, 3, 3], [EDGE; 3]);
            let mut scene = super::shocks::column(sheet, &ALUMINIUM, size, up);
            scene.materials = vec![ALUMINIUM.ductile([0.0029, 125.0, 0.1, 930.0])];
            let mut simulation = Simulation::new(&scene)?;
            let end = 0.8 * n as f64 * EDGE / exact.shock_speed;
            let (mut peak, mut soft) = (0.0f64, 0.0f64);
            while simulation.time() < end {
                simulation.step(end)?;
                peak = simulation.all_particles().map(|p| p.pressure).fold(peak, f64::max);
                let lost = simulation.all_elements().filter(|e| e.damage >= 1.0);
                soft = soft.max(largest(lost.map(|e| e.equivalent_stress)));
            }
            sheet.at_least("elements that have failed", simulation.failed().0 as f64, 1.0);
            sheet.at_most("largest pressure over the Hugoniot's", peak / exact.pressure, 2.0);
            sheet.enter(
                "shear stress in what has lost its strength",
                "Mbar",
                soft,
                Bound::AtMost(0.0),
            );
            sheet.at_most(
                "error of the energy balance",
                simulation.balance().energy_drift(),
                1e-10,
            );
            Ok(())
        });
    }
}

/// H28: a particle at 1000 km/s in a cold block.
pub(super) fn one_fast_particle(sheet: &mut Sheet) {
    sheet.part("centroid in the middle of a copper block at 1000 km/s", |sheet| {
        let n = sheet.size(9, 7);
        let mut scene =
            scene(sheet.space(), vec![COPPER.fluid()], vec![block("copper", [n; 3], EDGE)]);
        scene.bodies[0].noise = 1e-9;
        scene.stop_time = 10.0;
        let mut simulation = Simulation::new(&scene)?;
        march(&mut simulation, 20)?;
        let first = simulation.last_step();
        let still = Simulation::new(&scene)?;
        let size = |p: &Particle| p.position.iter().map(|x| x * x).sum::<f64>();
        let middle = still.all_particles().min_by(|p, q| size(p).total_cmp(&size(q))).map(|p| p.id);
        let speed = 100.0;
        let push = |p: &Particle| [if Some(p.id) == middle { speed } else { 0.0 }, 0.0, 0.0];
        let mut hit = shift(&scene, &still, VELOCITY, push)?;
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0f64);
        let (mut steps, mut recovered) = (0u32, f64::NAN);
        while hit.time() < 5.0 && steps < 20_000 {
            hit.step(5.0)?;
            steps += 1;
            let dt = hit.last_step();
            longest = longest.max(dt);
            if dt < shortest {
                (shortest, longest, recovered) = (dt, dt, f64::NAN);
                steps = 0;
            } else if recovered.is_nan() && dt > RECOVERED * first {
                recovered = f64::from(steps);
            }
        }
        sheet.shown("shortest step over that before", shortest / first);
        sheet.shown("sound speed over the speed", COPPER.sound() / speed);
        sheet.shown("longest step after it over that before", longest / first);
        sheet.at_most("steps from the shortest to half of that before", recovered, 50.0);
        sheet.at_most("error of the energy, residual booked", hit.balance().energy_drift(), 1e-6);
        let residual = hit.balance().relative_residual();
        sheet.shown("residual of the elements", residual);
        Ok(())
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use whipple_solver::method::Preset;

    #[test]
    fn cells_at_rest_have_their_own_volume() {
        let body = block("steel", [2; 3], EDGE);
        let scene = scene(Preset::Default.space(), vec![STEEL.elastic()], vec![body]);
        let simulation = Simulation::new(&scene).expect("a scene");
        assert!((flattest(&simulation) - 1.0).abs() < 1e-12);
    }
}
