//! Running a case: the clock, the progress line, and the record.

use std::collections::BTreeMap;
use std::time::Duration;

use cpu_time::ProcessTime;
use whipple_solver::Solver;
use whipple_solver::error::{SceneError, StepError};
use whipple_solver::output::Snapshot;
use whipple_solver::scene::Scene;
use whipple_solver::space;
use whipple_solver::space::ledger::Balance;

use crate::cases::Case;
use crate::godunov::GodunovError;
use crate::norms::NormError;
use crate::record::{Outcome, Provenance, RunKey, RunRecord, SCHEMA, Scheme, Series, SpaceRecord};
use crate::scene::AnyScene;

/// Steps between two looks at the clock and the interrupt flag.
const STEPS_PER_LOOK: u64 = 256;

/// The same in three dimensions, where a step takes milliseconds.
const STEPS_PER_SPACE_LOOK: u64 = 16;

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
    Interrupted,
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
                return Err(RunError::Interrupted);
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

/// A solver in three dimensions with a clock.
pub struct SpaceDriver<'a> {
    solver: space::Simulation,
    stop: f64,
    monitor: &'a dyn Monitor,
    cpu: Duration,
    worst: Worst,
}

/// Largest errors of the balances that were looked at.
#[derive(Debug, Clone, Copy, Default)]
struct Worst {
    energy: f64,
    momentum: f64,
    angular: f64,
}

impl<'a> SpaceDriver<'a> {
    /// A driver at t = 0.
    ///
    /// # Errors
    /// An invalid scene.
    pub fn new(scene: &space::Scene, monitor: &'a dyn Monitor) -> Result<Self, SceneError> {
        Ok(Self {
            solver: space::Simulation::new(scene)?,
            stop: scene.stop_time,
            monitor,
            cpu: Duration::ZERO,
            worst: Worst::default(),
        })
    }

    /// Changes the simulation before its first step: a state that no scene states.
    ///
    /// # Errors
    /// Those of the change.
    pub fn prepare(
        &mut self,
        change: impl FnOnce(&mut space::Simulation) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        change(&mut self.solver)
    }

    /// Steps to `time`, on the clock.
    ///
    /// # Errors
    /// A numerical failure, or the user's interrupt.
    pub fn advance_to(&mut self, time: f64) -> Result<(), RunError> {
        let start = ProcessTime::now();
        let result = self.steps_to(time);
        self.cpu += start.elapsed();
        result
    }

    fn steps_to(&mut self, time: f64) -> Result<(), RunError> {
        while self.solver.time() < time {
            self.solver.step(time)?;
            let done = self.solver.counters();
            if done.steps.is_multiple_of(STEPS_PER_SPACE_LOOK)
                && !self.monitor.tick(self.solver.time(), self.stop, done.particle_steps)
            {
                return Err(RunError::Interrupted);
            }
        }
        Ok(())
    }

    /// The balance now, off the clock; the record keeps the largest errors of those looked at.
    pub fn balance(&mut self) -> Balance {
        let balance = self.solver.balance();
        // `max` would pass over NaN.
        let keep = |worst: &mut f64, error: f64| {
            if error > *worst || error.is_nan() {
                *worst = error;
            }
        };
        keep(&mut self.worst.energy, balance.energy_drift());
        keep(&mut self.worst.momentum, balance.momentum_drift());
        keep(&mut self.worst.angular, balance.angular_drift());
        balance
    }

    /// The solver.
    #[must_use]
    pub fn solver(&self) -> &space::Simulation {
        &self.solver
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
}

/// Runs a case. A numerical failure is a result: it stands in the record.
///
/// # Errors
/// Whatever else prevents a record.
pub fn run(case: &dyn Case, request: Request, monitor: &dyn Monitor) -> Result<Run, RunError> {
    let Request { key, scene, threads, command } = request;
    let mut record = RunRecord {
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
        provenance: Provenance::here(command),
    };
    match scene {
        Some(AnyScene::Line(scene)) => line(case, scene, record, monitor),
        Some(AnyScene::Space(scene)) => in_space(case, scene, record, monitor),
        None => {
            debug_assert_eq!(record.key.scheme, Scheme::Godunov);
            let start = ProcessTime::now();
            let eulerian = case.eulerian(&record.key.variant, record.key.n)?;
            record.cpu_seconds = eulerian.cpu.unwrap_or_else(|| start.elapsed()).as_secs_f64();
            record.steps = eulerian.steps;
            record.particle_steps = eulerian.cell_steps;
            record.energy_drift = eulerian.energy_drift;
            fill(&mut record, eulerian.findings);
            Ok(Run { record, failure: None })
        }
    }
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
    record.limiters = Some(solver.decided());
    record.ledger = Some(ledger);
    record.scene = Some(scene.into());
    Ok(Run { record, failure })
}

fn in_space(
    case: &dyn Case,
    scene: space::Scene,
    mut record: RunRecord,
    monitor: &dyn Monitor,
) -> Result<Run, RunError> {
    let mut driver = SpaceDriver::new(&scene, monitor)?;
    let mut failure = None;
    match case.measure_space(&scene, &record.key, &mut driver) {
        Ok(findings) => fill(&mut record, findings),
        Err(RunError::Step(error)) => {
            record.outcome =
                Outcome::Failed { kind: error.kind().into(), message: error.to_string() };
            failure = Some(error);
        }
        Err(other) => return Err(other),
    }
    let balance = driver.balance();
    let solver = driver.solver();
    let (counters, (failed_elements, dead_elements)) = (solver.counters(), solver.failed());
    record.steps = counters.steps;
    record.particle_steps = counters.particle_steps;
    record.cpu_seconds = driver.cpu.as_secs_f64();
    record.energy_drift = driver.worst.energy;
    record.momentum_drift = driver.worst.momentum;
    record.counters = Some(counters);
    // A state that is no number has no balance, and a record of one could not be read.
    let sound = balance.energy_drift().is_finite() && balance.momentum_drift().is_finite();
    record.space = sound.then(|| SpaceRecord {
        particles: solver.particles(),
        elements: solver.elements(),
        failed_elements,
        dead_elements,
        balance,
        geometry_mass_error: geometry_mass_error(&scene, solver),
        mass_error: balance.mass_error(),
        angular_momentum_drift: driver.worst.angular,
        ledger_residual: balance.relative_residual(),
        updates_per_cpu_second: counters.particle_steps as f64 / record.cpu_seconds,
        bytes_per_particle: solver.bytes() as f64 / solver.particles() as f64,
    });
    record.scene = Some(scene.into());
    Ok(Run { record, failure })
}

/// Largest error of the mass of a body as it is meshed, over that of its shape.
fn geometry_mass_error(scene: &space::Scene, solver: &space::Simulation) -> f64 {
    let holdings = solver.holdings();
    let errors = scene.bodies.iter().zip(&holdings).filter_map(|(body, held)| {
        let material = &scene.materials[scene.material_index(&body.material)?];
        Some((held.mass / (material.density * body.shape.volume()) - 1.0).abs())
    });
    errors.fold(0.0, f64::max)
}

fn fill(record: &mut RunRecord, findings: Findings) {
    record.norms = findings.norms;
    record.profile = findings.profile;
    record.history = findings.history;
}
