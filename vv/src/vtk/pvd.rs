//! The collection: an index of the states of a run by time, kept readable after every frame.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use super::error::{CollectionError, VtkError};
use super::grid::Grid;
use super::vtu::save_vtu;
use crate::files::write_atomic;
use crate::xml::{attribute, escape, is_plain, unescape};

/// What an index begins and ends with.
const HEAD: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
    <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
const TAIL: &str = "</Collection>\n</VTKFile>\n";

/// One state in a collection.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Time of the state.
    pub time: f64,
    /// What the state shows, such as `particles`; the viewer offers each part by itself.
    pub part: String,
    /// File of the state, in the folder of the index.
    pub file: String,
}

/// A PVD collection. A run writes its frames through [`Collection::record`]; the states lie beside
/// the index and are named after it: `run.pvd`, `run-particles-000000.vtu`, ...
#[derive(Debug, Clone, PartialEq)]
pub struct Collection {
    path: PathBuf,
    stem: String,
    entries: Vec<Entry>,
}

impl Collection {
    /// An empty collection with its index at `path`. Nothing is written before the first frame.
    ///
    /// # Errors
    /// [`CollectionError::Path`] if `path` has no usable file name.
    pub fn new(path: &Path) -> Result<Self, CollectionError> {
        let stem = path.file_stem().and_then(|stem| stem.to_str()).filter(|stem| is_plain(stem));
        let Some(stem) = stem else { return Err(CollectionError::Path(path.to_owned())) };
        Ok(Self { path: path.to_owned(), stem: stem.to_owned(), entries: Vec::new() })
    }

    /// The collection at `path` with its frames before `time`, for a run that goes on from a
    /// checkpoint of that time: later frames are dropped and written anew.
    ///
    /// # Errors
    /// [`CollectionError`] if the index cannot be read or was not written by this program.
    pub fn resume(path: &Path, time: f64) -> Result<Self, CollectionError> {
        let mut collection = Self::new(path)?;
        let text = fs::read_to_string(path).map_err(|error| CollectionError::Read {
            path: path.to_owned(),
            reason: error.to_string(),
        })?;
        collection.entries = parse(path, &text)?;
        collection.entries.retain(|entry| entry.time < time);
        Ok(collection)
    }

    /// Files on the disk that are the index at `path`, or named after it as its states are.
    #[must_use]
    pub fn files(path: &Path) -> Vec<PathBuf> {
        let Ok(Self { stem, .. }) = Self::new(path) else { return Vec::new() };
        let own = |name: &str| {
            let inner = name.strip_prefix(&stem)?.strip_prefix('-')?.strip_suffix(".vtu")?;
            let (part, number) = inner.rsplit_once('-')?;
            let digits = number.len() >= 6 && number.chars().all(|c| c.is_ascii_digit());
            (digits && is_part(part)).then_some(())
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let states = entries.map(|entry| entry.path()).filter(|state| {
            let name = state.file_name().and_then(|name| name.to_str());
            name.is_some_and(|name| own(name).is_some())
        });
        states.chain(Some(path.to_owned()).filter(|path| path.exists())).collect()
    }

    /// The states, by time.
    #[must_use]
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Writes `grid` as the state of `part` at `time`, then the index with it. Parts of one time
    /// follow one another; a frame comes after all frames of earlier times.
    ///
    /// The state is on the disk before the index names it, so a run may be killed anywhere.
    ///
    /// # Errors
    /// [`VtkError`]; the index on the disk then still lists what it listed before.
    pub fn record(&mut self, time: f64, part: &str, grid: &Grid<'_>) -> Result<PathBuf, VtkError> {
        self.admit(time, part)?;
        let number = self.entries.iter().filter(|entry| entry.part == part).count();
        let file = format!("{}-{part}-{number:06}.vtu", self.stem);
        let state = self.path.with_file_name(&file);
        save_vtu(&state, grid, time)?;
        self.entries.push(Entry { time, part: part.to_owned(), file });
        if let Err(error) = write_atomic(&self.path, self.index().as_bytes()) {
            self.entries.pop();
            return Err(error.into());
        }
        Ok(state)
    }

    /// Refuses a part that cannot be named or a time out of order.
    fn admit(&self, time: f64, part: &str) -> Result<(), CollectionError> {
        if !is_part(part) {
            return Err(CollectionError::Part(part.to_owned()));
        }
        let Some(last) = self.entries.last() else { return Ok(()) };
        let latest = last.time;
        let mut same_time = self.entries.iter().rev().take_while(|entry| entry.time == latest);
        if time < latest || (time == latest && same_time.any(|entry| entry.part == part)) {
            return Err(CollectionError::Order { part: part.to_owned(), time, latest });
        }
        Ok(())
    }

    /// Text of the index. Parts are numbered in the order of their first frames.
    fn index(&self) -> String {
        let mut parts: Vec<&str> = Vec::new();
        let mut text = HEAD.to_owned();
        for Entry { time, part, file } in &self.entries {
            let number = parts.iter().position(|known| known == part).unwrap_or_else(|| {
                parts.push(part);
                parts.len() - 1
            });
            let file = escape(file);
            let line = format_args!(
                "<DataSet timestep=\"{time:?}\" part=\"{number}\" name=\"{part}\" file=\"{file}\"/>"
            );
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{line}");
        }
        text + TAIL
    }
}

/// Whether `part` can be a piece of a file name everywhere.
fn is_part(part: &str) -> bool {
    let usable = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    !part.is_empty() && part.chars().all(usable)
}

/// The entries of an index written by [`Collection::index`].
fn parse(path: &Path, text: &str) -> Result<Vec<Entry>, CollectionError> {
    let wrong = |line: usize, wanted: &'static str| CollectionError::Format {
        path: path.to_owned(),
        line,
        wanted,
    };
    let lines = text.lines().count();
    let body = text.strip_prefix(HEAD).ok_or_else(|| wrong(1, "the head of a collection"))?;
    let body = body.strip_suffix(TAIL).ok_or_else(|| wrong(lines, "the end of a collection"))?;
    let first = HEAD.lines().count() + 1;
    let entry = |(k, line)| {
        read_entry(line).ok_or_else(|| wrong(first + k, "a DataSet with timestep, name and file"))
    };
    body.lines().enumerate().map(entry).collect()
}

/// The entry that `line` stands for.
fn read_entry(line: &str) -> Option<Entry> {
    let inner = line.strip_prefix("<DataSet")?.strip_suffix("/>")?;
    let time = attribute(inner, "timestep")?.parse().ok().filter(|time: &f64| time.is_finite())?;
    let part = attribute(inner, "name").filter(|part| is_part(part))?.to_owned();
    let file = unescape(attribute(inner, "file")?);
    Some(Entry { time, part, file })
}
