//! Why a checkpoint is refused.

use std::io;
use std::path::PathBuf;

use super::element::ElementType;
use crate::files::FileError;

/// A checkpoint that was not written or not read. Every message says where (the header or the name
/// of a section) and what was wanted there.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The header is damaged, cut off, or that of another kind of file.
    #[error("header: {found}, wanted {wanted}")]
    Header {
        /// What stands there.
        found: String,
        /// What should stand there.
        wanted: String,
    },
    /// The file was written by a later program.
    #[error("header: format version {found} is newer than this program, wanted at most {known}")]
    Newer {
        /// Version of the file.
        found: u32,
        /// Latest version that can be read.
        known: u32,
    },
    /// The file is of another scene, whose state means something else.
    #[error("header: the state is of scene {}, wanted scene {}", short(found), short(wanted))]
    Scene {
        /// Hash of the scene of the file.
        found: String,
        /// Hash of the scene to be restored.
        wanted: String,
    },
    /// A section is damaged or cut off.
    #[error("section `{name}`: {found}, wanted {wanted}")]
    Section {
        /// Name of the section.
        name: String,
        /// What stands there.
        found: String,
        /// What should stand there.
        wanted: String,
    },
    /// A section has another form than the reading program wants.
    #[error("section `{name}`: holds {found} {found_shape:?}, wanted {wanted} {wanted_shape:?}")]
    Form {
        /// Name of the section.
        name: String,
        /// Type of its values.
        found: ElementType,
        /// Its shape.
        found_shape: Vec<u64>,
        /// The type wanted.
        wanted: ElementType,
        /// The shape wanted.
        wanted_shape: Vec<u64>,
    },
    /// A section that the reading program wants is not there.
    #[error("section `{name}`: missing, wanted {wanted} {wanted_shape:?}")]
    Missing {
        /// Name of the section.
        name: String,
        /// The type wanted.
        wanted: ElementType,
        /// The shape wanted; empty if any will do.
        wanted_shape: Vec<u64>,
    },
    /// A section that the reading program does not know, so that part of the state would be lost.
    #[error("section `{name}`: unknown to this program, wanted none of this name")]
    Extra {
        /// Name of the section.
        name: String,
    },
    /// The folder holds no checkpoint.
    #[error("no checkpoint in {}, wanted a file like checkpoint-000001.whp", .0.display())]
    None(PathBuf),
    /// The file or folder cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file cannot be put in its place.
    #[error(transparent)]
    Write(#[from] FileError),
    /// The new checkpoint is safe, but one that it replaces cannot be removed.
    #[error("cannot remove the earlier checkpoint {}: {source}", path.display())]
    Remove {
        /// The earlier checkpoint.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

/// The first digits of a hash, which tell it from any other.
pub(super) fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

impl CheckpointError {
    /// Something else than `wanted` in the header.
    pub(super) fn header(found: impl Into<String>, wanted: impl Into<String>) -> Self {
        Self::Header { found: found.into(), wanted: wanted.into() }
    }

    /// Something else than `wanted` in the section `name`.
    pub(super) fn section(name: &str, found: impl Into<String>, wanted: impl Into<String>) -> Self {
        Self::Section { name: name.to_owned(), found: found.into(), wanted: wanted.into() }
    }
}
