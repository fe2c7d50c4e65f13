//! The order of a report: numbered headings, figures and tables, and the check of its ids.

use super::ReportError;
use super::model::{Block, Drawing, Report, Section};
use std::collections::{BTreeMap, BTreeSet};

/// A section in reading order.
pub(super) struct Chapter<'a> {
    /// Number, such as `2.1`.
    pub(super) number: String,
    /// 0 for chapters, 1 for their parts, and so on.
    pub(super) depth: usize,
    /// Heading of the group that begins with it in the contents.
    pub(super) group: Option<&'a str>,
    /// The section itself.
    pub(super) section: &'a Section,
    /// Its blocks, figures and tables with their running number.
    pub(super) blocks: Vec<(usize, &'a Block)>,
}

/// All sections in reading order.
pub(super) fn outline(report: &Report) -> Vec<Chapter<'_>> {
    let mut chapters = Vec::new();
    let mut counts = (0, 0);
    walk(&report.sections, "", 0, &mut counts, &mut chapters);
    chapters
}

fn walk<'a>(
    sections: &'a [Section],
    prefix: &str,
    depth: usize,
    counts: &mut (usize, usize),
    chapters: &mut Vec<Chapter<'a>>,
) {
    for (i, section) in sections.iter().enumerate() {
        let number = format!("{prefix}{}", i + 1);
        let mut count = |block: &'a Block| {
            let counter = match block {
                Block::Figure { .. } | Block::Picture { .. } => &mut counts.0,
                Block::Table(_) => &mut counts.1,
                _ => return (0, block),
            };
            *counter += 1;
            (*counter, block)
        };
        let blocks = section.blocks.iter().map(&mut count).collect();
        let inner = format!("{number}.");
        let before = i.checked_sub(1).map_or("", |i| sections[i].group.as_str());
        let group = Some(section.group.as_str()).filter(|own| !own.is_empty() && *own != before);
        chapters.push(Chapter { number, depth, group, section, blocks });
        walk(&section.subsections, &inner, depth + 1, counts, chapters);
    }
}

/// Checks that ids are fit for file names and unique, and that every figure is there.
pub(super) fn check(
    report: &Report,
    figures: &BTreeMap<String, Drawing>,
) -> Result<(), ReportError> {
    let mut seen = BTreeSet::new();
    let mut claim = |kind: &'static str, id: &str| match valid(id) {
        true if seen.insert((kind, id.to_owned())) => Ok(()),
        true => Err(ReportError::Duplicate(id.into())),
        false => Err(ReportError::Id(id.into())),
    };
    for chapter in outline(report) {
        claim("section", &chapter.section.id)?;
        for (_, block) in &chapter.blocks {
            match block {
                Block::Table(table) => {
                    claim("table", &table.id)?;
                    if table.rows.iter().any(|row| row.len() != table.columns.len()) {
                        return Err(ReportError::Ragged(table.id.clone()));
                    }
                }
                Block::Figure { id, .. } => {
                    claim("figure", id)?;
                    if !matches!(figures.get(id), Some(Drawing::Chart(_))) {
                        return Err(ReportError::MissingFigure(id.clone()));
                    }
                }
                Block::Picture { id, .. } => {
                    claim("figure", id)?;
                    claim("figure", &format!("{id}-dark"))?;
                    if !matches!(figures.get(id), Some(Drawing::Picture { .. })) {
                        return Err(ReportError::MissingFigure(id.clone()));
                    }
                }
                _ => {}
            }
        }
    }
    figures.keys().find(|id| !valid(id)).map_or(Ok(()), |id| Err(ReportError::Id(id.clone())))
}

/// Whether an id is fit for file names and anchors on every system.
pub(super) fn valid(id: &str) -> bool {
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    (1..=100).contains(&id.len()) && id.chars().all(fits)
}
