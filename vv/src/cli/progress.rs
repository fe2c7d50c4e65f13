//! The progress line, and the interrupt.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::run::Monitor;

/// Set by the first interrupt.
static STOP: AtomicBool = AtomicBool::new(false);

/// Parts of a run that the bar is divided into.
const PARTS: u64 = 1000;

/// Watches a run for the user.
pub(super) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar on standard error, if that is a terminal; and an interrupt that ends the run after the
    /// step. A second interrupt ends the program.
    pub(super) fn new() -> Self {
        // A handler that is there already serves as well.
        let _ = ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(super::INTERRUPTED));
            }
        });
        let bar = ProgressBar::new(PARTS);
        if !std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let style = ProgressStyle::with_template("{prefix} {wide_bar} {msg}  {eta} left");
        if let Ok(style) = style {
            bar.set_style(style);
        }
        Self { bar }
    }

    /// Starts a new run on the same line.
    pub(super) fn start(&self, what: &str) {
        self.bar.reset();
        self.bar.set_prefix(what.to_owned());
    }

    /// Takes the line away.
    pub(super) fn done(&self) {
        self.bar.finish_and_clear();
    }
}

impl Monitor for Progress {
    fn tick(&self, time: f64, stop: f64, particle_steps: u64) -> bool {
        self.bar.set_position((PARTS as f64 * time / stop).min(PARTS as f64) as u64);
        let seconds = self.bar.elapsed().as_secs_f64().max(1e-9);
        let rate = particle_steps as f64 / seconds / 1e6;
        self.bar.set_message(format!("t = {time:.4e}, {rate:.1} M particle-steps/s"));
        !STOP.load(Ordering::Relaxed)
    }
}
