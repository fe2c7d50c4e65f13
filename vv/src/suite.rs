//! Running many cases: which, in what order, and where their records go.

use std::path::{Path, PathBuf};

use whipple_solver::method::Preset;

use crate::cases::{Case, Level};
use crate::claims::{Verdict, judge};
use crate::files::{FileError, ensure_writable_dir, write_atomic};
use crate::pictures::{PICTURES, write_photos};
use crate::record::{RecordError, Records, RunKey, RunRecord, Scheme};
use crate::run::{Monitor, Request, RunError, SpaceOptions, run_with};
use crate::scene::AnyScene;

/// Folder of the records inside a report folder.
const RECORDS: &str = "records";

/// Why a suite stopped.
#[derive(Debug, thiserror::Error)]
pub enum SuiteError {
    /// A run gave no record.
    #[error("{key}: {source}")]
    Run {
        /// File name of its record.
        key: String,
        /// Why.
        source: RunError,
    },
    /// A record cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A record cannot be read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A record cannot be put into JSON.
    #[error("record {key} cannot be written: {reason}")]
    Json {
        /// File name of the record.
        key: String,
        /// Why.
        reason: String,
    },
}

/// Folder of the records of a report.
#[must_use]
pub fn records_folder(report: &Path) -> PathBuf {
    report.join(RECORDS)
}

/// The scene of a run, overrides apart.
#[must_use]
pub fn scene_of(case: &dyn Case, key: &RunKey) -> Option<AnyScene> {
    let Scheme::Particles { preset, density } = key.scheme else {
        return None;
    };
    let mut scene = case.scene(preset, &key.variant, key.n);
    // A variant may choose a density of its own; a scheme that differs from the preset's wins.
    if density != preset.method().density {
        scene.set_density(density);
    }
    Some(scene)
}

/// The command that repeats a run.
#[must_use]
pub fn command_of(key: &RunKey) -> String {
    let mut command = format!("whipple run {}", key.case);
    if !key.variant.is_empty() {
        command += &format!(" --variant {}", key.variant);
    }
    match key.scheme {
        Scheme::Godunov => command += " --godunov",
        Scheme::Particles { preset, density } => {
            if preset != Preset::Default {
                command += &format!(" --preset {}", preset.name());
            }
            if density != preset.method().density {
                command += &format!(" --density {}", density.name());
            }
        }
    }
    command + &format!(" --n {}", key.n)
}

/// Runs everything that a level asks of some cases, one after the other on this thread, and writes
/// the records. `said` is told of every run before it starts and after.
///
/// # Errors
/// The first run without a record, or a record that cannot be written. Records so far stay.
pub fn run_suite(
    cases: &[&'static dyn Case],
    level: Level,
    report: &Path,
    monitor: &dyn Monitor,
    mut said: impl FnMut(&RunKey, Option<&RunRecord>),
) -> Result<(), SuiteError> {
    let folder = records_folder(report);
    ensure_writable_dir(&folder)?;
    for case in cases {
        for key in case.runs(level) {
            said(&key, None);
            let file = key.file_name();
            let request = Request {
                scene: scene_of(*case, &key),
                threads: 1,
                command: command_of(&key),
                key,
            };
            let options = SpaceOptions { pictures: case.draws(&request.key), ..Default::default() };
            let result = run_with(*case, request, options, monitor);
            let done = result.map_err(|source| SuiteError::Run { key: file.clone(), source })?;
            let mut record = done.record;
            if !case.draws(&record.key) {
                record.profile = None;
                record.history = None;
            }
            said(&record.key, Some(&record));
            // A record always has its pictures beside it.
            if !done.photos.is_empty() {
                write_photos(&folder.join(PICTURES), &done.photos)?;
            }
            write_record(&folder.join(&file), &record)?;
        }
    }
    Ok(())
}

/// Writes a record.
///
/// # Errors
/// What the file system says.
pub fn write_record(path: &Path, record: &RunRecord) -> Result<(), SuiteError> {
    let json = serde_json::to_string_pretty(&compact(record))
        .map_err(|e| SuiteError::Json { key: path.display().to_string(), reason: e.to_string() })?;
    Ok(write_atomic(path, (json + "\n").as_bytes())?)
}

/// Seven digits are enough for the fields that figures draw; norms keep all of theirs.
fn compact(record: &RunRecord) -> RunRecord {
    let round = |x: f64| format!("{x:.6e}").parse().unwrap_or(x);
    let mut out = record.clone();
    for series in [&mut out.profile, &mut out.history].into_iter().flatten() {
        for column in series.0.values_mut() {
            column.iter_mut().for_each(|x| *x = round(*x));
        }
    }
    out
}

/// Verdicts on the claims of all cases.
#[must_use]
pub fn verdicts(records: &Records) -> Vec<Verdict> {
    let claims = crate::cases::ALL.iter().flat_map(|c| c.claims()).collect();
    judge(claims, records)
}
