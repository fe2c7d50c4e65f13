//! Results as plain data. No file names, no plots: those are the harness's.

use serde::{Deserialize, Serialize};

/// All fields of all particles at one time, from left to right.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Time.
    pub time: f64,
    /// Positions `c`.
    pub x: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Densities.
    pub rho: Vec<f64>,
    /// Pressures.
    pub pressure: Vec<f64>,
    /// Temperatures.
    pub theta: Vec<f64>,
    /// Internal energies per unit mass.
    pub u: Vec<f64>,
    /// Masses.
    pub m: Vec<f64>,
}

impl Snapshot {
    pub(crate) fn new(time: f64, n: usize) -> Self {
        let column = || Vec::with_capacity(n);
        Self {
            time,
            x: column(),
            v: column(),
            rho: column(),
            pressure: column(),
            theta: column(),
            u: column(),
            m: column(),
        }
    }

    /// Lengths of the particles, mass over density (the cross-section is 1).
    #[must_use]
    pub fn lengths(&self) -> Vec<f64> {
        self.m.iter().zip(&self.rho).map(|(m, rho)| m / rho).collect()
    }
}
