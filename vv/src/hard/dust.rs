//! Loose particles: what meets head on, and clouds that fly apart.

use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Body, Scene};

use super::measure::{largest, minus, norm};
use super::scenes::{COPPER, DISPLACEMENT, VELOCITY, advance, block, march, scatter, scene, shift};
use super::sheet::{Sheet, Trouble};

/// Edge of a cell in cm.
const EDGE: f64 = 0.1;

/// Rate at which cells are torn apart, 1/us.
const TEARING: f64 = 0.1;

/// Cold bodies of copper whose elements die at once of their temperature.
fn crumbling(sheet: &Sheet, bodies: Vec<Body>) -> Scene {
    let mut metal = COPPER.fluid();
    metal.failure.melt = Some(301.0);
    let warm = |body: Body| Body { energy: 1e-5, ..body };
    scene(sheet.space(), vec![metal], bodies.into_iter().map(warm).collect())
}

/// A scene whose elements have all died, torn apart by a motion that is then stopped; how many are left is entered.
fn dust(sheet: &mut Sheet, scene: &Scene) -> Result<Simulation, Trouble> {
    let centre = |p: &Particle| scene.bodies[p.body].centre;
    let apart = |p: &Particle| minus(p.position, centre(p)).map(|x| TEARING * x);
    let mut hot = Simulation::new(scene)?;
    march(&mut hot, 40)?;
    // By now they have no strength; they die of their volume.
    let mut torn = shift(scene, &hot, VELOCITY, apart)?;
    march(&mut torn, 60)?;
    let simulation = shift(scene, &torn, VELOCITY, |p| p.velocity.map(|v| -v))?;
    let alive = simulation.elements() - simulation.failed().1;
    sheet.at_most("elements alive", alive as f64, 0.0);
    Ok(simulation)
}

/// H18: cells of loose particles, nine each, meet head on at 10 km/s without viscosity; and two jets of them go
/// through each other.
pub(super) fn crossing(sheet: &mut Sheet) {
    let mut angles: Vec<f64> = Vec::new();
    let offsets = [0.0, 1e-12, 1e-9, 1e-6];
    for offset in offsets {
        sheet.part(format!("nine on nine, off by {offset:e} cm"), |sheet| {
            let at = |x: f64| Body { centre: [x, 0.0, 0.0], ..block("copper", [1; 3], EDGE) };
            let mut scene = crumbling(sheet, vec![at(-0.2), at(0.2)]);
            (scene.method.visc_linear, scene.method.visc_quad) = (0.0, 0.0);
            let still = dust(sheet, &scene)?;
            let aside = |p: &Particle| [0.0, if p.body == 0 { offset } else { 0.0 }, 0.0];
            let aside = shift(&scene, &still, DISPLACEMENT, aside)?;
            let towards = |p: &Particle| [if p.body == 0 { 0.5 } else { -0.5 }, 0.0, 0.0];
            let mut simulation = shift(&scene, &aside, VELOCITY, towards)?;
            let before = simulation.holdings()[0].momentum;
            let end = simulation.time() + 1.5;
            advance(&mut simulation, end)?;
            let balance = simulation.balance();
            sheet.at_most("error of the energy", balance.energy_drift(), 1e-6);
            let finite = simulation.all_particles().filter(|p| !norm(p.velocity).is_finite());
            sheet.at_most("velocities that are no numbers", finite.count() as f64, 0.0);
            let after = simulation.holdings()[0].momentum;
            // Without this they have passed each other unseen.
            let handed = norm(minus(after, before)) / norm(before);
            sheet.at_least("momentum handed over, over that before", handed, 1e-3);
            let [x, y, z] = after;
            angles.push(y.hypot(z).atan2(x.abs()));
            Ok(())
        });
    }
    sheet.part("nine on nine, all offsets", |sheet| {
        let complete = angles.len() == offsets.len();
        for (angle, offset) in angles.iter().zip(offsets) {
            // From 1e-6 of a contact length no more than a thousandth of a radian can come continuously.
            let change = if complete { (angle - angles[0]).abs() } else { f64::NAN };
            sheet.at_most(
                &format!("angle off that without an offset, {offset:e} cm, rad"),
                change,
                1e-3,
            );
        }
        Ok(())
    });
    sheet.part("jets through each other", |sheet| {
        let n = sheet.size(12, 6);
        let half = 0.5 * n as f64 * EDGE;
        let jet = |x: f64| Body { centre: [x, 0.0, 0.0], ..block("copper", [n, 3, 3], EDGE) };
        let scene = crumbling(sheet, vec![jet(-half - 0.15), jet(half + 0.15)]);
        let still = dust(sheet, &scene)?;
        let towards = |p: &Particle| [if p.body == 0 { 0.5 } else { -0.5 }, 0.0, 0.0];
        let mut simulation = shift(&scene, &still, VELOCITY, towards)?;
        let end = simulation.time() + 4.0 * half;
        advance(&mut simulation, end)?;
        sheet.at_most("error of the energy", simulation.balance().energy_drift(), 1e-6);
        sheet.at_most("error of the momentum", simulation.balance().momentum_drift(), 1e-12);
        Ok(())
    });
}

/// H26: a cloud of loose particles flies apart for 100 us.
pub(super) fn quiet_flight(sheet: &mut Sheet) {
    sheet.part("dust that flies apart", |sheet| {
        let cells = sheet.size(36, 10);
        let end = sheet.size(100.0, 30.0);
        let mut scene = crumbling(sheet, vec![block("copper", [cells; 3], EDGE)]);
        scene.stop_time = end;
        let still = dust(sheet, &scene)?;
        let size = cells as f64 * EDGE;
        let rate = 0.3 / size;
        let mut cloud = shift(&scene, &still, VELOCITY, |p| {
            std::array::from_fn(|d| {
                let wobble = 0.01 * scatter(3 * u64::from(p.id) + d as u64);
                rate * (p.position[d] + size * wobble)
            })
        })?;
        sheet.shown("particles", cloud.particles() as f64);
        let mut costs = Vec::new();
        let begin = cloud.time();
        for k in 1..=10 {
            let (before, steps) = (cloud.searches(), cloud.counters().steps);
            advance(&mut cloud, begin + (end - begin) * f64::from(k) / 10.0)?;
            let tests = (cloud.searches().tests - before.tests) as f64;
            costs.push(tests / (cloud.counters().steps - steps) as f64);
        }
        let balance = cloud.balance();
        sheet.at_most("error of the momentum", balance.momentum_drift(), 1e-11);
        sheet.at_most("error of the angular momentum", balance.angular_drift(), 1e-11);
        sheet.at_most("error of the energy", balance.energy_drift(), 1e-9);
        let (first, last) = (costs[0], costs[costs.len() - 1]);
        let grown = last / first.max(1.0);
        sheet.at_most("distances compared a step, last tenth over the first", grown, 1.2);
        let far = largest(cloud.all_particles().flat_map(|p| p.position));
        sheet.at_least("domain over that at the start", (far / (0.5 * size)).powi(3), 100.0);
        Ok(())
    });
}
