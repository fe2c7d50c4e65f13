//! Runs in three dimensions: the driver that cases measure through, and how a run goes on from a
//! checkpoint.
//!
//! A run that goes on asks its case to measure from the beginning. Until the time of the checkpoint
//! nothing is stepped: every look gives what the checkpoint has kept of it. Then the state takes the
//! place of that of t = 0, and looks are looks again. The case need not know.

use std::cell::Cell;
use std::path::PathBuf;

use cpu_time::ProcessTime;
use whipple_solver::error::StepError;
use whipple_solver::space::ledger::Balance;
use whipple_solver::space::{Scene, Simulation};

use super::{Monitor, Run, RunError, fill};
use crate::cases::Case;
use crate::paint::PaintError;
use crate::record::{Outcome, PictureRecord, RunRecord, SpaceRecord};
use crate::space::checkpoint::{Halted, ResumeError};
use crate::space::measured::{Look, Measured, Photo};
use crate::space::recorder::{OutputError, Recorder};
use crate::words::told_apart;

/// Steps between two looks at the clock and the interrupt flag; a step takes milliseconds.
const STEPS_PER_LOOK: u64 = 16;

/// What a run in three dimensions may do beside giving a record.
#[derive(Debug, Default)]
pub struct SpaceOptions {
    /// Goes on from here.
    pub from: Option<Halted>,
    /// Leaves files while it goes on.
    pub recorder: Option<Recorder>,
    /// Takes the pictures that the case would take.
    pub pictures: bool,
}

/// A solver in three dimensions with a clock.
pub struct SpaceDriver<'a> {
    solver: Simulation,
    stop: f64,
    monitor: &'a dyn Monitor,
    measured: Measured,
    recorder: Option<Recorder>,
    pictures: bool,
    /// The time that the case asked for.
    now: f64,
    /// The state to go on from, while the case looks at what was before.
    ahead: Option<Simulation>,
    /// Looks that were kept, and how many of them have been taken again.
    kept: usize,
    taken: usize,
    /// The run has begun, or goes on.
    begun: bool,
    /// The case read the present state without [`SpaceDriver::look`].
    read: Cell<bool>,
    /// It has done so before the present time: a checkpoint would not hold what it found.
    unkept: bool,
}

impl<'a> SpaceDriver<'a> {
    /// A driver at t = 0, or at what the case measured before the state that it goes on from.
    ///
    /// # Errors
    /// An invalid scene.
    fn new(
        scene: &Scene,
        options: SpaceOptions,
        monitor: &'a dyn Monitor,
    ) -> Result<Self, RunError> {
        let SpaceOptions { from, recorder, pictures } = options;
        let (ahead, measured) = match from {
            Some(Halted { simulation, measured }) => (Some(simulation), measured),
            None => (None, Measured::default()),
        };
        Ok(Self {
            solver: Simulation::new(scene)?,
            stop: scene.stop_time,
            monitor,
            kept: measured.looks.len(),
            measured,
            recorder,
            pictures,
            now: 0.0,
            ahead,
            taken: 0,
            begun: false,
            read: Cell::new(false),
            unkept: false,
        })
    }

    /// Changes the simulation before its first step: a state that no scene states.
    ///
    /// # Errors
    /// Those of the change.
    pub fn prepare(
        &mut self,
        change: impl FnOnce(&mut Simulation) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        change(&mut self.solver)
    }

    /// Steps to `time`, on the clock.
    ///
    /// # Errors
    /// A numerical failure, the user's interrupt, or output that cannot be written.
    pub fn advance_to(&mut self, time: f64) -> Result<(), RunError> {
        self.unkept |= self.read.take();
        self.now = self.now.max(time);
        if self.ahead.as_ref().is_some_and(|state| time < state.time()) {
            return Ok(());
        }
        if let Some(state) = self.ahead.take() {
            self.solver = state;
        }
        if !std::mem::replace(&mut self.begun, true) {
            self.follow()?;
        }
        if time > self.solver.time() {
            self.drop_last_look()?;
        }
        while self.solver.time() < time {
            let start = ProcessTime::now();
            let stepped = self.stretch(time);
            self.measured.cpu_seconds += start.elapsed().as_secs_f64();
            stepped?;
            self.follow()?;
            // The end is kept anyway.
            let goes_on = self.solver.time() < self.stop;
            if goes_on && self.recorder.as_mut().is_some_and(Recorder::is_time_to_keep) {
                self.keep()?;
            }
            let done = self.solver.counters().particle_steps;
            if !self.monitor.tick(self.solver.time(), self.stop, done) {
                return Err(RunError::Interrupted { checkpoint: None });
            }
        }
        Ok(())
    }

    /// Takes down the present state.
    fn follow(&mut self) -> Result<(), OutputError> {
        self.recorder.as_mut().map_or(Ok(()), |recorder| recorder.follow(&self.solver))
    }

    /// Steps until there is something else to do.
    fn stretch(&mut self, time: f64) -> Result<(), StepError> {
        let due = self.recorder.as_ref().map_or(f64::INFINITY, Recorder::due).min(time);
        loop {
            self.solver.step(time)?;
            let steps = self.solver.counters().steps;
            if self.solver.time() >= due || steps.is_multiple_of(STEPS_PER_LOOK) {
                return Ok(());
            }
        }
    }

    /// The last look of a run that is made longer may be one that this run does not take.
    fn drop_last_look(&mut self) -> Result<(), RunError> {
        let left = &self.measured.looks[self.taken..self.kept];
        match left.iter().find(|look| look.time < self.solver.time()) {
            Some(look) => Err(other_looks(at(look.time, self.now), "no look at this time").into()),
            None => {
                self.measured.looks.drain(self.taken..self.kept);
                self.kept = self.taken;
                Ok(())
            }
        }
    }

    /// Reads numbers off the present state and its balance, off the clock; the record keeps the largest
    /// errors of the balance. Checkpoints hold the numbers: in a run that goes on from one, looks before
    /// it give the numbers again and do not look.
    ///
    /// # Errors
    /// A checkpoint with other looks.
    pub fn look(
        &mut self,
        find: impl FnOnce(&Simulation, &Balance) -> Vec<f64>,
    ) -> Result<Vec<f64>, RunError> {
        if self.taken < self.kept {
            let look = &self.measured.looks[self.taken];
            if look.time.to_bits() != self.now.to_bits() {
                return Err(other_looks(at(look.time, self.now), &at(self.now, look.time)).into());
            }
            self.taken += 1;
            return Ok(look.values.clone());
        }
        if self.ahead.is_some() {
            return Err(other_looks("no more looks".to_owned(), &at(self.now, 0.0)).into());
        }
        let balance = self.weigh();
        let values = find(&self.solver, &balance);
        self.measured.looks.push(Look { time: self.now, values: values.clone() });
        Ok(values)
    }

    /// Takes a picture of the present state, if pictures are wanted and a checkpoint has not kept it.
    ///
    /// # Errors
    /// A picture that cannot be painted.
    pub fn photograph(
        &mut self,
        id: &str,
        caption: &str,
        shoot: impl FnOnce(&Simulation) -> Result<[Vec<u8>; 2], PaintError>,
    ) -> Result<(), RunError> {
        if !self.pictures || self.measured.photos.iter().any(|photo| photo.id == id) {
            return Ok(());
        }
        let id = id.to_owned();
        match shoot(&self.solver) {
            Ok([light, dark]) => {
                let photo = Photo { id, caption: caption.to_owned(), light, dark };
                self.measured.photos.push(photo);
                Ok(())
            }
            Err(source) => Err(RunError::Picture { id, source }),
        }
    }

    /// The balance now, off the clock; the record keeps the largest errors of those looked at.
    /// Checkpoints do not hold it, see [`SpaceDriver::look`].
    pub fn balance(&mut self) -> Balance {
        self.mark();
        self.weigh()
    }

    fn weigh(&mut self) -> Balance {
        let balance = self.solver.balance();
        // `max` would pass over NaN.
        let keep = |worst: &mut f64, error: f64| {
            if error > *worst || error.is_nan() {
                *worst = error;
            }
        };
        let worst = &mut self.measured.worst;
        keep(&mut worst.energy, balance.energy_drift());
        keep(&mut worst.momentum, balance.momentum_drift());
        keep(&mut worst.angular, balance.angular_drift());
        self.monitor.drift(worst.energy);
        balance
    }

    /// The solver. Checkpoints do not hold what is read here after t = 0, see [`SpaceDriver::look`]: a
    /// run that reads and goes on leaves none.
    #[must_use]
    pub fn solver(&self) -> &Simulation {
        self.mark();
        &self.solver
    }

    /// The state is read. That of t = 0 is there again when a run goes on.
    fn mark(&self) {
        if self.now > 0.0 {
            self.read.set(true);
        }
    }

    /// Keeps the present state, if there is a folder for it and the case has found nothing that would
    /// be lost.
    fn keep(&self) -> Result<Option<PathBuf>, OutputError> {
        match &self.recorder {
            Some(recorder) if !self.unkept => recorder.keep(&self.solver, &self.measured).map(Some),
            _ => Ok(None),
        }
    }

    /// Keeps the last state that was seen before a failure.
    fn keep_last_good(&self) -> Result<Option<PathBuf>, OutputError> {
        match &self.recorder {
            Some(recorder) if !self.unkept => recorder.keep_last_good(&self.measured),
            _ => Ok(None),
        }
    }
}

/// A look, in words, told from one at another time.
fn at(time: f64, other: f64) -> String {
    format!("a look at {:?}", told_apart(time, other))
}

/// A checkpoint of a run that looked at other times.
fn other_looks(found: String, wanted: &str) -> ResumeError {
    ResumeError::Looks { found, wanted: wanted.to_owned() }
}

/// Runs a case in three dimensions.
pub(super) fn in_space(
    case: &dyn Case,
    scene: Scene,
    mut record: RunRecord,
    options: SpaceOptions,
    monitor: &dyn Monitor,
) -> Result<Run, RunError> {
    let mut driver = SpaceDriver::new(&scene, options, monitor)?;
    let measured = case.measure_space(&scene, &record.key, &mut driver);
    if let Some(recorder) = &driver.recorder {
        recorder.close()?;
    }
    let (failure, checkpoint) = match measured {
        Ok(findings) => {
            fill(&mut record, findings);
            (None, driver.keep()?)
        }
        Err(RunError::Step(error)) => {
            record.outcome =
                Outcome::Failed { kind: error.kind().into(), message: error.to_string() };
            (Some(error), driver.keep_last_good()?)
        }
        Err(RunError::Interrupted { .. }) => {
            return Err(RunError::Interrupted { checkpoint: driver.keep()? });
        }
        Err(other) => return Err(other),
    };
    let balance = driver.weigh();
    let solver = &driver.solver;
    let (counters, (failed_elements, dead_elements)) = (solver.counters(), solver.failed());
    let Measured { worst, cpu_seconds, photos, .. } = driver.measured;
    record.steps = counters.steps;
    record.particle_steps = counters.particle_steps;
    record.cpu_seconds = cpu_seconds;
    record.energy_drift = worst.energy;
    record.momentum_drift = worst.momentum;
    record.counters = Some(counters);
    record.limiters = Some(super::limiters(solver.votes().named()));
    record.space = Some(SpaceRecord {
        particles: solver.particles(),
        elements: solver.elements(),
        failed_elements,
        dead_elements,
        balance,
        geometry_mass_error: geometry_mass_error(&scene, solver),
        mass_error: balance.mass_error(),
        angular_momentum_drift: worst.angular,
        ledger_residual: balance.relative_residual(),
        updates_per_cpu_second: counters.particle_steps as f64 / cpu_seconds,
        bytes_per_particle: solver.bytes() as f64 / solver.particles() as f64,
    });
    record.pictures = photos.iter().map(PictureRecord::of).collect();
    record.scene = Some(scene.into());
    Ok(Run { checkpoint, photos, ..Run::new(record, failure) })
}

/// Largest error of the mass of a body as it is meshed, over that of its shape.
fn geometry_mass_error(scene: &Scene, solver: &Simulation) -> f64 {
    let holdings = solver.holdings();
    let errors = scene.bodies.iter().zip(&holdings).filter_map(|(body, held)| {
        let material = &scene.materials[scene.material_index(&body.material)?];
        Some((held.mass / (material.density * body.volume()) - 1.0).abs())
    });
    errors.fold(0.0, f64::max)
}
