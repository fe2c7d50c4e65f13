//! What a run leaves behind: everything that the verdicts and the report are made from.
//!
//! Records are JSON, one file a run. They are written by `whipple vv` and only read afterwards: the
//! report is a pure function of them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use whipple_solver::audit::Ledger;
use whipple_solver::counters::Counters;
use whipple_solver::method::{Density, Preset};
use whipple_solver::space::ledger::Balance;

use crate::scene::AnyScene;
use crate::space::measured::Photo;

/// Version of the record format. A reader refuses any other.
pub const SCHEMA: u32 = 1;

/// Which run a record is of.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct RunKey {
    /// Name of the case.
    pub case: String,
    /// Variant of the case; empty for cases that have none.
    pub variant: String,
    /// What ran.
    pub scheme: Scheme,
    /// Number of particles, or cells.
    pub n: usize,
}

/// The numerical scheme of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// The particle solver.
    Particles {
        /// Preset.
        preset: Preset,
        /// Density scheme, the preset's own or another.
        density: Density,
    },
    /// The second-order Eulerian Godunov code.
    Godunov,
}

impl Scheme {
    /// A preset with its own density.
    #[must_use]
    pub fn preset(preset: Preset) -> Self {
        Self::Particles { preset, density: preset.method().density }
    }

    /// Name for tables: `paper`, `default`, `default + kernel`, `Godunov`.
    #[must_use]
    pub fn label(self) -> String {
        match self {
            Self::Godunov => "Godunov".into(),
            Self::Particles { preset, density } if preset.method().density == density => {
                preset.name().into()
            }
            Self::Particles { preset, density } => {
                format!("{} + {}", preset.name(), density.name())
            }
        }
    }

    fn slug(self) -> String {
        self.label().replace(" + ", "-").to_lowercase()
    }
}

impl RunKey {
    /// Key of a case without variants.
    #[must_use]
    pub fn new(case: &str, scheme: Scheme, n: usize) -> Self {
        Self { case: case.into(), variant: String::new(), scheme, n }
    }

    /// The same run of another variant.
    #[must_use]
    pub fn variant(self, variant: &str) -> Self {
        Self { variant: variant.into(), ..self }
    }

    /// File name of the record.
    #[must_use]
    pub fn file_name(&self) -> String {
        let variant =
            if self.variant.is_empty() { String::new() } else { format!("_{}", self.variant) };
        format!("{}{variant}_{}_n{}.json", self.case, self.scheme.slug(), self.n)
    }
}

/// Named columns of equal length.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Series(#[serde(deserialize_with = "nullable::columns")] pub BTreeMap<String, Vec<f64>>);

impl Series {
    /// Points of one column over another; empty if either is missing.
    #[must_use]
    pub fn points(&self, x: &str, y: &str) -> Vec<(f64, f64)> {
        match (self.0.get(x), self.0.get(y)) {
            (Some(x), Some(y)) => x.iter().copied().zip(y.iter().copied()).collect(),
            _ => Vec::new(),
        }
    }
}

/// JSON has no word for what is no number, and writes null: that is read as NaN, so that the record of
/// a run that failed can be read.
mod nullable {
    use std::collections::BTreeMap;

    use serde::de::Error;
    use serde::{Deserialize, Deserializer};
    use serde_json::Value;

    use super::SpaceRecord;

    type Maybe = Option<f64>;

    fn or_nan(value: Maybe) -> f64 {
        value.unwrap_or(f64::NAN)
    }

    pub(super) fn number<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        Maybe::deserialize(from).map(or_nan)
    }

    pub(super) fn numbers<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<BTreeMap<String, f64>, D::Error> {
        let read = BTreeMap::<String, Maybe>::deserialize(from)?;
        Ok(read.into_iter().map(|(name, value)| (name, or_nan(value))).collect())
    }

    /// A balance in which a number is none is no balance.
    pub(super) fn space<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<Option<SpaceRecord>, D::Error> {
        fn has_null(value: &Value) -> bool {
            match value {
                Value::Null => true,
                Value::Array(all) => all.iter().any(has_null),
                Value::Object(all) => all.values().any(has_null),
                _ => false,
            }
        }
        let read = Value::deserialize(from)?;
        if has_null(&read) {
            return Ok(None);
        }
        serde_json::from_value(read).map(Some).map_err(D::Error::custom)
    }

    pub(super) fn columns<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<BTreeMap<String, Vec<f64>>, D::Error> {
        let read = BTreeMap::<String, Vec<Maybe>>::deserialize(from)?;
        let column = |values: Vec<Maybe>| values.into_iter().map(or_nan).collect();
        Ok(read.into_iter().map(|(name, values)| (name, column(values))).collect())
    }
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// At its stop time.
    Completed,
    /// By a numerical failure.
    Failed {
        /// Short name of the failure.
        kind: String,
        /// Particle, time and value.
        message: String,
    },
}

/// The record of one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Version of the format.
    pub schema: u32,
    /// Which run.
    pub key: RunKey,
    /// Threads used.
    pub threads: usize,
    /// How it ended.
    pub outcome: Outcome,
    /// The frozen scene; absent for the Godunov code.
    pub scene: Option<AnyScene>,
    /// Time steps.
    pub steps: u64,
    /// Particles advanced by a full step, or cells.
    pub particle_steps: u64,
    /// CPU seconds of the stepping, all threads.
    pub cpu_seconds: f64,
    /// Largest error of the energy balance, see [`Ledger::energy_drift`].
    #[serde(deserialize_with = "nullable::number")]
    pub energy_drift: f64,
    /// Largest error of the momentum balance, see [`Ledger::momentum_drift`].
    #[serde(deserialize_with = "nullable::number")]
    pub momentum_drift: f64,
    /// Norms and other numbers that claims refer to.
    #[serde(deserialize_with = "nullable::numbers")]
    pub norms: BTreeMap<String, f64>,
    /// Work done; absent for the Godunov code.
    pub counters: Option<Counters>,
    /// Steps that each limiter has decided, by name; absent for the Godunov code.
    pub limiters: Option<BTreeMap<String, u64>>,
    /// Final balance; absent for the Godunov code.
    pub ledger: Option<Ledger>,
    /// What only runs in space have.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "nullable::space"
    )]
    pub space: Option<SpaceRecord>,
    /// Fields at the end, where a figure needs them.
    pub profile: Option<Series>,
    /// Histories, where a figure needs them.
    pub history: Option<Series>,
    /// Pictures of states, for the report.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pictures: Vec<PictureRecord>,
    /// Where the numbers come from.
    pub provenance: Provenance,
}

impl RunRecord {
    /// Reads a record.
    ///
    /// # Errors
    /// [`RecordError`] if there is no such file or it is not a record.
    pub fn read(path: &Path) -> Result<Self, RecordError> {
        let text = std::fs::read_to_string(path).map_err(unreadable(path))?;
        parse(path, &text)
    }
}

/// Pictures cannot be drawn again from a record: their files stand beside the records, and the record
/// says which they are.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PictureRecord {
    /// Stem of its files.
    pub id: String,
    /// Its caption in the report.
    pub caption: String,
    /// BLAKE3 of the file for light pages, in hexadecimal.
    pub light: String,
    /// BLAKE3 of the file for dark pages.
    pub dark: String,
}

impl PictureRecord {
    /// What a record says of a picture.
    #[must_use]
    pub fn of(photo: &Photo) -> Self {
        let hash = |file: &[u8]| blake3::hash(file).to_hex().to_string();
        Self {
            id: photo.id.clone(),
            caption: photo.caption.clone(),
            light: hash(&photo.light),
            dark: hash(&photo.dark),
        }
    }
}

/// What a run in three dimensions leaves behind besides.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpaceRecord {
    /// Particles of the scene, those at rest included.
    pub particles: usize,
    /// Elements of the scene.
    pub elements: usize,
    /// Elements that have failed.
    pub failed_elements: usize,
    /// Elements of them that are no volume any more.
    pub dead_elements: usize,
    /// Final balance of mass, momentum and energy.
    pub balance: Balance,
    /// Error of the mass of the bodies as they are meshed, over that of their shapes.
    pub geometry_mass_error: f64,
    /// Change of the mass over the run.
    pub mass_error: f64,
    /// Largest error of the angular momentum seen over the run, see [`Balance::angular_drift`].
    pub angular_momentum_drift: f64,
    /// The residual of the elements, see [`Balance::relative_residual`].
    pub ledger_residual: f64,
    /// Particles advanced by a full step, per CPU second.
    pub updates_per_cpu_second: f64,
    /// Memory of the solver over the particles.
    pub bytes_per_particle: f64,
}

/// Where and by what a record was made.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of the program.
    pub version: String,
    /// Fingerprint of the sources that the numbers depend on.
    pub fingerprint: String,
    /// Commit, with `+` when the tree had changes; `unknown` outside a checkout.
    pub commit: String,
    /// Compiler.
    pub rustc: String,
    /// Build profile and target.
    pub build: String,
    /// Processor.
    pub cpu: String,
    /// Operating system.
    pub os: String,
    /// Time of the run, UTC.
    pub date: String,
    /// Command that repeats it.
    pub command: String,
}

/// Fingerprint of the sources that this program was built from.
pub const FINGERPRINT: &str = env!("WHIPPLE_FINGERPRINT");

impl Provenance {
    /// Of this program, here and now.
    #[must_use]
    pub fn here(command: String) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").into(),
            fingerprint: FINGERPRINT.into(),
            commit: commit(),
            rustc: env!("WHIPPLE_RUSTC").into(),
            build: concat!(env!("WHIPPLE_PROFILE"), ", ", env!("WHIPPLE_TARGET")).into(),
            cpu: cpu(),
            os: std::env::consts::OS.into(),
            date: date(std::time::SystemTime::now()),
            command,
        }
    }

    /// Whether the sources have changed since.
    #[must_use]
    pub fn is_stale(&self) -> bool {
        self.fingerprint != FINGERPRINT
    }
}

/// A time as RFC 3339 has it, to the second. A clock that stands before 1970 says 1970.
fn date(now: std::time::SystemTime) -> String {
    humantime::format_rfc3339_seconds(now.max(std::time::UNIX_EPOCH)).to_string()
}

fn commit() -> String {
    let git = |args: &[&str]| {
        let out = std::process::Command::new("git").args(args).output().ok()?;
        out.status.success().then(|| String::from_utf8_lossy(&out.stdout).trim().to_owned())
    };
    match git(&["rev-parse", "--short=12", "HEAD"]) {
        Some(head) => {
            let sources = ["status", "--porcelain", "--", "solver", "vv", "Cargo.lock"];
            let dirty = git(&sources).is_some_and(|s| !s.is_empty());
            head + if dirty { "+" } else { "" }
        }
        None => "unknown".into(),
    }
}

fn cpu() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name =
        info.lines().find(|l| l.starts_with("model name")).and_then(|l| l.split(": ").nth(1));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), str::to_owned)
}

/// Why a record cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The folder or file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// Path.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is not a record.
    #[error("{} is not a record of format {SCHEMA}: {reason}", path.display())]
    Malformed {
        /// Path.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

/// All records of a folder.
#[derive(Debug, Clone, Default)]
pub struct Records(BTreeMap<RunKey, RunRecord>);

impl Records {
    /// Reads every `.json` file of a folder.
    ///
    /// # Errors
    /// The first file that cannot be read or is not a record.
    pub fn read(folder: &Path) -> Result<Self, RecordError> {
        let mut records = Self::default();
        for path in files_in(folder)? {
            records.insert(RunRecord::read(&path)?);
        }
        Ok(records)
    }

    /// Adds a record, in place of an earlier one of the same run.
    pub fn insert(&mut self, record: RunRecord) {
        self.0.insert(record.key.clone(), record);
    }

    /// The record of a run.
    #[must_use]
    pub fn get(&self, key: &RunKey) -> Option<&RunRecord> {
        self.0.get(key)
    }

    /// All records, in order of their keys.
    pub fn iter(&self) -> impl Iterator<Item = &RunRecord> {
        self.0.values()
    }

    /// Records of a case.
    pub fn of_case<'a>(&'a self, case: &'a str) -> impl Iterator<Item = &'a RunRecord> {
        self.iter().filter(move |r| r.key.case == case)
    }
}

/// The `.json` files of a folder.
///
/// # Errors
/// A folder that cannot be read.
pub fn files_in(folder: &Path) -> Result<Vec<PathBuf>, RecordError> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable(folder))? {
        let path = entry.map_err(unreadable(folder))?.path();
        if path.extension().is_some_and(|e| e == "json") {
            paths.push(path);
        }
    }
    Ok(paths)
}

/// What the system says of a path.
fn unreadable(path: &Path) -> impl FnOnce(std::io::Error) -> RecordError {
    let path = path.to_owned();
    move |source| RecordError::Unreadable { path, source }
}

fn parse(path: &Path, text: &str) -> Result<RunRecord, RecordError> {
    let malformed = |reason: String| RecordError::Malformed { path: path.to_owned(), reason };
    let mut reader = serde_json::Deserializer::from_str(text);
    let record: RunRecord = serde_path_to_error::deserialize(&mut reader).map_err(|e| {
        malformed(match e.inner() {
            // What it lacks first says nothing of where the rest went.
            cut if cut.is_eof() => format!("the file is cut at line {}", cut.line()),
            other => format!("at `{}`: {other}", e.path()),
        })
    })?;
    if record.schema != SCHEMA {
        return Err(malformed(format!("it has format {}", record.schema)));
    }
    Ok(record)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The record of a run that failed must not make those beside it unreadable.
    #[test]
    fn what_is_no_number_is_written_and_read() {
        let series = Series(BTreeMap::from([("speed".into(), vec![1.0, f64::NAN])]));
        let text = serde_json::to_string(&series).unwrap_or_default();
        let back: Series = serde_json::from_str(&text).unwrap_or_default();
        let speeds = back.0.get("speed").cloned().unwrap_or_default();
        assert!(speeds.len() == 2 && speeds[0] == 1.0 && speeds[1].is_nan(), "{text}");
    }
}
