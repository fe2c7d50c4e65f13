//! Gas released into vacuum: the density must follow it down to nothing.

use super::Claim;
use super::gas::{GasProblem, Region, STUDIED, Setup, Sizes, membrane, studied};
use crate::exact::Gas;
use crate::run::RunError;
use whipple_solver::scene::{Boundaries, Boundary};

const ID: &str = "vacuum-release";
const EDGE: f64 = 0.5;
const GAS: Gas = Gas { density: 1.0, velocity: 0.0, pressure: 1.0, gamma: 1.4 };

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Release into vacuum",
    about: "Gas at rest (ρ = 1, p = 1, γ = 1.4) between a wall and vacuum. Its front runs off at \
            2c/(γ − 1) and its density tends to zero there; with the printed contact rule the density \
            cannot fall at all.",
    source: "exact Riemann solution with vacuum (Toro, Riemann Solvers, chapter 4)",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: STUDIED, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: false,
};

fn setup(_: &str) -> Result<Setup, RunError> {
    Ok(Setup {
        regions: vec![Region { span: (0.0, EDGE), gas: GAS, gradient: 0.0, share: 1.0 }],
        ends: Boundaries { left: Boundary::Mirror(0.0), right: Boundary::Free },
        u_0: 0.0,
        time: 0.2,
        exact: membrane(GAS, EDGE, Gas::vacuum(GAS.gamma))?,
    })
}

fn claims() -> Vec<Claim> {
    studied(ID, 0.0012)
}
