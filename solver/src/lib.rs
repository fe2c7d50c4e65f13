//! The solver of Whipple: the kernel-free hybrid particle-finite-element method of Park and
//! Fahrenthold, in one dimension.

pub mod audit;
mod boundary;
pub mod chain;
pub mod columns;
pub mod counters;
pub mod density;
pub mod elements;
pub mod eos;
pub mod error;
pub mod forces;
pub mod heat;
mod lanes;
pub mod method;
pub mod output;
pub mod physics;
pub mod scene;
pub mod simulation;
pub mod solver;
pub mod space;
pub mod sweep;
pub mod timestep;
pub mod units;
pub mod viscosity;

pub use simulation::Simulation;
pub use solver::{Solver, build};
