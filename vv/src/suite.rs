//! Running many cases: which, in what order, and where their records go.

use std::path::{Path, PathBuf};

use whipple_solver::method::Preset;

use crate::cases::{Case, Level};
use crate::claims::{Claim, Verdict, judge};
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

/// Whether a level has all runs that a claim of a case needs.
#[must_use]
pub fn covers(case: &dyn Case, level: Level, claim: &Claim) -> bool {
    let runs = case.runs(level);
    claim.quantity.runs().iter().all(|key| runs.contains(key))
}

/// The lowest level with all runs that a claim of a case needs, if there is one.
#[must_use]
pub fn level_of(case: &dyn Case, claim: &Claim) -> Option<Level> {
    Level::ALL.into_iter().find(|&level| covers(case, level, claim))
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

/// What the runs of a level will take, by the records of earlier ones.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Forecast {
    /// Runs of the level.
    pub runs: usize,
    /// CPU seconds that their records took.
    pub measured: f64,
    /// CPU seconds of runs without a record, by that of another size or scheme of the case.
    pub scaled: f64,
    /// Runs of which nothing is known.
    pub unknown: usize,
}

/// Forecasts the runs of a level. Without a record of its own a run is taken to cost as much as the
/// nearest in size of the case, times the ratio of the sizes to the power of its dimensions and one
/// more, for the steps.
#[must_use]
pub fn forecast(cases: &[&'static dyn Case], level: Level, records: &Records) -> Forecast {
    let mut out = Forecast::default();
    for case in cases {
        for key in case.runs(level) {
            out.runs += 1;
            let own = records.get(&key).map(|record| record.cpu_seconds);
            let known = records.of_case(case.id()).filter(|record| record.cpu_seconds > 0.0);
            let ratio = |record: &&RunRecord| key.n as f64 / record.key.n as f64;
            let nearest = known.min_by(|a, b| ratio(a).ln().abs().total_cmp(&ratio(b).ln().abs()));
            match (own, nearest) {
                (Some(seconds), _) => out.measured += seconds,
                (None, Some(record)) => {
                    let power = if record.space.is_some() { 4 } else { 2 };
                    out.scaled += record.cpu_seconds * ratio(&record).powi(power);
                }
                (None, None) => out.unknown += 1,
            }
        }
    }
    out
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

/// Verdicts on the claims of all cases that have a record; of the others nothing can be said.
#[must_use]
pub fn verdicts(records: &Records) -> Vec<Verdict> {
    let ran = crate::cases::ALL.iter().filter(|case| has_run(**case, records));
    judge(ran.flat_map(|case| case.claims()).collect(), records)
}

/// Whether a case has a record.
#[must_use]
pub fn has_run(case: &dyn Case, records: &Records) -> bool {
    records.of_case(case.id()).next().is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::blank;

    /// Known runs count with their time, others by the nearest size; the rest is owned to be unknown.
    #[test]
    fn forecasts_say_what_is_known() {
        let rod = crate::cases::find("long-rod").expect("the case");
        let runs = rod.runs(Level::Standard);
        let nothing = forecast(&[rod], Level::Standard, &Records::default());
        assert_eq!((nothing.runs, nothing.unknown), (runs.len(), runs.len()));
        let mut records = Records::default();
        let mut record = blank(runs[0].clone(), 1, String::new());
        record.cpu_seconds = 10.0;
        records.insert(record);
        let some = forecast(&[rod], Level::Standard, &records);
        let others = runs[1..].iter().map(|key| (key.n as f64 / runs[0].n as f64).powi(2));
        assert_eq!((some.runs, some.measured, some.unknown), (runs.len(), 10.0, 0));
        assert!((some.scaled - 10.0 * others.sum::<f64>()).abs() < 1e-9, "{some:?}");
    }
}
