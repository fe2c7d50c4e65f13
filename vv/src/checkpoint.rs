//! Checkpoints: the whole state of a run in one file that is either right or refused.
//!
//! # Format, version 1
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `89 57 48 50 0D 0A 1A 0A`: altered by any transfer that takes it for text |
//! | 4 | format version, little-endian like all numbers |
//! | 4 | length of the header |
//! | 4 | CRC-32 of the eight bytes before and of the header |
//! | header | JSON: `program`, `scene`, `step`, `time`, `sections` |
//! | sections | one after the other, without gaps, to the end of the file |
//!
//! `time` is text in the shortest form that reads back as the same double. Each entry of `sections`
//! has a `name`, an `element` (`f64`, `u8`, `u16`, `u32`, `u64`, `i16`, `i32` or `bytes`), a `shape`
//! (first index outermost), the `offset` of the section from the end of the header, its stored
//! `length` and the `blake3` of the stored bytes. A section is a zlib stream of the little-endian
//! array with its bytes regrouped: first byte 0 of every value, then byte 1 of every value, ...
//!
//! # Reading
//!
//! [`Reader::open`] checks every byte of the file before it hands out the first value, so a damaged
//! file cannot leave a half-restored state behind. The reading program names every section it
//! knows, with its shape; [`Reader::finish`] refuses what it did not ask for.

mod element;
mod error;
mod header;
mod reader;
mod rotation;
mod shuffle;
mod writer;

pub use element::{Element, ElementType};
pub use error::CheckpointError;
pub use header::{Meta, SectionInfo};
pub use reader::Reader;
pub use rotation::{Latest, list, open_latest, save_next};
pub use writer::Writer;
