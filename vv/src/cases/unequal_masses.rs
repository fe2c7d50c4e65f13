//! Cold streams of densities 1 and 8 collide: particle masses jump by 8 at the contact.

use super::gas::{COLD_PRESSURE, GasProblem, Setup, Sizes, two_regions};
use super::{Claim, Claims, Kind, Quantity, Scheme, Wanted, Weight, conservation};
use crate::exact::Gas;
use crate::exact::riemann::Riemann;
use crate::record::RunKey;
use crate::run::RunError;
use whipple_solver::method::Preset;
use whipple_solver::scene::{Boundaries, Boundary};

const ID: &str = "unequal-masses";
const LIGHT: Gas = Gas { density: 1.0, velocity: 1.0, pressure: COLD_PRESSURE, gamma: 5.0 / 3.0 };
const HEAVY: Gas = Gas { density: 8.0, velocity: -1.0, ..LIGHT };
const SIZES: &[usize] = &[100, 200, 400];

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Unequal masses, 1 : 8",
    about: "Two cold streams of densities 1 and 8 collide at speed 1 each, with equal particle spacing, so \
            that masses jump by 8 at the contact. Two strong shocks part from it.",
    source: "exact Riemann solution; the ratio is the 1D study's",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: SIZES, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: true,
};

fn setup(_: &str) -> Result<Setup, RunError> {
    let riemann = Riemann::new(LIGHT, HEAVY)?;
    Ok(Setup {
        regions: two_regions((-0.5, LIGHT), 0.0, (0.5, HEAVY)),
        ends: Boundaries { left: Boundary::Free, right: Boundary::Free },
        u_0: 1.0,
        time: 0.2,
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
        Wanted::AtMost(0.0158),
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
