//! What is read off the states of a run.

use whipple_solver::space::Simulation;
use whipple_solver::space::ledger::Balance;

use crate::cases::parts::{kilojoules, pieces};
use crate::record::Series;

/// What is read off a state, in this order.
const HISTORY: [&str; 13] = [
    "time",
    "length",
    "velocity",
    "mass",
    "kinetic",
    "internal",
    "shear",
    "tension",
    "residual",
    "momentum_x",
    "momentum_y",
    "failed",
    "dt",
];

/// The numbers of [`HISTORY`] of a state.
pub(super) fn look(solver: &Simulation, balance: &Balance) -> Vec<f64> {
    let left = pieces::largest(solver, 0);
    let now = &balance.now;
    let [kinetic, internal, shear, tension, residual] = kilojoules(balance);
    vec![
        solver.time(),
        left.length,
        10.0 * left.velocity,
        left.mass,
        kinetic,
        internal,
        shear,
        tension,
        residual,
        now.momentum[0],
        now.momentum[1],
        solver.failed().0 as f64,
        solver.last_step(),
    ]
}

/// Histories of a run, column by column.
pub(super) fn columns(rows: &[Vec<f64>]) -> Series {
    let column = |k: usize| rows.iter().map(|row| row[k]).collect();
    Series(HISTORY.into_iter().enumerate().map(|(k, name)| (name.into(), column(k))).collect())
}
