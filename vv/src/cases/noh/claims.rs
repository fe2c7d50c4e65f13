//! What is claimed: the paper's Table 2, accuracy, orders, cost.

use whipple_solver::method::Preset;

use super::tables::TABLE_2;
use super::{ID, SIZES};
use crate::cases::{
    Claim, Claims, Kind, Quantity, Wanted, Weight, conservation, default_run, paper_run, run_of,
};
use crate::record::RunKey;

/// 1D study, section 2, reading A converged in the time step.
const STUDY: [(usize, f64, f64); 4] = [
    (100, 0.16986, 0.08694),
    (200, 0.11999, 0.06117),
    (400, 0.08485, 0.04311),
    (800, 0.06000, 0.03038),
];

/// All of them.
pub(super) fn all() -> Vec<Claim> {
    let mut out = table_2();
    out.extend(accuracy());
    out.extend(orders());
    let default = |n| default_run(ID, n);
    for n in [100, 800] {
        out.extend(conservation(ID, &default(n)));
    }
    let cost = Claims::new(ID, Kind::Cost, Weight::Must, wanted!("one core, CPU time of stepping"));
    out.push(cost.claim(
        "particle-steps per CPU second, n = 800, `default`",
        Quantity::Speed(default(800)),
        Wanted::AtLeast(1e7),
    ));
    out.push(cost.claim(
        "CPU seconds, n = 800, `paper`",
        Quantity::CpuSeconds(paper_run(ID, 800)),
        Wanted::AtMost(5.0),
    ));
    out
}

/// The eight norms of Table 2, against the paper and against the study.
fn table_2() -> Vec<Claim> {
    let paper = Claims::new(ID, Kind::Replication, Weight::Must, "paper, Table 2").in_sample();
    let study = Claims {
        kind: Kind::Comparison,
        source: "1D study: reading A converged in the time step, within 0.5 %",
        ..paper
    };
    let mut out = Vec::new();
    for (claims, rows, share, whose) in
        [(paper, TABLE_2, 0.02, "Table 2"), (study, STUDY, 0.005, "study")]
    {
        for (n, velocity, temperature) in rows {
            let key = paper_run(ID, n);
            for (name, symbol, value) in
                [("velocity_rms", "v", velocity), ("temperature_rms", "θ", temperature)]
            {
                out.push(claims.claim(
                    format!("rms {symbol}, n = {n}, `paper`, {whose}"),
                    Quantity::Norm(key.clone(), name),
                    Wanted::Near(value, share),
                ));
            }
        }
    }
    out
}

/// What the default preset reaches.
fn accuracy() -> Vec<Claim> {
    let source = wanted!("the prototype reached 0.19, 0.102, 4.7 % and 0.011");
    let must = Claims::new(ID, Kind::Verification, Weight::Must, source).in_sample();
    let aim = Claims { weight: Weight::Aim, source: wanted!("goal beyond the prototype"), ..must };
    let mut out = Vec::new();
    for n in [100, 400] {
        let key = default_run(ID, n);
        let wrong = |name| Quantity::WrongParticles(key.clone(), name);
        let rows = [
            ("n·rms² of v", wrong("velocity_rms_phase"), 0.20, 0.15),
            ("n·rms² of θ", wrong("temperature_rms_phase"), 0.105, 0.06),
        ];
        for (what, quantity, bound, goal) in rows {
            let what = format!("{what}, phase average, n = {n}, `default`");
            out.push(must.claim(what.clone(), quantity.clone(), Wanted::AtMost(bound)));
            out.push(aim.claim(what, quantity, Wanted::AtMost(goal)));
        }
        let heating = Quantity::Norm(key.clone(), "wall_heating");
        let what = format!("wall heating, first particle, n = {n}, `default`");
        out.push(must.claim(what.clone(), heating.clone(), Wanted::WithinZero(0.05)));
        out.push(aim.claim(what, heating, Wanted::WithinZero(0.01)));
    }
    let key = default_run(ID, 100);
    let window = Quantity::Norm(key, "velocity_l1_window");
    let what = "window L1 of v, mean over phases, n = 100, `default`";
    out.push(must.claim(what, window.clone(), Wanted::AtMost(0.012)));
    let stored = Claims { source: "best value stored by another code, for one phase", ..aim };
    out.push(stored.claim(what, window, Wanted::AtMost(0.0077)));
    out
}

/// Orders of both presets.
fn orders() -> Vec<Claim> {
    let source = "a shock of fixed width in particles: RMS 1/2, L1 1";
    let must = Claims::new(ID, Kind::Verification, Weight::Must, source);
    let mut out = Vec::new();
    for preset in Preset::ALL {
        let runs = |n: &usize| run_of(ID, preset, *n);
        let keys: Vec<RunKey> = SIZES.iter().map(runs).collect();
        let rows = [
            ("velocity_rms_phase", "rms v", 0.50, 0.03),
            ("temperature_rms_phase", "rms θ", 0.50, 0.03),
            ("velocity_l1_phase", "L1 v", 1.0, 0.05),
            ("temperature_l1_phase", "L1 θ", 1.0, 0.05),
        ];
        for (name, symbol, order, band) in rows {
            out.push(must.claim(
                format!("order of {symbol}, phase average, `{}`", preset.name()),
                Quantity::Order(keys.clone(), name),
                Wanted::Around(order, band),
            ));
        }
    }
    out
}
