//! Modes of motion that elements may not see: sublattices against each other, and hourglass patterns.

use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::Scene;

use super::measure::{largest, mean};
use super::scenes::{COPPER, DISPLACEMENT, HEAT, Metal, STEEL, VELOCITY, begin, block, scene};
use super::sheet::{Sheet, Trouble};
use crate::cases::find;
use crate::record::{Outcome, RunKey, Scheme};
use crate::run::{Request, Silent, run};

/// Edge of a cell in cm.
const EDGE: f64 = 0.1;
/// Cells along each axis.
const CELLS: [usize; 3] = [6; 3];
/// Speed of the sublattices: 1 m/s.
const SPEED: f64 = 1e-4;
/// Pressure that alternates between them, in Mbar.
const PRESSURE: f64 = 1e-4;
/// Displacement of an hourglass pattern over the edge of a cell.
const AMPLITUDE: f64 = 1e-3;

/// Whether a particle is a centroid of a lattice whose nodes lie at whole cells from its corner.
fn is_centroid(p: &Particle) -> bool {
    let cells = p.position[0] / EDGE + 0.5 * CELLS[0] as f64;
    (cells - cells.round()).abs() > 0.25
}

/// H07: nodes against centroids.
pub(super) fn sublattices(sheet: &mut Sheet) {
    for (metal, strong) in [(&COPPER, false), (&STEEL, true)] {
        let material = if strong { metal.elastic() } else { metal.fluid() };
        let kind = if strong { "with shear" } else { "without strength" };
        sheet.part(format!("{}, {kind}: velocities", metal.name), |sheet| {
            let body = block(metal.name, CELLS, EDGE);
            let scene = scene(sheet.space(), vec![material.clone()], vec![body]);
            let mut simulation = begin(&scene, VELOCITY, |p| {
                [if is_centroid(p) { -SPEED } else { SPEED }, 0.0, 0.0]
            })?;
            decays(sheet, &mut simulation, metal, checkerboard)
        });
        sheet.part(format!("{}, {kind}: pressures", metal.name), |sheet| {
            let [density, _, _, gamma_0, _] = metal.constants;
            let body = block(metal.name, CELLS, EDGE);
            let scene = scene(sheet.space(), vec![material], vec![body]);
            let energy = PRESSURE / (gamma_0 * density);
            let mut simulation = begin(&scene, HEAT, |p| {
                if is_centroid(p) { [energy, PRESSURE, PRESSURE] } else { [0.0; 3] }
            })?;
            decays(sheet, &mut simulation, metal, |simulation| {
                let of = |centroids: bool| -> Vec<f64> {
                    let own = simulation
                        .all_particles()
                        .filter(|p| is_centre(p.id, simulation) == centroids);
                    own.map(|p| p.pressure).collect()
                };
                (mean(&of(true)) - mean(&of(false))).powi(2)
            })
        });
    }
}

/// Whether a particle is the centroid of an element: they come after all nodes.
fn is_centre(id: u32, simulation: &Simulation) -> bool {
    id as usize >= simulation.particles() - simulation.elements()
}

/// Kinetic energy of centroids against the mean of their corners.
fn checkerboard(simulation: &Simulation) -> f64 {
    simulation
        .all_elements()
        .map(|element| {
            let centre = simulation.particle(element.centre);
            let corners = element.corners.map(|i| simulation.particle(i).velocity);
            let square = |d: usize| {
                (centre.velocity[d] - 0.125 * corners.iter().map(|v| v[d]).sum::<f64>()).powi(2)
            };
            0.25 * centre.mass * (0..3).map(square).sum::<f64>()
        })
        .sum()
}

/// Enters the largest energy of a mode in the run, and in its last tenth, over that at the start.
fn decays(
    sheet: &mut Sheet,
    simulation: &mut Simulation,
    metal: &Metal,
    energy: impl Fn(&Simulation) -> f64,
) -> Result<(), Trouble> {
    let first = energy(simulation);
    let end = 20.0 * EDGE / metal.sound();
    let (mut most, mut last) = (0.0f64, 0.0f64);
    while simulation.time() < end {
        simulation.step(end)?;
        let now = largest([energy(simulation) / first]);
        most = most.max(now);
        if simulation.time() > 0.9 * end {
            last = last.max(now);
        }
    }
    sheet.at_most("largest energy of the mode over the initial one", most, 1.0 + 1e-9);
    sheet.at_most("energy of the mode left after 20 dx/c", last, 0.01);
    Ok(())
}

/// Signs of the four hourglass modes at a place counted in cells.
fn signs([a, b, c]: [usize; 3]) -> [f64; 4] {
    let sign = |n: usize| if n.is_multiple_of(2) { 1.0 } else { -1.0 };
    [sign(a + b), sign(b + c), sign(a + c), sign(a + b + c)]
}

/// H08: hourglass patterns, and a beam that bends.
pub(super) fn hourglass(sheet: &mut Sheet) {
    let steps = sheet.size(1000, 200);
    for (metal, strong) in [(&COPPER, false), (&STEEL, true)] {
        let material = if strong { metal.elastic() } else { metal.fluid() };
        let kind = if strong { "with shear" } else { "without strength" };
        sheet.part(format!("{}, {kind}: 12 patterns, {steps} steps", metal.name), |sheet| {
            let (mut worst, mut control) = (0.0f64, 0.0f64);
            for mode in 0..4 {
                for axis in 0..3 {
                    let body = block(metal.name, CELLS, EDGE);
                    let scene = scene(sheet.space(), vec![material.clone()], vec![body]);
                    let [most, held] = pattern(&scene, [mode, axis], steps)?;
                    (worst, control) = (worst.max(most), control.max(held));
                }
            }
            sheet.at_most("largest amplitude over the initial one", worst, 2.0);
            sheet.at_most("energy of the control over the internal one", control, 0.01);
            Ok(())
        });
    }
    sheet.part("free beam in bending, 4 cells through the height", |sheet| {
        let found = find("beam").map(|case| (case, case.scene(sheet.preset(), "", 4)));
        let Some((case, mut scene)) = found else {
            return Err(Trouble::Other(format!("no case `{}` in space", "beam")));
        };
        let scheme = sheet.scheme();
        if let Scheme::Particles { density, .. } = scheme {
            scene.set_density(density);
        }
        let request = Request {
            key: RunKey::new("beam", scheme, 4),
            scene: Some(scene),
            threads: 1,
            command: String::new(),
        };
        let record = run(case, request, &Silent)?.record;
        if let Outcome::Failed { message, .. } = record.outcome {
            return Err(Trouble::Other(message));
        }
        let error = record.norms.get("frequency_error").copied().unwrap_or(f64::NAN);
        sheet.at_most("error of the bending frequency", error.abs(), 0.05);
        Ok(())
    });
}

/// Largest amplitude of a pattern in a run over that at the start, and the largest energy of the control over the
/// internal energy and that of strain.
fn pattern(scene: &Scene, [mode, axis]: [usize; 2], steps: usize) -> Result<[f64; 2], Trouble> {
    let place = |p: &Particle| {
        p.position.map(|x| (x / EDGE + 0.5 * CELLS[0] as f64).round().max(0.0) as usize)
    };
    let mut simulation = begin(scene, DISPLACEMENT, |p| {
        let sign = if is_centroid(p) { 0.0 } else { signs(place(p))[mode] };
        std::array::from_fn(|d| if d == axis { AMPLITUDE * EDGE * sign } else { 0.0 })
    })?;
    // By places in space: the axes of a lattice may stand in another order.
    let whole = Simulation::new(scene)?;
    let mut own = vec![0.0; whole.all_particles().map(|p| p.id as usize + 1).max().unwrap_or(0)];
    for p in whole.all_particles() {
        own[p.id as usize] = signs(place(&p))[mode];
    }
    let amplitude = |simulation: &Simulation| {
        let squares: Vec<f64> = simulation
            .all_elements()
            .map(|element| {
                let of = |slot: usize| {
                    let id = element.corners[slot] as usize;
                    0.125 * own[id] * simulation.displacement(id)[axis]
                };
                (0..8).map(of).sum::<f64>().powi(2)
            })
            .collect();
        mean(&squares).sqrt()
    };
    let first = amplitude(&simulation);
    let (mut most, mut control) = (0.0f64, 0.0f64);
    for step in 0..steps {
        simulation.step(f64::INFINITY)?;
        if step % 5 == 0 {
            let held = simulation.balance().now;
            let own = held.internal + held.shear + held.tension;
            most = most.max(largest([amplitude(&simulation) / first]));
            control = control.max(largest([held.hourglass / own.max(f64::MIN_POSITIVE)]));
        }
    }
    Ok([most, control])
}

#[cfg(test)]
mod tests {
    use super::super::{Extent, SCHEMES};
    use super::*;

    #[test]
    fn every_pattern_is_there_at_the_start() {
        let sheet = Sheet::new(SCHEMES[0], Extent::Quick).expect("particles");
        for (mode, axis) in (0..4).flat_map(|mode| (0..3).map(move |axis| (mode, axis))) {
            let body = block("copper", CELLS, EDGE);
            let scene = scene(sheet.space(), vec![COPPER.fluid()], vec![body]);
            let Ok([most, _]) = pattern(&scene, [mode, axis], 20) else {
                panic!("pattern {mode} along {axis} does not run");
            };
            assert!(most > 0.5 && most < 2.0, "{mode} {axis}: {most}");
        }
    }

    #[test]
    fn patterns_have_no_linear_part() {
        for mode in 0..4 {
            let of = |slot: usize| [slot & 1, slot >> 1 & 1, slot >> 2 & 1];
            let sum: f64 = (0..8).map(|slot| signs(of(slot))[mode]).sum();
            let slope = |axis: usize| -> f64 {
                (0..8).map(|slot| signs(of(slot))[mode] * of(slot)[axis] as f64).sum()
            };
            assert_eq!([sum, slope(0), slope(1), slope(2)], [0.0; 4], "{mode}");
        }
    }

    #[test]
    fn nodes_and_centroids_are_told_apart() {
        let sheet = Sheet::new(SCHEMES[0], Extent::Quick).expect("particles");
        let body = block("copper", CELLS, EDGE);
        let scene = scene(sheet.space(), vec![COPPER.fluid()], vec![body]);
        let simulation = Simulation::new(&scene).expect("a scene");
        assert!(
            simulation.all_particles().all(|p| is_centroid(&p) == is_centre(p.id, &simulation))
        );
    }
}
