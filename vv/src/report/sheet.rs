//! Tables as CSV.

use super::inline::plain;
use super::model::{Status, Table};

/// A table as comma-separated values: heads with units, plain texts, unrounded numbers. A column
/// in which cells carry verdicts beside their text is followed by one with the verdicts.
pub fn csv(table: &Table) -> String {
    let judged = |column: usize| {
        table.rows.iter().any(|row| row.get(column).is_some_and(|c| c.remark().is_some()))
    };
    let judged: Vec<bool> = (0..table.columns.len()).map(judged).collect();
    let with_verdict = |(i, text, verdict): (usize, String, String)| {
        let verdict = judged.get(i).is_some_and(|j| *j).then_some(verdict);
        std::iter::once(text).chain(verdict)
    };
    let head = table.columns.iter().enumerate().map(|(i, column)| {
        let (name, unit) = (plain(&column.name), plain(&column.unit));
        let head = if unit.is_empty() { name.clone() } else { format!("{name} ({unit})") };
        (i, head, format!("{name} verdict"))
    });
    let mut writer = ::csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    // Writing to memory cannot fail.
    let _ = writer.write_record(head.flat_map(with_verdict));
    for row in &table.rows {
        let cells = row.iter().enumerate().map(|(i, cell)| {
            let text = cell.value.map_or_else(|| plain(&cell.text), number);
            (i, text, cell.status.map_or("", Status::word).to_owned())
        });
        let _ = writer.write_record(cells.flat_map(with_verdict));
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    let plain = value == 0.0 || (1e-4..1e15).contains(&value.abs()) || !value.is_finite();
    if plain { value.to_string() } else { format!("{value:e}") }
}
