//! Tests of the solver in three dimensions.

mod plain;
mod reference;
mod scenes;
