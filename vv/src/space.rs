//! What leaves and enters a run in three dimensions: checkpoints, frames for viewers, histories and
//! pictures, and what writes them while the run goes on.

pub mod checkpoint;
pub mod diagnosis;
pub mod frames;
pub mod history;
pub mod measured;
pub mod picture;
pub mod recorder;
