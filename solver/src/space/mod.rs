//! The three-dimensional solver: particles at the nodes and centroids of hexahedra.

pub mod cells;
pub mod columns;
pub mod contacts;
pub mod dispatch;
pub mod element;
pub mod eos;
pub mod hourglass;
pub mod kernel;
pub mod lanes;
pub mod lattice;
pub mod ledger;
pub mod mapping;
pub mod mesh;
pub mod method;
pub mod near;
pub mod output;
mod outset;
pub mod pass;
pub mod phase;
pub mod restart;
pub mod scene;
pub mod shape;
pub mod simulation;
pub mod spin;
pub mod strength;
mod surfaces;
pub mod sweep;
pub mod symmetric;
pub mod volumes;
pub mod votes;
pub mod walls;
#[cfg(target_arch = "x86_64")]
mod wide;

pub use scene::Scene;
pub use simulation::Simulation;
