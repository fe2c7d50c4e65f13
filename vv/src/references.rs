//! Reference data: CSV files with their source written on top.
//!
//! `#` lines before the header are the source of the numbers and stay with the table. Columns may
//! hold numbers or names; a column is read as numbers when it is asked for. Nothing is guessed: a
//! cell that is not what was asked for is an error with file, line and column.

use crate::suggest::did_you_mean;
use crate::words::counted;
use std::path::Path;

/// What a cell of numbers must look like.
const NUMBER: &str = "a finite number such as 1.25 or 3e-4";
/// How many names an error lists.
const NAMES_SHOWN: usize = 12;

/// Why a reference file cannot be used; lines count from 1.
#[derive(Debug, thiserror::Error)]
pub enum ReferenceError {
    /// The file cannot be read, or is not UTF-8 text.
    #[error("cannot read {file}: {source}")]
    Unreadable {
        /// Path of the file.
        file: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// Nothing is left after the `#` lines, or no row follows the header.
    #[error("{file}: no {missing}; wanted: `#` source lines, a line of column names, rows")]
    Empty {
        /// Name of the file.
        file: String,
        /// What is missing.
        missing: &'static str,
    },
    /// A row has more or fewer cells than the header.
    #[error(
        "{file}, line {line}: {}, wanted {wanted}, one for each column name",
        counted(*found, ["cell", "cells"])
    )]
    Ragged {
        /// Name of the file.
        file: String,
        /// Line of the row.
        line: u64,
        /// Cells in the row.
        found: usize,
        /// Column names.
        wanted: usize,
    },
    /// A cell or column name is not of the wanted form.
    #[error("{file}, line {line}, column `{column}`: found {found:?}, wanted {wanted}")]
    BadCell {
        /// Name of the file.
        file: String,
        /// Line of the cell.
        line: u64,
        /// Name of the column; its number for a bad column name.
        column: String,
        /// The text found, shortened.
        found: String,
        /// The form wanted.
        wanted: &'static str,
    },
    /// A column or row was asked for by a name the file does not have.
    #[error("{file}: no {what}{hint} (there are: {known})")]
    Missing {
        /// Name of the file.
        file: String,
        /// The column or row asked for.
        what: String,
        /// The nearest name as [`did_you_mean`] puts it, or nothing.
        hint: String,
        /// The names there are, at most twelve.
        known: String,
    },
    /// The text breaks the rules of CSV.
    #[error("{file}: {source}")]
    Syntax {
        /// Name of the file.
        file: String,
        /// What the CSV reader says.
        source: csv::Error,
    },
}

/// A reference file: source lines, column names, rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    file: String,
    provenance: Vec<String>,
    names: Vec<String>,
    rows: Vec<Row>,
}

/// One row with the line it stands on.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Row {
    line: u64,
    cells: Vec<String>,
}

impl Table {
    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`ReferenceError::Unreadable`], and as [`Table::parse`].
    pub fn read(path: &Path) -> Result<Self, ReferenceError> {
        let file = path.display().to_string();
        match std::fs::read_to_string(path) {
            Ok(text) => Self::parse(&file, &text),
            Err(source) => Err(ReferenceError::Unreadable { file, source }),
        }
    }

    /// Reads `text` (say from `include_str!`); `file` is its name in errors. Cells are trimmed.
    ///
    /// # Errors
    /// [`ReferenceError`] for a file without header or rows, an empty, numeric or repeated column
    /// name, a row with too many or few cells, a cell that reads as NaN or infinity, or a cell over
    /// several lines (a quote left open).
    pub fn parse(file: &str, text: &str) -> Result<Self, ReferenceError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let top = |line: &&str| line.starts_with('#') || line.trim().is_empty();
        let head: Vec<&str> = text.split_inclusive('\n').take_while(top).collect();
        let body = &text[head.iter().map(|line| line.len()).sum()..];
        let provenance = head.iter().filter_map(|line| line.strip_prefix('#'));

        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(body.as_bytes());
        let mut lines = Vec::new();
        for record in reader.records() {
            let record =
                record.map_err(|source| ReferenceError::Syntax { file: file.into(), source })?;
            let line = head.len() as u64 + record.position().map_or(0, |at| line_of(body, at));
            lines.push(Row { line, cells: record.iter().map(str::to_owned).collect() });
        }
        let mut lines = lines.into_iter();
        let empty = |missing| ReferenceError::Empty { file: file.into(), missing };
        let header = lines.next().ok_or_else(|| empty("column names"))?;
        let table = Self {
            file: file.into(),
            provenance: provenance.map(|line| line.trim().to_owned()).collect(),
            names: header.cells,
            rows: lines.collect(),
        };
        table.check_names(header.line)?;
        table.rows.iter().try_for_each(|row| table.check_row(row))?;
        if table.rows.is_empty() { Err(empty("rows")) } else { Ok(table) }
    }

    /// Name of the file, as given.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The source lines above the header, without `#`.
    #[must_use]
    pub fn provenance(&self) -> &[String] {
        &self.provenance
    }

    /// The column names, in the order of the file.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of rows, at least one.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// The numbers of a column, one for each row.
    ///
    /// # Errors
    /// [`ReferenceError::Missing`] for an unknown name (with the nearest one) and
    /// [`ReferenceError::BadCell`] for a cell that is not a number.
    pub fn column(&self, name: &str) -> Result<Vec<f64>, ReferenceError> {
        let index = self.index(name)?;
        self.rows.iter().map(|row| self.number(row, index)).collect()
    }

    /// As [`Table::column`], with `None` for an empty cell: a value the source does not give.
    ///
    /// # Errors
    /// As [`Table::column`].
    pub fn optional_column(&self, name: &str) -> Result<Vec<Option<f64>>, ReferenceError> {
        let index = self.index(name)?;
        let value = |row: &Row| match row.cells[index].as_str() {
            "" => Ok(None),
            _ => self.number(row, index).map(Some),
        };
        self.rows.iter().map(value).collect()
    }

    /// The cells of a column as text, one for each row.
    ///
    /// # Errors
    /// [`ReferenceError::Missing`] for an unknown name, with the nearest one.
    pub fn text(&self, name: &str) -> Result<Vec<&str>, ReferenceError> {
        let index = self.index(name)?;
        Ok(self.rows.iter().map(|row| row.cells[index].as_str()).collect())
    }

    /// The table of those rows whose cell in `column` is exactly `value`; at least one.
    ///
    /// # Errors
    /// [`ReferenceError::Missing`] if there is no such column or row, with the nearest name.
    pub fn rows_where(&self, column: &str, value: &str) -> Result<Self, ReferenceError> {
        let index = self.index(column)?;
        let mut chosen = self.clone();
        chosen.rows.retain(|row| row.cells[index] == value);
        if chosen.rows.is_empty() {
            return Err(self.missing(&format!("row with {column}"), value, self.text(column)?));
        }
        Ok(chosen)
    }

    /// Position of the column `name`.
    fn index(&self, name: &str) -> Result<usize, ReferenceError> {
        let found = self.names.iter().position(|known| known == name);
        let names = || self.names.iter().map(String::as_str).collect();
        found.ok_or_else(|| self.missing("column", name, names()))
    }

    /// The cell of `row` in column `index` as a finite number.
    fn number(&self, row: &Row, index: usize) -> Result<f64, ReferenceError> {
        let cell = &row.cells[index];
        let value = cell.parse().ok().filter(|value: &f64| value.is_finite());
        value.ok_or_else(|| self.bad_cell(row.line, &self.names[index], cell, NUMBER))
    }

    /// Column names: not empty, not numbers, no two alike.
    fn check_names(&self, line: u64) -> Result<(), ReferenceError> {
        for (index, name) in self.names.iter().enumerate() {
            let wanted = if name.is_empty() || name.parse::<f64>().is_ok() || name.contains('\n') {
                "a column name"
            } else if self.names[..index].contains(name) {
                "a column name not used before"
            } else {
                continue;
            };
            return Err(self.bad_cell(line, &(index + 1).to_string(), name, wanted));
        }
        Ok(())
    }

    /// As many cells as names, each on one line and none NaN or infinite.
    fn check_row(&self, row: &Row) -> Result<(), ReferenceError> {
        let (found, wanted) = (row.cells.len(), self.names.len());
        for (cell, name) in row.cells.iter().zip(&self.names) {
            if cell.contains(['\n', '\r']) {
                let wanted = "text on one line (is a quote left open?)";
                return Err(self.bad_cell(row.line, name, cell, wanted));
            }
            if cell.parse().is_ok_and(|value: f64| !value.is_finite()) {
                return Err(self.bad_cell(row.line, name, cell, NUMBER));
            }
        }
        let ragged =
            ReferenceError::Ragged { file: self.file.clone(), line: row.line, found, wanted };
        if found == wanted { Ok(()) } else { Err(ragged) }
    }

    /// The error for a `name` that is not among `known`, which are `kind`s.
    fn missing(&self, kind: &str, name: &str, mut known: Vec<&str>) -> ReferenceError {
        known.dedup();
        let hint = did_you_mean(name, known.iter().copied());
        let others = if known.len() > NAMES_SHOWN { ", ..." } else { "" };
        known.truncate(NAMES_SHOWN);
        ReferenceError::Missing {
            file: self.file.clone(),
            what: format!("{kind} `{name}`"),
            hint,
            known: known.join(", ") + others,
        }
    }

    /// The error for a `cell` that is not of the `wanted` form.
    fn bad_cell(
        &self,
        line: u64,
        column: &str,
        cell: &str,
        wanted: &'static str,
    ) -> ReferenceError {
        let (file, column) = (self.file.clone(), column.to_owned());
        let found = cell.chars().take(40).collect();
        ReferenceError::BadCell { file, line, column, found, wanted }
    }
}

/// Line in `body` of the record that the CSV reader says begins `at`: the reader means the place
/// before it skips blank lines (and the second half of a CRLF).
fn line_of(body: &str, at: &csv::Position) -> u64 {
    let rest = body.as_bytes().iter().skip(at.byte() as usize);
    let skipped = rest.take_while(|byte| matches!(byte, b'\n' | b'\r'));
    at.line() + skipped.filter(|&&byte| byte == b'\n').count() as u64
}

#[cfg(test)]
mod tests {
    use super::{ReferenceError, Table};
    use proptest::prelude::{ProptestConfig, prop, prop_assert, prop_assert_eq, proptest};
    use std::path::Path;

    const GOOD: &str = "# Park & Fahrenthold, Table 5\n# printed\n\ncase,length,speed\n\
        coarse,6.08,1.42\nfine, 6.59 ,\n";

    fn text(result: Result<impl std::fmt::Debug, ReferenceError>) -> String {
        result.unwrap_err().to_string()
    }

    fn parsed(content: &str) -> String {
        text(Table::parse("t.csv", content))
    }

    #[test]
    fn columns_by_name() {
        let table = Table::parse("t.csv", GOOD).unwrap();
        assert_eq!(table.provenance(), ["Park & Fahrenthold, Table 5", "printed"]);
        assert_eq!((table.file(), table.row_count()), ("t.csv", 2));
        assert_eq!(table.names(), ["case", "length", "speed"]);
        assert_eq!(table.column("length").unwrap(), [6.08, 6.59]);
        assert_eq!(table.optional_column("speed").unwrap(), [Some(1.42), None]);
        assert_eq!(table.text("case").unwrap(), ["coarse", "fine"]);
        let fine = table.rows_where("case", "fine").unwrap();
        assert_eq!(fine.column("length").unwrap(), [6.59]);
        assert_eq!(fine.provenance(), table.provenance());
    }

    #[test]
    fn line_ends_and_byte_order_mark_change_nothing() {
        let table = Table::parse("t.csv", GOOD).unwrap();
        for other in [format!("\u{feff}{GOOD}"), GOOD.trim_end().into()] {
            assert_eq!(Table::parse("t.csv", &other).unwrap(), table);
        }
        assert_eq!(Table::parse("t.csv", &GOOD.replace('\n', "\r\n")).unwrap(), table);
    }

    #[test]
    fn errors_name_file_line_column_found_and_wanted() {
        let table = Table::parse("t.csv", GOOD).unwrap();
        assert_eq!(
            text(table.column("lenght")),
            "t.csv: no column `lenght`; did you mean `length`? (there are: case, length, speed)"
        );
        assert_eq!(
            text(table.rows_where("case", "fin")),
            "t.csv: no row with case `fin`; did you mean `fine`? (there are: coarse, fine)"
        );
        assert_eq!(
            text(table.column("speed")),
            "t.csv, line 6, column `speed`: found \"\", wanted a finite number such as 1.25 or 3e-4"
        );
        assert_eq!(
            text(table.column("case")),
            "t.csv, line 5, column `case`: found \"coarse\", wanted a finite number such as 1.25 or 3e-4"
        );
        assert_eq!(
            text(Table::read(Path::new("no/such.csv"))).find("cannot read no/such.csv"),
            Some(0)
        );
    }

    #[test]
    fn long_lists_of_names_are_cut() {
        let rows: String = (0..20).map(|i| format!("{i}\n")).collect();
        let table = Table::parse("t.csv", &format!("x\n{rows}")).unwrap();
        assert_eq!(
            text(table.rows_where("x", "abcd")),
            "t.csv: no row with x `abcd` (there are: 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, ...)"
        );
    }

    #[test]
    fn bad_files_are_refused() {
        let empty = "wanted: `#` source lines, a line of column names, rows";
        assert_eq!(parsed(""), format!("t.csv: no column names; {empty}"));
        assert_eq!(parsed("# source\n\n"), format!("t.csv: no column names; {empty}"));
        assert_eq!(parsed("# source\na,b\n"), format!("t.csv: no rows; {empty}"));
        let ragged = "wanted 2, one for each column name";
        assert_eq!(parsed("# s\na,b\n1,2\n\n\n3\n"), format!("t.csv, line 6: 1 cell, {ragged}"));
        assert_eq!(
            parsed("a,b\r\n1,2\r\n\r\n3,4,5\r\n"),
            format!("t.csv, line 4: 3 cells, {ragged}")
        );
        assert_eq!(parsed("a,b\n1,2\n# late\n3,4\n"), format!("t.csv, line 3: 1 cell, {ragged}"));
        for bad in ["NaN", "-inf", "1e999"] {
            assert_eq!(
                parsed(&format!("# s\na,b\n1,{bad}\n")),
                format!(
                    "t.csv, line 3, column `b`: found {bad:?}, \
                     wanted a finite number such as 1.25 or 3e-4"
                )
            );
        }
        assert_eq!(
            parsed("a,b\n1,2\n3,\"4\n5,6\n"),
            "t.csv, line 3, column `b`: found \"4\\n5,6\", \
             wanted text on one line (is a quote left open?)"
        );
        for (header, found, wanted) in [
            ("a,", "", "a column name"),
            ("a,1.5", "1.5", "a column name"),
            ("a,a", "a", "a column name not used before"),
        ] {
            assert_eq!(
                parsed(&format!("{header}\n1,2\n")),
                format!("t.csv, line 1, column `2`: found {found:?}, wanted {wanted}")
            );
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

        #[test]
        fn numbers_come_back_bit_for_bit(
            values in prop::collection::vec(prop::num::f64::NORMAL, 1..20),
        ) {
            let rows: String = values.iter().map(|value| format!("{value:e},x\n")).collect();
            let table = Table::parse("t.csv", &format!("# s\nnumber,name\n{rows}")).unwrap();
            prop_assert_eq!(table.column("number").unwrap(), values);
        }

        #[test]
        fn no_text_makes_it_panic(content in "[#a1.,\"\r\n é-]{0,60}") {
            if let Ok(table) = Table::parse("t.csv", &content) {
                prop_assert!(table.row_count() > 0);
            }
        }
    }
}
