//! The hard cases in the report: what they are, which number decides, and what happened.

use crate::hard::{
    ALL, Answer, Bound, Extent, HardRecord, HardRecords, Reading, SCHEMES, Severity, Stated, reason,
};
use crate::report::{Block, Cell, Column, Section, Status, Table, Tally};

/// Numbers of failures that a cell tells of.
const TOLD: usize = 2;

/// The section of the hard cases; nothing where none was run.
#[must_use]
pub fn section(records: &HardRecords, stated: &[Stated]) -> Option<Section> {
    records.iter().next()?;
    let mut blocks = vec![Block::Paragraph(about(records))];
    let not_run: Vec<String> = ALL
        .iter()
        .filter_map(|case| match case.answer {
            Answer::Not(reason) => Some(format!("*{}* is not run: {reason}.", case.id)),
            Answer::Run(_) => None,
        })
        .collect();
    if !not_run.is_empty() {
        blocks.push(Block::List(not_run));
    }
    blocks.push(Block::Table(summary(records, stated)));
    let subsections = stated.iter().filter_map(|case| detail(case, records)).collect();
    let tally = Some(tally(records, stated));
    Some(Section { tally, subsections, ..Section::new("hard", "Hard cases", blocks) })
}

fn about(records: &HardRecords) -> String {
    let stale = records.iter().filter(|record| record.is_stale()).count();
    let quick = records.iter().filter(|record| record.extent == Extent::Quick).count();
    let mut text = "Set-ups that try to break the solver, from `references/hard_cases.toml` (H) and of this \
                    project's own (W, `references/own_cases.toml`): each has numbers that decide. `must` cases have to hold with `default`; the other schemes stand beside it. The number \
                    shown is one that fails, or the one nearest to its bound. `whipple vv hard` runs them."
        .to_owned();
    if quick > 0 {
        text += &format!(" {quick} records are of smaller set-ups than the list states.");
    }
    if stale > 0 {
        text += &format!(" {stale} records are older than the solver.");
    }
    text
}

/// How the required cases stand with `default`.
fn tally(records: &HardRecords, stated: &[Stated]) -> Tally {
    let mut tally = Tally::default();
    for case in stated.iter().filter(|case| case.severity == Severity::Must) {
        match records.get(&case.id, SCHEMES[0]) {
            Some(record) if record.passes() => tally.held += 1,
            Some(_) => tally.failed += 1,
            None => tally.missing += 1,
        }
    }
    tally
}

/// One row a case and scheme.
fn summary(records: &HardRecords, stated: &[Stated]) -> Table {
    let columns = vec![
        Column::text("case"),
        Column::text("set-up"),
        Column::text("weight"),
        Column::text("scheme"),
        Column::number("number", ""),
        Column::text("bound"),
        Column::text("verdict"),
        Column::text("what happened"),
    ];
    let rows = records.iter().filter_map(|record| {
        let case = stated.iter().find(|case| case.id == record.id)?;
        let deciding = record.deciding();
        Some(vec![
            format!("{} {}", case.id, case.name).into(),
            plain(&case.setup).into(),
            case.severity.name().into(),
            record.scheme.label().into(),
            deciding.map_or_else(Cell::default, number),
            deciding.map_or_else(String::new, |reading| bound(reading.bound)).into(),
            verdict(record.passes()),
            plain(&happened(record)).into(),
        ])
    });
    Table {
        id: "hard".into(),
        caption: "Hard cases by scheme.".into(),
        columns,
        rows: rows.collect(),
    }
}

/// All numbers of a case.
fn detail(case: &Stated, records: &HardRecords) -> Option<Section> {
    let own: Vec<&HardRecord> = records.iter().filter(|record| record.id == case.id).collect();
    if own.is_empty() {
        return None;
    }
    let columns = vec![
        Column::text("scheme"),
        Column::text("run"),
        Column::text("what"),
        Column::number("number", ""),
        Column::text("bound"),
        Column::text("verdict"),
    ];
    let row = |record: &HardRecord, reading: &Reading| {
        let what = match &reading.said {
            Some(said) => format!("{}: {said}", reading.what),
            None => reading.what.clone(),
        };
        vec![
            record.scheme.label().into(),
            plain(&reading.part).into(),
            plain(&what).into(),
            number(reading),
            bound(reading.bound).into(),
            if reading.decides() { verdict(reading.pass) } else { Cell::text("–") },
        ]
    };
    let rows =
        own.iter().flat_map(|record| record.readings.iter().map(|reading| row(record, reading)));
    let id = format!("hard-{}", case.id);
    let table = Table {
        id: id.clone(),
        caption: format!("{}: all numbers.", case.id),
        columns,
        rows: rows.collect(),
    };
    let wanted = format!("{}. Wanted: {}.", plain(&case.setup), plain(&case.pass));
    let title = format!("{}: {}", case.id, case.name);
    Some(Section::new(id, title, vec![Block::Paragraph(wanted), Block::Table(table)]))
}

fn verdict(pass: bool) -> Cell {
    Cell::verdict(if pass { Status::Pass } else { Status::Fail })
}

fn number(reading: &Reading) -> Cell {
    match reading.value {
        Some(value) => {
            let mut cell = Cell::number(value, 3);
            if !reading.unit.is_empty() {
                cell.text += &format!(" {}", reading.unit);
            }
            cell
        }
        None => Cell::text("none"),
    }
}

fn bound(bound: Bound) -> String {
    let text = |value: f64| Cell::number(value, 3).text;
    match bound {
        Bound::AtMost(most) => format!("≤\u{a0}{}", text(most)),
        Bound::AtLeast(least) => format!("≥\u{a0}{}", text(least)),
        Bound::Shown => "shown".into(),
    }
}

/// What happened, in a line.
fn happened(record: &HardRecord) -> String {
    let failed: Vec<&Reading> = record.readings.iter().filter(|reading| !reading.pass).collect();
    let all = record.readings.iter().filter(|reading| reading.decides()).count();
    if failed.is_empty() {
        return format!("all {all} numbers hold");
    }
    let tell = |reading: &&Reading| match &reading.said {
        Some(said) => format!("{}: {said}", reading.part),
        None => format!("{}: {}", reading.part, reading.what),
    };
    let told: Vec<String> = failed.iter().take(TOLD).map(tell).collect();
    let why =
        reason(&record.id, record.scheme).map_or(String::new(), |why| format!(". Why: {why}"));
    format!("{} of {all} fail: {}{why}", failed.len(), told.join("; "))
}

/// A text without the signs that a report gives a meaning.
fn plain(text: &str) -> String {
    text.chars()
        .flat_map(|c| {
            matches!(c, '*' | '`' | '[' | ']' | '$' | '\\').then_some('\\').into_iter().chain([c])
        })
        .collect()
}
