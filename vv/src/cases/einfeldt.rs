//! Einfeldt's 123 problem: two streams part and leave almost nothing between them.

use super::gas::{GasProblem, Setup, Sizes, two_regions};
use super::{Claim, Claims, Kind, Quantity, Scheme, Wanted, Weight, conservation};
use crate::exact::Gas;
use crate::exact::riemann::Riemann;
use crate::record::RunKey;
use crate::run::RunError;
use whipple_solver::method::Preset;
use whipple_solver::scene::{Boundaries, Boundary};

const ID: &str = "einfeldt-123";
const MEMBRANE: f64 = 0.5;
const LEFT: Gas = Gas { density: 1.0, velocity: -2.0, pressure: 0.4, gamma: 1.4 };
const RIGHT: Gas = Gas { velocity: 2.0, ..LEFT };
const SIZES: &[usize] = &[100, 200, 400];

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Einfeldt's 123 problem",
    about: "Two halves of a gas (ρ = 1, p = 0.4, γ = 1.4) part at speed 2 each. The density in the middle \
            falls to 0.022: a test of re-expansion, which the printed contact rule cannot pass. The \
            outer ends move with the gas under its own pressure, so that no wave comes from there.",
    source: "Einfeldt et al., J. Comput. Phys. 92 (1991) 273; states as in ExactPack; exact Riemann solution",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: SIZES, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: true,
};

fn setup(_: &str) -> Result<Setup, RunError> {
    let riemann = Riemann::new(LEFT, RIGHT)?;
    let pushed = Boundary::Pressure(LEFT.pressure);
    Ok(Setup {
        regions: two_regions((0.0, LEFT), MEMBRANE, (1.0, RIGHT)),
        ends: Boundaries { left: pushed, right: pushed },
        u_0: 0.0,
        time: 0.15,
        exact: Box::new(move |x, t| Ok(riemann.sample((x - MEMBRANE) / t).gas)),
    })
}

fn claims() -> Vec<Claim> {
    let study = "1D study, section 5: its best prototype at n = 200";
    let aim = Claims::new(ID, Kind::Verification, Weight::Aim, study);
    let key = RunKey::new(ID, Scheme::preset(Preset::Default), 200);
    let keys = SIZES.iter().map(|&n| RunKey::new(ID, Scheme::preset(Preset::Default), n)).collect();
    let order = Claims { source: "first order in L1", weight: Weight::Must, ..aim };
    let mut out = vec![
        aim.claim(
            "L1 ρ, n = 200, `default`",
            Quantity::Norm(key.clone(), "density_l1"),
            Wanted::AtMost(0.0075),
        ),
        order.claim(
            "order of L1 ρ, `default`",
            Quantity::Order(keys, "density_l1"),
            Wanted::AtLeast(0.8),
        ),
    ];
    out.extend(conservation(ID, &key));
    out
}
