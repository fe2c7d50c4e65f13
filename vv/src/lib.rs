//! The harness of Whipple: cases, exact solutions, norms, claims, records and the report.

pub mod cases;
pub mod checkpoint;
pub mod claims;
pub mod cli;
pub mod convergence;
pub mod cost;
pub mod document;
pub mod exact;
pub mod files;
pub mod godunov;
pub mod norms;
pub mod overrides;
pub mod pace;
pub mod paint;
pub mod pictures;
pub mod plots;
pub mod record;
pub mod references;
pub mod report;
pub mod run;
pub mod scene;
pub mod space;
pub mod suggest;
pub mod suite;
pub mod validation;
pub mod vtk;
mod xml;
