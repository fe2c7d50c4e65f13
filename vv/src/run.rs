//! Running a case: the clock, the progress line, and the record.

mod spatial;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

use cpu_time::ProcessTime;
use whipple_solver::Solver;
use whipple_solver::error::{SceneError, StepError};
use whipple_solver::output::Snapshot;
use whipple_solver::scene::Scene;

use crate::cases::Case;
use crate::godunov::GodunovError;
use crate::norms::NormError;
use crate::paint::PaintError;
use crate::record::{Outcome, Provenance, RunKey, RunRecord, SCHEMA, Scheme, Series};
use crate::scene::AnyScene;
use crate::space::checkpoint::ResumeError;
use crate::space::measured::Photo;
use crate::space::recorder::OutputError;

pub use spatial::{SpaceDriver, SpaceOptions};

/// Steps between two looks at the clock and the interrupt flag.
const STEPS_PER_LOOK: u64 = 256;

/// Why a run gave no record.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The scene cannot be simulated.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A numerical failure.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A norm that is not a number.
    #[error("cannot measure: {0}")]
    Norm(#[from] NormError),
    /// An exact solution or reference that cannot be evaluated.
    #[error("cannot evaluate the reference solution: {0}")]
    Reference(String),
    /// The Godunov code failed.
    #[error("the Godunov code failed: {0}")]
    Godunov(#[from] GodunovError),
    /// The scheme does not exist for the case.
    #[error("case `{case}` cannot run {what}")]
    NotThere {
        /// Case.
        case: String,
        /// What is missing.
        what: String,
    },
    /// The user stopped the run.
    #[error("interrupted")]
    Interrupted {
        /// What it goes on from, if that was kept.
        checkpoint: Option<PathBuf>,
    },
    /// A picture that cannot be painted.
    #[error("picture `{id}`: {source}")]
    Picture {
        /// Its name.
        id: String,
        /// Why.
        source: PaintError,
    },
    /// A checkpoint that the run cannot go on from.
    #[error(transparent)]
    Resume(#[from] ResumeError),
    /// What the run should leave could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl From<crate::exact::InputError> for RunError {
    fn from(error: crate::exact::InputError) -> Self {
        Self::Reference(error.to_string())
    }
}

/// What watches a run.
pub trait Monitor: Sync {
    /// Told now and then how far the run is; returns false to stop it.
    fn tick(&self, time: f64, stop: f64, particle_steps: u64) -> bool;

    /// Told the error of the energy balance whenever a run in three dimensions looks at it.
    fn drift(&self, _energy: f64) {}
}

/// Watches nothing.
pub struct Silent;

impl Monitor for Silent {
    fn tick(&self, _: f64, _: f64, _: u64) -> bool {
        true
    }
}

/// What a case measured.
#[derive(Debug, Clone, Default)]
pub struct Findings {
    /// Named numbers.
    pub norms: BTreeMap<String, f64>,
    /// Fields at the end.
    pub profile: Option<Series>,
    /// Histories.
    pub history: Option<Series>,
}

impl Findings {
    /// Enters a named number.
    pub fn enter(&mut self, name: &str, value: f64) {
        self.norms.insert(name.into(), value);
    }
}

/// A solver with a clock.
pub struct Driver<'a> {
    solver: Box<dyn Solver>,
    stop: f64,
    monitor: &'a dyn Monitor,
    cpu: Duration,
    timed: Option<Timed>,
}

/// Counts at the end of the timed part.
#[derive(Debug, Clone, Copy)]
struct Timed {
    steps: u64,
    particle_steps: u64,
}

impl<'a> Driver<'a> {
    /// A driver at t = 0.
    ///
    /// # Errors
    /// An invalid scene.
    pub fn new(scene: &Scene, monitor: &'a dyn Monitor) -> Result<Self, SceneError> {
        let solver = whipple_solver::build(scene)?;
        Ok(Self { solver, stop: scene.stop_time, monitor, cpu: Duration::ZERO, timed: None })
    }

    /// Steps to `time`, on the clock.
    ///
    /// # Errors
    /// A numerical failure, or the user's interrupt.
    pub fn advance_to(&mut self, time: f64) -> Result<(), RunError> {
        self.observe_to(time, |_| {})
    }

    /// Steps to `time`, on the clock, and shows the solver after every step.
    ///
    /// # Errors
    /// A numerical failure, or the user's interrupt.
    pub fn observe_to(
        &mut self,
        time: f64,
        observe: impl FnMut(&dyn Solver),
    ) -> Result<(), RunError> {
        let start = ProcessTime::now();
        let result = self.steps_to(time, observe);
        self.cpu += start.elapsed();
        result
    }

    /// Ends the timed part of the run: later steps only sample.
    pub fn stop_clock(&mut self) {
        let counters = self.solver.counters();
        self.timed = Some(Timed { steps: counters.steps, particle_steps: counters.particle_steps });
    }

    /// Steps to `time`, off the clock.
    ///
    /// # Errors
    /// A numerical failure, or the user's interrupt.
    pub fn sample_at(&mut self, time: f64) -> Result<Snapshot, RunError> {
        self.steps_to(time, |_| {})?;
        Ok(self.solver.snapshot())
    }

    fn steps_to(
        &mut self,
        time: f64,
        mut observe: impl FnMut(&dyn Solver),
    ) -> Result<(), RunError> {
        while self.solver.time() < time {
            self.solver.step(time)?;
            observe(self.solver.as_ref());
            let done = self.solver.counters();
            if done.steps.is_multiple_of(STEPS_PER_LOOK)
                && !self.monitor.tick(self.solver.time(), self.stop, done.particle_steps)
            {
                return Err(RunError::Interrupted { checkpoint: None });
            }
        }
        Ok(())
    }

    /// The solver.
    #[must_use]
    pub fn solver(&self) -> &dyn Solver {
        self.solver.as_ref()
    }

    /// What watches the run.
    #[must_use]
    pub fn monitor(&self) -> &'a dyn Monitor {
        self.monitor
    }
}

/// A request for a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Which run.
    pub key: RunKey,
    /// The scene, overrides included; absent for the Godunov code.
    pub scene: Option<AnyScene>,
    /// Threads.
    pub threads: usize,
    /// The command that repeats it.
    pub command: String,
}

/// A record and, where the run failed numerically, the failure.
pub struct Run {
    /// The record, in either case.
    pub record: RunRecord,
    /// The failure.
    pub failure: Option<StepError>,
    /// Where a run in three dimensions that has a folder may be continued: at its end, or at the last
    /// state before a failure.
    pub checkpoint: Option<PathBuf>,
    /// Pictures, if they were wanted; the record has their hashes.
    pub photos: Vec<Photo>,
}

impl Run {
    fn new(record: RunRecord, failure: Option<StepError>) -> Self {
        Self { record, failure, checkpoint: None, photos: Vec::new() }
    }
}

/// Runs a case. A numerical failure is a result: it stands in the record.
///
/// # Errors
/// Whatever else prevents a record.
pub fn run(case: &dyn Case, request: Request, monitor: &dyn Monitor) -> Result<Run, RunError> {
    run_with(case, request, SpaceOptions::default(), monitor)
}

/// [`run`], with what only runs in three dimensions can do.
///
/// # Errors
/// As [`run`]; and what cannot be written, or not be continued.
pub fn run_with(
    case: &dyn Case,
    request: Request,
    options: SpaceOptions,
    monitor: &dyn Monitor,
) -> Result<Run, RunError> {
    let Request { key, scene, threads, command } = request;
    let record = blank(key, threads, command);
    match scene {
        Some(AnyScene::Line(scene)) => line(case, scene, record, monitor),
        Some(AnyScene::Space(scene)) => spatial::in_space(case, scene, record, options, monitor),
        None => eulerian(case, record),
    }
}

/// The record of a run that has not begun.
pub(crate) fn blank(key: RunKey, threads: usize, command: String) -> RunRecord {
    RunRecord {
        schema: SCHEMA,
        key,
        threads,
        outcome: Outcome::Completed,
        scene: None,
        steps: 0,
        particle_steps: 0,
        cpu_seconds: 0.0,
        energy_drift: 0.0,
        momentum_drift: 0.0,
        norms: BTreeMap::new(),
        counters: None,
        limiters: None,
        ledger: None,
        space: None,
        profile: None,
        history: None,
        pictures: Vec::new(),
        provenance: Provenance::here(command),
    }
}

/// The Godunov code on a case.
fn eulerian(case: &dyn Case, mut record: RunRecord) -> Result<Run, RunError> {
    debug_assert_eq!(record.key.scheme, Scheme::Godunov);
    let start = ProcessTime::now();
    let eulerian = case.eulerian(&record.key.variant, record.key.n)?;
    record.cpu_seconds = eulerian.cpu.unwrap_or_else(|| start.elapsed()).as_secs_f64();
    record.steps = eulerian.steps;
    record.particle_steps = eulerian.cell_steps;
    record.energy_drift = eulerian.energy_drift;
    fill(&mut record, eulerian.findings);
    Ok(Run::new(record, None))
}

/// Steps by the name of what decided them, without what decided none.
fn limiters(decided: impl IntoIterator<Item = (&'static str, u64)>) -> BTreeMap<String, u64> {
    let some = decided.into_iter().filter(|(_, steps)| *steps > 0);
    some.map(|(name, steps)| (name.to_owned(), steps)).collect()
}

fn line(
    case: &dyn Case,
    scene: Scene,
    mut record: RunRecord,
    monitor: &dyn Monitor,
) -> Result<Run, RunError> {
    let mut driver = Driver::new(&scene, monitor)?;
    let mut failure = None;
    match case.measure(&scene, &record.key, &mut driver) {
        Ok(findings) => fill(&mut record, findings),
        Err(RunError::Step(error)) => {
            record.outcome =
                Outcome::Failed { kind: error.kind().into(), message: error.to_string() };
            failure = Some(error);
        }
        Err(other) => return Err(other),
    }
    let solver = driver.solver();
    let (counters, ledger) = (solver.counters(), *solver.ledger());
    let timed = driver
        .timed
        .unwrap_or(Timed { steps: counters.steps, particle_steps: counters.particle_steps });
    record.steps = timed.steps;
    record.particle_steps = timed.particle_steps;
    record.cpu_seconds = driver.cpu.as_secs_f64();
    record.energy_drift = ledger.energy_drift();
    record.momentum_drift = ledger.momentum_drift();
    record.counters = Some(counters);
    record.limiters = Some(limiters(solver.decided().named()));
    record.ledger = Some(ledger);
    record.scene = Some(scene.into());
    Ok(Run::new(record, failure))
}

fn fill(record: &mut RunRecord, findings: Findings) {
    record.norms = findings.norms;
    record.profile = findings.profile;
    record.history = findings.history;
}
