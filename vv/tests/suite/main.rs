//! Tests of the harness through its public interface and its program, as one binary so that it
//! links once.

mod cli;
mod common;
mod convergence;
mod names;
mod report;
mod tables;
