//! Observed order of convergence, Richardson extrapolation and the grid convergence index.
//!
//! Two questions, two entries. With an exact solution the *errors* are known: [`pairwise_orders`]
//! and [`fitted_order`]. Without one, only the *values* are: [`grid_study`] estimates the order,
//! the limit and a band (Roache; rules and worked numbers in the dossier, section 5.1).

mod grid;
mod order;

use serde::{Deserialize, Serialize};

use crate::words::counted;

pub use grid::{
    Behaviour, Estimate, GridStudy, LOWEST_ORDER, ORDER_TOLERANCE, OrderCheck, SAFETY_OTHERWISE,
    SAFETY_THREE_LEVELS, grid_study,
};
pub use order::{OrderFit, fitted_order, pairwise_orders, student_t95};

/// One resolution: particle spacing and what was computed with it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// Particle spacing `h`, above zero, any unit (only ratios count).
    pub spacing: f64,
    /// An error norm (above zero) or a computed quantity, any unit.
    pub value: f64,
}

impl Level {
    /// A level of `particles` in `dimension` dimensions, with `h = N^(-1/d)`. Fair only where cells
    /// were refined by integers, so that particle number and cell number go together.
    #[must_use]
    pub fn from_count(particles: u32, dimension: u8, value: f64) -> Self {
        Self { spacing: f64::from(particles).powf(-1.0 / f64::from(dimension)), value }
    }
}

/// Why no order can be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConvergenceError {
    /// Fewer levels than the method needs.
    #[error("{}, at least {wanted} needed", counted(*found, ["level given", "levels given"]))]
    TooFewLevels {
        /// Levels given.
        found: usize,
        /// Least number.
        wanted: usize,
    },
    /// A spacing, an error or the formal order is not a finite number above zero.
    #[error("{what} is {value}, not a finite number above zero")]
    NotPositive {
        /// What is at fault, with its level.
        what: String,
        /// The value found.
        value: f64,
    },
    /// A computed quantity (or a difference of two) is infinite or not a number.
    #[error("the value at spacing {spacing} is {value}, or too large to subtract")]
    NonFinite {
        /// Spacing of the level.
        spacing: f64,
        /// The value found.
        value: f64,
    },
    /// Two levels that are compared have the same spacing.
    #[error("two levels have the spacing {spacing}: no refinement between them")]
    EqualSpacing {
        /// The spacing found twice.
        spacing: f64,
    },
}

/// At least `wanted` levels, every spacing above zero.
fn check_levels(levels: &[Level], wanted: usize) -> Result<(), ConvergenceError> {
    if levels.len() < wanted {
        return Err(ConvergenceError::TooFewLevels { found: levels.len(), wanted });
    }
    let spacing = |(i, level): (usize, &Level)| {
        positive(|| format!("the spacing of level {i} (counted from 0)"), level.spacing)
    };
    levels.iter().enumerate().try_for_each(spacing)
}

/// `value` is a finite number above zero.
fn positive(what: impl Fn() -> String, value: f64) -> Result<(), ConvergenceError> {
    let good = value.is_finite() && value > 0.0;
    if good { Ok(()) } else { Err(ConvergenceError::NotPositive { what: what(), value }) }
}

#[cfg(test)]
mod tests;
