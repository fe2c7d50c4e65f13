//! Figures of the histories.

use whipple_solver::method::Preset;

use super::key;
use super::problem::SIZES;
use super::published::{LENGTH, VELOCITY};
use crate::plots::{Axis, Figure, Layer, Panel, Series as Curve};
use crate::record::{Records, Series};

/// Runs whose histories are shown, with their names.
fn shown(records: &Records) -> Vec<(String, &Series)> {
    let all = [Preset::Default, Preset::Paper]
        .into_iter()
        .flat_map(|preset| SIZES.map(|n| (format!("{}, n = {n}", preset.name()), key(preset, n))));
    all.filter_map(|(name, key)| Some((name, records.get(&key)?.history.as_ref()?))).collect()
}

/// Length and velocity over time.
pub(super) fn histories(records: &Records) -> Option<Figure> {
    let runs = shown(records);
    if runs.is_empty() {
        return None;
    }
    let [coarse, _, fine] = LENGTH.table_5;
    let panel = |column: &str, label: &str, rules: &[(f64, &str)]| {
        let mut panel = Panel::new("", Axis::linear("time, µs"), Axis::linear(label));
        for (name, history) in &runs {
            panel = panel.with(Curve::line(name.clone(), history.points("time", column)));
        }
        for (at, name) in rules {
            panel = panel.with(Layer::horizontal(*at, *name));
        }
        panel
    };
    let lengths =
        [(LENGTH.measured, "experiment"), (coarse, "paper, coarse"), (fine, "paper, fine")];
    let velocities = [(VELOCITY.measured, "experiment"), (VELOCITY.table_5[0], "paper")];
    let panels = vec![
        panel("length", "residual length, cm", &lengths),
        panel("velocity", "residual velocity, km/s", &velocities),
    ];
    let caption = "What is left of the rod: length and velocity of the largest connected set of live \
                   elements.";
    Some(Figure::new("long-rod-residual", caption, panels))
}

/// Where the energy goes.
pub(super) fn energies(records: &Records) -> Option<Figure> {
    let record = records.get(&key(Preset::Default, SIZES[0]))?;
    let history = record.history.as_ref()?;
    let mut panel = Panel::new("", Axis::linear("time, µs"), Axis::log("energy, kJ"));
    for kind in ["kinetic", "internal", "shear", "tension", "residual"] {
        let points = history.points("time", kind).into_iter().map(|p| (p.0, p.1.abs())).collect();
        panel = panel.with(Curve::line(kind, points));
    }
    let failed = Panel::new("", Axis::linear("time, µs"), Axis::linear("failed elements"))
        .with(Curve::line("failed elements", history.points("time", "failed")));
    let caption = "Energy of rod and plate by kind, and elements that have failed; n = 5, `default`. \
                   The residual is the size of the work on elements that is neither stored nor heat.";
    Some(Figure::new("long-rod-energy", caption, vec![panel, failed]))
}
