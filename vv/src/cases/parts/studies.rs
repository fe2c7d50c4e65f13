//! What tables of validation share: cells of numbers that may be missing, bands, comparisons.

use crate::convergence::{Behaviour, GridStudy};
use crate::report::{Cell, Column, sig};
use crate::validation::Comparison;

/// The order at best: shocks and failure are spread over a number of cells.
pub(in crate::cases) const FORMAL_ORDER: f64 = 1.0;

/// A number, or a dash where there is none.
pub(in crate::cases) fn number(value: Option<f64>, digits: usize) -> Cell {
    value.map_or_else(|| "–".into(), |value| Cell::number(value, digits))
}

/// A number over another, less one, in percent.
pub(in crate::cases) fn percent(value: Option<f64>, of: Option<f64>) -> Cell {
    number(value.zip(of).map(|(value, of)| 100.0 * (value / of - 1.0)), 2)
}

/// Two ends in words.
pub(in crate::cases) fn range([low, high]: [f64; 2], digits: usize) -> String {
    format!("{} to {}", sig(low, digits), sig(high, digits))
}

/// The band to quote; equal numbers show none, least of all numbers that were rounded.
pub(in crate::cases) fn band(study: &GridStudy) -> Option<f64> {
    (study.behaviour != Behaviour::Flat).then(|| study.band())
}

/// A simulated number beside data, with the standard uncertainties that are known.
pub(in crate::cases) struct Judged {
    pub(in crate::cases) simulated: Option<f64>,
    pub(in crate::cases) measured: f64,
    pub(in crate::cases) numerical: Option<f64>,
    pub(in crate::cases) input: Option<f64>,
    pub(in crate::cases) data: f64,
}

impl Judged {
    /// Columns of [`Judged::cells`].
    pub(in crate::cases) fn columns() -> impl Iterator<Item = Column> {
        let numbers = ["S", "D", "E = S - D", "u_num", "u_input", "u_D", "u_val"];
        let numbers = numbers.into_iter().map(|name| Column::number(name, ""));
        numbers.chain(["error of the model", "shows"].map(Column::text))
    }

    /// The comparison, if every part of it is known.
    fn whole(&self) -> Option<Comparison> {
        let Self { measured, data, .. } = *self;
        let (simulated, numerical, input) = (self.simulated?, self.numerical?, self.input?);
        Some(Comparison { simulated, measured, numerical, input, data })
    }

    /// Comparison error, its uncertainty and what they show.
    pub(in crate::cases) fn cells(&self) -> Vec<Cell> {
        let whole = self.whole();
        let says = match (whole, self.numerical) {
            (Some(whole), _) if whole.resolves() => "an error of the model",
            (Some(_), _) => "no error of the model is resolved",
            (None, Some(_)) => "not to be judged: u_input is not known",
            (None, None) => "not to be judged: u_num is not known",
        };
        vec![
            number(self.simulated, 4),
            number(Some(self.measured), 4),
            number(self.simulated.map(|simulated| simulated - self.measured), 2),
            number(self.numerical, 2),
            number(self.input, 2),
            number(Some(self.data), 2),
            number(whole.map(|w| w.uncertainty()), 2),
            whole.map_or_else(|| "–".into(), |w| range(w.model_error(), 2)).into(),
            says.into(),
        ]
    }
}
