//! What can be wrong with a grid, a collection or their files.

use std::io;
use std::path::PathBuf;

use crate::files::FileError;
use crate::words::{counted, either};

/// A state that was not written.
#[derive(Debug, thiserror::Error)]
pub enum VtkError {
    /// The state itself cannot be written as VTU.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The collection does not accept the frame, or its index cannot be read.
    #[error(transparent)]
    Collection(#[from] CollectionError),
    /// The file cannot be put in its place.
    #[error(transparent)]
    File(#[from] FileError),
    /// The stream refused the bytes.
    #[error("cannot write the VTU stream: {0}")]
    Stream(#[from] io::Error),
}

/// Why a grid is refused. Nothing is written then.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridError {
    /// The time is infinite or not a number.
    #[error("time is {0:?}, wanted a finite number")]
    Time(f64),
    /// A coordinate is infinite or not a number.
    #[error("coordinate {axis} of point {point} is {value:?}, wanted a finite number")]
    Coordinate {
        /// Index of the point.
        point: usize,
        /// `x`, `y` or `z`.
        axis: char,
        /// What stands there.
        value: f64,
    },
    /// A cell names a point that does not exist.
    #[error("{kind} {cell} uses point {point}, wanted less than {points}, the number of points")]
    PointIndex {
        /// `vertex` or `hexahedron`.
        kind: &'static str,
        /// Index of the cell among its kind.
        cell: usize,
        /// The point it names.
        point: u32,
        /// How many points there are.
        points: usize,
    },
    /// A field has no name, or one that XML cannot carry.
    #[error("field name {0:?} is not usable, wanted text without control characters")]
    FieldName(String),
    /// Two fields of one kind have the same name.
    #[error("{place} field `{name}` is given twice, wanted each name once")]
    Repeated {
        /// `point` or `cell`.
        place: &'static str,
        /// The name.
        name: String,
    },
    /// A field is longer or shorter than what it describes.
    #[error(
        "{place} field `{name}` has {}, wanted {components} for each of the {entries} {place}{}",
        counted(*found, ["value", "values"]),
        either(*entries, ["", "s"])
    )]
    Length {
        /// `point` or `cell`.
        place: &'static str,
        /// Name of the field.
        name: String,
        /// Values given.
        found: usize,
        /// Components an entry.
        components: usize,
        /// Points or cells.
        entries: usize,
    },
    /// A field has no components.
    #[error("{place} field `{name}` has 0 components, wanted at least 1")]
    NoComponents {
        /// `point` or `cell`.
        place: &'static str,
        /// Name of the field.
        name: String,
    },
    /// A finite value turns infinite in single precision.
    #[error("{place} field `{name}` holds {value:?} at index {index}, too large for Float32")]
    TooLarge {
        /// `point` or `cell`.
        place: &'static str,
        /// Name of the field.
        name: String,
        /// Index of the value.
        index: usize,
        /// The value.
        value: f64,
    },
}

/// Why a collection refuses a frame or a file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CollectionError {
    /// The path of the index has no file name, or one that is not Unicode.
    #[error("{} cannot be a collection, wanted a path like `out/run.pvd`", .0.display())]
    Path(PathBuf),
    /// A part name that cannot be a piece of a file name everywhere.
    #[error("part name {0:?} is not usable, wanted letters, digits, `-` or `_`")]
    Part(String),
    /// Time runs backwards, or the part has a frame at this time already.
    #[error("part `{part}` at time {time:?} comes after time {latest:?}, wanted a later time")]
    Order {
        /// Name of the part.
        part: String,
        /// Time of the refused frame.
        time: f64,
        /// Latest time of the collection.
        latest: f64,
    },
    /// An earlier index that is to be continued cannot be read.
    #[error("cannot read {}: {reason}", path.display())]
    Read {
        /// Path of the index.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// An earlier index that is to be continued was not written by this program.
    #[error("{}:{line}: not a collection of this program, wanted {wanted}", path.display())]
    Format {
        /// Path of the index.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What should stand there.
        wanted: &'static str,
    },
}
