//! The ledger of a run, read again.

use std::path::{Path, PathBuf};

/// A ledger that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct LedgerError {
    path: PathBuf,
    reason: String,
}

/// Columns over the times of their rows, in the units of the scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ledger {
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
}

impl Ledger {
    /// Reads the CSV file that a run leaves. What is no number, such as the name of a limiter, is NaN.
    ///
    /// # Errors
    /// A file that cannot be read, that does not begin with `time`, has rows of other lengths or none, or
    /// whose times do not rise; with its line.
    pub fn read(path: &Path) -> Result<Self, LedgerError> {
        let wrong = |reason: String| LedgerError { path: path.to_owned(), reason };
        let text =
            std::fs::read_to_string(path).map_err(|e| wrong(format!("cannot be read: {e}")))?;
        Self::of(&text).map_err(wrong)
    }

    /// The same of a text.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn of(text: &str) -> Result<Self, String> {
        let mut lines = text.lines();
        let head = lines.next().unwrap_or_default();
        let names: Vec<String> = head.split(',').map(str::to_owned).collect();
        if names.first().is_none_or(|name| name != "time") {
            return Err("line 1: no ledger of a run, wanted a first column `time`".into());
        }
        let mut columns = vec![Vec::new(); names.len()];
        for (k, line) in lines.enumerate() {
            let cells: Vec<&str> = line.split(',').collect();
            if cells.len() != names.len() {
                let (found, wanted, line) = (cells.len(), names.len(), k + 2);
                return Err(format!(
                    "line {line}: {found} columns, wanted {wanted} as in the head"
                ));
            }
            for (column, cell) in columns.iter_mut().zip(cells) {
                column.push(cell.parse().unwrap_or(f64::NAN));
            }
            let rises = match columns[0][..] {
                [.., before, now] => before < now,
                [now] => now.is_finite(),
                [] => true,
            };
            if !rises {
                return Err(format!("line {}: wanted a time after that of the row before", k + 2));
            }
        }
        if columns[0].is_empty() {
            return Err("it has no rows".into());
        }
        Ok(Self { names, columns })
    }

    /// Names of the columns.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// A column; empty if there is none of this name.
    #[must_use]
    pub fn column(&self, name: &str) -> &[f64] {
        let k = self.names.iter().position(|known| known == name);
        k.map_or(&[], |k| &self.columns[k])
    }

    /// The last value of a column; NaN if there is none.
    #[must_use]
    pub fn last(&self, name: &str) -> f64 {
        self.column(name).last().copied().unwrap_or(f64::NAN)
    }

    /// A column at a time, straight between its rows; NaN outside of them.
    #[must_use]
    pub fn at(&self, name: &str, time: f64) -> f64 {
        let (times, values) = (self.column("time"), self.column(name));
        let after = times.partition_point(|t| *t < time);
        if values.is_empty() || after >= times.len() {
            return f64::NAN;
        }
        if times[after] == time {
            return values[after];
        }
        let Some(before) = after.checked_sub(1) else { return f64::NAN };
        let share = (time - times[before]) / (times[after] - times[before]);
        values[before] + share * (values[after] - values[before])
    }
}

#[cfg(test)]
mod tests {
    use super::Ledger;

    #[test]
    fn values_lie_straight_between_rows() {
        let ledger = Ledger::of("time,limiter,a\n0.0,,1.0\n2.0,sound,5.0\n").expect("a ledger");
        assert_eq!([0.0, 0.5, 2.0].map(|t| ledger.at("a", t)), [1.0, 2.0, 5.0]);
        assert!(ledger.at("a", 2.1).is_nan() && ledger.at("b", 1.0).is_nan());
        assert_eq!(ledger.last("a"), 5.0);
        for bad in ["step,a\n1,2\n", "time,a\n", "time,a\n0.0\n", "time,a\n1.0,1\n1.0,2\n"] {
            assert!(Ledger::of(bad).is_err(), "{bad}");
        }
    }
}
