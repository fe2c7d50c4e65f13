//! Work done, counted: what tests assert where times can only be reported.

use serde::{Deserialize, Serialize};

/// Counts since the start of a simulation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Time steps.
    pub steps: u64,
    /// Particles advanced by a full step; mirror images excluded.
    pub particle_steps: u64,
    /// Evaluations of the forces, two a step.
    pub stages: u64,
    /// Sweeps over neighbours for forces and densities: one a stage, or two with a kernel.
    pub sweeps: u64,
    /// Second, light sweeps of the compatible integrator.
    pub work_sweeps: u64,
    /// Pairs visited by force sweeps.
    pub pairs: u64,
    /// Evaluations of the kernel function.
    pub kernel_evaluations: u64,
    /// Particles, summed over the steps, whose density the lowest one of their equation of state held.
    #[serde(default)]
    pub floored: u64,
    /// Particles, summed over the steps, that the least volume of a cell held from getting denser.
    #[serde(default)]
    pub packed: u64,
    /// Contacts, summed over the steps, whose viscosity would have thrown particles back and was lessened.
    #[serde(default)]
    pub lessened: u64,
}
