//! Tests of the solver in three dimensions.

mod bodies;
mod conservation;
mod determinism;
mod ellipsoids;
mod failure;
mod gas;
mod lattice_density;
mod mapped;
mod memory;
mod objectivity;
mod plain;
mod planar;
mod plasticity;
mod reference;
mod refusals;
mod scenes;
mod stability;
mod surfaces;
mod viscosity;
