//! Tests of the harness through its public interface and its program, as one binary so that it
//! links once.

mod after;
mod checkpoint;
mod checkpoint_damage;
mod checkpoint_rotation;
mod cli;
mod common;
mod convergence;
mod docs;
mod faults;
mod fuzz;
mod kills;
mod long_runs;
mod mapped;
mod names;
mod own_scenes;
mod planar_impact;
mod readme;
mod report;
mod schema;
mod score;
mod solids;
mod space_output;
mod tables;
mod vtk;
mod vtk_collection;
mod vtk_reader;
