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

/// What is known of a run before it begins.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Outlook {
    /// Unit of simulated time.
    pub(super) unit: &'static str,
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
    start: Instant,
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
        let bar = ProgressBar::new(PARTS);
        let terminal = std::io::stderr().is_terminal();
        if !terminal {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) = ProgressStyle::with_template("{prefix} {wide_bar} {msg}") {
            bar.set_style(style);
        }
        let start = Instant::now();
        let state = State { start, drift: None, said: (!terminal).then_some(start) };
        Self { bar, outlook, state: Mutex::new(state) }
    }

    /// Starts a new run on the same line.
    pub(super) fn start(&self, what: &str) {
        self.bar.reset();
        self.bar.set_prefix(what.to_owned());
        let mut state = self.state();
        (state.start, state.drift) = (Instant::now(), None);
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

impl Monitor for Progress {
    fn tick(&self, time: f64, stop: f64, particle_steps: u64) -> bool {
        let mut state = self.state();
        let Outlook { unit, from: (first, before), .. } = self.outlook;
        let seconds = state.start.elapsed().as_secs_f64().max(1e-9);
        let rate = particle_steps.saturating_sub(before) as f64 / seconds / 1e6;
        let left = seconds * (stop - time) / (time - first);
        let space = if unit.is_empty() { "" } else { " " };
        let mut message = format!("t = {time:.4e}{space}{unit}, {rate:.1} M particle-steps/s");
        if let Some(drift) = state.drift {
            message += &format!(", energy drift {drift:.0e}");
        }
        // Long times are rounded up to whole seconds; nothing is known at the beginning.
        if let Ok(left) = Duration::try_from_secs_f64(left.ceil()) {
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

    #[test]
    fn lines_come_soon_and_then_less_often() {
        let after = |seconds| patience(Duration::from_secs(seconds)).as_secs();
        assert_eq!([0, 100, 300, 7200].map(after), [10, 10, 30, 60]);
    }
}
