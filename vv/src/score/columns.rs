//! Which column is what, and in which unit.
//!
//! Cases along a line have no units. Their numbers are then taken to be cm, g, µs and Mbar, which go together: any other
//! set that does gives the same results.

use whipple_solver::units::Units;

use super::table::{Column, Table};
use crate::scenes::error::FileError;
use crate::scenes::quantity::{Kind, read};
use crate::suggest::did_you_mean;

/// What a column can be: its name here, other names that are known, and what it measures.
const KNOWN: [(&str, &[&str], Kind); 8] = [
    ("x", &["position", "r", "radius", "pos", "coordinate", "x1", "z"], Kind::LENGTH),
    ("density", &["rho", "dens", "d", "ρ"], Kind::DENSITY),
    ("velocity", &["u", "v", "vx", "vel", "velx", "v1", "ux", "vr", "speed"], Kind::VELOCITY),
    ("pressure", &["p", "pres", "press", "prs"], Kind::PRESSURE),
    (
        "energy",
        &["e", "eint", "internal energy", "internal_energy", "ie", "sie"],
        Kind::SPECIFIC_ENERGY,
    ),
    ("temperature", &["t", "temp", "theta"], Kind::NUMBER),
    ("width", &["dx", "length", "dr", "h"], Kind::LENGTH),
    ("mass", &["m", "dm"], Kind::NUMBER),
];

/// Names of what a column can be.
pub fn known() -> impl Iterator<Item = &'static str> {
    KNOWN.iter().map(|known| known.0)
}

fn find(name: &str) -> Option<(&'static str, Kind)> {
    let name = name.trim().to_lowercase();
    let same = |known: &&(&str, &[&str], Kind)| known.0 == name || known.1.contains(&name.as_str());
    KNOWN.iter().find(same).map(|known| (known.0, known.2))
}

/// What the user says of columns.
#[derive(Debug, Clone, Default)]
pub struct Named {
    /// What is in which column of the files.
    pub columns: Vec<(String, String)>,
    /// What is in which unit.
    pub units: Vec<(String, String)>,
}

impl Named {
    /// Checks what `--column` and `--unit` name.
    ///
    /// # Errors
    /// A quantity that is not known, in words.
    pub fn check(&self) -> Result<(), String> {
        let named = self.columns.iter().map(|c| ("--column", c));
        for (option, (quantity, _)) in named.chain(self.units.iter().map(|u| ("--unit", u))) {
            if !known().any(|known| known == quantity) {
                let all: Vec<&str> = known().collect();
                return Err(format!(
                    "{option} {quantity}: there is no such quantity{} (there is: {})",
                    did_you_mean(quantity, known()),
                    all.join(", ")
                ));
            }
        }
        Ok(())
    }

    /// A quantity of a table in the units of cases; none if the table has no such column.
    ///
    /// # Errors
    /// A named column that is not there, two columns for one quantity, or a unit that is none of it.
    pub fn column(&self, table: &Table, quantity: &str) -> Result<Option<Vec<f64>>, FileError> {
        let Some(column) = self.named(table, quantity)? else { return Ok(None) };
        let unit = self.units.iter().find(|(of, _)| of == quantity).map(|(_, unit)| unit.as_str());
        let Some(unit) = unit.or(column.unit.as_deref()).filter(|unit| !matches!(*unit, "-" | "1"))
        else {
            return Ok(Some(column.values.clone()));
        };
        let kind = find(quantity).map_or(Kind::NUMBER, |known| known.1);
        let factor = read(&format!("1 {unit}"), kind, Units::CmGUsMbar)
            .map_err(|error| table.names_wrong(format!("column `{}`: {error}", column.name)))?;
        Ok(Some(column.values.iter().map(|value| value * factor).collect()))
    }

    fn named<'a>(&self, table: &'a Table, quantity: &str) -> Result<Option<&'a Column>, FileError> {
        if let Some((_, name)) = self.columns.iter().find(|(of, _)| of == quantity) {
            let found = table.columns.iter().find(|column| column.name == *name);
            return found.map(Some).ok_or_else(|| {
                let names: Vec<&str> = table.columns.iter().map(|c| c.name.as_str()).collect();
                let near = did_you_mean(name, names.iter().copied());
                let all = names.join(", ");
                table.names_wrong(format!(
                    "there is no column `{name}` here{near} (there is: {all})"
                ))
            });
        }
        // A column that was given to another quantity is not free.
        let free = |column: &&Column| !self.columns.iter().any(|(_, name)| *name == column.name);
        let is = |column: &&Column| find(&column.name).is_some_and(|found| found.0 == quantity);
        let mut all = table.columns.iter().filter(free).filter(is);
        match (all.next(), all.next()) {
            (Some(a), Some(b)) => Err(table.names_wrong(format!(
                "`{}` and `{}` are both names of {quantity}: say which with --column {quantity}={}",
                a.name, b.name, a.name
            ))),
            (first, _) => Ok(first),
        }
    }
}
