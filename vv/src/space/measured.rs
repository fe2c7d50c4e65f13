//! What a case has found so far in a run in three dimensions: it stands in the checkpoints, so that a
//! run that goes on from one gives the record of a run that was never stopped.

use crate::checkpoint::{CheckpointError, Reader, Writer};
use crate::words::counted;

/// Names of the sections.
const TIMES: &str = "measured.times";
const COUNTS: &str = "measured.counts";
const VALUES: &str = "measured.values";
const WORST: &str = "measured.worst";
const CPU: &str = "measured.cpu_seconds";
/// First letters of the sections of pictures, and their last ones.
const PICTURE: &str = "picture.";
const CAPTION: &str = ".caption";
const LIGHT: &str = ".light";
const DARK: &str = ".dark";

/// What a case read off a state.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// The time that the case asked for.
    pub time: f64,
    /// Numbers of its own.
    pub values: Vec<f64>,
}

/// A picture of a state, as PNG for light and for dark pages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Photo {
    /// Stem of its files.
    pub id: String,
    /// Its caption in the report.
    pub caption: String,
    /// For light pages and paper.
    pub light: Vec<u8>,
    /// For dark pages.
    pub dark: Vec<u8>,
}

/// Largest errors of the balances that were looked at.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Worst {
    /// Of the energy.
    pub energy: f64,
    /// Of the momentum.
    pub momentum: f64,
    /// Of the angular momentum.
    pub angular: f64,
}

/// What a run has given so far beside its state.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Measured {
    /// What the case read, in the order of its looks.
    pub looks: Vec<Look>,
    /// Largest errors of the balances.
    pub worst: Worst,
    /// CPU seconds of the stepping.
    pub cpu_seconds: f64,
    /// Pictures.
    pub photos: Vec<Photo>,
}

impl Measured {
    /// Forgets the looks after `time`.
    pub fn forget_after(&mut self, time: f64) {
        self.looks.retain(|look| look.time <= time);
    }

    /// Adds the sections to a checkpoint.
    pub(super) fn write(&self, writer: &mut Writer) -> Result<(), CheckpointError> {
        let times: Vec<f64> = self.looks.iter().map(|look| look.time).collect();
        let counts: Vec<u64> = self.looks.iter().map(|look| look.values.len() as u64).collect();
        let values: Vec<f64> = self.looks.iter().flat_map(|look| look.values.clone()).collect();
        writer.section(TIMES, &times)?;
        writer.section(COUNTS, &counts)?;
        writer.section(VALUES, &values)?;
        let Worst { energy, momentum, angular } = self.worst;
        writer.section(WORST, &[energy, momentum, angular])?;
        writer.section(CPU, &[self.cpu_seconds])?;
        for Photo { id, caption, light, dark } in &self.photos {
            writer.bytes(&format!("{PICTURE}{id}{CAPTION}"), caption.as_bytes())?;
            writer.bytes(&format!("{PICTURE}{id}{LIGHT}"), light)?;
            writer.bytes(&format!("{PICTURE}{id}{DARK}"), dark)?;
        }
        Ok(())
    }

    /// Reads the sections of a checkpoint.
    pub(super) fn read(reader: &mut Reader) -> Result<Self, CheckpointError> {
        let looks = count(reader, TIMES);
        let times: Vec<f64> = reader.array(TIMES, &[looks])?;
        let counts: Vec<u64> = reader.array(COUNTS, &[looks])?;
        let there = count(reader, VALUES);
        let values: Vec<f64> = reader.array(VALUES, &[there])?;
        let named = counts.iter().try_fold(0_u64, |sum, &count| sum.checked_add(count));
        if named != Some(there as u64) {
            return Err(CheckpointError::Section {
                name: COUNTS.to_owned(),
                found: "other numbers of values".to_owned(),
                wanted: counted(there, ["value in all", "values in all"]),
            });
        }
        let mut rest = values.as_slice();
        let mut next = |(&time, &count): (&f64, &u64)| {
            let (values, after) = rest.split_at(count as usize);
            rest = after;
            Look { time, values: values.to_vec() }
        };
        let looks = times.iter().zip(&counts).map(&mut next).collect();
        let worst: Vec<f64> = reader.array(WORST, &[3])?;
        let cpu: Vec<f64> = reader.array(CPU, &[1])?;
        let id = |name: &str| Some(name.strip_prefix(PICTURE)?.strip_suffix(CAPTION)?.to_owned());
        let ids: Vec<String> = reader.sections().iter().filter_map(|s| id(&s.name)).collect();
        let mut photos = Vec::new();
        for id in ids {
            let mut part = |end: &str| reader.bytes(&format!("{PICTURE}{id}{end}"));
            let caption = String::from_utf8_lossy(&part(CAPTION)?).into_owned();
            let (light, dark) = (part(LIGHT)?, part(DARK)?);
            photos.push(Photo { id, caption, light, dark });
        }
        Ok(Self {
            looks,
            worst: Worst { energy: worst[0], momentum: worst[1], angular: worst[2] },
            cpu_seconds: cpu[0],
            photos,
        })
    }
}

/// Number of values in a section; 0 if there is none.
fn count(reader: &Reader, name: &str) -> usize {
    let section = reader.sections().iter().find(|section| section.name == name);
    section.and_then(|section| usize::try_from(*section.shape.first()?).ok()).unwrap_or(0)
}
