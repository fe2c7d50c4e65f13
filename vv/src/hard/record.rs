//! Records of hard cases: JSON, one file a case and scheme, in a folder beside the other records.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::sheet::{Extent, Reading};
use crate::files::{FileError, write_atomic};
use crate::record::Scheme;

/// Version of the format. A reader refuses any other.
const SCHEMA: u32 = 1;

/// What a case found with a scheme.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HardRecord {
    /// Version of the format.
    pub schema: u32,
    /// The case, H01 to H30 or W01 to W10.
    pub id: String,
    /// What ran.
    pub scheme: Scheme,
    /// How large it was run.
    pub extent: Extent,
    /// Fingerprint of the sources of the solver that ran.
    pub fingerprint: String,
    /// The numbers.
    pub readings: Vec<Reading>,
}

/// A record that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum HardError {
    /// The file system refuses.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is no record of a hard case.
    #[error("{} is no record of a hard case: {why}; `whipple vv hard` makes it anew", path.display())]
    NotOne {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        why: String,
    },
}

impl HardRecord {
    /// A record of a run of this program.
    #[must_use]
    pub fn new(id: &str, scheme: Scheme, extent: Extent, readings: Vec<Reading>) -> Self {
        let fingerprint = env!("WHIPPLE_FINGERPRINT").into();
        Self { schema: SCHEMA, id: id.into(), scheme, extent, fingerprint, readings }
    }

    /// Whether all of its numbers keep to their bounds.
    #[must_use]
    pub fn passes(&self) -> bool {
        !self.readings.is_empty() && self.readings.iter().all(|reading| reading.pass)
    }

    /// Whether the solver has changed since.
    #[must_use]
    pub fn is_stale(&self) -> bool {
        self.fingerprint != env!("WHIPPLE_FINGERPRINT")
    }

    /// The number that decides: one that fails, or the one nearest to its bound.
    #[must_use]
    pub fn deciding(&self) -> Option<&Reading> {
        let near = |reading: &&Reading| {
            let nearness = reading.bound.nearness(reading.value.unwrap_or(f64::NAN));
            if reading.pass { nearness.min(1.0) } else { 1.0 + nearness }
        };
        self.readings.iter().max_by(|a, b| near(a).total_cmp(&near(b)))
    }

    /// Name of its file.
    #[must_use]
    pub fn file_name(&self) -> String {
        let scheme = self.scheme.label().replace(" + ", "-");
        format!("{}_{scheme}.json", self.id)
    }

    /// Writes it to a folder, which must exist.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn write(&self, folder: &Path) -> Result<(), FileError> {
        // Plain data: JSON can carry all of it.
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        write_atomic(&folder.join(self.file_name()), text.as_bytes())
    }
}

/// The folder of the records of hard cases in that of a report.
#[must_use]
pub fn folder(report: &Path) -> PathBuf {
    report.join("hard")
}

/// All records of a folder.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct HardRecords(Vec<HardRecord>);

impl HardRecords {
    /// Reads a folder; one that is not there holds none.
    ///
    /// # Errors
    /// The first file that cannot be read, or is no such record.
    pub fn read(folder: &Path) -> Result<Self, HardError> {
        let unreadable = |path: &Path| {
            let path = path.to_owned();
            move |source| HardError::Unreadable { path, source }
        };
        if !folder.is_dir() {
            return Ok(Self::default());
        }
        let mut all = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(unreadable(folder))? {
            let path = entry.map_err(unreadable(folder))?.path();
            if path.extension().is_none_or(|extension| extension != "json") {
                continue;
            }
            let text = std::fs::read_to_string(&path).map_err(unreadable(&path))?;
            let not_one = |why: String| HardError::NotOne { path: path.clone(), why };
            let record: HardRecord =
                serde_json::from_str(&text).map_err(|error| not_one(error.to_string()))?;
            if record.schema != SCHEMA {
                return Err(not_one(format!("its schema is {}, wanted {SCHEMA}", record.schema)));
            }
            all.push(record);
        }
        Ok(all.into())
    }

    /// In the order of cases and schemes.
    pub fn iter(&self) -> impl Iterator<Item = &HardRecord> {
        self.0.iter()
    }

    /// That of a case and scheme.
    #[must_use]
    pub fn get(&self, id: &str, scheme: Scheme) -> Option<&HardRecord> {
        self.iter().find(|record| record.id == id && record.scheme == scheme)
    }
}

impl From<Vec<HardRecord>> for HardRecords {
    fn from(mut all: Vec<HardRecord>) -> Self {
        let place = |record: &HardRecord| super::SCHEMES.iter().position(|s| *s == record.scheme);
        all.sort_by(|a, b| (&a.id, place(a)).cmp(&(&b.id, place(b))));
        Self(all)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Bound, SCHEMES};
    use super::*;

    fn reading(value: f64, bound: Bound) -> Reading {
        Reading {
            part: "at rest".into(),
            what: "error".into(),
            unit: String::new(),
            value: Some(value).filter(|value| value.is_finite()),
            bound,
            pass: bound.holds(value),
            said: None,
        }
    }

    #[test]
    fn what_fails_decides_and_else_what_is_nearest_to_its_bound() {
        let of = |readings| HardRecord::new("H01", SCHEMES[0], Extent::Stated, readings);
        let near = reading(0.9, Bound::AtMost(1.0));
        let far = reading(0.1, Bound::AtMost(1.0));
        assert_eq!(of(vec![far.clone(), near.clone()]).deciding(), Some(&near));
        let none = reading(f64::NAN, Bound::Shown);
        let failed = of(vec![near, none.clone(), far]);
        assert!(!failed.passes());
        assert_eq!(failed.deciding(), Some(&none));
        assert!(!of(Vec::new()).passes());
    }

    #[test]
    fn records_are_read_as_they_were_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let readings = vec![reading(0.5, Bound::AtMost(1.0)), reading(f64::NAN, Bound::Shown)];
        let written = SCHEMES.map(|s| HardRecord::new("H02", s, Extent::Quick, readings.clone()));
        for record in written.iter().rev() {
            record.write(folder.path()).expect("a file");
        }
        let read = HardRecords::read(folder.path()).expect("records");
        assert!(read.iter().eq(written.iter()));
        std::fs::write(folder.path().join("other.json"), "{}").expect("a file");
        let refused = HardRecords::read(folder.path()).expect_err("no record");
        assert!(refused.to_string().contains("other.json"), "{refused}");
    }
}
