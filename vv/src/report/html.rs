//! The report as one self-contained page.

use super::ReportError;
use super::inline;
use super::model::{Align, Block, Drawing, Report};
use super::outline::{self, Chapter};
use crate::plots::{THEME, themed};
use crate::xml::escape;
use askama::Template;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::collections::BTreeMap;

/// The whole page.
#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    report: &'a Report,
    chapters: Vec<Chapter<'a>>,
    figures: &'a BTreeMap<String, Drawing>,
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

    fn figure(&self, id: &str) -> String {
        match self.figures.get(id) {
            Some(Drawing::Chart(svg)) => themed(svg),
            _ => String::new(),
        }
    }

    /// The picture for light and dark pages within the page; paper gets the light one.
    fn picture(&self, id: &str, caption: &str) -> String {
        let Some(Drawing::Picture { light, dark }) = self.figures.get(id) else {
            return String::new();
        };
        let data = |file: &[u8]| format!("data:image/png;base64,{}", STANDARD.encode(file));
        let size = size(light).map(|[w, h]| format!(" width=\"{w}\" height=\"{h}\""));
        format!(
            "<picture><source media=\"screen and (prefers-color-scheme: dark)\" srcset=\"{}\">\
             <img alt=\"{}\"{} src=\"{}\"></picture>",
            data(dark),
            escape(&inline::plain(caption)),
            size.unwrap_or_default(),
            data(light),
        )
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
/// paper.
///
/// # Errors
/// An id is unfit or used twice, a figure is missing, or a row does not fit its table.
pub fn html(report: &Report, figures: &BTreeMap<String, Drawing>) -> Result<String, ReportError> {
    outline::check(report, figures)?;
    let chapters = outline::outline(report);
    Ok(Page { report, chapters, figures }.render()?)
}

/// Width and height of a PNG file in pixels.
fn size(png: &[u8]) -> Option<[u32; 2]> {
    let word = |at: usize| Some(u32::from_be_bytes(png.get(at..at + 4)?.try_into().ok()?));
    Some([word(16)?, word(20)?])
}
