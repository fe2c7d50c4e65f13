//! What is wrong with a scene file: file, line, the place under a caret, and the wanted form.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::suggest::did_you_mean;

/// Why a file is no scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileError {
    file: PathBuf,
    /// Line and column from 1, the line itself, and how many characters are meant.
    place: Option<([usize; 2], String, usize)>,
    message: String,
}

impl std::error::Error for FileError {}

impl FileError {
    /// An error of a whole file.
    #[must_use]
    pub fn whole(file: &Path, message: String) -> Self {
        Self { file: file.to_owned(), place: None, message }
    }

    /// An error at these bytes of the text of a file.
    #[must_use]
    pub fn at(file: &Path, text: &str, span: Range<usize>, message: String) -> Self {
        let start = (0..=span.start.min(text.len())).rev().find(|&k| text.is_char_boundary(k));
        let start = start.unwrap_or(0);
        let begin = text[..start].rfind('\n').map_or(0, |k| k + 1);
        let line = text[begin..].lines().next().unwrap_or_default();
        let column = text[begin..start].chars().count();
        let left = line.chars().count().saturating_sub(column).max(1);
        let wide = span.end.saturating_sub(span.start).clamp(1, left);
        let number = text[..begin].matches('\n').count() + 1;
        Self {
            place: Some(([number, column + 1], line.to_owned(), wide)),
            ..Self::whole(file, message)
        }
    }

    /// What the reader of TOML says, with the nearest known key.
    #[must_use]
    pub fn toml(file: &Path, text: &str, error: &toml::de::Error) -> Self {
        let said = error.message();
        let quoted: Vec<&str> = said.split('`').skip(1).step_by(2).collect();
        let message = match quoted.split_first() {
            Some((name, known))
                if said.starts_with("unknown field") || said.starts_with("unknown variant") =>
            {
                let thing = if said.starts_with("unknown field") { "key" } else { "choice" };
                let hint = did_you_mean(name, known.iter().copied());
                format!("there is no {thing} `{name}` here{hint} (there is: {})", known.join(", "))
            }
            Some((name, _)) if said.starts_with("missing field") => {
                format!(
                    "the key `{name}` is missing: `whipple new` writes a scene with all that one needs"
                )
            }
            _ => said.to_owned(),
        };
        match error.span() {
            Some(span) => Self::at(file, text, span, message),
            None => Self::whole(file, message),
        }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = self.file.display();
        let Some(([number, column], line, wide)) = &self.place else {
            return write!(f, "{file}: {}", self.message);
        };
        let gutter = number.to_string().len();
        writeln!(f, "{file}, line {number}: {}", self.message)?;
        writeln!(f, "{:gutter$} |", "")?;
        writeln!(f, "{number} | {line}")?;
        write!(f, "{:gutter$} | {:column$}{}", "", "", "^".repeat(*wide), column = column - 1)
    }
}
