//! Tables of numbers as other programs write them: commas, semicolons or blanks between columns, names and units
//! in a line above, comments after `#`.

use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::scenes::error::FileError;

/// A named column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name, as the file has it.
    pub name: String,
    /// Unit in brackets behind the name, if there is one.
    pub unit: Option<String>,
    /// Values, from the first row to the last.
    pub values: Vec<f64>,
}

/// A table that was read.
#[derive(Debug, Clone)]
pub struct Table {
    /// Its file.
    pub file: PathBuf,
    /// Columns, from left to right.
    pub columns: Vec<Column>,
    text: String,
    /// Bytes of the line of names, and of every row.
    head: Range<usize>,
    rows: Vec<Range<usize>>,
}

/// What stands between columns.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Between {
    Mark(char),
    Blanks,
}

impl Between {
    /// That of a line: a mark that is in it, or blanks.
    fn of(line: &str) -> Self {
        [',', ';'].into_iter().find(|mark| line.contains(*mark)).map_or(Self::Blanks, Self::Mark)
    }

    /// Cells of a line, as bytes of it; what stands in brackets is never divided.
    fn cells(self, line: &str) -> Vec<Range<usize>> {
        let (mut cells, mut depth, mut start): (Vec<Range<usize>>, usize, usize) = (vec![], 0, 0);
        for (k, c) in line.char_indices() {
            match c {
                '[' | '(' => depth += 1,
                ']' | ')' => depth = depth.saturating_sub(1),
                _ => {}
            }
            let ends = match self {
                Self::Mark(mark) => c == mark,
                Self::Blanks => c.is_whitespace(),
            };
            if ends && depth == 0 {
                cells.push(start..k);
                start = k + c.len_utf8();
            }
        }
        cells.push(start..line.len());
        if self == Self::Blanks {
            cells.retain(|cell| !cell.is_empty());
        }
        cells
    }
}

/// Names with the units behind them.
fn names(line: &str, between: Between) -> Vec<(String, Option<String>)> {
    let mut all: Vec<(String, Option<String>)> = Vec::new();
    for cell in between.cells(line) {
        let cell = line[cell].trim().trim_matches('"');
        let (name, unit) = match cell.find(['[', '(']) {
            Some(at) => {
                let unit = cell[at + 1..].trim_end().trim_end_matches([']', ')']).trim();
                (cell[..at].trim(), Some(unit.to_owned()).filter(|unit| !unit.is_empty()))
            }
            None => (cell, None),
        };
        match all.last_mut() {
            // A unit that blanks part from its name.
            Some(last) if name.is_empty() && unit.is_some() => last.1 = unit,
            _ => all.push((name.to_owned(), unit)),
        }
    }
    all
}

impl Table {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that cannot be read, has no names or no rows, a row of another length, or what is no finite number.
    pub fn read(file: &Path) -> Result<Self, FileError> {
        let text = std::fs::read_to_string(file)
            .map_err(|error| FileError::whole(file, format!("cannot be read: {error}")))?;
        Self::parse(file, text)
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// As [`Table::read`].
    pub fn parse(file: &Path, text: String) -> Result<Self, FileError> {
        let (mut head, mut rows): (Option<Range<usize>>, Vec<Range<usize>>) = (None, Vec::new());
        let mut start = 0;
        for whole in text.split_inclusive('\n') {
            let span = start..start + whole.trim_end().len();
            start += whole.len();
            let line = text[span.clone()].trim_start();
            let begin = span.end - line.len();
            let words = line.trim_start_matches(['#', ' ', '\t', '!', '%']);
            let named = words.starts_with(|c: char| !c.is_ascii_digit() && !"+-.".contains(c));
            if line.is_empty() {
                continue;
            }
            if line.starts_with(['#', '!', '%']) || (named && rows.is_empty()) {
                // The last line of words above the numbers names them.
                if rows.is_empty() && named {
                    head = Some(span.end - words.len()..span.end);
                }
                continue;
            }
            rows.push(begin..span.end);
        }
        let wanted = "wanted a line of column names, such as `x density velocity pressure`, above rows of numbers";
        let (Some(head), Some(first)) = (head, rows.first()) else {
            return Err(FileError::whole(file, format!("there is no table in it: {wanted}")));
        };
        let between = Between::of(&text[first.clone()]);
        let of_head = match Between::of(&text[head.clone()]) {
            Between::Blanks => between,
            mark => mark,
        };
        // A line of names may have blanks where rows have marks, or the other way round.
        let count = between.cells(&text[first.clone()]).len();
        let mut named = names(&text[head.clone()], of_head);
        if named.len() != count {
            named = names(&text[head.clone()], Between::Blanks);
        }
        if named.len() != count {
            let message = format!("{} names above rows of {count} numbers: {wanted}", named.len());
            return Err(FileError::at(file, &text, head, message));
        }
        let mut columns: Vec<Column> = named
            .into_iter()
            .map(|(name, unit)| Column { name, unit, values: Vec::with_capacity(rows.len()) })
            .collect();
        for row in &rows {
            let line = &text[row.clone()];
            let cells = between.cells(line);
            if cells.len() != count {
                let message = format!("{} numbers in a row, wanted {count}", cells.len());
                return Err(FileError::at(file, &text, row.clone(), message));
            }
            for (column, cell) in columns.iter_mut().zip(cells) {
                let word = line[cell.clone()].trim();
                // Fortran writes exponents with a D.
                let value =
                    word.replace(['d', 'D'], "e").parse().ok().filter(|x: &f64| x.is_finite());
                let Some(value) = value else {
                    let message =
                        format!("`{word}` in column `{}` is no finite number", column.name);
                    let at = row.start + cell.start..row.start + cell.end;
                    return Err(FileError::at(file, &text, at, message));
                };
                column.values.push(value);
            }
        }
        Ok(Self { file: file.to_owned(), columns, text, head, rows })
    }

    /// An error at the line of names.
    #[must_use]
    pub fn names_wrong(&self, message: String) -> FileError {
        FileError::at(&self.file, &self.text, self.head.clone(), message)
    }

    /// An error at a row, counted from 0.
    #[must_use]
    pub fn row_wrong(&self, row: usize, message: String) -> FileError {
        FileError::at(&self.file, &self.text, self.rows[row].clone(), message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Table, FileError> {
        Table::parse(Path::new("theirs.dat"), text.into())
    }

    #[test]
    fn forms_of_one_table_are_read_alike() {
        let wanted = read("x,rho [g/cm^3]\n0.5,1\n1.5,2e-1\n").unwrap().columns;
        assert_eq!(wanted[1].unit.as_deref(), Some("g/cm^3"));
        assert_eq!(wanted[1].values, [1.0, 0.2]);
        for text in [
            "# made by hand\n# x rho[g/cm^3]\n 0.5 1\n 1.5 0.2D0\n",
            "x; rho (g/cm^3)\n0.5;1\n# in between\n1.5;0.2\n\n",
            "x   rho [g/cm^3]\r\n0.5\t1.0\r\n1.5\t0.2\r\n",
        ] {
            assert_eq!(read(text).unwrap().columns, wanted, "{text}");
        }
    }

    #[test]
    fn what_is_no_table_is_said_with_its_line() {
        for (text, wanted) in [
            ("", "there is no table in it"),
            ("1 2\n3 4\n", "there is no table in it"),
            ("x rho\n1 2 3\n", "line 1: 2 names above rows of 3 numbers"),
            ("x rho\n1 2\n3\n", "line 3: 1 numbers in a row, wanted 2"),
            ("x,rho\n1,2\n3,nan\n", "line 3: `nan` in column `rho` is no finite number"),
            ("x,rho\n1,2\n3,two\n", "line 3: `two` in column `rho` is no finite number"),
        ] {
            let said = read(text).unwrap_err().to_string();
            assert!(said.contains(wanted), "{text}: {said}");
        }
    }
}
