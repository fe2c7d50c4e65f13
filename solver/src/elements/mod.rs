//! Elements: what carries tension, so that the particles carry compression alone.

mod segment;

pub use segment::{NoSolid, Segments, Solid, series};
