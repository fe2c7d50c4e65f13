//! What holds of any scene, looked at while a random impact runs.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use serde::{Deserialize, Serialize};
use whipple_solver::space::Simulation;
use whipple_solver::space::ledger::Balance;
use whipple_solver::space::restart::{Section, Values};
use whipple_solver::space::votes::Voter;

use super::super::measure::{minus, norm};
use super::Impact;

/// Steps from one look at the state to the next.
const LOOK: u64 = 10;
/// One scene in so many runs on two threads besides.
const TWICE: u64 = 10;
/// Largest error of balances of energy and momentum.
const ROUND_OFF: f64 = 1e-12;
/// Largest residual of the elements over the energy of the scene.
const RESIDUAL: f64 = 1e-2;
/// The residual above which scenes are counted: what hard cases ask for.
pub(super) const SMALL_RESIDUAL: f64 = 1e-3;
/// Steps in a row whose length is looked at: of one that is short alone the step recovers.
const IN_A_ROW: usize = 20;
/// Mean of their lengths over that of a quiet scene, of which three cross a cell: below the first a run stands still and says
/// nothing, below the second scenes are counted.
const STALLED: f64 = 1e-4;
pub(super) const SLOW: f64 = 1e-2;
/// Kinetic energy over all energy at the start above which scenes are counted.
pub(super) const GROWN: f64 = 2.0;
/// Part of the momentum of a scene above which what a body is given is more than round-off: bodies have met.
const MET: f64 = 1e-9;

/// What holds of any scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Property {
    /// Nothing panics.
    Panic,
    /// The time step does not collapse without an error.
    Stall,
    /// All that can be read of particles and elements is a finite number.
    Finite,
    /// No particle and no mass is lost.
    Mass,
    /// The balance of energy closes to round-off of the energy that is there, with the residual of the elements booked.
    Energy,
    /// It closes to round-off of the ledger's energy too, which is the kinetic one at the start, where it closes to that
    /// of all.
    EnergyScale,
    /// That of momentum closes, with what walls gave.
    Momentum,
    /// The residual of the elements is small beside all energy at the start.
    Residual,
    /// It is small beside the ledger's energy too, which is the kinetic one at the start, where it is so beside all.
    ResidualScale,
    /// Two threads give the bits of one.
    Threads,
}

impl Property {
    /// Name for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Panic => "panic",
            Self::Stall => "time step collapsed in silence",
            Self::Finite => "not finite, in silence",
            Self::Mass => "mass",
            Self::Energy => "energy balance",
            Self::EnergyScale => "energy balance by the ledger's scale alone",
            Self::Momentum => "momentum balance",
            Self::Residual => "residual of the elements",
            Self::ResidualScale => "residual of the elements by the ledger's scale alone",
            Self::Threads => "bits on two threads",
        }
    }
}

/// A property that does not hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Broken {
    /// Which.
    pub property: Property,
    /// First step after which it was seen not to hold.
    pub step: u64,
    /// Worst number, if it is one.
    pub worst: Option<f64>,
    /// What was seen first.
    pub seen: String,
}

/// How the run of a scene ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// After all of its steps, or at its time.
    Ran,
    /// The scene was refused, with this message.
    Refused {
        /// Dotted key of the value that is refused.
        key: String,
        /// The message.
        said: String,
    },
    /// The solver reported a numerical failure.
    Reported {
        /// Short name of its kind.
        kind: String,
        /// The message.
        said: String,
    },
    /// It panicked, with this message.
    Panicked(String),
}

/// Largest errors that were seen, and what there was.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// Particles.
    pub particles: usize,
    /// Steps that were taken.
    pub steps: u64,
    /// Elements that died.
    pub died: usize,
    /// Error of the energy balance over the ledger's energy.
    pub energy: f64,
    /// The same over the largest energy that there was of any kind.
    pub energy_of_all: f64,
    /// Error of the momentum balance over `sum m |v|`.
    pub momentum: f64,
    /// Error of the angular momentum balance over `sum m |x| |v|`; it decides nothing.
    pub angular: f64,
    /// Residual of the elements over the ledger's energy.
    pub residual: f64,
    /// The same over all energy at the start, and that of walls; it decides nothing.
    pub residual_of_start: f64,
    /// Largest kinetic energy over the same: above 1 what moves has taken more than there was. It decides nothing.
    pub kinetic: f64,
    /// Shortest step over the time in which sound and motion cross a cell at the start, but for steps that land on the
    /// end.
    pub shortest: Option<f64>,
    /// Least mean of 20 steps in a row over those of a quiet scene, of which three cross a cell;
    /// nothing where there were less.
    pub pace: Option<f64>,
    /// Whether a body was given momentum.
    pub met: bool,
}

impl Figures {
    /// Ratios that are errors or tell of one, with their names.
    #[must_use]
    pub fn errors(&self) -> [(&'static str, f64); 7] {
        [
            ("error of the energy balance", self.energy),
            ("error of the energy balance over the largest energy", self.energy_of_all),
            ("error of the momentum balance", self.momentum),
            ("error of the angular momentum balance, not asked for", self.angular),
            ("residual of the elements", self.residual),
            ("residual of the elements over all energy at the start", self.residual_of_start),
            ("kinetic energy over all energy at the start", self.kinetic),
        ]
    }
}

/// What was found in a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Examined {
    /// How it ended.
    pub ending: Ending,
    /// What was seen; nothing of a scene that was refused or panicked.
    pub figures: Option<Figures>,
    /// Properties that do not hold.
    pub broken: Vec<Broken>,
    /// Whether it was run on two threads besides.
    pub twice: bool,
}

/// One thread and two, to run scenes on.
#[derive(Debug)]
pub struct Threads {
    one: ThreadPool,
    two: ThreadPool,
}

impl Threads {
    /// Starts them.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn start() -> Result<Self, ThreadPoolBuildError> {
        let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build();
        Ok(Self { one: pool(1)?, two: pool(2)? })
    }

    /// Runs the scene of an impact and looks at its properties; of one seed in ten on two threads too.
    #[must_use]
    pub fn examine(&self, impact: &Impact) -> Examined {
        let twice = impact.seed.is_multiple_of(TWICE);
        let (mut examined, alone) = run(&self.one, impact, true);
        if twice && !matches!(examined.ending, Ending::Panicked(_)) {
            let (other, together) = run(&self.two, impact, false);
            let seen = if other.ending == examined.ending {
                differing(&alone, &together)
            } else {
                Some(format!("on two threads: {:?}", other.ending))
            };
            if let Some(seen) = seen {
                let step = examined.figures.map_or(0, |figures| figures.steps);
                let broken = Broken { property: Property::Threads, step, worst: None, seen };
                examined.broken.push(broken);
            }
        }
        examined.twice = twice;
        examined
    }
}

/// Runs a scene on some threads, with a look at its properties or not; what it found, and the last state.
fn run(pool: &ThreadPool, impact: &Impact, look: bool) -> (Examined, Vec<Section>) {
    let work = || pool.install(|| march(impact, look));
    // Nothing of what a panic leaves half done is seen again.
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| {
        let said = message(payload.as_ref());
        let property = Property::Panic;
        let broken = Broken { property, step: 0, worst: None, seen: said.clone() };
        let ending = Ending::Panicked(said);
        (Examined { ending, figures: None, broken: vec![broken], twice: false }, Vec::new())
    })
}

/// The message of a panic.
fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "a panic without a message".into())
}

/// The first section of two states that has other bits.
fn differing(a: &[Section], b: &[Section]) -> Option<String> {
    let bits = |values: &Values| match values {
        Values::F64(values) => Ok(values.iter().map(|x| x.to_bits()).collect::<Vec<u64>>()),
        other => Err(other.clone()),
    };
    if a.len() != b.len() {
        return Some(format!("{} sections and {}", a.len(), b.len()));
    }
    let mut pairs = a.iter().zip(b);
    let other = pairs.find(|(a, b)| a.name != b.name || bits(&a.values) != bits(&b.values));
    other.map(|(a, _)| format!("section {} has other bits", a.name))
}

/// Takes the steps of a scene.
fn march(impact: &Impact, look: bool) -> (Examined, Vec<Section>) {
    let mut simulation = match Simulation::new(&impact.scene) {
        Ok(simulation) => simulation,
        Err(error) => {
            let ending = Ending::Refused { key: error.key.clone(), said: error.to_string() };
            let examined = Examined { ending, figures: None, broken: Vec::new(), twice: false };
            return (examined, Vec::new());
        }
    };
    let mut watch = Watch::new(impact, &simulation);
    let mut ending = Ending::Ran;
    watch.look(&simulation);
    for step in 1..=impact.steps {
        if simulation.time() >= impact.scene.stop_time {
            break;
        }
        if let Err(error) = simulation.step(impact.scene.stop_time) {
            ending = Ending::Reported { kind: error.kind().into(), said: error.to_string() };
            break;
        }
        watch.time(&simulation);
        let last = step == impact.steps || simulation.time() >= impact.scene.stop_time;
        if look && (last || step.is_multiple_of(LOOK)) {
            watch.look(&simulation);
        }
    }
    watch.figures.steps = simulation.counters().steps;
    let Watch { figures, broken, .. } = watch;
    (Examined { ending, figures: Some(figures), broken, twice: false }, simulation.sections())
}

/// What is seen of a run.
struct Watch {
    crossing: f64,
    momenta: Vec<[f64; 3]>,
    /// Largest energy of any kind so far.
    most: f64,
    /// Lengths of the last steps over the crossing of a cell; endless before the first.
    row: [f64; IN_A_ROW],
    figures: Figures,
    broken: Vec<Broken>,
}

impl Watch {
    /// Of a run that begins.
    fn new(impact: &Impact, simulation: &Simulation) -> Self {
        let figures = Figures {
            particles: simulation.particles(),
            steps: 0,
            died: 0,
            energy: 0.0,
            energy_of_all: 0.0,
            momentum: 0.0,
            angular: 0.0,
            residual: 0.0,
            residual_of_start: 0.0,
            kinetic: 0.0,
            shortest: None,
            pace: None,
            met: false,
        };
        let momenta = simulation.holdings().iter().map(|own| own.momentum).collect();
        Self {
            crossing: impact.crossing,
            momenta,
            most: 0.0,
            row: [f64::INFINITY; IN_A_ROW],
            figures,
            broken: Vec::new(),
        }
    }

    /// Notes that a property does not hold: what was seen first, and the worst number.
    fn note(&mut self, property: Property, step: u64, value: f64, seen: impl FnOnce() -> String) {
        match self.broken.iter_mut().find(|broken| broken.property == property) {
            Some(broken) => {
                let worse = |worst: f64| {
                    if property == Property::Stall { value < worst } else { value > worst }
                };
                broken.worst = broken.worst.map(|worst| if worse(worst) { value } else { worst });
            }
            None => {
                let worst = Some(value).filter(|value| value.is_finite());
                self.broken.push(Broken { property, step, worst, seen: seen() });
            }
        }
    }

    /// Looks at the length of the last step.
    fn time(&mut self, simulation: &Simulation) {
        let voter = simulation.votes().last;
        if voter == Some(Voter::Landing) {
            return;
        }
        let length = simulation.last_step() / self.crossing;
        let least = |before: Option<f64>, now: f64| Some(before.map_or(now, |old| old.min(now)));
        self.figures.shortest = least(self.figures.shortest, length);
        self.row.rotate_left(1);
        self.row[IN_A_ROW - 1] = length;
        let pace = 3.0 * self.row.iter().sum::<f64>() / IN_A_ROW as f64;
        if pace.is_infinite() {
            return;
        }
        self.figures.pace = least(self.figures.pace, pace);
        if pace < STALLED {
            self.note(Property::Stall, simulation.counters().steps, pace, || {
                let voter = voter.map_or("nothing", Voter::name);
                let last = simulation.last_step();
                format!(
                    "{IN_A_ROW} steps at {pace:.1e} of those of a quiet scene, the last of {last:.3e} us by {voter}"
                )
            });
        }
    }

    /// Looks at the state and its balance.
    fn look(&mut self, simulation: &Simulation) {
        let step = simulation.counters().steps;
        if let Some(seen) = not_finite(simulation) {
            self.note(Property::Finite, step, f64::NAN, || seen);
        }
        let balance = simulation.balance();
        let count = simulation.all_particles().count();
        if balance.mass_error() != 0.0 || count != self.figures.particles {
            let seen = || format!("{count} particles of {}", self.figures.particles);
            let seen = seen();
            self.note(Property::Mass, step, balance.mass_error(), || seen);
        }
        self.balances(step, &balance);
        self.figures.died = simulation.failed().1;
        let moved = simulation.holdings().into_iter().zip(&self.momenta);
        let given = moved.map(|(own, before)| norm(minus(own.momentum, *before)));
        let least = MET * balance.initial.momentum_scale;
        self.figures.met |= given.fold(0.0, f64::max) > least;
    }

    /// Looks at the balances.
    fn balances(&mut self, step: u64, balance: &Balance) {
        let now = &balance.now;
        let kinds = [now.kinetic, now.internal.abs(), now.stored(), balance.wall_work.abs()];
        let start = [balance.initial.kinetic, balance.initial.internal];
        self.most = kinds.into_iter().chain(start).fold(self.most, f64::max);
        let total = now.energy() + balance.residual() - balance.initial.energy();
        let of_all = (total - balance.wall_work).abs() / self.most.max(f64::MIN_POSITIVE);
        let residual = balance.relative_residual().abs();
        let given = start[0] + start[1].abs() + balance.wall_work.abs();
        let of_start = |energy: f64| energy / given.max(f64::MIN_POSITIVE);
        let residual_of_start = of_start(balance.residual().abs());
        let [energy, momentum] = [balance.energy_drift(), balance.momentum_drift()];
        let figures = &mut self.figures;
        figures.energy = figures.energy.max(energy);
        figures.energy_of_all = figures.energy_of_all.max(of_all);
        figures.momentum = figures.momentum.max(momentum);
        figures.angular = figures.angular.max(balance.angular_drift());
        figures.residual = figures.residual.max(residual);
        figures.residual_of_start = figures.residual_of_start.max(residual_of_start);
        figures.kinetic = figures.kinetic.max(of_start(now.kinetic));
        let of = |[all, ledger]: [Property; 2], small| if small { ledger } else { all };
        let drifts = of([Property::Energy, Property::EnergyScale], of_all <= ROUND_OFF);
        let left = [Property::Residual, Property::ResidualScale];
        let left = of(left, residual_of_start <= RESIDUAL);
        let all = "the largest energy there was";
        for (property, value, most, beside) in [
            (drifts, energy, ROUND_OFF, Some((of_all, all))),
            (Property::Momentum, momentum, ROUND_OFF, None),
            (left, residual, RESIDUAL, Some((residual_of_start, "all energy at the start"))),
        ] {
            // What is no number holds nothing.
            if value.is_nan() || value > most {
                let beside = beside
                    .map_or(String::new(), |(part, whole)| format!(", {part:.1e} of {whole}"));
                self.note(property, step, value, || format!("{value:.3e} of {most:.0e}{beside}"));
            }
        }
    }
}

/// The first number that is not finite.
fn not_finite(simulation: &Simulation) -> Option<String> {
    let bad = |whose: String, values: &[(&str, f64)]| {
        let (what, value) = values.iter().find(|(_, value)| !value.is_finite())?;
        Some(format!("{what} of {whose} is {value}"))
    };
    let of_particles = simulation.all_particles().find_map(|p| {
        let ([x, y, z], [u, v, w]) = (p.position, p.velocity);
        let place = [("x", x), ("y", y), ("z", z), ("vx", u), ("vy", v), ("vz", w)];
        let state = [("rho", p.rho), ("pressure", p.pressure), ("theta", p.theta), ("u", p.u)];
        let whose = || format!("particle {}", p.id);
        bad(whose(), &place).or_else(|| bad(whose(), &state))
    });
    let of_elements = || {
        simulation.all_elements().find_map(|e| {
            let [strain, damage] = [("plastic strain", e.strain), ("damage", e.damage)];
            let stress = ("equivalent stress", e.equivalent_stress);
            bad(format!("the element of particle {}", e.centre), &[strain, damage, stress])
        })
    };
    let of_turns = || {
        let ellipsoid = |id: u32| Some((id, simulation.ellipsoid(id)?));
        simulation.all_particles().filter_map(|p| ellipsoid(p.id)).find_map(|(id, ellipsoid)| {
            let wrong = ellipsoid.axes.into_iter().flatten().find(|x| !x.is_finite())?;
            Some(format!("an axis of particle {id} is {wrong}"))
        })
    };
    of_particles.or_else(of_elements).or_else(of_turns)
}
