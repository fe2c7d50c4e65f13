//! The record of random impacts: JSON, one file a stretch of seeds, in a folder beside the records of hard cases.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::examine::{GROWN, SLOW, SMALL_RESIDUAL};
use super::{Broken, Ending, Examined, Figures, Impact, Property};
use crate::files::{FileError, write_atomic};
use crate::record::Scheme;

/// Version of the format.
const SCHEMA: u32 = 1;

/// How a scene counts. A property that does not hold weighs more than how the run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It ran, and all properties hold.
    Ran,
    /// The solver refused it.
    Refused,
    /// The solver reported a numerical failure, and until then all properties held.
    Reported,
    /// A property does not hold.
    Failed,
}

impl Outcome {
    /// All, in the order of tables.
    pub const ALL: [Self; 4] = [Self::Ran, Self::Refused, Self::Reported, Self::Failed];

    /// Name for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ran => "ran",
            Self::Refused => "refused",
            Self::Reported => "reported numerical failure",
            Self::Failed => "FAILED property",
        }
    }
}

impl Examined {
    /// How it counts.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        match self.ending {
            _ if !self.broken.is_empty() => Outcome::Failed,
            Ending::Ran => Outcome::Ran,
            Ending::Refused { .. } => Outcome::Refused,
            Ending::Reported { .. } => Outcome::Reported,
            Ending::Panicked(_) => Outcome::Failed,
        }
    }
}

/// Counts of the scenes of a scheme.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tally {
    /// Preset and density.
    pub scheme: Scheme,
    /// Scenes by outcome, in the order of [`Outcome::ALL`].
    pub outcomes: [usize; 4],
    /// Scenes whose bodies met each other or a wall.
    pub met: usize,
    /// Scenes of whose elements some died.
    pub died: usize,
    /// Scenes whose residual of the elements was above 0.1 %.
    pub above: usize,
    /// Scenes in which the kinetic energy was more than twice all energy at the start.
    pub grown: usize,
    /// Scenes whose steps were for a while less than a hundredth of those of a quiet one.
    pub slow: usize,
}

/// A largest error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// Seed of its scene.
    pub seed: u64,
    /// The error, a ratio.
    pub value: f64,
}

/// A scene of which a property does not hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Failed {
    /// Its seed.
    pub seed: u64,
    /// What is set up.
    pub scene: String,
    /// How it ended.
    pub ending: Ending,
    /// What was seen.
    pub figures: Option<Figures>,
    /// Properties that do not hold.
    pub broken: Vec<Broken>,
}

/// What was found in a stretch of seeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RandomRecord {
    /// Version of the format.
    pub schema: u32,
    /// Fingerprint of the sources of the solver that ran.
    pub fingerprint: String,
    /// First seed.
    pub from: u64,
    /// Number of seeds.
    pub count: usize,
    /// Scenes that were run on two threads besides.
    pub twice: usize,
    /// Counts by scheme.
    pub tallies: Vec<Tally>,
    /// Largest errors of all scenes that were run.
    pub worst: BTreeMap<String, Worst>,
    /// Scenes that were refused, by the key of the value; `N` is the number of a body.
    pub refused: BTreeMap<String, usize>,
    /// Seeds of scenes with a numerical failure, with the message of the solver, by its kind.
    pub reported: BTreeMap<String, BTreeMap<u64, String>>,
    /// Seeds of scenes in which the kinetic energy was more than twice all energy at the start.
    pub grown: Vec<u64>,
    /// Scenes of which a property does not hold.
    pub failed: Vec<Failed>,
}

impl RandomRecord {
    /// An empty one that begins with this seed.
    #[must_use]
    pub fn new(from: u64) -> Self {
        let fingerprint = env!("WHIPPLE_FINGERPRINT").into();
        Self {
            schema: SCHEMA,
            fingerprint,
            from,
            count: 0,
            twice: 0,
            tallies: Vec::new(),
            worst: BTreeMap::new(),
            refused: BTreeMap::new(),
            reported: BTreeMap::new(),
            grown: Vec::new(),
            failed: Vec::new(),
        }
    }

    /// Enters what was found in the scene of the next seed.
    pub fn enter(&mut self, impact: &Impact, examined: Examined) {
        self.count += 1;
        self.twice += usize::from(examined.twice);
        let outcome = examined.outcome();
        if examined.figures.is_some_and(|figures| figures.kinetic > GROWN) {
            self.grown.push(impact.seed);
        }
        let tally = self.tally(impact.scheme);
        tally.outcomes[outcome as usize] += 1;
        if let Some(figures) = examined.figures {
            tally.met += usize::from(figures.met);
            tally.died += usize::from(figures.died > 0);
            tally.grown += usize::from(figures.kinetic > GROWN);
            tally.slow += usize::from(figures.pace.is_some_and(|pace| pace < SLOW));
            tally.above += usize::from(figures.residual > SMALL_RESIDUAL);
            for (what, value) in figures.errors() {
                let seed = impact.seed;
                let worst = self.worst.entry(what.into()).or_insert(Worst { seed, value });
                if value > worst.value {
                    *worst = Worst { seed, value };
                }
            }
        }
        match &examined.ending {
            Ending::Refused { key, .. } => {
                let any = |part: &str| part.bytes().all(|b| b.is_ascii_digit());
                let parts = key.split('.').map(|part| if any(part) { "N" } else { part });
                *self.refused.entry(parts.collect::<Vec<_>>().join(".")).or_default() += 1;
            }
            Ending::Reported { kind, said } => {
                let seeds = self.reported.entry(kind.clone()).or_default();
                seeds.insert(impact.seed, said.clone());
            }
            Ending::Ran | Ending::Panicked(_) => {}
        }
        if outcome == Outcome::Failed {
            let Examined { ending, figures, broken, .. } = examined;
            let (seed, scene) = (impact.seed, impact.to_string());
            self.failed.push(Failed { seed, scene, ending, figures, broken });
        }
    }

    /// The counts of a scheme.
    fn tally(&mut self, scheme: Scheme) -> &mut Tally {
        let at = self.tallies.iter().position(|tally| tally.scheme == scheme);
        let at = at.unwrap_or_else(|| {
            let tally =
                Tally { scheme, outcomes: [0; 4], met: 0, died: 0, above: 0, grown: 0, slow: 0 };
            self.tallies.push(tally);
            self.tallies.sort_by_key(|tally| tally.scheme.label());
            self.tallies.iter().position(|tally| tally.scheme == scheme).unwrap_or(0)
        });
        &mut self.tallies[at]
    }

    /// Seeds of which a property does not hold, by property.
    #[must_use]
    pub fn broken(&self) -> BTreeMap<Property, Vec<u64>> {
        let mut all: BTreeMap<Property, Vec<u64>> = BTreeMap::new();
        for failed in &self.failed {
            for broken in &failed.broken {
                all.entry(broken.property).or_default().push(failed.seed);
            }
        }
        all
    }

    /// Name of its file.
    #[must_use]
    pub fn file_name(&self) -> String {
        format!("from_{}_{}.json", self.from, self.count)
    }

    /// The folder of these records in that of hard cases.
    #[must_use]
    pub fn folder(hard: &Path) -> PathBuf {
        hard.join("random")
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
