//! Uniform collapse: a cold gas falls on a point, and every density rule must say 1/(1 - t).

use super::gas::{COLD_PRESSURE, GasProblem, Region, Setup, Sizes};
use super::{Claim, Claims, Kind, Quantity, Wanted, Weight, conservation, default_run, paper_run};
use crate::exact::Gas;
use crate::exact::Geometry;
use crate::exact::collapse::UniformCollapse;
use crate::run::RunError;
use whipple_solver::scene::{Boundaries, Boundary};

const ID: &str = "uniform-collapse";
const GAS: Gas = Gas { density: 1.0, velocity: 0.0, pressure: COLD_PRESSURE, gamma: 5.0 / 3.0 };
const SIZES: &[usize] = &[100, 200, 400];

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Uniform collapse",
    about: "Cold gas with velocity −x falls on the origin: its density is 1/(1 − t) everywhere, and no shock \
            forms. Tests the density rule and the viscosity's sense of a uniform compression alone.",
    source: "Noh, J. Comput. Phys. 72 (1987) 92; ExactPack noh2",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: SIZES, drawn: 200, fine: &[] },
    setup,
    claims,
    answer: "exact",
    eulerian: false,
};

fn setup(_: &str) -> Result<Setup, RunError> {
    let exact = UniformCollapse::new(Geometry::Planar, GAS, 1.0)?;
    Ok(Setup {
        regions: vec![Region { span: (0.0, 1.0), gas: GAS, gradient: -1.0, share: 1.0 }],
        ends: Boundaries { left: Boundary::Mirror(0.0), right: Boundary::Free },
        u_0: 1.0,
        time: 0.5,
        exact: Box::new(move |x, t| Ok(exact.sample(x, t)?)),
    })
}

fn claims() -> Vec<Claim> {
    let rule = "the density rule is exact for uniform compression, and nothing else may act";
    let must = Claims::new(ID, Kind::Verification, Weight::Must, rule);
    let key = default_run(ID, 200);
    let mut out = vec![must.claim(
        "L1 ρ, n = 200, `default`",
        Quantity::Norm(key.clone(), "density_l1"),
        Wanted::AtMost(1e-9),
    )];
    let limit =
        "linear viscosity heats a uniform compression, and the printed heating (60) ends the run";
    let shown = Claims { kind: Kind::Stability, weight: Weight::Shown, source: limit, ..must };
    out.push(shown.claim(
        "L1 ρ, n = 200, `paper`",
        Quantity::Norm(paper_run(ID, 200), "density_l1"),
        Wanted::AtMost(1e-3),
    ));
    out.extend(conservation(ID, &key));
    out
}
