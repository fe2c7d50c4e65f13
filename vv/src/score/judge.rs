//! Profiles against the exact solution: norms, and orders over several resolutions.

use std::collections::BTreeMap;

use serde::Serialize;

use super::answer::{Answer, Fields};
use super::columns::Named;
use super::table::Table;
use crate::convergence::{Level, fitted_order, pairwise_orders};
use crate::norms::{self, NormError};
use crate::run::RunError;
use crate::scenes::error::FileError;

/// Why a profile cannot be judged.
#[derive(Debug, thiserror::Error)]
pub enum ScoreError {
    /// What is wrong with a file.
    #[error(transparent)]
    File(#[from] FileError),
    /// The case has no answer there.
    #[error("{file}: {source}")]
    Answer {
        /// The file.
        file: String,
        /// What the case says.
        source: RunError,
    },
    /// No norm of it.
    #[error("{file}: {field}: {source}")]
    Norm {
        /// The file.
        file: String,
        /// The field.
        field: String,
        /// Why.
        source: NormError,
    },
}

/// Where the weights of the norms come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Weights {
    /// A column of masses.
    Mass,
    /// A column of widths, times the density.
    Width,
    /// Half the way to both neighbours, times the density.
    Neighbours,
}

impl Weights {
    /// In words.
    #[must_use]
    pub fn said(self) -> &'static str {
        match self {
            Self::Mass => "masses of the file",
            Self::Width => "widths of the file times density",
            Self::Neighbours => "half the distances to neighbours times density",
        }
    }
}

/// A profile in the units of its case.
#[derive(Debug, Clone)]
pub struct Profile {
    /// Name of its file, or what it is.
    pub name: String,
    /// Places, increasing.
    pub x: Vec<f64>,
    /// Fields by name.
    pub fields: Fields,
    /// Weights of the norms: masses.
    pub mass: Vec<f64>,
    /// Where these come from.
    pub weights: Weights,
    /// What the case says at the same places.
    pub exact: Fields,
}

/// Half the way to both neighbours, the ends as far out as in.
fn widths(x: &[f64]) -> Vec<f64> {
    let gap = |k: usize| x[k + 1] - x[k];
    let last = x.len() - 1;
    let width = |k: usize| 0.5 * (gap(k.saturating_sub(1)) + gap(k.min(last - 1)));
    (0..x.len()).map(width).collect()
}

impl Profile {
    /// The profile of a table, beside the answer at a time.
    ///
    /// # Errors
    /// What is wrong with the table, or a place at which there is no answer.
    pub fn of(
        table: &Table,
        named: &Named,
        answer: &Answer,
        time: f64,
    ) -> Result<Self, ScoreError> {
        let name = table.file.display().to_string();
        let Some(x) = named.column(table, "x")? else {
            let message = "there is no position here: wanted a column `x`, or --column x=NAME";
            return Err(table.names_wrong(message.into()).into());
        };
        if x.len() < 2 {
            return Err(table.row_wrong(0, "one row: wanted two or more".into()).into());
        }
        if let Some(k) = x.windows(2).position(|pair| pair[1] <= pair[0]) {
            let message = "positions must increase from row to row".to_owned();
            return Err(table.row_wrong(k + 1, message).into());
        }
        let exact = answer
            .at(&x, time)
            .map_err(|source| ScoreError::Answer { file: name.clone(), source })?;
        let mut fields = Fields::new();
        for field in exact.keys() {
            if let Some(values) = named.column(table, field)? {
                fields.insert(field.clone(), values);
            }
        }
        if fields.is_empty() {
            let all: Vec<&str> = exact.keys().map(String::as_str).collect();
            let message = format!(
                "no field of the case here (it has: {}): name one with --column",
                all.join(", ")
            );
            return Err(table.names_wrong(message).into());
        }
        let given = [named.column(table, "mass")?, named.column(table, "width")?];
        let (weights, lengths) = match given {
            [Some(mass), _] => (Weights::Mass, mass),
            [None, Some(width)] => (Weights::Width, width),
            [None, None] => (Weights::Neighbours, widths(&x)),
        };
        let density = fields.get("density").or(exact.get("density"));
        let mass = match (weights, density) {
            (Weights::Mass, _) | (_, None) => lengths,
            (_, Some(density)) => lengths.iter().zip(density).map(|(l, rho)| l * rho).collect(),
        };
        Ok(Self { name, x, fields, mass, weights, exact })
    }
}

/// Errors of a field over the range of the exact one, or as they are where that is uniform.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Norms {
    /// Mass-weighted mean, as the report has it.
    pub l1: f64,
    /// Mass-weighted root of the mean square.
    pub l2: f64,
    /// The largest.
    pub linf: f64,
}

/// Norms of a profile, by field.
///
/// # Errors
/// A norm that is not a number, such as of masses below zero.
pub fn norms(profile: &Profile) -> Result<BTreeMap<String, Norms>, ScoreError> {
    let of =
        |(field, values): (&String, &Vec<f64>)| {
            let exact = &profile.exact[field];
            let errors: Vec<f64> = values.iter().zip(exact).map(|(v, e)| v - e).collect();
            let judged = judge(&errors, &profile.mass, exact).map_err(|source| {
                ScoreError::Norm { file: profile.name.clone(), field: field.clone(), source }
            })?;
            Ok((field.clone(), judged))
        };
    profile.fields.iter().map(of).collect()
}

fn judge(errors: &[f64], mass: &[f64], exact: &[f64]) -> Result<Norms, NormError> {
    let absolute = norms::l1_weighted(errors, mass)?;
    let l1 = match norms::relative_l1(errors, mass, exact) {
        // As cases do: a uniform field has no range to divide by.
        Err(NormError::NoMeasure { .. }) => absolute,
        other => other?,
    };
    let low = exact.iter().copied().fold(f64::INFINITY, f64::min);
    let high = exact.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let range = if high > low { high - low } else { 1.0 };
    let squares: Vec<f64> = errors.iter().map(|e| (e / range).powi(2)).collect();
    let l2 = norms::l1_weighted(&squares, mass)?.sqrt();
    Ok(Norms { l1, l2, linf: norms::linf(errors)? / range })
}

/// Orders of the L1 norm of one field.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Orders {
    /// Between neighbours, the coarsest first.
    pub pairwise: Vec<f64>,
    /// Fitted to all, with its 95 % interval, from three on.
    pub fitted: Option<(f64, (f64, f64))>,
}

/// Orders by field of profiles of growing size, where all have the field; none where an error is zero or two sizes
/// are alike.
#[must_use]
pub fn orders(sizes: &[usize], norms: &[BTreeMap<String, Norms>]) -> BTreeMap<String, Orders> {
    let fields = norms.first().into_iter().flat_map(BTreeMap::keys);
    let of = |field: &String| {
        let level = |(n, all): (&usize, &BTreeMap<String, Norms>)| {
            Some(Level { spacing: 1.0 / *n as f64, value: all.get(field)?.l1 })
        };
        let levels: Vec<Level> = sizes.iter().zip(norms).map(level).collect::<Option<_>>()?;
        let pairwise = pairwise_orders(&levels).ok()?;
        let fitted = fitted_order(&levels).ok().map(|fit| (fit.order, fit.interval));
        Some((field.clone(), Orders { pairwise, fitted }))
    };
    fields.filter_map(of).collect()
}
