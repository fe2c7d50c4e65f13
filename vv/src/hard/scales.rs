//! The answer may not know units, places or the times at which somebody looks.

use whipple_solver::space::Simulation;
use whipple_solver::space::scene::{EosData, Flow, Material, Scene};

use super::measure::{apart, at_pace, pace};
use super::scenes::{advance, rod, scatter};
use super::sheet::{Sheet, Trouble};

/// Steps over which round-off alone may tell two runs apart.
const STEPS: usize = 100;

/// The coarse rod.
fn coarse(sheet: &Sheet) -> Scene {
    let method = sheet.space();
    sheet.size(rod(method, 5, 30, [24, 6, 15]), rod(method, 3, 12, [12, 3, 8]))
}

/// A choice of units: what one of the old units of length, time and mass is in the new ones.
#[derive(Clone, Copy)]
struct Measure {
    length: f64,
    time: f64,
    mass: f64,
}

impl Measure {
    fn speed(self) -> f64 {
        self.length / self.time
    }

    fn density(self) -> f64 {
        self.mass / self.length.powi(3)
    }

    fn energy(self) -> f64 {
        self.speed() * self.speed()
    }

    fn pressure(self) -> f64 {
        self.density() * self.energy()
    }

    /// A scene in other units.
    fn of(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.stop_time *= self.time;
        scene.materials.iter_mut().for_each(|material| self.material(material));
        for body in &mut scene.bodies {
            let long = |x: f64| self.length * x;
            body.shape = body.shape.scaled(self.length);
            body.centre = body.centre.map(long);
            body.velocity = body.velocity.map(|v| self.speed() * v);
            body.spin = body.spin.map(|w| w / self.time);
            body.energy *= self.energy();
        }
        scene
    }

    fn material(self, material: &mut Material) {
        material.density *= self.density();
        match &mut material.eos {
            EosData::MieGruneisen { c0, c_v, .. } => {
                *c0 *= self.speed();
                *c_v *= self.energy();
            }
            EosData::IdealGas { c_v, .. } => *c_v *= self.energy(),
        }
        if let Some(strength) = &mut material.strength {
            strength.shear_modulus *= self.pressure();
            match &mut strength.flow {
                Some(Flow::Hardening { y_0, .. }) => *y_0 *= self.pressure(),
                Some(Flow::JohnsonCook { a, b, rate_0, .. }) => {
                    *a *= self.pressure();
                    *b *= self.pressure();
                    *rate_0 /= self.time;
                }
                None => {}
            }
        }
        material.failure.spall = material.failure.spall.map(|spall| spall * self.pressure());
    }
}

/// W04: the rod in units that are powers of two of its own, in which every number has the same digits.
pub(super) fn units(sheet: &mut Sheet) {
    let two = |power: i32| 2f64.powi(power);
    let choices = [
        ("a millionth of the length", Measure { length: two(-20), time: 1.0, mass: 1.0 }),
        (
            "a million times the length and time",
            Measure { length: two(20), time: two(20), mass: 1.0 },
        ),
        ("a thousandth of the time", Measure { length: 1.0, time: two(-10), mass: 1.0 }),
        ("a million times the mass", Measure { length: 1.0, time: 1.0, mass: two(20) }),
    ];
    for (name, measure) in choices {
        sheet.part(format!("rod with {name}, {STEPS} steps"), |sheet| {
            let own = coarse(sheet);
            let mut a = Simulation::new(&own)?;
            let mut b = Simulation::new(&measure.of(&own))?;
            for _ in 0..STEPS {
                a.step(f64::INFINITY)?;
                b.step(f64::INFINITY)?;
            }
            let time = (b.time() / measure.time / a.time() - 1.0).abs();
            sheet.at_most("times apart", time, 1e-12);
            let differ = |of: fn(&whipple_solver::space::output::Particle) -> f64, unit: f64| {
                let pairs = a.all_particles().zip(b.all_particles());
                let scale = a.all_particles().map(|p| of(&p).abs()).fold(0.0, f64::max);
                super::measure::largest(pairs.map(|(p, q)| (of(&q) / unit - of(&p)) / scale))
            };
            sheet.at_most("positions apart", differ(|p| p.position[0], measure.length), 1e-12);
            sheet.at_most("internal energies apart", differ(|p| p.u, measure.energy()), 1e-12);
            sheet.at_most("pressures apart", differ(|p| p.pressure, measure.pressure()), 1e-12);
            Ok(())
        });
    }
}

/// W05: the rod, a million cells away.
pub(super) fn far_away(sheet: &mut Sheet) {
    for cells in [1e3, 1e6] {
        sheet.part(format!("rod {cells:e} cells from the origin, {STEPS} steps"), |sheet| {
            let own = coarse(sheet);
            let times = pace(&own, STEPS)?;
            let mut far = own.clone();
            let edge = 0.1;
            for body in &mut far.bodies {
                body.centre = [0.6, -0.64, 0.48].map(|s| s * cells * edge);
            }
            for (body, still) in far.bodies.iter_mut().zip(&own.bodies) {
                body.centre = std::array::from_fn(|d| body.centre[d] + still.centre[d]);
            }
            let [mut a, mut b] = [Simulation::new(&own)?, Simulation::new(&far)?];
            at_pace(&mut a, &times)?;
            at_pace(&mut b, &times)?;
            let most = 1e-12 * cells;
            sheet.at_most("densities apart", apart([&a, &b], |p| p.rho), most);
            sheet.at_most("internal energies apart", apart([&a, &b], |p| p.u), most);
            sheet.at_most("velocities apart", apart([&a, &b], |p| p.velocity[1]), most);
            Ok(())
        });
    }
}

/// W09: the rod, looked at at random times, twice each, a billionth of a microsecond apart.
pub(super) fn looks(sheet: &mut Sheet) {
    sheet.part("rod stopped 200 times at random, twice each", |sheet| {
        let own = coarse(sheet);
        let end = sheet.size(6.0, 2.0);
        let mut undisturbed = Simulation::new(&own)?;
        advance(&mut undisturbed, end)?;
        let mut stops: Vec<f64> = (0..200).map(|k| end * 0.5 * (1.0 + scatter(k))).collect();
        stops.sort_by(f64::total_cmp);
        let mut stopped = Simulation::new(&own)?;
        for stop in stops {
            advance(&mut stopped, stop)?;
            advance(&mut stopped, stop + 1e-9)?;
        }
        advance(&mut stopped, end)?;
        alike(sheet, [&undisturbed, &stopped])
    });
}

/// Energies of two runs agree to 1 %, and the second has not lost any.
fn alike(sheet: &mut Sheet, [plain, other]: [&Simulation; 2]) -> Result<(), Trouble> {
    let energies = |simulation: &Simulation| {
        let held = simulation.balance().now;
        [held.kinetic, held.internal, held.shear]
    };
    let [one, two] = [plain, other].map(energies);
    for (k, what) in ["kinetic", "internal", "shear"].into_iter().enumerate() {
        sheet.at_most(&format!("change of the {what} energy"), (two[k] / one[k] - 1.0).abs(), 0.01);
    }
    let steps = other.counters().steps as f64 / plain.counters().steps as f64;
    sheet.shown("steps over those of the undisturbed run", steps);
    super::measure::energy(sheet, other);
    Ok(())
}
