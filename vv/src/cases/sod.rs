//! Sod's shock tube: every wave of a gas, none of them strong.

use super::gas::{GasProblem, Setup, Sizes};
use super::{Claim, Claims, Kind, Quantity, Wanted, Weight, conservation, default_run, run_of};
use crate::exact::Gas;
use crate::run::RunError;
use whipple_solver::method::Preset;

const ID: &str = "sod";
const MEMBRANE: f64 = 0.5;
const LEFT: Gas = Gas { density: 1.0, velocity: 0.0, pressure: 1.0, gamma: 1.4 };
const RIGHT: Gas = Gas { density: 0.125, velocity: 0.0, pressure: 0.1, gamma: 1.4 };
const SIZES: &[usize] = &[100, 200, 400, 800];

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Sod's shock tube",
    about: "A membrane between gas at pressure 1 and 0.1 (density 1 and 0.125, γ = 1.4) breaks: a \
            rarefaction, a contact and a shock. Run with equal particle spacing, so that particle \
            masses jump by 8 at the contact, and with equal masses.",
    source: "Sod, J. Comput. Phys. 27 (1978) 1; states as in ExactPack; exact Riemann solution",
    variants: &["", "equal-mass"],
    sizes: Sizes { quick: &[100, 200], standard: SIZES, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: true,
};

fn setup(variant: &str) -> Result<Setup, RunError> {
    let mut setup = Setup::tube((0.0, LEFT), MEMBRANE, (1.0, RIGHT), 0.2)?;
    let regions = &mut setup.regions;
    if variant == "equal-mass" {
        let mass: f64 = regions.iter().map(|r| r.gas.density * (r.span.1 - r.span.0)).sum();
        for region in regions {
            region.share = region.gas.density * (region.span.1 - region.span.0) / mass;
        }
    }
    Ok(setup)
}

fn claims() -> Vec<Claim> {
    let first = "L1 converges with first order for a method that captures shocks";
    let study = "1D study, section 5: its best prototype at n = 200";
    let verified = Claims::new(ID, Kind::Verification, Weight::Must, first);
    let mut out = Vec::new();
    for preset in Preset::ALL {
        let keys = SIZES.iter().map(|&n| run_of(ID, preset, n)).collect();
        out.push(verified.claim(
            format!("order of L1 ρ, `{}`", preset.name()),
            Quantity::Order(keys, "density_l1"),
            Wanted::AtLeast(0.8),
        ));
    }
    let at = |variant: &str| default_run(ID, 200).variant(variant);
    let study = Claims::new(ID, Kind::Verification, Weight::Aim, study).in_sample();
    let l1 = |variant, bound| (Quantity::Norm(at(variant), "density_l1"), Wanted::AtMost(bound));
    let (quantity, wanted) = l1("", 0.0033);
    out.push(study.claim("L1 ρ, equal spacing, n = 200, `default`", quantity, wanted));
    let (quantity, wanted) = l1("equal-mass", 0.0044);
    out.push(study.claim("L1 ρ, equal mass, n = 200, `default`", quantity, wanted));
    out.extend(conservation(ID, &at("")));
    out
}
