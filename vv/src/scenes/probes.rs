//! What is looked at while a scene of a file runs: bodies, probes, the ranges of material constants, and what ends it.

use whipple_solver::space::Simulation;
use whipple_solver::space::ledger::{Balance, Holdings};
use whipple_solver::space::output::Particle;

use super::build::{Built, Reading};
use super::error::FileError;
use super::file::{Probe, Quantity, Until};
use super::quantity::Kind;
use super::schema::Spanned;
use crate::suggest::did_you_mean;

/// Where something is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Eye {
    /// The particle nearest to a place at the start.
    Point([f64; 3]),
    /// Mass and momentum beyond a plane across an axis.
    Plane(usize, f64),
    /// A body.
    Body(usize),
}

/// What ends a run before its time.
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    /// So much of the mass of a body is beyond a plane, in the sense of its flight.
    Beyond { body: usize, axis: usize, at: f64, part: f64 },
    /// The kinetic energy over that at the start.
    KineticBelow(f64),
    /// The velocity of a body.
    Slower { body: usize, than: f64 },
}

/// What is looked at.
#[derive(Debug, Clone)]
pub struct Probes {
    eyes: Vec<(String, Eye)>,
    end: Option<End>,
    bodies: Vec<String>,
    /// Material of each body.
    materials: Vec<usize>,
    names: Vec<String>,
    /// Sense of the flight along the axis of a condition.
    sense: f64,
}

impl Probes {
    /// Those of a scene.
    ///
    /// # Errors
    /// A body that is not there, or a probe of nothing.
    pub fn new(built: &Built) -> Result<Self, FileError> {
        let of = built.reading();
        let bodies: Vec<String> = built.scene.bodies.iter().map(|b| b.name.clone()).collect();
        let mut eyes = Vec::new();
        for probe in &built.file.probe {
            eyes.push((probe.get_ref().name.get_ref().clone(), eye(&of, probe, &bodies)?));
        }
        let end = built.file.until.as_ref().map(|until| end(&of, until, &bodies)).transpose()?;
        let sense = match end {
            Some(End::Beyond { body, axis, .. }) => {
                built.scene.bodies[body].velocity[axis].signum()
            }
            _ => 1.0,
        };
        let material = |body: &whipple_solver::space::scene::Body| {
            built.scene.material_index(&body.material).unwrap_or(0)
        };
        Ok(Self {
            eyes,
            end,
            materials: built.scene.bodies.iter().map(material).collect(),
            names: built.scene.materials.iter().map(|m| m.name.clone()).collect(),
            bodies,
            sense,
        })
    }

    /// What a row of [`Probes::row`] holds: names of columns and what they measure.
    #[must_use]
    pub fn columns(&self) -> Vec<(String, Option<Kind>)> {
        let mut all = vec![("time".to_owned(), Some(Kind::TIME))];
        for what in ["kinetic", "internal"] {
            all.push((what.to_owned(), Some(Kind::ENERGY)));
        }
        for body in &self.bodies {
            body_columns(body, &mut all);
        }
        for (name, eye) in &self.eyes {
            match eye {
                Eye::Point(_) => {
                    for axis in ["x", "y", "z"] {
                        all.push((format!("{name}.{axis}"), Some(Kind::LENGTH)));
                    }
                    for axis in ["vx", "vy", "vz"] {
                        all.push((format!("{name}.{axis}"), Some(Kind::VELOCITY)));
                    }
                    all.push((format!("{name}.density"), Some(Kind::DENSITY)));
                    all.push((format!("{name}.pressure"), Some(Kind::PRESSURE)));
                    all.push((format!("{name}.temperature"), Some(Kind::TEMPERATURE)));
                }
                Eye::Plane(..) => {
                    for what in ["mass", "momentum"] {
                        all.push((format!("{name}.{what}_beyond"), None));
                    }
                }
                Eye::Body(_) => body_columns(name, &mut all),
            }
        }
        for name in &self.names {
            all.push((format!("{name}.highest_pressure"), Some(Kind::PRESSURE)));
            all.push((format!("{name}.highest_sound_temperature"), Some(Kind::TEMPERATURE)));
        }
        all.push(("end".to_owned(), None));
        all
    }

    /// Particles that the probes of places follow, from the state at the start.
    #[must_use]
    pub fn find(&self, start: &Simulation) -> Vec<u32> {
        let places = self.eyes.iter().filter_map(|(_, eye)| match *eye {
            Eye::Point(place) => Some(place),
            _ => None,
        });
        places.map(|place| nearest(start, place)).collect()
    }

    /// The numbers of a state, with the particles of [`Probes::find`].
    #[must_use]
    pub fn row(&self, found: &[u32], (simulation, balance): (&Simulation, &Balance)) -> Vec<f64> {
        let holdings = simulation.holdings();
        let live = live_masses(simulation, self.bodies.len());
        let mut row = vec![simulation.time(), balance.now.kinetic, balance.now.internal];
        let centres = centres(simulation, self.bodies.len());
        let body = |k: usize, row: &mut Vec<f64>| {
            let Holdings { mass, momentum, kinetic, .. } = holdings[k];
            row.extend(centres[k]);
            row.extend(momentum.map(|p| p / mass));
            row.extend([kinetic, live[k]]);
        };
        for k in 0..self.bodies.len() {
            body(k, &mut row);
        }
        let mut found = found.iter();
        for (_, eye) in &self.eyes {
            match *eye {
                Eye::Point(_) => {
                    let p = simulation.particle(found.next().copied().unwrap_or(0));
                    row.extend(p.position);
                    row.extend(p.velocity);
                    row.extend([p.rho, p.pressure, p.theta]);
                }
                Eye::Plane(axis, at) => {
                    let beyond = simulation.all_particles().filter(|p| p.position[axis] > at);
                    let sums = beyond
                        .fold([0.0; 2], |[m, q], p| [m + p.mass, q + p.mass * p.velocity[axis]]);
                    row.extend(sums);
                }
                Eye::Body(k) => body(k, &mut row),
            }
        }
        let mut highest = vec![[0.0f64; 2]; self.names.len()];
        for p in simulation.all_particles() {
            let [pressure, _] = &mut highest[self.materials[p.body]];
            *pressure = pressure.max(p.pressure);
        }
        // What has failed bears nothing that would depend on its temperature.
        for element in simulation.all_elements().filter(|e| e.live && !e.failed) {
            let [_, theta] = &mut highest[self.materials[element.body]];
            *theta = theta.max(simulation.particle(element.centre).theta);
        }
        row.extend(highest.into_iter().flatten());
        row.push(f64::from(u8::from(self.ends(simulation, balance, &holdings))));
        row
    }

    fn ends(&self, simulation: &Simulation, balance: &Balance, holdings: &[Holdings]) -> bool {
        match self.end {
            None => false,
            Some(End::KineticBelow(part)) => balance.now.kinetic < part * balance.initial.kinetic,
            Some(End::Slower { body, than }) => {
                let Holdings { mass, momentum, .. } = holdings[body];
                momentum.iter().map(|p| p * p).sum::<f64>().sqrt() < than * mass
            }
            Some(End::Beyond { body, axis, at, part }) => {
                let beyond =
                    |p: &Particle| p.body == body && self.sense * (p.position[axis] - at) > 0.0;
                let mass: f64 = simulation.all_particles().filter(beyond).map(|p| p.mass).sum();
                mass > part * holdings[body].mass
            }
        }
    }
}

/// Columns of a body.
fn body_columns(name: &str, all: &mut Vec<(String, Option<Kind>)>) {
    for axis in ["x", "y", "z"] {
        all.push((format!("{name}.{axis}"), Some(Kind::LENGTH)));
    }
    for axis in ["vx", "vy", "vz"] {
        all.push((format!("{name}.{axis}"), Some(Kind::VELOCITY)));
    }
    all.push((format!("{name}.kinetic"), Some(Kind::ENERGY)));
    all.push((format!("{name}.sound_mass"), None));
}

/// The particle that is nearest to a place.
fn nearest(simulation: &Simulation, place: [f64; 3]) -> u32 {
    let off = |p: &Particle| (0..3).map(|d| (p.position[d] - place[d]).powi(2)).sum::<f64>();
    let all = simulation.all_particles();
    all.min_by(|a, b| off(a).total_cmp(&off(b))).map_or(0, |p| p.id)
}

/// Centres of mass of the bodies.
fn centres(simulation: &Simulation, bodies: usize) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 4]; bodies];
    for p in simulation.all_particles() {
        let sum = &mut sums[p.body];
        sum[3] += p.mass;
        for (sum, x) in sum.iter_mut().zip(p.position) {
            *sum += p.mass * x;
        }
    }
    sums.into_iter().map(|[x, y, z, m]| [x / m, y / m, z / m]).collect()
}

/// Mass of each body in elements that have not failed.
fn live_masses(simulation: &Simulation, bodies: usize) -> Vec<f64> {
    let mut sums = vec![0.0; bodies];
    for element in simulation.all_elements().filter(|e| e.live && !e.failed) {
        // Half of a cell is at its centroid.
        sums[element.body] += 2.0 * simulation.particle(element.centre).mass;
    }
    sums
}

fn eye(of: &Reading<'_>, probe: &Spanned<Probe>, bodies: &[String]) -> Result<Eye, FileError> {
    let (span, probe) = (probe.span(), probe.get_ref());
    match (&probe.point, &probe.plane, &probe.body) {
        (Some([x, y, z]), None, None) => {
            let at = |q: &Quantity| of.read(q, Kind::LENGTH);
            Ok(Eye::Point([at(x)?, at(y)?, at(z)?]))
        }
        (None, Some(plane), None) => {
            Ok(Eye::Plane(plane.axis.index(), of.read(&plane.at, Kind::LENGTH)?))
        }
        (None, None, Some(body)) => Ok(Eye::Body(body_of(of, body, bodies)?)),
        _ => {
            let name = probe.name.get_ref();
            Err(of.wrong(
                span,
                format!("the probe `{name}` needs one of `point`, `plane` and `body`"),
            ))
        }
    }
}

fn end(of: &Reading<'_>, until: &Spanned<Until>, bodies: &[String]) -> Result<End, FileError> {
    Ok(match until.get_ref() {
        Until::KineticBelow(part) => End::KineticBelow(of.positive(part, Kind::NUMBER)?),
        Until::Slower(own) => End::Slower {
            body: body_of(of, &own.body, bodies)?,
            than: of.positive(&own.than, Kind::VELOCITY)?,
        },
        Until::Beyond(own) => End::Beyond {
            body: body_of(of, &own.body, bodies)?,
            axis: own.axis.index(),
            at: of.read(&own.at, Kind::LENGTH)?,
            part: of.positive(&own.part, Kind::NUMBER)?,
        },
    })
}

/// Index of the body of a name.
fn body_of(
    of: &Reading<'_>,
    name: &Spanned<String>,
    bodies: &[String],
) -> Result<usize, FileError> {
    bodies.iter().position(|body| body == name.get_ref()).ok_or_else(|| {
        let hint = did_you_mean(name.get_ref(), bodies.iter().map(String::as_str));
        let all = bodies.join(", ");
        of.wrong(
            name.span(),
            format!("there is no body `{}`{hint} (there is: {all})", name.get_ref()),
        )
    })
}
