//! The report as a page, with its pictures beside it or within.

use super::ReportError;
use super::inline;
use super::model::{Align, Block, Drawing, Pictures, Report};
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
    pictures: Pictures,
}

impl Page<'_> {
    fn rich(&self, text: &str) -> String {
        match self.pictures {
            Pictures::Beside => inline::html(text),
            Pictures::Within => inline::html_alone(text),
        }
    }

    fn plain(&self, text: &str) -> String {
        inline::plain(text)
    }

    fn display(&self, tex: &str) -> String {
        inline::display(tex)
    }

    fn has_tallies(&self) -> bool {
        self.chapters.iter().any(|chapter| chapter.section.tally.is_some())
    }

    fn figure(&self, id: &str) -> String {
        match self.figures.get(id) {
            Some(Drawing::Chart(svg)) => themed(svg),
            _ => String::new(),
        }
    }

    /// The picture for light and dark pages; paper gets the light one.
    fn picture(&self, id: &str, caption: &str) -> String {
        let Some(Drawing::Picture { light, dark }) = self.figures.get(id) else {
            return String::new();
        };
        let [light_name, dark_name] = Drawing::picture_files(id);
        let source = |name: &str, file: &[u8]| match self.pictures {
            Pictures::Beside => format!("figures/{name}"),
            Pictures::Within => format!("data:image/png;base64,{}", STANDARD.encode(file)),
        };
        let size = size(light).map(|[w, h]| format!(" width=\"{w}\" height=\"{h}\""));
        format!(
            "<picture><source media=\"screen and (prefers-color-scheme: dark)\" srcset=\"{}\">\
             <img loading=\"lazy\" alt=\"{}\"{} src=\"{}\"></picture>",
            source(&dark_name, dark),
            escape(&inline::plain(caption)),
            size.unwrap_or_default(),
            source(&light_name, light),
        )
    }

    fn class(&self, align: &Align) -> &'static str {
        match align {
            Align::Left => "left",
            Align::Center => "center",
            Align::Right => "right",
        }
    }

    /// Classes of a table with so many columns, which paper has smaller letters or a turned page for.
    fn width(&self, columns: usize) -> &'static str {
        match columns {
            ..=8 => "",
            9 => " nine",
            10..=12 => " dozen",
            13..=16 => " turned",
            _ => " turned many",
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

/// The report as a page in light and dark, for screen and paper. Charts are drawn in the page; it needs nothing
/// beside it but its pictures, and those only if they are not within. A few lines of script sort its tables; without
/// them all is there, in its own order.
///
/// # Errors
/// An id is unfit or used twice, a figure is missing, or a row does not fit its table.
pub fn html(
    report: &Report,
    figures: &BTreeMap<String, Drawing>,
    pictures: Pictures,
) -> Result<String, ReportError> {
    outline::check(report, figures)?;
    let chapters = outline::outline(report);
    Ok(Page { report, chapters, figures, pictures }.render()?)
}

/// Width and height of a PNG file in pixels.
fn size(png: &[u8]) -> Option<[u32; 2]> {
    let word = |at: usize| Some(u32::from_be_bytes(png.get(at..at + 4)?.try_into().ok()?));
    Some([word(16)?, word(20)?])
}
