//! Noh's problem without a wall: two cold streams collide.

use super::Claim;
use super::gas::{COLD_PRESSURE, GasProblem, STUDIED, Setup, Sizes, studied};
use crate::exact::Gas;
use crate::run::RunError;
use whipple_solver::scene::{Boundaries, Boundary};

const ID: &str = "two-stream-noh";
const GAS: Gas = Gas { density: 1.0, velocity: 1.0, pressure: COLD_PRESSURE, gamma: 5.0 / 3.0 };

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Two-stream Noh",
    about: "Two cold streams of the gas of Table 1 collide at speed 1 each: Noh's wall shock and its mirror \
            image, with nothing standing at the wall. The frame is free, so the case also serves the \
            boost test.",
    source: "Noh, J. Comput. Phys. 72 (1987) 78; exact solution",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: STUDIED, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: true,
};

fn setup(_: &str) -> Result<Setup, RunError> {
    streams(0.0)
}

/// The problem in a frame in which everything moves at `boost`.
pub(super) fn streams(boost: f64) -> Result<Setup, RunError> {
    let moving = |v| Gas { velocity: v + boost, ..GAS };
    let (left, right) = (moving(1.0), moving(-1.0));
    Ok(Setup {
        ends: Boundaries { left: Boundary::Free, right: Boundary::Free },
        u_0: 1.0,
        ..Setup::tube((-0.5, left), 0.0, (0.5, right), 0.3)?
    })
}

fn claims() -> Vec<Claim> {
    studied(ID, 0.0080)
}
