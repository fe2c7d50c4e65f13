//! Gas released into vacuum: the density must follow it down to nothing.

use super::gas::{GasProblem, Region, Setup, Sizes};
use super::{Claim, Claims, Kind, Quantity, Scheme, Wanted, Weight, conservation};
use crate::exact::Gas;
use crate::exact::riemann::Riemann;
use crate::record::RunKey;
use crate::run::RunError;
use whipple_solver::method::Preset;
use whipple_solver::scene::{Boundaries, Boundary};

const ID: &str = "vacuum-release";
const EDGE: f64 = 0.5;
const GAS: Gas = Gas { density: 1.0, velocity: 0.0, pressure: 1.0, gamma: 1.4 };
const SIZES: &[usize] = &[100, 200, 400];

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Release into vacuum",
    about: "Gas at rest (ρ = 1, p = 1, γ = 1.4) between a wall and vacuum. Its front runs off at \
            2c/(γ − 1) and its density tends to zero there; with the printed contact rule the density \
            cannot fall at all.",
    source: "exact Riemann solution with vacuum (Toro, Riemann Solvers, chapter 4)",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: SIZES, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: false,
};

fn setup(_: &str) -> Result<Setup, RunError> {
    let riemann = Riemann::new(GAS, Gas::vacuum(GAS.gamma))?;
    Ok(Setup {
        regions: vec![Region { span: (0.0, EDGE), gas: GAS, gradient: 0.0, share: 1.0 }],
        ends: Boundaries { left: Boundary::Mirror(0.0), right: Boundary::Free },
        u_0: 0.0,
        time: 0.2,
        exact: Box::new(move |x, t| Ok(riemann.sample((x - EDGE) / t).gas)),
    })
}

fn claims() -> Vec<Claim> {
    let study = "1D study, section 5: its best prototype at n = 200";
    let aim = Claims::new(ID, Kind::Verification, Weight::Aim, study);
    let key = RunKey::new(ID, Scheme::preset(Preset::Default), 200);
    let mut out = vec![aim.claim(
        "L1 ρ, n = 200, `default`",
        Quantity::Norm(key.clone(), "density_l1"),
        Wanted::AtMost(0.0012),
    )];
    let keys = SIZES.iter().map(|&n| RunKey::new(ID, Scheme::preset(Preset::Default), n)).collect();
    let order = Claims { source: "first order in L1", weight: Weight::Must, ..aim };
    out.push(order.claim(
        "order of L1 ρ, `default`",
        Quantity::Order(keys, "density_l1"),
        Wanted::AtLeast(0.8),
    ));
    out.extend(conservation(ID, &key));
    out
}
