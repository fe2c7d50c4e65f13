//! The answer may not know who looks: moving, turned and mirrored frames.

use nalgebra::{UnitQuaternion, Vector3};
use whipple_solver::scene::{Boundary, Profile};
use whipple_solver::space::output::Particle;
use whipple_solver::space::scene::{Body, Hold, Scene, Shape, Side, Turn, Wall};
use whipple_solver::space::{Simulation, lattice};
use whipple_solver::{output::Snapshot, scene as line};

use super::measure::{apart, at_pace, largest, minus, norm, pace};
use super::scenes::{COPPER, STEEL, advance, block, bricks, march, mirror, rod, scene};
use super::sheet::{Sheet, Trouble};
use crate::cases::find;
use crate::scene::AnyScene;

/// Steps over which round-off alone may tell two runs apart.
const STEPS: usize = 100;

/// Speeds of the frame in cm/us: 10 and 100 km/s; and what may differ.
const BOOSTS: [(f64, f64); 2] = [(1.0, 1e-9), (10.0, 1e-6)];

/// Skew direction of the frame.
const SKEW: [f64; 3] = [0.6, -0.64, 0.48];

/// The coarse rod: 3 cm of five cells across.
fn coarse(sheet: &Sheet) -> Scene {
    let method = sheet.space();
    sheet.size(rod(method, 5, 30, [24, 6, 15]), rod(method, 3, 12, [12, 3, 8]))
}

/// H01: gas along a line and the rod, at rest and in moving frames.
pub(super) fn boosted(sheet: &mut Sheet) {
    for (case, boundary) in [("two-stream-noh", None), ("sod", Some([1.0, 0.1]))] {
        for (boost, most) in [(10.0, 1e-9), (100.0, 1e-6)] {
            sheet.part(format!("{case}, frame at {boost}"), |sheet| {
                let still = gas_scene(sheet, case, boundary)?;
                along_a_line(sheet, &still, boost, most)
            });
        }
    }
    for (boost, most) in BOOSTS {
        let frame = format!("rod, frame at {} km/s", 10.0 * boost);
        sheet.part(format!("{frame}, {STEPS} steps"), |sheet| {
            let (still, moving) = both(&coarse(sheet), boost);
            let times = pace(&still, STEPS)?;
            let [mut a, mut b] = [Simulation::new(&still)?, Simulation::new(&moving)?];
            at_pace(&mut a, &times)?;
            at_pace(&mut b, &times)?;
            let more = b.counters().steps.abs_diff(a.counters().steps);
            sheet.at_most("steps more than at rest", more as f64, 0.0);
            let travelled = SKEW.map(|s| s * boost * a.time());
            let length = 3.0;
            let places = a
                .all_particles()
                .zip(b.all_particles())
                .map(|(p, q)| norm(minus(minus(q.position, travelled), p.position)) / length);
            sheet.at_most("positions apart, over the length", largest(places), most);
            sheet.at_most("densities apart", apart([&a, &b], |p| p.rho), most);
            sheet.at_most("internal energies apart", apart([&a, &b], |p| p.u), most);
            Ok(())
        });
        sheet.part(format!("{frame}, to the end"), |sheet| {
            let (still, moving) = both(&coarse(sheet), boost);
            let end = sheet.size(20.0, 4.0);
            let [mut a, mut b] = [Simulation::new(&still)?, Simulation::new(&moving)?];
            advance(&mut a, end)?;
            advance(&mut b, end)?;
            alike(sheet, [&a, &b]);
            Ok(())
        });
    }
}

/// A case of gas along a line, without walls: pressed at the ends instead.
fn gas_scene(
    sheet: &Sheet,
    case: &str,
    pressures: Option<[f64; 2]>,
) -> Result<line::Scene, Trouble> {
    let found = find(case).map(|c| c.scene(sheet.preset(), "", c.default_size()));
    let Some(AnyScene::Line(mut scene)) = found else {
        return Err(Trouble::Other(format!("no case `{case}` along a line")));
    };
    scene.method = sheet.line();
    if let Some([left, right]) = pressures {
        scene.boundaries.left = Boundary::Pressure(left);
        scene.boundaries.right = Boundary::Pressure(right);
    }
    Ok(scene)
}

/// The same scene along a line in a frame that moves.
fn moved(scene: &line::Scene, boost: f64) -> line::Scene {
    let mut moving = scene.clone();
    for body in &mut moving.bodies {
        body.velocity = match body.velocity {
            Profile::Uniform(v) => Profile::Uniform(v + boost),
            Profile::Linear { at_origin, slope } => {
                Profile::Linear { at_origin: at_origin + boost, slope }
            }
            Profile::Cosine { mean, amplitude, mode } => {
                Profile::Cosine { mean: mean + boost, amplitude, mode }
            }
        };
    }
    moving
}

/// Both runs step to the times of a slower one, so that their steps are equal.
fn along_a_line(
    sheet: &mut Sheet,
    still: &line::Scene,
    boost: f64,
    most: f64,
) -> Result<(), Trouble> {
    let mut slower = still.clone();
    slower.method.cfl *= 0.8;
    let mut first = whipple_solver::build(&slower)?;
    let mut runs = [whipple_solver::build(still)?, whipple_solver::build(&moved(still, boost))?];
    while first.time() < still.stop_time {
        first.step(still.stop_time)?;
        for run in &mut runs {
            run.advance_to(first.time())?;
        }
    }
    let more = runs[1].counters().steps.abs_diff(runs[0].counters().steps);
    sheet.at_most("steps more than at rest", more as f64, 0.0);
    let [a, b] = runs.map(|run| run.snapshot());
    let travelled = boost * a.time;
    let differ = |of: fn(&Snapshot) -> &[f64], shift: f64| {
        let scale = largest(of(&a).iter().copied());
        largest(of(&a).iter().zip(of(&b)).map(|(a, b)| b - shift - a)) / scale
    };
    sheet.at_most("positions apart", differ(|s| &s.x, travelled), most);
    sheet.at_most("densities apart", differ(|s| &s.rho, 0.0), most);
    sheet.at_most("internal energies apart", differ(|s| &s.u, 0.0), most);
    Ok(())
}

/// A scene, and the same in a frame that moves in the skew direction.
fn both(still: &Scene, boost: f64) -> (Scene, Scene) {
    let mut moving = still.clone();
    for body in &mut moving.bodies {
        body.velocity = std::array::from_fn(|d| body.velocity[d] + boost * SKEW[d]);
    }
    (still.clone(), moving)
}

/// Enters how far lengths, internal energies and masses of the bodies of two runs differ: 1 % at most.
fn alike(sheet: &mut Sheet, [a, b]: [&Simulation; 2]) {
    for body in 0..a.bodies() {
        let [one, other] = [a, b].map(|simulation| {
            let held = simulation.holdings()[body];
            [extent(simulation, body), held.internal, held.mass]
        });
        let differ = |k: usize| (other[k] / one[k] - 1.0).abs();
        for (k, what) in ["length", "internal energy", "mass"].into_iter().enumerate() {
            sheet.at_most(&format!("{what} of body {} changes", body + 1), differ(k), 0.01);
        }
    }
}

/// Longest distance of a particle that elements hold from the first of the body, which no frame changes.
fn extent(simulation: &Simulation, body: usize) -> f64 {
    let held: Vec<Particle> =
        simulation.all_particles().filter(|p| p.body == body && p.held > 0.0).collect();
    let far = |from: [f64; 3]| {
        let farther = |a: &&Particle, b: &&Particle| {
            norm(minus(a.position, from)).total_cmp(&norm(minus(b.position, from)))
        };
        held.iter().max_by(farther).map_or(from, |p| p.position)
    };
    let Some(first) = held.first() else { return f64::NAN };
    let one = far(first.position);
    norm(minus(far(one), one))
}

/// Rotations that look random: axes and degrees.
const TURNS: [([f64; 3], f64); 3] =
    [([0.3, -0.5, 0.8], 71.0), ([-0.9, 0.2, 0.37], 203.0), ([0.1, 0.93, -0.4], 317.0)];

/// H02: the whole model turned.
pub(super) fn turned(sheet: &mut Sheet) {
    for (axis, degrees) in TURNS {
        let name = format!("turned by {degrees} degrees");
        sheet.part(format!("{name}, {STEPS} steps"), |sheet| {
            let straight = coarse(sheet);
            let times = pace(&straight, STEPS)?;
            let other = rotated(&straight, axis, degrees);
            let [mut a, mut b] = [Simulation::new(&straight)?, Simulation::new(&other)?];
            at_pace(&mut a, &times)?;
            at_pace(&mut b, &times)?;
            let scalars = |simulation: &Simulation| {
                let held = simulation.balance().now;
                let strain = largest(simulation.all_elements().map(|e| e.strain));
                [extent(simulation, 0), held.kinetic, held.internal, held.shear, strain]
            };
            let [one, two] = [&a, &b].map(scalars);
            for (k, what) in [
                "length of the rod",
                "kinetic energy",
                "internal energy",
                "shear energy",
                "largest strain",
            ]
            .into_iter()
            .enumerate()
            {
                sheet.at_most(&format!("{what} changes"), (two[k] / one[k] - 1.0).abs(), 1e-8);
            }
            Ok(())
        });
        sheet.part(format!("{name}, to the end"), |sheet| {
            let straight = coarse(sheet);
            let other = rotated(&straight, axis, degrees);
            let end = sheet.size(20.0, 4.0);
            let [mut a, mut b] = [Simulation::new(&straight)?, Simulation::new(&other)?];
            advance(&mut a, end)?;
            advance(&mut b, end)?;
            alike(sheet, [&a, &b]);
            Ok(())
        });
    }
}

/// A scene turned as a whole.
fn rotated(straight: &Scene, axis: [f64; 3], degrees: f64) -> Scene {
    let turned = lattice::rotation(axis, degrees.to_radians());
    let rotate = |v: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|d| (0..3).map(|k| v[k] * turned[k][d]).sum())
    };
    let quaternion = |axis: [f64; 3], degrees: f64| {
        let axis = nalgebra::Unit::new_normalize(Vector3::from(axis));
        UnitQuaternion::from_axis_angle(&axis, degrees.to_radians())
    };
    let mut other = straight.clone();
    for body in &mut other.bodies {
        body.centre = rotate(body.centre);
        body.velocity = rotate(body.velocity);
        let whole = quaternion(axis, degrees) * quaternion(body.turn.axis, body.turn.degrees);
        if let Some((axis, angle)) = whole.axis_angle() {
            let axis = axis.into_inner();
            body.turn = Turn { axis: [axis.x, axis.y, axis.z], degrees: angle.to_degrees() };
        }
    }
    other
}

/// H19: what is symmetric at the start stays so.
pub(super) fn mirrored(sheet: &mut Sheet) {
    sheet.part("blocks that collide, x to -x", |sheet| {
        let half = |side: f64| Body {
            centre: [side * 0.36, 0.0, 0.0],
            velocity: [-side * 0.05, 0.0, 0.0],
            ..block("steel", [6, 6, 6], 0.1)
        };
        let metal = STEEL.ductile([0.0075, 5.67, 0.49, 1700.0]);
        let scene = scene(sheet.space(), vec![metal], vec![half(-1.0), half(1.0)]);
        let mut simulation = Simulation::new(&scene)?;
        symmetric(sheet, &mut simulation, 200, |x| [-x[0], x[1], x[2]])
    });
    sheet.part("Taylor bar, x to y", |sheet| {
        let metal = COPPER.ductile([0.004, 10.0, 0.3, 1356.0]);
        let size = [0.4, 0.4, 2.0];
        let bar = Body {
            centre: size.map(|edge| 0.5 * edge),
            velocity: [0.0, 0.0, -0.019],
            ..bricks("copper", [4, 4, 20], [0.1; 3])
        };
        let mut scene = scene(sheet.space(), vec![metal], vec![bar]);
        scene.walls = vec![
            mirror(0, 0.0, Side::Above),
            mirror(1, 0.0, Side::Above),
            Wall { axis: 2, position: 0.0, material: Side::Above, hold: Hold::Rest },
        ];
        let mut simulation = Simulation::new(&scene)?;
        symmetric(sheet, &mut simulation, 500, |x| [x[1], x[0], x[2]])
    });
    sheet.part("whole Taylor bar, momentum across", |sheet| {
        let metal = COPPER.ductile([0.004, 10.0, 0.3, 1356.0]);
        let shape = Shape::Cylinder { diameter: 0.8, length: 2.0 };
        let bar = Body {
            centre: [0.0, 0.0, 1.0],
            velocity: [0.0, 0.0, -0.019],
            ..super::scenes::body("copper", shape, [8, 8, 20])
        };
        let mut scene = scene(sheet.space(), vec![metal], vec![bar]);
        scene.walls =
            vec![Wall { axis: 2, position: 0.0, material: Side::Above, hold: Hold::Rest }];
        let mut simulation = Simulation::new(&scene)?;
        march(&mut simulation, 500)?;
        let balance = simulation.balance();
        let [x, y, _] = balance.now.momentum;
        let axial = balance.initial.momentum[2].abs();
        sheet.at_most("momentum across, over that along", x.hypot(y) / axial, 1e-12);
        Ok(())
    });
}

/// Enters how far particles are from the images of their partners, over the length of the scene.
fn symmetric(
    sheet: &mut Sheet,
    simulation: &mut Simulation,
    steps: usize,
    image: impl Fn([f64; 3]) -> [f64; 3],
) -> Result<(), Trouble> {
    let start: Vec<Particle> = simulation.all_particles().collect();
    let length = largest(start.iter().flat_map(|p| p.position));
    let partner = |p: &Particle| {
        let place = image(p.position);
        let near = |q: &&Particle| norm(minus(q.position, place)) < 1e-6 * length;
        start.iter().find(near).map(|q| q.id)
    };
    let partners: Vec<Option<u32>> = start.iter().map(partner).collect();
    march(simulation, steps)?;
    let alone = partners.iter().filter(|partner| partner.is_none()).count();
    sheet.at_most("particles without a partner", alone as f64, 0.0);
    let apart = start.iter().zip(&partners).filter_map(|(p, partner)| {
        let [own, other] = [p.id, (*partner)?].map(|id| simulation.particle(id).position);
        Some(norm(minus(image(own), other)) / length)
    });
    sheet.at_most("positions off the mirror, over the length", largest(apart), 1e-11);
    Ok(())
}
