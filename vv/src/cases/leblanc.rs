//! LeBlanc's tube, in both forms that go by the name: a huge pressure ratio and a small density ratio.

use super::gas::{GasProblem, Setup, Sizes};
use super::{Claim, Claims, Kind, Quantity, Wanted, Weight, conservation, default_run};
use crate::exact::Gas;
use crate::run::RunError;

const ID: &str = "leblanc";
const LEFT: Gas = Gas { density: 1.0, velocity: 0.0, pressure: 0.2 / 3.0, gamma: 5.0 / 3.0 };
const COLD: f64 = 2e-10 / 3.0;
const SIZES: &[usize] = &[100, 200, 400];

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "LeBlanc's shock tube",
    about: "Hot dense gas against cold thin gas, γ = 5/3, with a pressure ratio of 10⁹. The form of \
            ExactPack has a density ratio of 100; the usual form (`standard`) has 1000. Most codes \
            put the shock in the wrong place at moderate resolution.",
    source: "ExactPack (density ratio 100) and the usual statement (1000); exact Riemann solution",
    variants: &["", "standard"],
    sizes: Sizes { quick: &[200], standard: SIZES, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: true,
};

fn setup(variant: &str) -> Result<Setup, RunError> {
    let (density, place) = if variant == "standard" { (1e-3, 1.0 / 3.0) } else { (0.01, 0.3) };
    let right = Gas { density, pressure: COLD, ..LEFT };
    Setup::tube((0.0, LEFT), place, (1.0, right), 0.5)
}

fn claims() -> Vec<Claim> {
    let falls = "the error must fall with refinement; many codes are 5 % off at 400 (dossier)";
    let must = Claims::new(ID, Kind::Verification, Weight::Must, falls);
    let mut out = Vec::new();
    for variant in CASE.variants {
        let key = |&n: &usize| default_run(ID, n).variant(variant);
        let form = if variant.is_empty() { "ExactPack's form" } else { "usual form" };
        out.push(must.claim(
            format!("order of L1 ρ, {form}, `default`"),
            Quantity::Order(SIZES.iter().map(key).collect(), "density_l1"),
            Wanted::AtLeast(0.5),
        ));
        out.extend(conservation(ID, &key(&200)));
    }
    out
}
