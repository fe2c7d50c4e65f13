//! Shocks in columns: fast ones, their release, rarefaction, and cells of unequal edges.

use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Body, Hold, Scene, Shape, Side, Turn, Wall};

use super::measure::{Planes, energy, front, largest, mean, minus, norm};
use super::scenes::{
    ALUMINIUM, COPPER, Metal, STEEL, TUNGSTEN, VELOCITY, advance, begin, block, body, bricks,
    scene, sleeve,
};
use super::sheet::{Bound, Sheet, Trouble};

/// Edge of a cell in cm.
const EDGE: f64 = 0.1;
/// A first step so short that nothing moves in it, in us.
const SHORT: f64 = 1e-6;
/// Planes of particles left out at either end of a released block: six cells.
const MARGIN: usize = 12;
/// Times over which its density is averaged.
const LOOKS: u32 = 40;

/// A column that runs into a wall at x = 0 which it may leave.
pub(super) fn column(
    sheet: &Sheet,
    metal: &Metal,
    (cells, edges): ([usize; 3], [f64; 3]),
    up: f64,
) -> Scene {
    let length = cells[0] as f64 * edges[0];
    let body = Body {
        centre: [0.5 * length, 0.0, 0.0],
        velocity: [-up, 0.0, 0.0],
        ..bricks(metal.name, cells, edges)
    };
    let mut scene = scene(sheet.space(), vec![metal.fluid()], vec![body]);
    scene.walls = sleeve([cells[1] as f64 * edges[1], cells[2] as f64 * edges[2]]);
    scene.walls.push(Wall { axis: 0, position: 0.0, material: Side::Above, hold: Hold::Rest });
    scene
}

/// Speed of the shock of a column through its undeformed self, from two of its places, and the largest pressure.
fn shock(
    simulation: &mut Simulation,
    exact: [f64; 2],
    length: f64,
    half: f64,
) -> Result<f64, Trouble> {
    let [speed, pressure] = exact;
    let planes = Planes::new(simulation, 0, half);
    let mut places = Vec::new();
    for part in [0.4, 0.75] {
        advance(simulation, part * length / speed)?;
        let curve = planes.means(simulation, |p| p.pressure);
        places.push((simulation.time(), front(&curve, 0.5 * pressure)));
    }
    let [(first, Some(a)), (last, Some(b))] = places[..] else { return Ok(f64::NAN) };
    Ok((b - a) / (last - first))
}

/// H12: planar impact and a sphere on a plate at 20 and 50 km/s.
pub(super) fn fast(sheet: &mut Sheet) {
    for speed in [20.0, 50.0] {
        sheet.part(format!("Al on Al at {speed} km/s, planar"), |sheet| {
            planar(sheet, 0.05 * speed, |_| {}, None)
        });
        // What a first step that knows no rates does to it.
        sheet.part(format!("the same after a step of {SHORT:e} us"), |sheet| {
            planar(sheet, 0.05 * speed, |_| {}, Some(SHORT))
        });
        // What more viscosity does to it, with elements that bear to be pressed to a tenth.
        sheet.part(
            "the same with twice the quadratic viscosity, failing at a volume of 0.1",
            |sheet| {
                let change = |scene: &mut Scene| {
                    scene.method.visc_quad *= 2.0;
                    scene.materials[0].failure.compression = 0.1;
                };
                planar(sheet, 0.05 * speed, change, Some(0.0))
            },
        );
        sheet.part(format!("Al sphere on Al plate at {speed} km/s"), |sheet| {
            let n = sheet.size(8, 4);
            let edge = 1.0 / n as f64;
            let v = 0.1 * speed;
            let sphere = Body {
                name: "sphere".into(),
                centre: [0.01 * edge, 0.02 * edge, 0.5 + 0.6 * edge],
                velocity: [0.0, 0.0, -v],
                ..body("aluminium", Shape::Sphere { diameter: 1.0 }, [n; 3])
            };
            let plate = block("aluminium", [3 * n, 3 * n, n / 2], edge);
            let plate = Body { centre: [0.0, 0.0, -0.25], ..plate };
            let metal = ALUMINIUM.ductile([0.0029, 125.0, 0.1, 930.0]);
            let mut scene = scene(sheet.space(), vec![metal], vec![sphere, plate]);
            scene.stop_time = 3.0 / v;
            let mut simulation = Simulation::new(&scene)?;
            advance(&mut simulation, scene.stop_time)?;
            let counters = simulation.counters();
            sheet.at_most("particles and steps at a floor", counters.floored as f64, 0.0);
            energy(sheet, &simulation);
            Ok(())
        });
    }
    sheet.part("Noh along a line at Mach 1e6", |sheet| super::gas::noh_of_mach(sheet, 1e6));
}

/// A column of aluminium against a wall. As it stands its numbers have to hold, after a first step of given length, or changed,
/// they are shown.
fn planar(
    sheet: &mut Sheet,
    up: f64,
    change: impl Fn(&mut Scene),
    first: Option<f64>,
) -> Result<(), Trouble> {
    let exact = ALUMINIUM.hugoniot()?.at_particle_speed(up)?;
    let cells = sheet.size(80, 40);
    let mut scene = column(sheet, &ALUMINIUM, ([cells, 3, 3], [EDGE; 3]), up);
    change(&mut scene);
    let mut simulation = Simulation::new(&scene)?;
    advance(&mut simulation, first.unwrap_or(0.0))?;
    let length = cells as f64 * EDGE;
    let found = shock(&mut simulation, [exact.shock_speed, exact.pressure], length, 0.5 * EDGE)?;
    let error = (found / exact.shock_speed - 1.0).abs();
    let floored = simulation.counters().floored as f64;
    sheet.shown("elements that have died", simulation.failed().1 as f64);
    if first.is_some() {
        sheet.shown("error of the shock speed", error);
        sheet.shown("particles and steps at a floor", floored);
    } else {
        sheet.at_most("error of the shock speed", error, 0.03);
        sheet.at_most("particles and steps at a floor", floored, 0.0);
        energy(sheet, &simulation);
    }
    Ok(())
}

/// H05: a block shocked to 50 GPa by a wall is released at its other end, and leaves the wall.
pub(super) fn released(sheet: &mut Sheet) {
    for (metal, wanted) in [(&COPPER, 0.990), (&ALUMINIUM, 0.972), (&STEEL, 0.994)] {
        sheet.part(metal.name, |sheet| {
            let peak = 0.5;
            let state = metal.hugoniot()?.at_pressure(peak)?;
            let up = state.particle_speed;
            let exact = metal.gruneisen()?.release(up, 0.0)?;
            let density = exact.density / metal.density();
            sheet.enter(
                "end density of the isentrope over the list's",
                "",
                density / wanted,
                Bound::Shown,
            );
            let cells = sheet.size(60, 30);
            let length = cells as f64 * EDGE;
            let scene = column(sheet, metal, ([cells, 3, 3], [EDGE; 3]), up);
            let mut simulation = Simulation::new(&scene)?;
            let planes = Planes::new(&simulation, 0, 0.5 * EDGE);
            // The shock runs through and the release back; then the block rings about its stress-free state, so
            // that densities are averaged over the time after. In sample: chosen when single readings had missed.
            let crossing = length / metal.sound();
            let mut densities = Vec::new();
            for k in 0..=LOOKS {
                let part = f64::from(k) / f64::from(LOOKS);
                advance(&mut simulation, (4.0 + 8.0 * part) * crossing)?;
                let all = planes.means(&simulation, |p| p.rho / metal.density());
                densities.extend(all[MARGIN..all.len() - MARGIN].iter().map(|p| p.1));
            }
            let error = (mean(&densities) / density - 1.0).abs();
            sheet.at_most("error of the end density", error, 0.005);
            let lonely = lonely(&simulation, sheet.space().reach());
            let pressures = lonely.iter().map(|p| p.pressure / peak);
            sheet.at_most("pressure without a contact, over the peak", largest(pressures), 1e-3);
            sheet.shown("particles without a contact", lonely.len() as f64);
            energy(sheet, &simulation);
            Ok(())
        });
    }
}

/// Particles that nothing touches: no element holds them, and no other particle is within reach.
fn lonely(simulation: &Simulation, reach: f64) -> Vec<Particle> {
    let all: Vec<Particle> = simulation.all_particles().collect();
    let far = reach * simulation.sizes(0).0;
    let near =
        |p: &Particle, q: &Particle| p.id != q.id && norm(minus(p.position, q.position)) < far;
    let free = |p: &&Particle| p.held == 0.0 && !all.iter().any(|q| near(p, q));
    all.iter().filter(free).copied().collect()
}

/// H15: two halves of a cold column part, with conduction and without.
pub(super) fn rarefied(sheet: &mut Sheet) {
    for heat_coeff in [0.0, 0.5] {
        for up in [0.05, 0.2] {
            sheet.part(format!("copper parts at {} km/s, k_o {heat_coeff}", 10.0 * up), |sheet| {
                let cells = sheet.size(40, 20);
                let body = block("copper", [cells, 3, 3], EDGE);
                let mut scene = scene(sheet.space(), vec![COPPER.fluid()], vec![body]);
                scene.method.heat_coeff = heat_coeff;
                scene.walls = sleeve([3.0 * EDGE; 2]);
                let mut simulation =
                    begin(&scene, VELOCITY, |p| [up * p.position[0].signum(), 0.0, 0.0])?;
                let [_, c0, _, _, c_v] = COPPER.constants;
                let mut coldest = f64::INFINITY;
                let end = 2.0 * cells as f64 * EDGE / c0;
                while simulation.time() < end {
                    simulation.step(end)?;
                    let thetas = simulation.all_particles().map(|p| p.theta);
                    coldest = thetas.fold(coldest, f64::min);
                }
                let floored = simulation.counters().floored as f64;
                let cold = c_v * coldest / (c0 * c0);
                let counted = if floored > 0.0 { 0.0 } else { cold.min(0.0) };
                sheet.at_least("thermal energy that is not counted, over c0^2", counted, -1e-9);
                sheet.enter("lowest temperature", "K", coldest, Bound::Shown);
                sheet.shown("particles and steps at the floor", floored);
                let drift = simulation.balance().energy_drift();
                sheet.at_most("error of the energy balance, floors booked", drift, 1e-12);
                Ok(())
            });
        }
    }
}

/// Lattices through which a shock runs along a plane of cells, a diagonal of their faces, and one of their bodies.
const LATTICES: [(&str, [f64; 3], f64); 4] = [
    ("<100>", [0.0, 0.0, 1.0], 0.0),
    ("<110>", [0.0, 0.0, 1.0], 45.0),
    // From a diagonal of the cells to the x axis.
    ("<111>", [0.0, 1.0, -1.0], 54.735_610_317_245_35),
    ("30 degrees", [0.0, 0.0, 1.0], 30.0),
];

/// H25: shocks along and across the lattice, and two metals that meet a wall side by side.
pub(super) fn oblique(sheet: &mut Sheet) {
    let up = 0.1;
    let mut found: Vec<[f64; 2]> = Vec::new();
    for (name, axis, degrees) in LATTICES {
        sheet.part(format!("halves of aluminium at 2 km/s, along {name}"), |sheet| {
            let lattice = Turn { axis, degrees };
            let [speed, pressure, aside] = through(sheet, lattice, up)?;
            let exact = ALUMINIUM.hugoniot()?.at_particle_speed(up)?;
            sheet.shown("speed of the shock over the exact one", speed / exact.shock_speed);
            sheet.shown("pressure behind it over the exact one", pressure / exact.pressure);
            sheet.at_most("speed aside behind it, over that of the material", aside / up, 0.05);
            found.push([speed, pressure]);
            Ok(())
        });
    }
    sheet.part("all lattices", |sheet| {
        let complete = found.len() == LATTICES.len();
        for (k, what) in ["speed of the shock", "pressure behind it"].into_iter().enumerate() {
            let all: Vec<f64> = found.iter().map(|found| found[k]).collect();
            let (least, most) =
                all.iter().fold((f64::INFINITY, 0.0f64), |(l, m), x| (l.min(*x), m.max(*x)));
            let spread = if complete { most / least - 1.0 } else { f64::NAN };
            sheet.at_most(&format!("{what}, largest over smallest less 1"), spread, 0.02);
        }
        Ok(())
    });
    sheet.part("aluminium and copper side by side on a wall at 1 km/s", |sheet| {
        let n = sheet.size(12, 8);
        let half = 0.5 * n as f64 * EDGE;
        let gap = 0.51 * EDGE;
        let bar = |metal: &Metal, side: f64| Body {
            centre: [half + 0.5 * EDGE, side * (half + 0.5 * gap), 0.0],
            velocity: [-up, 0.0, 0.0],
            ..block(metal.name, [n; 3], EDGE)
        };
        let metals = vec![ALUMINIUM.fluid(), COPPER.fluid()];
        let mut scene =
            scene(sheet.space(), metals, vec![bar(&ALUMINIUM, 1.0), bar(&COPPER, -1.0)]);
        scene.walls.push(Wall { axis: 0, position: 0.0, material: Side::Above, hold: Hold::Rest });
        let mut simulation = Simulation::new(&scene)?;
        advance(&mut simulation, 2.0 * half / ALUMINIUM.sound())?;
        let fastest = largest(simulation.all_particles().map(|p| norm(p.velocity) / up));
        // A free surface takes twice the speed at most.
        sheet.at_most("fastest particle over the speed of impact", fastest, 3.0);
        energy(sheet, &simulation);
        Ok(())
    });
}

/// Speed of the shock in a wide block whose halves run into each other, the pressure behind it, and the largest speed aside, all
/// in the core that nothing from its sides has reached. The halves are one lattice, so that no stairs meet.
fn through(sheet: &Sheet, lattice: Turn, up: f64) -> Result<[f64; 3], Trouble> {
    let n = sheet.size(20, 16);
    let (long, wide) = (n as f64 * EDGE, 2.4 * n as f64 * EDGE);
    let shape = Shape::Skewed { size: [2.0 * long, wide, wide], lattice };
    // Cells as near to cubes of one edge as whole numbers are.
    let cells = shape.extent().map(|extent| (extent / EDGE).round() as usize);
    let block = body("aluminium", shape, cells);
    let scene = scene(sheet.space(), vec![ALUMINIUM.fluid()], vec![block]);
    let mut simulation = begin(&scene, VELOCITY, |p| {
        let side = if p.position[0].abs() < 1e-9 { 0.0 } else { p.position[0].signum() };
        [-up * side, 0.0, 0.0]
    })?;
    let core = 0.15 * wide;
    // Particles of a slice as thick as a cell, and the sum of their places.
    let mut bins: Vec<(f64, Vec<u32>)> = vec![(0.0, Vec::new()); n];
    let inner = |p: &Particle| p.position[1].abs().max(p.position[2].abs()) < core;
    for p in simulation.all_particles().filter(|p| p.position[0] > 0.0 && inner(p)) {
        let (sum, ids) = &mut bins[((p.position[0] / EDGE) as usize).min(n - 1)];
        *sum += p.position[0];
        ids.push(p.id);
    }
    let exact = ALUMINIUM.hugoniot()?.at_particle_speed(up)?;
    let mut places = Vec::new();
    for part in [0.45, 0.8] {
        advance(&mut simulation, part * long / exact.shock_speed)?;
        let pressure = |ids: &Vec<u32>| {
            mean(&ids.iter().map(|&id| simulation.particle(id).pressure).collect::<Vec<f64>>())
        };
        let curve: Vec<(f64, f64)> =
            bins.iter().map(|(sum, ids)| (sum / ids.len() as f64, pressure(ids))).collect();
        places.push((simulation.time(), front(&curve, 0.5 * exact.pressure), curve));
    }
    let [(first, Some(a), _), (last, Some(b), curve)] = &places[..] else {
        return Ok([f64::NAN; 3]);
    };
    let behind = 4..((0.8 * n as f64) as usize).saturating_sub(5);
    let pressure = mean(&curve[behind.clone()].iter().map(|p| p.1).collect::<Vec<f64>>());
    let aside = bins[behind].iter().flat_map(|(_, ids)| ids).map(|&id| {
        let v = simulation.particle(id).velocity;
        v[1].hypot(v[2])
    });
    Ok([(b - a) / (last - first), pressure, largest(aside)])
}

/// H17: waves along each axis of flat and of slender cells, and slender particles that meet.
pub(super) fn flat_cells(sheet: &mut Sheet) {
    for edges in [[0.1, 1.0, 1.0], [1.0, 0.1, 1.0], [0.1, 0.1, 1.0], [1.0, 0.1, 0.1]] {
        sheet.part(format!("cells of {edges:?} cm, wave along the first"), |sheet| {
            let up = 0.002;
            let exact = COPPER.hugoniot()?.at_particle_speed(up)?;
            let n = sheet.size(40, 20);
            let scene = column(sheet, &COPPER, ([n, 3, 3], edges), up);
            let mut simulation = Simulation::new(&scene)?;
            let speeds = [exact.shock_speed, exact.pressure];
            let found = shock(&mut simulation, speeds, n as f64 * edges[0], 0.5 * edges[0])?;
            sheet.at_most("error of the wave speed", (found / exact.shock_speed - 1.0).abs(), 0.03);
            Ok(())
        });
    }
    sheet.part("slender particles, tip to side", |sheet| {
        let fast = Body {
            velocity: [0.1, -0.05, 0.0],
            ..bricks("tungsten", [2, 4, 4], [0.5, 0.05, 0.05])
        };
        let slow =
            Body { centre: [0.72, -0.13, 0.02], ..bricks("steel", [4, 2, 4], [0.05, 0.5, 0.05]) };
        let metals = vec![TUNGSTEN.elastic(), STEEL.elastic()];
        let mut simulation = Simulation::new(&scene(sheet.space(), metals, vec![fast, slow]))?;
        advance(&mut simulation, 6.0)?;
        let balance = simulation.balance();
        sheet.at_least("momentum handed over, g cm/us", simulation.holdings()[1].momentum[0], 1e-4);
        sheet.at_most("error of the angular momentum", balance.angular_drift(), 1e-10);
        let deepest = deepest(&simulation);
        sheet.enter("tip beyond the far side", "cm", deepest, Bound::AtMost(0.0));
        Ok(())
    });
}

/// How far the first body reaches beyond the far side of the second along x.
fn deepest(simulation: &Simulation) -> f64 {
    let farthest = |body: usize| {
        let own = simulation.all_particles().filter(|p| p.body == body);
        own.map(|p| p.position[0]).fold(f64::NEG_INFINITY, f64::max)
    };
    farthest(0) - farthest(1)
}
