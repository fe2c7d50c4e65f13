//! The ledger of conserved quantities, and the checks that every step passes.

use serde::{Deserialize, Serialize};

/// Sums over the particles at one time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// Mass.
    pub mass: f64,
    /// Kinetic co-energy `T*`, Eqs. (18)-(19).
    pub kinetic: f64,
    /// Internal energy, the first term of Eq. (21).
    pub internal: f64,
    /// Momentum, Eq. (20).
    pub momentum: f64,
    /// Sum of `m |v|`, the scale of the momentum.
    pub momentum_scale: f64,
}

impl Totals {
    /// A share of the mean specific energy in the frame of the centre of mass; without bound before
    /// anything is known.
    pub(crate) fn round_off(&self, share: f64) -> f64 {
        if self.mass <= 0.0 {
            return f64::INFINITY;
        }
        let drifting = 0.5 * self.momentum * self.momentum / self.mass;
        share * (self.kinetic - drifting + self.internal) / self.mass
    }

    /// Adds the sums of another group of particles.
    pub(crate) fn add(&mut self, other: &Self) {
        self.mass += other.mass;
        self.kinetic += other.kinetic;
        self.internal += other.internal;
        self.momentum += other.momentum;
        self.momentum_scale += other.momentum_scale;
    }
}

/// What entered the scene, what it holds, and how far the balance is off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Sums at the start.
    pub initial: Totals,
    /// Sums now.
    pub now: Totals,
    /// Work of the boundaries on the particles.
    pub boundary_work: f64,
    /// Impulse of the boundaries.
    pub boundary_impulse: f64,
    /// Work done on the segments: their strain energy, integrated over the steps.
    pub strain: f64,
    /// Largest error of the energy balance so far.
    pub worst_energy: f64,
    /// Largest boundary work so far, in size.
    pub largest_work: f64,
    /// Largest error of the momentum balance so far.
    pub worst_momentum: f64,
    /// Largest sum of `m |v|` so far.
    pub largest_momentum: f64,
}

impl Ledger {
    /// A ledger that starts with these sums.
    #[must_use]
    pub fn new(initial: Totals) -> Self {
        Self { initial, now: initial, largest_momentum: initial.momentum_scale, ..Self::default() }
    }

    /// Enters the sums at the end of a step.
    pub(crate) fn enter(&mut self, now: Totals) {
        self.now = now;
        let before = self.initial.kinetic + self.initial.internal;
        let after = now.kinetic + now.internal + self.strain;
        let error = (after - before - self.boundary_work).abs();
        self.worst_energy = keep_nan(self.worst_energy, error);
        self.largest_work = self.largest_work.max(self.boundary_work.abs());
        let error = now.momentum - self.initial.momentum - self.boundary_impulse;
        self.worst_momentum = keep_nan(self.worst_momentum, error.abs());
        self.largest_momentum = self.largest_momentum.max(now.momentum_scale);
    }

    /// Largest error of the energy balance over the initial kinetic energy; over the work of the
    /// boundaries where there was none; over the internal energy where there was neither.
    #[must_use]
    pub fn energy_drift(&self) -> f64 {
        let scales = [self.initial.kinetic, self.largest_work, self.initial.internal];
        let scale = scales.into_iter().find(|&s| s > 0.0).unwrap_or(1.0);
        self.worst_energy / scale
    }

    /// Largest error of the momentum balance over the largest sum of `m |v|`: an elastic bar comes
    /// to rest for an instant in every period.
    #[must_use]
    pub fn momentum_drift(&self) -> f64 {
        if self.largest_momentum > 0.0 { self.worst_momentum / self.largest_momentum } else { 0.0 }
    }

    /// Change of the mass over the mass. Zero: particles are neither made nor deleted.
    #[must_use]
    pub fn mass_drift(&self) -> f64 {
        ((self.now.mass - self.initial.mass) / self.initial.mass).abs()
    }
}

/// The larger of two numbers, and NaN if the second is.
fn keep_nan(so_far: f64, now: f64) -> f64 {
    if now <= so_far { so_far } else { now }
}
