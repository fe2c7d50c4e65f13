//! Pictures of states beside the records: they cannot be drawn again without a run, so they are kept as
//! they are, and the record has their hashes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::cases::{Level, find};
use crate::files::{FileError, ensure_writable_dir, write_atomic};
use crate::record::{PictureRecord, Records, RunKey, RunRecord};
use crate::report::Drawing;
use crate::space::measured::Photo;

/// Folder of the pictures beside a record.
pub const PICTURES: &str = "pictures";

/// A picture that is not the one of its record.
#[derive(Debug, thiserror::Error)]
#[error(
    "{}: {found}, wanted the picture of {record} (BLAKE3 {wanted}); `{command}` makes it again",
    path.display()
)]
pub struct PictureError {
    /// The file.
    pub path: PathBuf,
    /// What is there.
    pub found: String,
    /// File name of the record.
    pub record: String,
    /// The hash in the record.
    pub wanted: String,
    /// The command that makes it again.
    pub command: String,
}

/// Writes pictures to a folder, which is made.
///
/// # Errors
/// What the file system says.
pub fn write_photos(folder: &Path, photos: &[Photo]) -> Result<(), FileError> {
    ensure_writable_dir(folder)?;
    for Photo { id, light, dark, .. } in photos {
        for (name, file) in Drawing::picture_files(id).iter().zip([light, dark]) {
            write_atomic(&folder.join(name), file)?;
        }
    }
    Ok(())
}

/// The command that makes a record of a report and its pictures again, of the lowest level that does.
fn command_for(record: &RunRecord, report: &Path) -> String {
    let RunKey { case, .. } = &record.key;
    let runs =
        |level: &Level| find(case).is_some_and(|case| case.runs(*level).contains(&record.key));
    let level = Level::ALL.into_iter().find(runs).unwrap_or(Level::Full);
    format!("whipple vv {case} --level {} --out {}", level.name(), report.display())
}

/// The pictures of all records of a folder, by their ids.
///
/// # Errors
/// The first picture that is missing or not the one of its record.
pub fn read_pictures(
    folder: &Path,
    records: &Records,
) -> Result<BTreeMap<String, Drawing>, PictureError> {
    let mut pictures = BTreeMap::new();
    for record in records.iter() {
        for PictureRecord { id, light, dark, .. } in &record.pictures {
            let [light_file, dark_file] = Drawing::picture_files(id);
            let read = |name: &str, wanted: &str| {
                let path = folder.join(PICTURES).join(name);
                let found = match std::fs::read(&path) {
                    Ok(file) if blake3::hash(&file).to_hex().as_str() == wanted => return Ok(file),
                    Ok(file) => format!("BLAKE3 is {}", blake3::hash(&file).to_hex()),
                    Err(error) => format!("cannot be read ({error})"),
                };
                let (record_file, wanted) = (record.key.file_name(), wanted.to_owned());
                let command = command_for(record, folder.parent().unwrap_or(folder));
                Err(PictureError { path, found, record: record_file, wanted, command })
            };
            let drawing = Drawing::Picture {
                light: read(&light_file, light)?,
                dark: read(&dark_file, dark)?,
            };
            pictures.insert(id.clone(), drawing);
        }
    }
    Ok(pictures)
}
