//! The history of a run in three dimensions, as CSV: energies by body and kind, momenta, the time
//! step and who voted it, failed elements, pairs.

use std::path::{Path, PathBuf};

use whipple_solver::space::ledger::Holdings;
use whipple_solver::space::votes::Voter;
use whipple_solver::space::{Scene, Simulation};

use crate::files::{FileError, write_atomic};
use crate::words::told_apart;

/// Columns that are there once, before those of the bodies.
const COLUMNS: [&str; 16] = [
    "time",
    "step",
    "dt",
    "dt_sound",
    "dt_density",
    "dt_elements",
    "dt_contacts",
    "dt_springs",
    "limiter",
    "failed_elements",
    "dead_elements",
    "pairs",
    "moving_particles",
    "energy_drift",
    "momentum_drift",
    "angular_drift",
];

/// Columns of the balance, after those of the bodies.
const BALANCE: [&str; 10] = [
    "element_work",
    "element_heat",
    "residual",
    "wall_work",
    "wall_impulse_x",
    "wall_impulse_y",
    "wall_impulse_z",
    "wall_moment_x",
    "wall_moment_y",
    "wall_moment_z",
];

/// Columns of each body and of all together.
const HOLDINGS: [&str; 11] = [
    "mass",
    "kinetic",
    "internal",
    "shear",
    "tension",
    "momentum_x",
    "momentum_y",
    "momentum_z",
    "angular_x",
    "angular_y",
    "angular_z",
];

/// Why an earlier history cannot be continued.
#[derive(Debug, thiserror::Error)]
pub enum HistoryError {
    /// It cannot be read.
    #[error("cannot read {}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// It has other columns than this scene gives.
    #[error("{}:{line}: not a history of this scene, wanted {wanted}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What should stand there.
        wanted: String,
    },
    /// It ends before the state that the run goes on from.
    #[error(
        "{} ends at time {}, before that of the checkpoint, {}: it is of another run of this scene; name \
         another folder with --out",
        path.display(),
        told_apart(*end, *time),
        told_apart(*time, *end)
    )]
    Short {
        /// The file.
        path: PathBuf,
        /// Time of its last row.
        end: f64,
        /// Time of the state.
        time: f64,
    },
}

/// Rows over time. They are kept in memory; [`History::save`] replaces the file as a whole.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    path: PathBuf,
    head: String,
    /// Lines with their times.
    rows: Vec<(f64, String)>,
}

impl History {
    /// The history of a new run, in a file at `path`. Nothing is written before [`History::save`].
    #[must_use]
    pub fn new(path: &Path, scene: &Scene) -> Self {
        Self { path: path.to_owned(), head: head(scene), rows: Vec::new() }
    }

    /// The history of a run that goes on from a checkpoint of `time`: later rows are dropped.
    ///
    /// # Errors
    /// [`HistoryError`] if the file cannot be read, is not a history of this scene, or has not come so far.
    pub fn resume(path: &Path, scene: &Scene, time: f64) -> Result<Self, HistoryError> {
        let mut history = Self::new(path, scene);
        let text = std::fs::read_to_string(path).map_err(|error| HistoryError::Read {
            path: path.to_owned(),
            reason: error.to_string(),
        })?;
        let wrong = |line: usize, wanted: &str| HistoryError::Format {
            path: path.to_owned(),
            line,
            wanted: wanted.to_owned(),
        };
        let mut lines = text.lines().enumerate();
        if lines.next().is_none_or(|(_, head)| head != history.head) {
            return Err(wrong(1, &history.head));
        }
        for (k, line) in lines {
            let at: Option<f64> = line.split(',').next().and_then(|time| time.parse().ok());
            let at = at.ok_or_else(|| wrong(k + 1, "a row that begins with its time"))?;
            if at <= time {
                history.rows.push((at, line.to_owned()));
            }
        }
        let end = history.rows.last().map_or(f64::NEG_INFINITY, |(at, _)| *at);
        if end < time {
            return Err(HistoryError::Short { path: path.to_owned(), end, time });
        }
        Ok(history)
    }

    /// The same rows, for a file at another path.
    #[must_use]
    pub fn at(self, path: &Path) -> Self {
        Self { path: path.to_owned(), ..self }
    }

    /// Adds the present state, unless there is a row of this time.
    pub fn record(&mut self, simulation: &Simulation) {
        let time = simulation.time();
        if self.rows.last().is_none_or(|(last, _)| *last < time) {
            self.rows.push((time, row(simulation)));
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The table.
    #[must_use]
    pub fn csv(&self) -> String {
        let rows = self.rows.iter().map(|(_, row)| row.as_str());
        std::iter::once(self.head.as_str()).chain(rows).flat_map(|line| [line, "\n"]).collect()
    }

    /// Writes the table to its file.
    ///
    /// # Errors
    /// [`FileError`]; the earlier file is then still there.
    pub fn save(&self) -> Result<(), FileError> {
        write_atomic(&self.path, self.csv().as_bytes())
    }
}

/// Names of the columns. What separates columns in a name of a body becomes a line.
fn head(scene: &Scene) -> String {
    let plain = |name: &str| name.replace(|c: char| c == ',' || c == '"' || c.is_control(), "_");
    let bodies = scene.bodies.iter().map(|body| plain(&body.name));
    let holders = std::iter::once("total".to_owned()).chain(bodies);
    let held = holders.flat_map(|holder| HOLDINGS.map(|kind| format!("{holder}.{kind}")));
    let once = COLUMNS.into_iter().chain(BALANCE).map(str::to_owned);
    once.chain(held).collect::<Vec<String>>().join(",")
}

fn row(simulation: &Simulation) -> String {
    let votes = simulation.votes();
    let (failed, dead) = simulation.failed();
    let holdings = simulation.holdings();
    let balance = simulation.balance();
    let mut cells = vec![
        number(simulation.time()),
        simulation.counters().steps.to_string(),
        number(simulation.last_step()),
        number(votes.of(Voter::Sound)),
        number(votes.of(Voter::Density)),
        number(votes.of(Voter::Elements)),
        number(votes.of(Voter::Contacts)),
        number(votes.of(Voter::Springs)),
        votes.last.map_or("", Voter::name).to_owned(),
        failed.to_string(),
        dead.to_string(),
        simulation.pairs().to_string(),
        simulation.moving().to_string(),
        number(balance.energy_drift()),
        number(balance.momentum_drift()),
        number(balance.angular_drift()),
        number(balance.element_work),
        number(balance.element_heat),
        number(balance.residual()),
        number(balance.wall_work),
    ];
    cells.extend(balance.wall_impulse.into_iter().chain(balance.wall_moment).map(number));
    for held in std::iter::once(&balance.now).chain(&holdings) {
        let Holdings { mass, momentum, angular, kinetic, internal, shear, tension, .. } = *held;
        let energies = [mass, kinetic, internal, shear, tension];
        cells.extend(energies.into_iter().chain(momentum).chain(angular).map(number));
    }
    cells.join(",")
}

/// The shortest text that reads back as the same number; empty for what is not finite.
fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:?}") } else { String::new() }
}
