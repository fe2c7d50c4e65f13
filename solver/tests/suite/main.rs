//! Tests of the solver through its public interface, as one program so that it links once.

// A few tests print the number that they judge.
#![allow(clippy::print_stdout)]

mod boundaries;
mod common;
mod counters;
mod density;
mod determinism;
mod equations;
mod failures;
mod laws;
mod properties;
mod refusals;
mod restart;
mod space;
