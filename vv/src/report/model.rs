//! The neutral document model of a report.
//!
//! Texts may hold minimal inline markup: `` `code` ``, `*emphasis*`, `[text](address)` and
//! `$tex$`; a backslash takes the meaning from the next sign.

use super::number::sig;
use serde::Serialize;

/// A whole report.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Title of the page.
    pub title: String,
    /// One line below the title.
    pub subtitle: String,
    /// The verdict in short.
    pub summary: Summary,
    /// Chapters.
    pub sections: Vec<Section>,
}

/// The verdict in short.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// A sentence or two.
    pub text: String,
    /// How often each verdict was given.
    pub counts: Vec<(Status, usize)>,
}

/// A chapter or part of one.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Section {
    /// Anchor: letters, digits, `-` and `_`.
    pub id: String,
    /// Heading.
    pub title: String,
    /// What the contents list it under, with its neighbours of the same group; may be empty.
    pub group: String,
    /// How its required claims stand, if it has any: beside its title in the contents.
    pub tally: Option<Tally>,
    /// Content before the first subsection.
    pub blocks: Vec<Block>,
    /// Parts.
    pub subsections: Vec<Section>,
}

impl Section {
    /// A section without parts.
    pub fn new(id: impl Into<String>, title: impl Into<String>, blocks: Vec<Block>) -> Self {
        Self { id: id.into(), title: title.into(), blocks, ..Self::default() }
    }

    /// The section in a group of the contents.
    #[must_use]
    pub fn within(mut self, group: impl Into<String>) -> Self {
        self.group = group.into();
        self
    }
}

/// How the required claims of a section stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// They hold.
    pub held: usize,
    /// They do not.
    pub failed: usize,
    /// They have no record.
    pub missing: usize,
}

impl Tally {
    /// All of them.
    pub fn all(self) -> usize {
        self.held + self.failed + self.missing
    }

    /// The verdict on the whole: the worst of its parts.
    pub fn status(self) -> Status {
        match self {
            Self { failed: 1.., .. } => Status::Fail,
            Self { missing: 1.., .. } => Status::Warn,
            _ => Status::Pass,
        }
    }
}

/// A piece of content.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Block {
    /// Running text.
    Paragraph(String),
    /// A displayed formula.
    Equation {
        /// The formula in TeX.
        tex: String,
        /// Its number, without parentheses.
        number: Option<String>,
    },
    /// A table.
    Table(Table),
    /// A figure.
    Figure {
        /// Its id: the stem of its files.
        id: String,
        /// Its caption.
        caption: String,
    },
    /// A picture, which has no vector form.
    Picture {
        /// Its id: the stem of its files.
        id: String,
        /// Its caption.
        caption: String,
    },
    /// A bullet list.
    List(Vec<String>),
    /// Names with their meanings, such as the provenance of a run.
    Definitions(Vec<(String, String)>),
    /// A remark that should not be overlooked.
    Callout {
        /// Its kind.
        kind: Status,
        /// Its text.
        text: String,
    },
}

/// What a figure shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Drawing {
    /// A chart, as the text of an SVG file.
    Chart(String),
    /// A picture, as PNG files.
    Picture {
        /// For light pages and paper.
        light: Vec<u8>,
        /// For dark pages.
        dark: Vec<u8>,
    },
}

impl Drawing {
    /// Names of the two files of a picture.
    pub fn picture_files(id: &str) -> [String; 2] {
        [format!("{id}.png"), format!("{id}-dark.png")]
    }
}

impl From<&str> for Drawing {
    fn from(svg: &str) -> Self {
        Self::Chart(svg.into())
    }
}

/// Where the page has its pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pictures {
    /// In `figures/` beside it, read when they come into view.
    Beside,
    /// In itself: one file that can be sent around.
    Within,
}

/// A verdict, or the weight of a remark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Status {
    /// The claim holds.
    Pass,
    /// The claim does not hold.
    Fail,
    /// Something to look at.
    Warn,
    /// From an earlier version of the program.
    Stale,
    /// For information.
    Info,
}

impl Status {
    /// The verdict as a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Warn => "warning",
            Self::Stale => "stale",
            Self::Info => "note",
        }
    }

    /// The verdict as a sign.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Pass => "✓",
            Self::Fail => "✗",
            Self::Warn => "!",
            Self::Stale => "↻",
            Self::Info => "i",
        }
    }
}

/// A table, with as many cells in each row as there are columns.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Table {
    /// File stem and anchor: letters, digits, `-` and `_`.
    pub id: String,
    /// Caption.
    pub caption: String,
    /// Columns.
    pub columns: Vec<Column>,
    /// Rows of cells.
    pub rows: Vec<Vec<Cell>>,
}

/// The head of a column.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Column {
    /// Quantity.
    pub name: String,
    /// Unit; may be empty.
    pub unit: String,
    /// Alignment of its cells.
    pub align: Align,
}

impl Column {
    /// A left-aligned column of words.
    pub fn text(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// A right-aligned column of numbers.
    pub fn number(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into(), align: Align::Right }
    }
}

/// Alignment of a column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub enum Align {
    /// For words.
    #[default]
    Left,
    /// For verdicts.
    Center,
    /// For numbers.
    Right,
}

/// A cell of a table.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Cell {
    /// What a reader sees.
    pub text: String,
    /// The number behind the text, written unrounded to CSV files.
    pub value: Option<f64>,
    /// A verdict about the cell.
    pub status: Option<Status>,
}

impl Cell {
    /// A cell of words.
    pub fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// A number, shown to `digits` significant digits.
    pub fn number(value: f64, digits: usize) -> Self {
        Self { text: sig(value, digits), value: Some(value), status: None }
    }

    /// A number shown to so many decimals, where it has no more; a zero has no sign.
    pub fn fixed(value: f64, decimals: usize) -> Self {
        let text = format!("{value:.decimals$}");
        let value = text.parse::<f64>().ok().map(|value| value + 0.0);
        let text = value.map_or(text, |value| format!("{value:.decimals$}").replace('-', "−"));
        Self { text, value, status: None }
    }

    /// A whole number, shown in full.
    pub fn count(value: u64) -> Self {
        Self { text: value.to_string(), value: Some(value as f64), status: None }
    }

    /// A verdict by itself.
    pub fn verdict(status: Status) -> Self {
        Self { text: status.word().into(), value: None, status: Some(status) }
    }

    /// The cell with a verdict.
    #[must_use]
    pub fn status(mut self, status: Status) -> Self {
        self.status = Some(status);
        self
    }

    /// The word of the verdict, unless the text says it already.
    pub(super) fn remark(&self) -> Option<&'static str> {
        let word = self.status?.word();
        (!self.text.to_lowercase().contains(word)).then_some(word)
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Self::text(text)
    }
}
