//! Einfeldt's 123 problem: two streams part and leave almost nothing between them.

use super::Claim;
use super::gas::{GasProblem, STUDIED, Setup, Sizes, studied};
use crate::exact::Gas;
use crate::run::RunError;
use whipple_solver::scene::{Boundaries, Boundary};

const ID: &str = "einfeldt-123";
const MEMBRANE: f64 = 0.5;
const LEFT: Gas = Gas { density: 1.0, velocity: -2.0, pressure: 0.4, gamma: 1.4 };
const RIGHT: Gas = Gas { velocity: 2.0, ..LEFT };

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Einfeldt's 123 problem",
    about: "Two halves of a gas (ρ = 1, p = 0.4, γ = 1.4) part at speed 2 each. The density in the middle \
            falls to 0.022: a test of re-expansion, which the printed contact rule cannot pass. The \
            outer ends move with the gas under its own pressure, so that no wave comes from there.",
    source: "Einfeldt et al., J. Comput. Phys. 92 (1991) 273; states as in ExactPack; exact Riemann solution",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: STUDIED, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: true,
};

fn setup(_: &str) -> Result<Setup, RunError> {
    let pushed = Boundary::Pressure(LEFT.pressure);
    Ok(Setup {
        ends: Boundaries { left: pushed, right: pushed },
        ..Setup::tube((0.0, LEFT), MEMBRANE, (1.0, RIGHT), 0.15)?
    })
}

fn claims() -> Vec<Claim> {
    studied(ID, 0.0075)
}
