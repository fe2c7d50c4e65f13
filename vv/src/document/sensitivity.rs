//! The sensitivity of headline numbers in the report.

use crate::hard::sensitivity::{SensitivityRecord, Study};
use crate::report::{Block, Cell, Column, Section, Table};

/// The section; nothing where no study was run.
#[must_use]
pub fn section(studies: &[(Study, SensitivityRecord)]) -> Option<Section> {
    if studies.is_empty() {
        return None;
    }
    let mut about = "How far the numbers of impacts move, in per cent of the case as it stands, with choices that no \
                     experiment decides: the time step, where the lattice of the projectile lies on that of the plate \
                     and how it is turned, viscosity, and constants of failure over their ranges in \
                     `references/gaps.toml` or by a fifth. Spreads are the smallest and largest change. `whipple vv hard \
                     --sensitivity` runs them."
        .to_owned();
    let stale = studies.iter().filter(|(_, record)| record.is_stale()).count();
    if stale > 0 {
        about += &format!(" {stale} of the records are older than the solver.");
    }
    let blocks = vec![Block::Paragraph(about), Block::Table(spreads(studies))];
    let subsections = studies.iter().map(|(study, record)| detail(study, record)).collect();
    Some(Section { subsections, ..Section::new("sensitivity", "Sensitivity", blocks) })
}

/// The spread of every number by kind of change.
fn spreads(studies: &[(Study, SensitivityRecord)]) -> Table {
    let mut kinds: Vec<&str> = Vec::new();
    for kind in studies.iter().flat_map(|(_, record)| record.kinds()) {
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let mut columns =
        vec![Column::text("case"), Column::text("number"), Column::text("as it stands")];
    columns.extend(kinds.iter().map(|kind| Column::text(format!("{kind}, %"))));
    let row = |study: &Study, record: &SensitivityRecord, k: usize| {
        let headline = &study.headlines[k];
        let mut cells: Vec<Cell> = vec![
            format!("{}, n = {}", study.case, record.n).into(),
            headline.title.into(),
            with_unit(record.base(k), headline.unit).into(),
        ];
        cells.extend(kinds.iter().map(|kind| match record.spread(Some(kind), k) {
            Some([low, high]) => Cell::text(format!("{:+.2} to {:+.2}", 100.0 * low, 100.0 * high)),
            None => Cell::default(),
        }));
        cells
    };
    let rows = studies
        .iter()
        .flat_map(|(study, record)| (0..study.headlines.len()).map(move |k| row(study, record, k)));
    Table {
        id: "sensitivity".into(),
        caption: "Spread of headline numbers.".into(),
        columns,
        rows: rows.collect(),
    }
}

/// All changes of a case.
fn detail(study: &Study, record: &SensitivityRecord) -> Section {
    let mut columns = vec![Column::text("what"), Column::text("change")];
    for headline in study.headlines {
        columns.push(Column::number(headline.title, headline.unit));
        columns.push(Column::number("change", "%"));
    }
    let rows =
        record.rows.iter().map(|row| {
            let mut cells: Vec<Cell> =
                vec![row.kind.as_str().into(), told(&row.change, row.failed.as_deref()).into()];
            for (k, value) in row.values.iter().enumerate() {
                cells.push(value.map_or_else(Cell::default, |value| Cell::number(value, 4)));
                let moved = record.moved(row, k).filter(|_| !row.kind.is_empty());
                cells.push(moved.map_or_else(Cell::default, |moved| {
                    Cell::text(format!("{:+.2}", 100.0 * moved))
                }));
            }
            cells
        });
    let id = format!("sensitivity-{}", study.case);
    let table = Table {
        id: id.clone(),
        caption: format!("{}: all changes.", study.case),
        columns,
        rows: rows.collect(),
    };
    Section::new(id, study.case, vec![Block::Table(table)])
}

fn told(change: &str, failed: Option<&str>) -> String {
    failed.map_or_else(|| change.to_owned(), |failed| format!("{change}: {failed}"))
}

fn with_unit(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(String::new, |value| {
        format!("{} {unit}", Cell::number(value, 4).text).trim_end().to_owned()
    })
}
