//! How fast a scene in three dimensions runs, and where its time goes.
//!
//! The solver tells the phases of its steps and reads no clock; the clock is here. Times are CPU times
//! of the process, which other programs of the machine disturb less than the clock on the wall; only
//! the gain by threads is measured on the wall.

mod bandwidth;
pub mod rivals;
mod tables;

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use whipple_solver::error::{SceneError, StepError};
use whipple_solver::space::phase::Phase;
use whipple_solver::space::{Scene, Simulation};

use crate::words::counted;

pub use tables::{figure, machine, phases, work};

/// Parts of a run whose times are kept apart, for the figure.
const PARTS: u32 = 25;

/// Why a pace cannot be measured.
#[derive(Debug, thiserror::Error)]
pub enum PaceError {
    /// The scene cannot be simulated.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A numerical failure.
    #[error(transparent)]
    Step(#[from] StepError),
    /// Threads that cannot be started.
    #[error("cannot start {}: {reason}", counted(*threads, ["thread", "threads"]))]
    Threads {
        /// Number of threads.
        threads: usize,
        /// What the system says.
        reason: String,
    },
}

/// How much of a run is measured, from its start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stretch {
    /// So many steps.
    Steps(u64),
    /// All of it.
    Whole,
}

/// CPU seconds of the phases, in the order of [`Phase::ALL`].
pub type Spent = [f64; Phase::ALL.len()];

/// A part of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Simulated time at its end.
    pub time: f64,
    /// Particles advanced by a full step in it.
    pub updates: u64,
    /// Where its time went.
    pub spent: Spent,
}

/// How fast a run was, and the work that it did.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Pace {
    /// Name of what ran.
    pub name: String,
    /// Threads.
    pub threads: usize,
    /// Particles of the scene.
    pub particles: usize,
    /// Steps taken.
    pub steps: u64,
    /// Particles advanced by a full step.
    pub updates: u64,
    /// CPU seconds of the steps, all threads.
    pub cpu: f64,
    /// Seconds on the wall.
    pub wall: f64,
    /// Parts of the run.
    pub parts: Vec<Part>,
    /// CPU seconds of one balance.
    pub balance: f64,
    /// Bytes that the simulation holds at the end.
    pub bytes: usize,
    /// Elements evaluated, summed over the steps.
    pub elements: u64,
    /// Pairs in the list, summed over the steps.
    pub listed: u64,
    /// Pairs that acted, summed over the steps.
    pub acting: u64,
    /// Lists made.
    pub renewals: u64,
    /// Distances compared for them.
    pub tests: u64,
    /// Evaluations of a kernel.
    pub kernel_evaluations: u64,
}

impl Pace {
    /// CPU seconds of the phases over the whole stretch.
    #[must_use]
    pub fn spent(&self) -> Spent {
        let mut sum = Spent::default();
        for part in &self.parts {
            sum.iter_mut().zip(part.spent).for_each(|(sum, spent)| *sum += spent);
        }
        sum
    }

    /// Particle-updates per CPU second.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.updates as f64 / self.cpu
    }

    /// Something that was counted, for each update.
    #[must_use]
    pub fn per_update(&self, count: u64) -> f64 {
        count as f64 / self.updates as f64
    }
}

/// Takes the time of the phases.
struct Stopwatch {
    /// The phase that the time goes to, if it counts.
    at: Option<Phase>,
    since: ProcessTime,
    spent: [Duration; Phase::ALL.len()],
}

impl Stopwatch {
    fn new() -> Self {
        Self { at: None, since: ProcessTime::now(), spent: Default::default() }
    }

    fn turn_to(&mut self, phase: Option<Phase>) {
        let now = ProcessTime::now();
        if let Some(at) = self.at {
            self.spent[at as usize] += now.duration_since(self.since);
        }
        (self.at, self.since) = (phase, now);
    }
}

/// Runs a scene and measures it.
///
/// # Errors
/// A scene that cannot be simulated, a numerical failure, or threads that do not start.
pub fn measure(
    name: &str,
    scene: &Scene,
    stretch: Stretch,
    threads: usize,
) -> Result<Pace, PaceError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|e| PaceError::Threads { threads, reason: e.to_string() })?;
    let mut pace = pool.install(|| run(scene, stretch))?;
    (pace.name, pace.threads) = (name.to_owned(), threads);
    Ok(pace)
}

fn run(scene: &Scene, stretch: Stretch) -> Result<Pace, PaceError> {
    let mut simulation = Simulation::new(scene)?;
    let stop = scene.stop_time;
    let most = match stretch {
        Stretch::Steps(steps) => steps,
        Stretch::Whole => u64::MAX,
    };
    let mut pace = Pace { particles: simulation.particles(), ..Pace::default() };
    let searched = simulation.searches();
    while pace.steps < most && simulation.time() < stop {
        let before = simulation.counters();
        let mut watch = Stopwatch::new();
        let part = pace.parts.len() as u32 + 1;
        // A part ends by steps or by time, whatever the stretch is measured in.
        let more = |steps: u64, time: f64| match stretch {
            Stretch::Steps(all) => steps < (all * u64::from(part)).div_ceil(u64::from(PARTS)),
            Stretch::Whole => time < stop * f64::from(part) / f64::from(PARTS),
        };
        while more(pace.steps, simulation.time()) && simulation.time() < stop {
            let wall = Instant::now();
            simulation.step_by_phases(stop, &mut |phase| watch.turn_to(Some(phase)))?;
            watch.turn_to(None);
            pace.wall += wall.elapsed().as_secs_f64();
            pace.steps += 1;
            pace.elements += simulation.working() as u64;
            pace.listed += simulation.pairs() as u64;
            pace.acting += simulation.acting() as u64;
        }
        let spent = watch.spent.map(|spent| spent.as_secs_f64());
        let done = simulation.counters();
        pace.cpu += spent.iter().sum::<f64>();
        let updates = done.particle_steps - before.particle_steps;
        pace.parts.push(Part { time: simulation.time(), updates, spent });
    }
    let (done, searches) = (simulation.counters(), simulation.searches());
    pace.updates = done.particle_steps;
    pace.kernel_evaluations = done.kernel_evaluations;
    pace.renewals = searches.rebuilds - searched.rebuilds;
    pace.tests = searches.tests - searched.tests;
    pace.bytes = simulation.bytes();
    let start = ProcessTime::now();
    std::hint::black_box(simulation.balance());
    pace.balance = start.elapsed().as_secs_f64();
    Ok(pace)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::find;
    use whipple_solver::method::Preset;

    fn short() -> Scene {
        let scene = find("planar-impact").expect("the case").scene(Preset::Default, "", 16);
        scene.space().expect("a scene in space").clone()
    }

    /// Phases are told in every step, the counts are those of the run, and listening moves no bit.
    #[test]
    fn phases_make_up_the_run() {
        let scene = short();
        let pace = measure("short", &scene, Stretch::Steps(20), 1).expect("a run");
        let mut plain = Simulation::new(&scene).expect("a scene");
        let (mut listed, mut acting) = (0, 0);
        for _ in 0..20 {
            plain.step(scene.stop_time).expect("a step");
            listed += plain.pairs() as u64;
            acting += plain.acting() as u64;
        }
        assert_eq!((pace.steps, pace.updates), (20, plain.counters().particle_steps));
        assert_eq!((pace.listed, pace.acting), (listed, acting));
        assert_eq!(pace.parts.last().expect("a part").time.to_bits(), plain.time().to_bits());
        let spent = pace.spent();
        assert!((spent.iter().sum::<f64>() / pace.cpu - 1.0).abs() < 1e-9);
        for phase in Phase::ALL {
            let there = spent[phase as usize] > 0.0;
            assert_eq!(there, phase != Phase::Kernel, "{}", phase.name());
        }
        assert!(pace.elements > 0 && pace.elements <= 20 * plain.elements() as u64);
    }

    /// Times are kept by the place of a phase.
    #[test]
    fn phases_stand_in_their_order() {
        for (place, phase) in Phase::ALL.into_iter().enumerate() {
            assert_eq!(phase as usize, place);
        }
    }

    #[test]
    fn whole_runs_end_at_their_time() {
        let scene = short();
        let pace = measure("short", &scene, Stretch::Whole, 2).expect("a run");
        assert_eq!(pace.parts.len(), PARTS as usize);
        assert_eq!(pace.parts.last().expect("a part").time, scene.stop_time);
        assert_eq!(pace.parts.iter().map(|p| p.updates).sum::<u64>(), pace.updates);
    }
}
