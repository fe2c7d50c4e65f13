//! Results of any program judged against the exact profile of a case, by the norms that judge our own runs.

pub mod answer;
pub mod columns;
pub mod figure;
pub mod judge;
pub mod table;
