//! Small random impacts: property tests of the solver in three dimensions.
//!
//! A scene is a function of one seed and nothing else ([`Impact::of`]): two to four bodies of any form and material that
//! run into each other. Properties that hold of any scene are looked at while it runs ([`Threads::examine`]). A scene
//! that the solver refuses, or a numerical failure that it reports, is none of them broken.

mod body;
mod draw;
mod examine;
mod impact;
mod material;
mod record;
#[cfg(test)]
mod tests;

pub use examine::{Broken, Ending, Examined, Figures, Property, Threads};
pub use impact::Impact;
pub use record::{Failed, Outcome, RandomRecord, Tally, Worst};
