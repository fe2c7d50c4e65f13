//! Noh's problem without a wall: two cold streams collide.

use super::gas::{COLD_PRESSURE, GasProblem, Setup, Sizes, two_regions};
use super::{Claim, Claims, Kind, Quantity, Scheme, Wanted, Weight, conservation};
use crate::exact::Gas;
use crate::exact::riemann::Riemann;
use crate::record::RunKey;
use crate::run::RunError;
use whipple_solver::method::Preset;
use whipple_solver::scene::{Boundaries, Boundary};

const ID: &str = "two-stream-noh";
const GAS: Gas = Gas { density: 1.0, velocity: 1.0, pressure: COLD_PRESSURE, gamma: 5.0 / 3.0 };
const SIZES: &[usize] = &[100, 200, 400];

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Two-stream Noh",
    about: "Two cold streams of the gas of Table 1 collide at speed 1 each: Noh's wall shock and its mirror \
            image, with nothing standing at the wall. The frame is free, so the case also serves the \
            boost test.",
    source: "Noh, J. Comput. Phys. 72 (1987) 78; exact solution",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: SIZES, drawn: 200, fine: &[] },
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
    let riemann = Riemann::new(left, right)?;
    Ok(Setup {
        regions: two_regions((-0.5, left), 0.0, (0.5, right)),
        ends: Boundaries { left: Boundary::Free, right: Boundary::Free },
        u_0: 1.0,
        time: 0.3,
        exact: Box::new(move |x, t| Ok(riemann.sample(x / t).gas)),
    })
}

fn claims() -> Vec<Claim> {
    let study = "1D study, section 5: its best prototype at n = 200";
    let aim = Claims::new(ID, Kind::Verification, Weight::Aim, study);
    let key = RunKey::new(ID, Scheme::preset(Preset::Default), 200);
    let mut out = vec![aim.claim(
        "L1 ρ, n = 200, `default`",
        Quantity::Norm(key.clone(), "density_l1"),
        Wanted::AtMost(0.0080),
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
