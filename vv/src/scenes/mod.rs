//! Scenes of the user's own: files with units, the material library, and how such a scene runs.
//!
//! A file is read ([`mod@file`]), its numbers become those of the scene ([`quantity`], [`material`]) and its shapes cells
//! ([`build`]). It then is a case like the built-in ones ([`case`]): what runs, records, resumes and draws those does the
//! same for it.

pub mod build;
pub mod case;
pub mod error;
pub mod file;
pub mod forecast;
pub mod foresight;
pub mod material;
pub mod probes;
pub mod quantity;
pub mod schema;
pub mod stl;
pub mod vary;
