//! Cold streams of densities 1 and 8 collide: particle masses jump by 8 at the contact.

use super::Claim;
use super::gas::{COLD_PRESSURE, GasProblem, STUDIED, Setup, Sizes, studied};
use crate::exact::Gas;
use crate::run::RunError;
use whipple_solver::scene::{Boundaries, Boundary};

const ID: &str = "unequal-masses";
const LIGHT: Gas = Gas { density: 1.0, velocity: 1.0, pressure: COLD_PRESSURE, gamma: 5.0 / 3.0 };
const HEAVY: Gas = Gas { density: 8.0, velocity: -1.0, ..LIGHT };

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Unequal masses, 1 : 8",
    about: "Two cold streams of densities 1 and 8 collide at speed 1 each, with equal particle spacing, so \
            that masses jump by 8 at the contact. Two strong shocks part from it.",
    source: "exact Riemann solution; the ratio is the 1D study's",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: STUDIED, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: true,
};

fn setup(_: &str) -> Result<Setup, RunError> {
    Ok(Setup {
        ends: Boundaries { left: Boundary::Free, right: Boundary::Free },
        u_0: 1.0,
        ..Setup::tube((-0.5, LIGHT), 0.0, (0.5, HEAVY), 0.2)?
    })
}

fn claims() -> Vec<Claim> {
    studied(ID, 0.0158)
}
