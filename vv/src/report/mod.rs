//! Reports: a neutral document model ([`Report`]) and its renderings as an HTML page, Markdown
//! and CSV, and a folder of all of them.
//!
//! Nothing here knows the date or the machine: the same input gives the same bytes.

mod html;
mod inline;
mod markdown;
mod model;
mod number;
mod outline;
mod sheet;
mod write;

pub use html::html;
pub use markdown::markdown;
pub use model::{
    Align, Block, Cell, Column, Drawing, Pictures, Report, Section, Status, Summary, Table, Tally,
};
pub use number::sig;
pub use sheet::csv;
pub use write::{INDEX, TEXT, write};

use crate::files::Cause;
use crate::plots::PlotError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a report could not be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// An id that is no safe file name.
    #[error("`{0}` is no id: use 1 to 100 letters, digits, `-` and `_`")]
    Id(String),
    /// Two sections, figures or tables of one id.
    #[error("the id `{0}` is used twice")]
    Duplicate(String),
    /// A figure that the report shows but nobody drew.
    #[error("there is no figure `{0}`")]
    MissingFigure(String),
    /// A row with more or fewer cells than there are columns.
    #[error("table `{0}` has a row that does not fit its columns")]
    Ragged(String),
    /// The page template failed.
    #[error("the page cannot be rendered")]
    Page(#[from] askama::Error),
    /// A figure could not be rasterised.
    #[error("figure `{id}` cannot be rasterised")]
    Picture {
        /// The figure.
        id: String,
        /// The cause.
        source: PlotError,
    },
    /// The file system refused.
    #[error("cannot {action} `{path}`: {cause}", path = path.display(), cause = Cause::from(source))]
    Io {
        /// What was tried.
        action: &'static str,
        /// On which file or folder.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
}

#[cfg(test)]
mod tests;
