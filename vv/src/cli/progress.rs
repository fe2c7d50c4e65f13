//! The progress line, and what ends a run early.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::run::Monitor;

/// Set by the first interrupt.
static STOP: AtomicBool = AtomicBool::new(false);

/// Parts of a run that the bar is divided into.
const PARTS: u64 = 1000;

/// Least and greatest time between two lines of progress where there is no bar: in between it is a tenth of
/// what a run has taken so far.
const PATIENCE: [Duration; 2] = [Duration::from_secs(10), Duration::from_secs(60)];

/// Part of a run over which its pace is taken.
const PART: f64 = 0.1;

/// What is known of a run before it begins.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Outlook {
    /// Time and particle-steps that it goes on from.
    pub(super) from: (f64, u64),
    /// Time on the clock after which it is to stop.
    pub(super) max_wall: Option<Duration>,
}

/// Watches a run for the user.
pub(super) struct Progress {
    bar: ProgressBar,
    outlook: Outlook,
    state: Mutex<State>,
}

/// What changes during a run.
struct State {
    /// Unit of simulated time.
    unit: &'static str,
    start: Instant,
    pace: Pace,
    drift: Option<f64>,
    /// When the last line was printed, where there is no bar.
    said: Option<Instant>,
}

impl Progress {
    /// A bar on standard error, if that is a terminal, and else a line now and then; and an interrupt that
    /// ends the run after the step. A second interrupt ends the program.
    pub(super) fn new(outlook: Outlook) -> Self {
        // A handler that is there already serves as well.
        let _ = ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(super::INTERRUPTED));
            }
        });
        Self::watching(outlook)
    }

    /// The bar or the lines alone.
    fn watching(outlook: Outlook) -> Self {
        let bar = ProgressBar::new(PARTS);
        let terminal = std::io::stderr().is_terminal();
        if !terminal {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) = ProgressStyle::with_template("{prefix} {wide_bar} {msg}") {
            bar.set_style(style);
        }
        let start = Instant::now();
        let pace = Pace::from(outlook.from.0);
        let state =
            State { unit: "", start, pace, drift: None, said: (!terminal).then_some(start) };
        Self { bar, outlook, state: Mutex::new(state) }
    }

    /// Starts a new run on the same line, in this unit of simulated time.
    pub(super) fn start(&self, what: &str, unit: &'static str) {
        self.bar.reset();
        self.bar.set_prefix(what.to_owned());
        let mut state = self.state();
        (state.unit, state.start, state.drift) = (unit, Instant::now(), None);
        state.pace = Pace::from(self.outlook.from.0);
    }

    /// Takes the line away.
    pub(super) fn done(&self) {
        self.bar.finish_and_clear();
    }

    /// Whether the time on the clock is used up.
    pub(super) fn is_late(&self) -> bool {
        self.outlook.max_wall.is_some_and(|most| self.state().start.elapsed() >= most)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Nobody panics while holding it.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Time between two lines of a run that has taken so long.
fn patience(so_far: Duration) -> Duration {
    let [least, most] = PATIENCE;
    (so_far / 10).clamp(least, most)
}

/// How fast simulated time has passed lately. Steps shorten and contacts come over a run: its beginning
/// says little of the rest.
struct Pace {
    /// Simulated time that the run began at.
    first: f64,
    /// Seconds and simulated time at two points of the run, a part apart.
    marks: [(f64, f64); 2],
}

impl Pace {
    /// Of a run that begins at a time.
    fn from(first: f64) -> Self {
        Self { first, marks: [(0.0, first); 2] }
    }

    /// Seconds that are left of a run to `stop`, by the rate over the last part or two of it. In its first
    /// part nothing is said.
    fn left(&mut self, seconds: f64, time: f64, stop: f64) -> Option<f64> {
        let part = PART * (stop - self.first);
        if time < self.first + part {
            return None;
        }
        let [(from, of), _] = self.marks;
        let left = (stop - time) * (seconds - from) / (time - of);
        if time >= self.marks[1].1 + part {
            self.marks = [self.marks[1], (seconds, time)];
        }
        Some(left)
    }
}

impl Monitor for Progress {
    fn tick(&self, time: f64, stop: f64, particle_steps: u64) -> bool {
        let mut state = self.state();
        let (unit, (_, before)) = (state.unit, self.outlook.from);
        let seconds = state.start.elapsed().as_secs_f64().max(1e-9);
        let rate = particle_steps.saturating_sub(before) as f64 / seconds / 1e6;
        let left = state.pace.left(seconds, time, stop);
        let space = if unit.is_empty() { "" } else { " " };
        let mut message = format!("t = {time:.4e}{space}{unit}, {rate:.1} M particle-steps/s");
        if let Some(drift) = state.drift {
            message += &format!(", energy drift {drift:.0e}");
        }
        // Long times are rounded up to whole seconds.
        if let Some(Ok(left)) = left.map(|left| Duration::try_from_secs_f64(left.ceil())) {
            message += &format!(", {} left", humantime::format_duration(left));
        }
        if state.said.is_some_and(|last| last.elapsed() >= patience(state.start.elapsed())) {
            state.said = Some(Instant::now());
            super::say(&format!("{}: {message}", self.bar.prefix()));
        }
        drop(state);
        self.bar.set_position((PARTS as f64 * time / stop).min(PARTS as f64) as u64);
        self.bar.set_message(message);
        !STOP.load(Ordering::Relaxed) && !self.is_late()
    }

    fn drift(&self, energy: f64) {
        self.state().drift = Some(energy);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nothing is said at first; then the last part counts, and not what was before it.
    #[test]
    fn time_left_is_that_of_the_last_part() {
        let mut pace = Pace::from(2.0);
        assert_eq!(pace.left(1.0, 2.9, 12.0), None);
        // A second for each unit of time up to 7, then ten.
        for k in 1..=5 {
            let t = f64::from(k);
            assert_eq!(pace.left(t, 2.0 + t, 12.0), Some(10.0 - t));
        }
        pace.left(15.0, 8.0, 12.0);
        pace.left(25.0, 9.0, 12.0);
        assert_eq!(pace.left(35.0, 10.0, 12.0), Some(20.0));
        assert_eq!(pace.left(55.0, 12.0, 12.0), Some(0.0));
    }

    #[test]
    fn lines_have_the_unit_of_their_run() {
        let progress = Progress::watching(Outlook::default());
        for (unit, said) in [("us", "t = 2.0000e0 us, "), ("", "t = 2.0000e0, ")] {
            progress.start("a run", unit);
            progress.tick(2.0, 4.0, 1000);
            assert!(progress.bar.message().starts_with(said), "{}", progress.bar.message());
        }
    }

    #[test]
    fn lines_come_soon_and_then_less_often() {
        let after = |seconds| patience(Duration::from_secs(seconds)).as_secs();
        assert_eq!([0, 100, 300, 7200].map(after), [10, 10, 30, 60]);
    }
}
