//! Figures 1 to 4 of the paper, convergence, and speed against error.

use super::errors::exact;
use super::{DRAWN, ID, LENGTH, SIZES, STOP, THETA_0, schemes};
use crate::cases::gas::curve;
use crate::cases::kernel_default;
use crate::exact::Gas;
use crate::exact::noh::Noh as Exact;
use crate::plots::{Axis, Figure, Layer, Panel, Series as Curve};
use crate::record::{Records, RunKey, RunRecord, Scheme, Series};

/// The exact field as the corners of its step.
fn step(exact: &Exact, field: &str) -> Vec<(f64, f64)> {
    let of = |gas: Gas| match field {
        "velocity" => gas.velocity,
        "density" => gas.density,
        "pressure" => gas.pressure,
        _ => THETA_0 + gas.energy(),
    };
    let (behind, ahead) = (of(exact.behind()), of(exact.ahead()));
    let shock = exact.shock_position(STOP);
    vec![(0.0, behind), (shock, behind), (shock, ahead), (LENGTH - STOP, ahead)]
}

/// Figures 1 to 4 of the paper.
pub(super) fn profiles(records: &Records) -> Option<Figure> {
    let drawn: Vec<(Scheme, &Series)> = schemes()
        .into_iter()
        .filter(|s| *s != kernel_default())
        .filter_map(|s| Some((s, records.get(&RunKey::new(ID, s, DRAWN))?.profile.as_ref()?)))
        .collect();
    let exact = exact().ok()?;
    let fields = [
        ("velocity", "Figure 1"),
        ("density", "Figure 2"),
        ("pressure", "Figure 3"),
        ("temperature", "Figure 4"),
    ];
    let panels = fields
        .map(|(name, number)| {
            let x = Axis::linear("x").range(0.0, 0.2);
            let title = format!("{name}: as the paper's {number}");
            let mut panel = Panel::new(title, x, Axis::linear(name));
            panel = panel.with(Layer::exact("exact", step(&exact, name)));
            for (scheme, series) in &drawn {
                panel = panel.with(curve(*scheme, series.points("x", name)));
            }
            panel
        })
        .into();
    let caption = format!(
        "Wall shock at t = 0.3, {DRAWN} particles, what Figures 1 to 4 of the paper show: both presets, \
         the Godunov code ({DRAWN} cells over the initial length) and the exact solution, near the wall."
    );
    Some(Figure::new("noh-profiles", caption, panels))
}

/// Points of a norm over something, one per size.
fn points(
    records: &Records,
    scheme: Scheme,
    x: impl Fn(&RunRecord) -> f64,
    name: &str,
) -> Vec<(f64, f64)> {
    let record = |n: &usize| records.get(&RunKey::new(ID, scheme, *n));
    let point = |r: &RunRecord| Some((x(r), *r.norms.get(name)?));
    SIZES.iter().filter_map(record).filter_map(point).collect()
}

pub(super) fn convergence(records: &Records) -> Figure {
    let rows = [
        ("velocity_rms_phase", "rms error of v, phase average", 0.5),
        ("velocity_l1_phase", "L1 error of v, phase average", 1.0),
    ];
    let panels = rows
        .map(|(name, label, order)| {
            let mut panel = Panel::new("", Axis::log("spacing 1/n"), Axis::log(label))
                .with(Layer::slope(order));
            for scheme in schemes() {
                let spacing = |r: &RunRecord| 1.0 / r.key.n as f64;
                let points = points(records, scheme, spacing, name);
                panel = panel.with(Curve::marked(scheme.label(), points));
            }
            panel
        })
        .into();
    let caption = "Convergence on the wall shock: RMS with order 1/2, L1 with order 1.";
    Figure::new("noh-convergence", caption, panels)
}

pub(super) fn speed_against_error(records: &Records) -> Figure {
    type Cost = fn(&RunRecord) -> f64;
    let costs: [(&str, Cost); 2] = [
        ("CPU seconds", |r| r.cpu_seconds),
        ("particle-steps or cell-steps", |r| r.particle_steps as f64),
    ];
    let panels = costs
        .map(|(label, cost)| {
            let y = Axis::log("rms error of v, phase average");
            let mut panel = Panel::new("", Axis::log(label), y);
            for scheme in schemes() {
                let points = points(records, scheme, cost, "velocity_rms_phase");
                panel = panel.with(Curve::marked(scheme.label(), points));
            }
            panel
        })
        .into();
    let caption = "Speed against error on the wall shock, n = 100 to 800: lower and further left is \
                   better. CPU time is that of the machine named under provenance.";
    Figure::new("noh-speed-against-error", caption, panels)
}
