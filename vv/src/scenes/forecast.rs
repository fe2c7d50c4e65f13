//! How long a run will take on this machine: by its first steps, and by what those of a coarser copy said of its whole run.

use std::time::{Duration, Instant};

use whipple_solver::error::StepError;
use whipple_solver::method::Preset;
use whipple_solver::space::Simulation;

use super::case::FileCase;
use crate::cases::Case;

/// Longest time that steps are tried.
const CALIBRATION: Duration = Duration::from_millis(1500);

/// Most steps of it, and those of its start that are not counted: the first are shorter.
const STEPS: [u64; 2] = [400, 5];

/// Seconds below which a run is foreseen by running it, and what a coarser copy may be told to take.
const SHORT: f64 = 2.5;

/// Longest time that a run is waited for: debris takes coarser copies longer than told.
const PATIENCE: Duration = Duration::from_secs(20);

/// Power of the number of cells across with which the time of a run grows: cells in space, and steps.
const GROWTH: i32 = 4;

/// Time that steps take here, and how long they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Length of the first step.
    pub first: f64,
    /// Mean length of those that were tried.
    pub step: f64,
    /// Seconds on the clock for one of them.
    pub seconds: f64,
}

impl Pace {
    /// Tries steps, with nothing asleep.
    fn of(mut simulation: Simulation, stop: f64) -> Result<Self, StepError> {
        simulation.keep_awake();
        simulation.step(stop)?;
        let first = simulation.last_step();
        let [most, left_out] = STEPS;
        for _ in 1..left_out {
            simulation.step(stop)?;
        }
        let (from, start) = (simulation.time(), Instant::now());
        let mut steps = 0u64;
        while steps < most && start.elapsed() < CALIBRATION && simulation.time() < stop {
            simulation.step(stop)?;
            steps += 1;
        }
        let steps = steps.max(1) as f64;
        let seconds = start.elapsed().as_secs_f64() / steps;
        let step = ((simulation.time() - from) / steps).max(f64::MIN_POSITIVE);
        Ok(Self { first, step, seconds })
    }

    /// Seconds that a run to this time takes, if its steps stay as they are.
    fn whole(&self, stop: f64) -> f64 {
        stop / self.step * self.seconds
    }
}

/// What a forecast stands on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Basis {
    /// The run itself, as short as it is.
    Itself,
    /// A copy with so many cells through the thinnest part, whose run took this many times what its first steps told.
    Copy(usize, f64),
    /// The first steps alone.
    FirstSteps,
}

/// How long a run will take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forecast {
    /// Its first steps.
    pub pace: Pace,
    /// Seconds on the clock, on one thread, checkpoints and pictures apart.
    pub seconds: f64,
    /// By what.
    pub basis: Basis,
}

impl Forecast {
    /// Of a scene with so many cells through its thinnest part, from its start.
    ///
    /// # Errors
    /// A numerical failure in the first steps.
    pub fn of(case: &FileCase, n: usize, start: &Simulation, stop: f64) -> Result<Self, StepError> {
        let pace = Pace::of(start.clone(), stop)?;
        let told = pace.whole(stop);
        let first = Self { pace, seconds: told, basis: Basis::FirstSteps };
        if told <= SHORT {
            let own = run(case, start.clone(), stop);
            return Ok(own.map_or(first, |seconds| Self {
                seconds,
                basis: Basis::Itself,
                ..first
            }));
        }
        let coarser = (1..n).rev().find(|&m| told * (m as f64 / n as f64).powi(GROWTH) <= SHORT);
        let share = coarser.and_then(|m| {
            let scene = case.scene(Preset::Default, "", m);
            let copy = Simulation::new(scene.space()?).ok()?;
            let told = Pace::of(copy.clone(), stop).ok()?.whole(stop);
            Some((m, run(case, copy, stop)? / told))
        });
        Ok(share.map_or(first, |(m, share)| Self {
            seconds: told * share,
            basis: Basis::Copy(m, share),
            ..first
        }))
    }
}

/// Seconds that a run takes; none if it fails or takes too long.
fn run(case: &FileCase, simulation: Simulation, stop: f64) -> Option<f64> {
    let start = Instant::now();
    case.follow(simulation, stop, PATIENCE).ok()?.then(|| start.elapsed().as_secs_f64())
}
