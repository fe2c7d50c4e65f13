//! What leaves and enters a run in three dimensions: checkpoints, frames for viewers, histories and
//! pictures.

pub mod checkpoint;
pub mod frames;
pub mod history;
pub mod picture;
