//! The report as one self-contained page.

use super::ReportError;
use super::inline;
use super::model::{Align, Block, Report};
use super::outline::{self, Chapter};
use crate::plots::{THEME, themed};
use askama::Template;
use std::collections::BTreeMap;

/// The whole page.
#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    report: &'a Report,
    chapters: Vec<Chapter<'a>>,
    figures: &'a BTreeMap<String, String>,
}

impl Page<'_> {
    fn rich(&self, text: &str) -> String {
        inline::html(text)
    }

    fn plain(&self, text: &str) -> String {
        inline::plain(text)
    }

    fn display(&self, tex: &str) -> String {
        inline::display(tex)
    }

    fn picture(&self, id: &str) -> String {
        self.figures.get(id).map(|svg| themed(svg)).unwrap_or_default()
    }

    fn class(&self, align: &Align) -> &'static str {
        match align {
            Align::Left => "left",
            Align::Center => "center",
            Align::Right => "right",
        }
    }

    /// The heading level: chapters are below the title.
    fn level(&self, depth: &usize) -> usize {
        (depth + 2).min(6)
    }

    /// Declarations of the figures' colours, light or dark.
    fn colours(&self, dark: bool) -> String {
        let declare =
            |(name, l, d): &(&str, u32, u32)| format!("{name}:#{:06x};", if dark { d } else { l });
        THEME.iter().map(declare).collect()
    }
}

/// The report as one page without scripts or outside resources, in light and dark, for screen and
/// paper. `figures` are SVG texts by id.
///
/// # Errors
/// An id is unfit or used twice, a figure is missing, or a row does not fit its table.
pub fn html(report: &Report, figures: &BTreeMap<String, String>) -> Result<String, ReportError> {
    outline::check(report, figures)?;
    let chapters = outline::outline(report);
    Ok(Page { report, chapters, figures }.render()?)
}
