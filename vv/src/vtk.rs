//! States for `ParaView` and `PyVista`: VTU files and the PVD collection that lists them by time.
//!
//! A state is a [`Grid`]: points, cells over them (particles as vertices, elements as hexahedra, or
//! both in one file) and named fields. [`write_vtu`] and [`save_vtu`] write one state;
//! [`Collection::record`] writes one and lists it, so that a run killed at any moment leaves a
//! collection that opens.
//!
//! The same grid gives the same bytes: nothing of the clock, the machine or the thread count is
//! written. Arrays are zlib blocks in base64, which is legal XML for every reader; raw appended data
//! is shorter but refused by builds with a strict XML parser.

mod blocks;
mod error;
mod field;
mod grid;
mod pvd;
mod vtu;

pub use error::{CollectionError, GridError, VtkError};
pub use field::{Field, Values};
pub use grid::{Cells, Grid, Vertices};
pub use pvd::{Collection, Entry};
pub use vtu::{save_vtu, write_vtu};
