//! The time step, by vote: every limiter gives the step it would take and its name.

use serde::{Deserialize, Serialize};

/// Share of the stop time below which a time step counts as collapsed: nobody waits for the end of a run
/// of a billion steps.
pub(crate) const SMALLEST_STEP: f64 = 1e-9;

/// What can limit a time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limiter {
    /// A sound wave may not cross a spacing.
    Sound,
    /// Two particles may not meet.
    Closing,
    /// Viscosity and conduction may not overshoot.
    Diffusion,
    /// The load on an end may not push its particle over a spacing.
    Load,
    /// The run lands on its time.
    Landing,
}

impl Limiter {
    /// All limiters.
    pub const ALL: [Self; 5] =
        [Self::Sound, Self::Closing, Self::Diffusion, Self::Load, Self::Landing];

    /// Name for messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sound => "sound",
            Self::Closing => "closing speed",
            Self::Diffusion => "viscosity and conduction",
            Self::Load => "load on an end",
            Self::Landing => "landing on the time asked for",
        }
    }
}

/// A vote on the time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vote {
    /// The step that the limiter would take.
    pub dt: f64,
    /// The limiter.
    pub limiter: Limiter,
    /// Index of the particle that decides, images included.
    pub particle: usize,
}

impl Vote {
    /// An abstention.
    #[must_use]
    pub fn none(limiter: Limiter) -> Self {
        Self { dt: f64::INFINITY, limiter, particle: 0 }
    }

    /// Lowers the vote to `dt`.
    #[inline(always)]
    pub fn consider(&mut self, dt: f64, particle: usize) {
        if dt < self.dt {
            self.dt = dt;
            self.particle = particle;
        }
    }

    /// The smaller of two votes; the first when they are equal.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        if other.dt < self.dt { other } else { self }
    }

    /// Two limits that act at once: half their harmonic mean, in the name of the smaller.
    #[must_use]
    pub fn together(self, other: Self) -> Self {
        let dt = 1.0 / (1.0 / self.dt + 1.0 / other.dt);
        Self { dt, ..self.min(other) }
    }

    /// The vote times a safety factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { dt: factor * self.dt, ..self }
    }
}

/// Steps decided by each limiter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Decided {
    /// By [`Limiter::Sound`].
    pub sound: u64,
    /// By [`Limiter::Closing`].
    pub closing: u64,
    /// By [`Limiter::Diffusion`].
    pub diffusion: u64,
    /// By [`Limiter::Load`].
    pub load: u64,
    /// By [`Limiter::Landing`].
    pub landing: u64,
}

impl Decided {
    /// With short names.
    #[must_use]
    pub fn named(self) -> [(&'static str, u64); 5] {
        let Self { sound, closing, diffusion, load, landing } = self;
        [
            ("sound", sound),
            ("closing", closing),
            ("diffusion", diffusion),
            ("load", load),
            ("landing", landing),
        ]
    }

    pub(crate) fn count(&mut self, limiter: Limiter) {
        *match limiter {
            Limiter::Sound => &mut self.sound,
            Limiter::Closing => &mut self.closing,
            Limiter::Diffusion => &mut self.diffusion,
            Limiter::Load => &mut self.load,
            Limiter::Landing => &mut self.landing,
        } += 1;
    }
}
