//! Waves and slow motion in bodies: a pull, and a wave into a coarser lattice.

use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};
use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::Body as SpaceBody;
use whipple_solver::units::Units;

use super::measure::{largest, mean, minus, norm};
use super::scenes::{
    COPPER, DISPLACEMENT, STEEL, VELOCITY, advance, begin, block, scatter, scene, shift, sleeve,
};
use super::sheet::{Sheet, Trouble};

/// Edge of a cell in cm.
const EDGE: f64 = 0.1;
/// Cells of the length `L` of the pulled bar that is looked at.
const LOOKED: usize = 10;
/// Perturbation of the lattice over the edge of a cell.
const PERTURBED: f64 = 1e-6;

/// H03: a bar is stretched at the rate `c0/(100 L)`, to 5 % in 5 transit times and on to 10. What is looked at is
/// the middle tenth of a millimetre lattice so long that no wave from its free ends gets there.
pub(super) fn pulled(sheet: &mut Sheet) {
    sheet.part("uniaxial strain between mirrors", |sheet| {
        let transits = sheet.size(10.0, 3.0);
        let length = LOOKED as f64 * EDGE;
        let longitudinal = longitudinal();
        // Waves of both ends run through the strained bar.
        let cells = LOOKED * (1.0 + 2.4 * transits * longitudinal / COPPER.sound()).ceil() as usize;
        let rate = COPPER.sound() / (100.0 * length);
        let body = block("copper", [cells, 3, 3], EDGE);
        let mut scene = scene(sheet.space(), vec![COPPER.elastic()], vec![body]);
        scene.walls = sleeve([3.0 * EDGE; 2]);
        let runs = transits * length / COPPER.sound();
        scene.stop_time = runs;
        let pull = |p: &Particle| [rate * p.position[0], 0.0, 0.0];
        let start = |perturbed: f64| -> Result<Simulation, Trouble> {
            let bent = begin(&scene, DISPLACEMENT, |p| {
                std::array::from_fn(|d| {
                    // What lies on a mirror stays on it.
                    let held = d > 0 && p.position[d].abs() > 1.49 * EDGE;
                    if held {
                        0.0
                    } else {
                        perturbed * EDGE * scatter(3 * u64::from(p.id) + d as u64)
                    }
                })
            })?;
            shift(&scene, &bent, VELOCITY, pull)
        };
        let [mut plain, mut other] = [start(0.0)?, start(PERTURBED)?];
        let middle: Vec<u32> = plain
            .all_particles()
            .filter(|p| p.position[0].abs() < 0.5 * length)
            .map(|p| p.id)
            .collect();
        let strain_times = [0.5, 1.0];
        for part in strain_times {
            advance(&mut plain, part * runs)?;
            advance(&mut other, part * runs)?;
            let apart = middle
                .iter()
                .map(|&id| norm(minus(plain.particle(id).position, other.particle(id).position)));
            let transits = part * transits;
            let grown = largest(apart) / (3f64.sqrt() * PERTURBED * EDGE);
            sheet.at_most(&format!("growth of the perturbation, {transits} transits"), grown, 10.0);
            let spread = spread(&other, &middle);
            sheet.at_most(
                &format!("spread of nearest distances, {transits} transits"),
                spread,
                1e-4,
            );
        }
        Ok(())
    });
}

/// Speed of longitudinal waves in copper.
fn longitudinal() -> f64 {
    (COPPER.sound().powi(2) + 4.0 / 3.0 * COPPER.shear / COPPER.density()).sqrt()
}

/// Largest deviation of the distance of a centroid from a corner from the mean, over the mean, of elements in
/// the middle.
fn spread(simulation: &Simulation, middle: &[u32]) -> f64 {
    let distances: Vec<f64> = simulation
        .all_elements()
        .filter(|e| middle.contains(&e.centre))
        .flat_map(|e| {
            let centre = simulation.particle(e.centre).position;
            e.corners.map(|corner| norm(minus(simulation.particle(corner).position, centre)))
        })
        .collect();
    let mean = mean(&distances);
    largest(distances.iter().map(|d| d / mean - 1.0))
}

/// H22: particles of unequal sizes in contact and, along a line, joined.
pub(super) fn unequal_sizes(sheet: &mut Sheet) {
    for ratio in [2usize, 4, 10] {
        sheet.part(format!("blocks that collide, cells 1:{ratio}"), |sheet| {
            let fine = 0.2 / ratio as f64;
            let across = ratio;
            let small = SpaceBody {
                centre: [-0.5 * 0.2 - 0.2, 0.013, 0.007],
                velocity: [0.05, 0.0, 0.0],
                ..block("steel", [ratio, across, across], fine)
            };
            let large = SpaceBody { centre: [0.2, 0.0, 0.0], ..block("copper", [2, 3, 3], 0.2) };
            let metals = vec![STEEL.fluid(), COPPER.fluid()];
            let scene = scene(sheet.space(), metals, vec![small, large]);
            let mut simulation = Simulation::new(&scene)?;
            advance(&mut simulation, 4.0)?;
            let balance = simulation.balance();
            sheet.at_least(
                "momentum handed over, g cm/us",
                simulation.holdings()[1].momentum[0],
                1e-9,
            );
            sheet.at_most("error of the momentum", balance.momentum_drift(), 1e-13);
            Ok(())
        });
    }
    for ratio in [2usize, 4, 10] {
        sheet.part(format!("gas along a line, joined, spacings 1:{ratio}"), |sheet| {
            let reflected = reflected(sheet, ratio)?;
            if ratio == 2 {
                sheet.at_most("reflected over the wave", reflected, 0.05);
            } else {
                sheet.shown("reflected over the wave", reflected);
            }
            Ok(())
        });
    }
}

/// Speed of the wave over that of sound.
const WAVE: f64 = 1e-3;

/// A wave of the shape of a cosine, 40 fine spacings long, runs into a coarser joined lattice: the largest wave that
/// comes back, over it.
fn reflected(sheet: &Sheet, ratio: usize) -> Result<f64, Trouble> {
    let gamma: f64 = 1.4;
    let energy = 1.0 / (gamma * (gamma - 1.0));
    let per_length = 40;
    let body = |from: f64, to: f64, finer: usize| Body {
        material: "gas".into(),
        from,
        to,
        particles: ((to - from) * f64::from(per_length)) as usize / finer,
        layout: Layout::Centres,
        compression: 1.0,
        interface: Interface::Joined,
        velocity: Profile::Uniform(0.0),
        energy: Profile::Uniform(energy),
    };
    // Sound has speed 1, the gas density 1: p' = v, and e' = v / (gamma - 1) at constant density.
    let bump = |amplitude: f64, mean: f64| Profile::Cosine {
        mean: mean + 0.5 * amplitude,
        amplitude: -0.5 * amplitude,
        mode: 2.0,
    };
    let wave = Body {
        velocity: bump(WAVE, 0.0),
        energy: bump(WAVE / (gamma - 1.0), energy),
        ..body(4.0, 5.0, 1)
    };
    let scene = Scene {
        name: "hard".into(),
        units: Units::None,
        stop_time: 4.0,
        method: sheet.line(),
        boundaries: Boundaries { left: Boundary::Mirror(0.0), right: Boundary::Mirror(14.0) },
        materials: vec![Material {
            name: "gas".into(),
            density: 1.0,
            eos: EosData::IdealGas { adiabatic_index: gamma, c_v: 1.0, u_0: 0.0, theta_0: 0.0 },
        }],
        bodies: vec![body(0.0, 4.0, 1), wave, body(5.0, 7.0, 1), body(7.0, 14.0, ratio)],
    };
    let mut solver = whipple_solver::build(&scene)?;
    solver.advance_to(4.0)?;
    let now = solver.snapshot();
    // The wave is at 8 to 9 by now, what came back at 5 to 6, and the heat that it started from at 4 to 5.
    let left = now.x.iter().zip(now.v.iter().zip(&now.pressure));
    let back = left
        .filter(|(x, _)| (5.1..6.8).contains(*x))
        .map(|(_, (v, p))| 0.5 * ((p - 1.0 / gamma) - v));
    Ok(largest(back) / WAVE)
}
