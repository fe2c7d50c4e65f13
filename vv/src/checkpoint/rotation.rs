//! The checkpoints of a run: the last two are kept, so that there is always one that was written
//! long enough ago to be whole.

use std::fs;
use std::path::{Path, PathBuf};

use super::error::CheckpointError;
use super::reader::Reader;
use super::writer::Writer;

/// Checkpoints that are kept.
const KEPT: usize = 2;

/// The newest checkpoint that can be used.
#[derive(Debug)]
pub struct Latest {
    /// Its file.
    pub path: PathBuf,
    /// The checkpoint.
    pub reader: Reader,
    /// Newer ones that are damaged, and how.
    pub passed_over: Vec<(PathBuf, CheckpointError)>,
}

/// Writes `writer` as the next checkpoint of the run in `folder` and removes what is older than the
/// last two whole ones.
///
/// Files are numbered in the order of writing and not by step: a run that starts again from an
/// earlier step must not be outranked by what it replaces. A damaged file takes the place of none that
/// can be gone on from. A folder is for one run at a time.
///
/// # Errors
/// [`CheckpointError`]; earlier checkpoints are kept until the new one is on the disk. After
/// [`CheckpointError::Remove`] the new one is in place as well.
pub fn save_next(folder: &Path, writer: &Writer) -> Result<PathBuf, CheckpointError> {
    let earlier = numbered(folder)?;
    let number = earlier.last().map_or(1, |(number, _)| number + 1);
    let path = folder.join(file_name(number));
    writer.write(&path)?;
    let mut whole = 1;
    for (_, path) in earlier.into_iter().rev() {
        if whole < KEPT {
            whole += usize::from(Reader::open_any(&path).is_ok());
        } else {
            fs::remove_file(&path).map_err(|source| CheckpointError::Remove { path, source })?;
        }
    }
    Ok(path)
}

/// The checkpoints in `folder`, the oldest first. Files with other names are left alone.
///
/// # Errors
/// [`CheckpointError::Read`] if the folder cannot be read.
pub fn list(folder: &Path) -> Result<Vec<PathBuf>, CheckpointError> {
    Ok(numbered(folder)?.into_iter().map(|(_, path)| path).collect())
}

/// Opens the newest checkpoint in `folder` that is whole. One of another scene or a newer version is
/// not passed over: the folder is then not that of this run.
///
/// # Errors
/// [`CheckpointError::None`] if there is no checkpoint; that of the newest if none can be used.
pub fn open_latest(folder: &Path, scene: &str) -> Result<Latest, CheckpointError> {
    let mut passed_over = Vec::new();
    for path in list(folder)?.into_iter().rev() {
        match Reader::open(&path, scene) {
            Ok(reader) => return Ok(Latest { path, reader, passed_over }),
            Err(
                error @ (CheckpointError::Header { .. }
                | CheckpointError::Section { .. }
                | CheckpointError::Read { .. }),
            ) => passed_over.push((path, error)),
            Err(error) => return Err(error),
        }
    }
    let newest = passed_over.into_iter().next();
    Err(newest.map_or_else(|| CheckpointError::None(folder.to_owned()), |(_, error)| error))
}

/// Name of the checkpoint `number`.
fn file_name(number: u64) -> String {
    format!("checkpoint-{number:06}.whp")
}

/// The checkpoints in `folder` by their numbers.
fn numbered(folder: &Path) -> Result<Vec<(u64, PathBuf)>, CheckpointError> {
    let read = |source| CheckpointError::Read { path: folder.to_owned(), source };
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(read)? {
        let path = entry.map_err(read)?.path();
        if let Some(number) = path.file_name().and_then(|name| number_of(name.to_str()?)) {
            found.push((number, path));
        }
    }
    found.sort_unstable();
    Ok(found)
}

/// The number in a name that [`file_name`] gives. A number without a successor is none of ours.
fn number_of(name: &str) -> Option<u64> {
    let number = name.strip_prefix("checkpoint-")?.strip_suffix(".whp")?.parse().ok()?;
    (number < u64::MAX && file_name(number) == name).then_some(number)
}
