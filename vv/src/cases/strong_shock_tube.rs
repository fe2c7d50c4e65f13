//! A shock tube with a pressure ratio of 1e5: does the method survive, and where is the shock?

use super::gas::{GasProblem, Setup, Sizes};
use super::{Claim, Claims, Kind, Quantity, Wanted, Weight, conservation, run_of};
use crate::exact::Gas;
use crate::record::RunKey;
use crate::run::RunError;
use whipple_solver::method::Preset;

const ID: &str = "strong-shock-tube";
const MEMBRANE: f64 = 0.5;
const LEFT: Gas = Gas { density: 1.0, velocity: 0.0, pressure: 1000.0, gamma: 1.4 };
const RIGHT: Gas = Gas { pressure: 0.01, ..LEFT };
const SIZES: &[usize] = &[100, 200, 400];

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Strong shock tube, pressure ratio 10⁵",
    about: "Gas at pressure 1000 against gas at 0.01 of the same density (γ = 1.4): the left half of the \
            blast wave, and Toro's third test. The density behind the shock is six times that ahead.",
    source: "Toro, Riemann Solvers, test 3 (states recalled, also in the Castro manual); exact Riemann solution",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: SIZES, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: true,
};

fn setup(_: &str) -> Result<Setup, RunError> {
    Setup::tube((0.0, LEFT), MEMBRANE, (1.0, RIGHT), 0.012)
}

fn claims() -> Vec<Claim> {
    let source = "acceptance number of the 1D study: relative L1 of density at n = 200";
    let must = Claims::new(ID, Kind::Verification, Weight::Must, source).in_sample();
    let at = |preset| run_of(ID, preset, 200);
    let default = at(Preset::Default);
    let l1 = |key: RunKey| Quantity::Norm(key, "density_l1");
    let mut out =
        vec![must.claim("L1 ρ, n = 200, `default`", l1(default.clone()), Wanted::AtMost(0.010))];
    let limit = "printed heating (60) cools particles behind a fast contact below absolute zero";
    let shown = Claims::new(ID, Kind::Stability, Weight::Shown, limit);
    out.push(shown.claim("L1 ρ, n = 200, `paper`", l1(at(Preset::Paper)), Wanted::AtMost(0.025)));
    out.extend(conservation(ID, &default));
    out
}
