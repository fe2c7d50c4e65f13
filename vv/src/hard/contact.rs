//! Contact between bodies: unlike densities, gaps, grazing, and what is left of a plate.

use whipple_solver::method::Density;
use whipple_solver::scene::{
    Body as Stretch, Boundaries, Boundary, EosData, Interface, Layout, Material as Gas, Profile,
    Scene as Line,
};
use whipple_solver::space::Simulation;
use whipple_solver::space::method::Method;
use whipple_solver::space::scene::{Body, EosData as SpaceEos, Failure, Material, Scene, Shape};
use whipple_solver::units::Units;

use super::measure::{Planes, largest, mean, minus, to_the_end};
use super::scenes::{
    ALUMINIUM, COPPER, Metal, STEEL, TUNGSTEN, advance, block, body, scene, sleeve,
};
use super::sheet::{Bound, Sheet, Trouble};
use crate::exact::Gas as State;
use crate::exact::hugoniot::{Hugoniot, PlanarImpact};
use crate::exact::riemann::Riemann;

/// Edge of a cell in cm.
const EDGE: f64 = 0.1;
/// Foam as light as tungsten particles ten times as fine are: density, `c0`, `s`.
const FOAM: [f64; 3] = [0.02, 0.05, 1.1];
/// Speed of the tungsten: 1 km/s.
const SPEED: f64 = 0.1;

/// H06: tungsten runs into foam, and a heavy gas into a light one.
pub(super) fn unlike_densities(sheet: &mut Sheet) {
    for finer in [1usize, 10] {
        let kind = if finer == 1 { "size" } else { "mass" };
        sheet.part(format!("tungsten on foam, particles of equal {kind}"), |sheet| {
            on_foam(sheet, finer)
        });
    }
    for equal_mass in [false, true] {
        let kind = if equal_mass { "mass" } else { "size" };
        sheet.part(format!("gases 1000:1 along a line, particles of equal {kind}"), |sheet| {
            gases(sheet, equal_mass)
        });
    }
}

/// Foam, which is crushed to a twentieth before it fails.
pub(super) fn foam() -> Material {
    let [density, c0, s] = FOAM;
    let eos = match COPPER.fluid().eos {
        SpaceEos::MieGruneisen { law, .. } => {
            SpaceEos::MieGruneisen { c0, s, gamma_0: 0.5, law, c_v: 1e-5, theta_0: 300.0 }
        }
        gas @ SpaceEos::IdealGas { .. } => gas,
    };
    let failure = Failure { compression: 0.05, ..Failure::default() };
    Material { name: "foam".into(), density, eos, failure, ..COPPER.fluid() }
}

/// The tungsten has cells so many times as fine as the foam's.
fn on_foam(sheet: &mut Sheet, finer: usize) -> Result<(), Trouble> {
    let [density, c0, s] = FOAM;
    let across = if finer == 1 { 3 } else { 1 };
    let width = across as f64 * EDGE;
    let fine = EDGE / finer as f64;
    let length = 2.0;
    let along = if finer == 1 { 10 } else { 20 };
    let tungsten = Body {
        centre: [-0.5 * along as f64 * fine - 0.5 * EDGE, 0.0, 0.0],
        velocity: [SPEED, 0.0, 0.0],
        ..block("tungsten", [along, across * finer, across * finer], fine)
    };
    let target = Body {
        centre: [0.5 * length, 0.0, 0.0],
        ..block("foam", [(length / EDGE) as usize, across, across], EDGE)
    };
    let mut scene = scene(sheet.space(), vec![TUNGSTEN.fluid(), foam()], vec![tungsten, target]);
    scene.walls = sleeve([width; 2]);
    let exact = PlanarImpact::new(&TUNGSTEN.hugoniot()?, &Hugoniot::new(density, c0, s)?, SPEED)?;
    let mut simulation = Simulation::new(&scene)?;
    let planes = Planes::new(&simulation, 1, 0.5 * EDGE);
    let end = 0.7 * length / exact.target.shock_speed;
    let mut deepest = f64::NEG_INFINITY;
    let mut pressures = Vec::new();
    for k in 1..=40 {
        advance(&mut simulation, end * f64::from(k) / 40.0)?;
        let ends = [0, 1].map(|body| extremes(&simulation, body));
        deepest = deepest.max((ends[0][1] - ends[1][0]) / EDGE);
        if k > 30 {
            let near = planes.means(&simulation, |p| p.pressure);
            pressures.extend(near[2..10].iter().map(|p| p.1));
        }
    }
    sheet.at_most("overlap, over the cell of the foam", deepest, 0.5);
    let error = mean(&pressures) / exact.pressure - 1.0;
    sheet.at_most("error of the pressure beside the interface", error.abs(), 0.05);
    sheet.at_most("error of the momentum", simulation.balance().momentum_drift(), 1e-12);
    Ok(())
}

/// Smallest and largest x of the particles of a body.
fn extremes(simulation: &Simulation, body: usize) -> [f64; 2] {
    let own = simulation.all_particles().filter(|p| p.body == body);
    own.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| {
        [low.min(p.position[0]), high.max(p.position[0])]
    })
}

/// A heavy gas at speed 2 against a light one at rest, at equal pressures.
fn gases(sheet: &mut Sheet, equal_mass: bool) -> Result<(), Trouble> {
    let gamma = 1.4;
    let of = |density: f64, velocity: f64| State { density, velocity, pressure: 1e-3, gamma };
    let (heavy, light) = (of(1.0, 2.0), of(1e-3, 0.0));
    let fine = sheet.size(400, 200);
    let material = |name: &str, density| Gas {
        name: name.into(),
        density,
        eos: EosData::IdealGas { adiabatic_index: gamma, c_v: 1.0, u_0: 0.0, theta_0: 0.0 },
    };
    let stretch = |name: &str, state: &State, [from, to]: [f64; 2], particles| Stretch {
        material: name.into(),
        from,
        to,
        particles,
        layout: Layout::Centres,
        compression: 1.0,
        interface: Interface::Joined,
        velocity: Profile::Uniform(state.velocity),
        energy: Profile::Uniform(state.energy()),
    };
    // Of equal mass the light gas is a thousand times as coarse: so many particles need a long tube, and the heavy gas
    // has to be so long that nothing comes back from its end.
    let (heavy_length, light_length, light_count) =
        if equal_mass { (4.0, 500.0, 200) } else { (1.0, 2.0, 2 * fine) };
    let heavy_count = if equal_mass { 1600 } else { fine };
    let time = if equal_mass { 80.0 } else { 0.4 };
    let pushed = Boundary::Pressure(1e-3);
    let scene = Line {
        name: "hard".into(),
        units: Units::None,
        stop_time: time,
        method: sheet.line(),
        boundaries: Boundaries { left: pushed, right: pushed },
        materials: vec![material("heavy", 1.0), material("light", 1e-3)],
        bodies: vec![
            stretch("heavy", &heavy, [-heavy_length, 0.0], heavy_count),
            stretch("light", &light, [0.0, light_length], light_count),
        ],
    };
    let riemann = Riemann::new(heavy, light)?;
    let speed = riemann.right_wave().map_or(f64::NAN, |wave| wave.head());
    let contact = riemann.sample(2.0 - 1e-9).gas.velocity;
    let star = riemann.sample(0.5 * (contact + speed)).gas.pressure;
    let mut solver = whipple_solver::build(&scene)?;
    solver.advance_to(time)?;
    let now = solver.snapshot();
    let last = (2.0 + 0.75 * (speed - 2.0)) * time;
    let behind: Vec<f64> = now
        .pressure
        .iter()
        .enumerate()
        .filter(|(k, _)| *k >= heavy_count && now.x[*k] < last)
        .map(|(_, p)| *p)
        .collect();
    sheet.at_most(
        "error of the pressure in the light gas",
        (mean(&behind) / star - 1.0).abs(),
        0.05,
    );
    sheet.at_most("error of the momentum", solver.ledger().momentum_drift(), 1e-12);
    Ok(())
}

/// H10: plates of copper close a gap.
pub(super) fn gaps(sheet: &mut Sheet) {
    let mut found: Vec<[f64; 3]> = Vec::new();
    let gaps = [1e-6, 1e-3, 0.5, 0.999];
    for gap in gaps {
        sheet.part(format!("gap of {gap} dx"), |sheet| {
            let reading = closing(sheet, gap)?;
            let [time, step, peak] = reading;
            let wanted = gap * EDGE / 0.15;
            sheet.enter("first force", "us", time, Bound::Shown);
            sheet.at_most(
                "first force off the gap over the speed, in steps",
                (time - wanted).abs() / step,
                1.0,
            );
            sheet.enter("largest pressure", "Mbar", peak, Bound::Shown);
            found.push(reading);
            Ok(())
        });
    }
    sheet.part("all gaps", |sheet| {
        let peaks: Vec<f64> = found.iter().map(|reading| reading[2]).collect();
        let complete = peaks.len() == gaps.len();
        let middle = mean(&peaks);
        let spread = largest(peaks.iter().map(|p| p / middle - 1.0));
        sheet.at_most(
            "spread of the largest pressure",
            if complete { spread } else { f64::NAN },
            0.01,
        );
        Ok(())
    });
}

/// Distance at which bodies of cubic cells feel each other: half an edge of the springs between surfaces, or where
/// contacts begin at the reference density, node on node.
fn felt(method: &Method) -> f64 {
    let length = 0.5 * 3f64.sqrt() * EDGE;
    match method.density {
        Density::Hybrid => 0.5 * EDGE,
        Density::Nonholonomic => length * (1.0 + method.contact_tolerance).min(method.reach()),
        Density::Kernel => length * method.reach(),
    }
}

/// Time of the first force, the step then, and the largest pressure, of plates that close a gap at 1.5 km/s.
fn closing(sheet: &Sheet, gap: f64) -> Result<[f64; 3], Trouble> {
    let method = sheet.space();
    let felt = felt(&method);
    let plate = |centre: f64, velocity: f64| Body {
        centre: [centre, 0.0, 0.0],
        velocity: [velocity, 0.0, 0.0],
        ..block("copper", [10, 3, 3], EDGE)
    };
    let half = 0.5 * (10.0 * EDGE + felt + gap * EDGE);
    let mut scene = scene(method, vec![COPPER.fluid()], vec![plate(-half, 0.15), plate(half, 0.0)]);
    scene.walls = sleeve([3.0 * EDGE; 2]);
    let mut simulation = Simulation::new(&scene)?;
    let whole = simulation.holdings()[0].momentum[0];
    let (mut first, mut step, mut peak) = (f64::NAN, f64::NAN, 0.0f64);
    while simulation.time() < 3.0 {
        let before = simulation.time();
        simulation.step(3.0)?;
        let handed = simulation.holdings()[1].momentum[0];
        if first.is_nan() && handed.abs() > 1e-12 * whole {
            (first, step) = (before, simulation.time() - before);
        }
        peak = simulation.all_particles().map(|p| p.pressure).fold(peak, f64::max);
    }
    Ok([first, step, peak])
}

/// H11: a block with a flat face, a sphere and a rod graze a plate.
pub(super) fn grazing(sheet: &mut Sheet) {
    let n = sheet.size(6, 4);
    let shapes = [
        ("block", Shape::Box { size: [n as f64 * EDGE; 3] }, [n; 3]),
        ("sphere", Shape::Sphere { diameter: n as f64 * EDGE }, [n; 3]),
        (
            "rod",
            Shape::Cylinder { diameter: n as f64 * EDGE, length: 2.0 * n as f64 * EDGE },
            [n, n, 2 * n],
        ),
    ];
    for (name, shape, cells) in shapes {
        for degrees in [80.0f64, 85.0, 89.0] {
            sheet.part(format!("{name} at {degrees} degrees"), |sheet| {
                let (s, c) = degrees.to_radians().sin_cos();
                let v = 0.1;
                let half = 0.5 * cells[2] as f64 * EDGE;
                let above = Body {
                    name: name.into(),
                    centre: [-1.5 * EDGE, 0.0, half + 1.02 * felt(&sheet.space())],
                    velocity: [v * s, 0.0, -v * c],
                    ..body("steel", shape.clone(), cells)
                };
                graze(sheet, above, name == "block")
            });
        }
    }
    sheet.part("block slides past at 0.999 of its contact distance", |sheet| {
        let felt = felt(&sheet.space());
        let half = 0.5 * n as f64 * EDGE;
        let above = Body {
            centre: [-1.5 * EDGE, 0.0, half + 0.999 * felt],
            velocity: [0.1, 0.0, 0.0],
            ..block("steel", [n; 3], EDGE)
        };
        graze(sheet, above, true)
    });
}

/// What happens to a body of steel above a plate of it, without viscosity.
fn graze(sheet: &mut Sheet, above: Body, flat: bool) -> Result<(), Trouble> {
    let plate = block("steel", [20, 10, 3], EDGE);
    let plate = Body { name: "plate".into(), centre: [0.0, 0.0, -1.5 * EDGE], ..plate };
    let mut scene = scene(sheet.space(), vec![STEEL.elastic()], vec![above, plate]);
    scene.method.visc_linear = 0.0;
    scene.method.visc_quad = 0.0;
    scene.method.visc_expansion = 0.0;
    let ([along, _, normal], rise) = meeting(&scene)?;
    let round_off = 1e-12;
    let tangential = along.abs() / normal.abs().max(round_off);
    if flat {
        sheet.at_most("momentum along the plate over the impulse", tangential, 0.01);
    } else {
        sheet.shown("momentum along the plate over the impulse", tangential);
    }
    sheet.enter("impulse of the plate", "g cm/us", normal, Bound::Shown);
    sheet.at_most("rise of the energy", rise, 1e-6);
    // Velocities are half a step ahead of places: of the energy, that errs by a part of the step.
    scene.method.cfl *= 0.25;
    sheet.shown("rise of the energy at a quarter of the step", meeting(&scene)?.1);
    Ok(())
}

/// What the first body is given of momentum, and the highest energy over that at the start, less 1.
fn meeting(scene: &Scene) -> Result<([f64; 3], f64), Trouble> {
    let mut simulation = Simulation::new(scene)?;
    let start = simulation.holdings()[0].momentum;
    let mut highest = f64::NEG_INFINITY;
    for k in 1..=32 {
        advance(&mut simulation, 0.25 * f64::from(k))?;
        let balance = simulation.balance();
        highest = highest.max(balance.now.energy() / balance.initial.energy() - 1.0);
    }
    Ok((minus(simulation.holdings()[0].momentum, start), highest))
}

/// A metal that falls to pieces at little strain.
pub(super) fn brittle(metal: &Metal) -> Material {
    let mut material = metal.ductile([0.0029, 125.0, 0.1, 930.0]);
    material.failure.plastic_strain = Some(0.2);
    material.failure.spall = Some(0.012);
    material
}

/// A sphere through a plate of one cell, with what falls to pieces.
pub(super) fn perforation(sheet: &Sheet, speed: f64) -> Scene {
    let n = sheet.size(5, 4);
    let sphere = Body {
        name: "sphere".into(),
        centre: [0.013, 0.021, 0.5 * n as f64 * EDGE + 0.6 * EDGE],
        velocity: [0.0, 0.0, -speed],
        ..body("aluminium", Shape::Sphere { diameter: n as f64 * EDGE }, [n; 3])
    };
    let plate = block("aluminium", [4 * n, 4 * n, 1], EDGE);
    let plate = Body { name: "plate".into(), centre: [0.0, 0.0, -0.5 * EDGE], ..plate };
    scene(sheet.space(), vec![brittle(&ALUMINIUM)], vec![sphere, plate])
}

/// H09: fragments fly on for 50 us.
pub(super) fn fragments(sheet: &mut Sheet) {
    sheet.part("aluminium sphere through a plate of one cell at 4 km/s", |sheet| {
        let mut scene = perforation(sheet, 0.4);
        scene.stop_time = sheet.size(50.0, 10.0);
        let simulation = to_the_end(sheet, &scene)?;
        let hot = largest(simulation.all_particles().map(|p| p.theta));
        let balance = simulation.balance();
        sheet.enter("highest temperature", "K", hot, Bound::AtMost(f64::MAX));
        sheet.at_least("elements that have died", simulation.failed().1 as f64, 10.0);
        sheet.at_most("change of the mass", balance.mass_error(), 1e-15);
        sheet.at_most("error of the momentum", balance.momentum_drift(), 1e-12);
        sheet.shown("residual of the elements", balance.relative_residual());
        Ok(())
    });
}
