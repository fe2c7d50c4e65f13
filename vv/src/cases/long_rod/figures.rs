//! Figures of the histories.

use whipple_solver::method::Preset;

use super::key;
use super::problem::SIZES;
use super::published::{LENGTH, VELOCITY};
use crate::plots::{Axis, Dash, Figure, Layer, MAX_SERIES, Panel, Series as Curve};
use crate::record::{Records, Series};

/// Runs whose histories are shown, drawn by a dash for each preset and a colour for each size.
fn shown(records: &Records) -> Vec<(Curve, &Series)> {
    let presets = [(Preset::Default, Dash::Solid), (Preset::Paper, Dash::Dashed)];
    let all = presets.into_iter().flat_map(|(preset, dash)| {
        SIZES.into_iter().enumerate().map(move |(hue, n)| {
            let key = key(preset, n);
            // Of `paper` it is no plain run that stands beside Table 5.
            let name = format!("{} {}", preset.name(), key.variant);
            let name = format!("{}, n = {n}", name.trim_end());
            (Curve::line(name, Vec::new()).styled(dash, hue), key)
        })
    });
    all.filter_map(|(curve, key)| Some((curve, records.get(&key)?.history.as_ref()?))).collect()
}

/// End of the axis of time in us: labels of level lines stand right of the curves, which end at 100.
const AXIS_END: f64 = 128.0;

/// Length and velocity over time.
pub(super) fn histories(records: &Records) -> Option<Figure> {
    let runs = shown(records);
    if runs.is_empty() {
        return None;
    }
    let [coarse, _, fine] = LENGTH.table_5;
    let panel = |column: &str, label: &str, rules: &[(f64, &str)]| {
        let time = Axis::linear("time, µs").range(0.0, AXIS_END);
        let mut panel = Panel::new("", time, Axis::linear(label));
        for (curve, history) in &runs {
            panel = panel.with(Curve { points: history.points("time", column), ..curve.clone() });
        }
        for (at, name) in rules {
            panel = panel.with(Layer::horizontal(*at, *name));
        }
        panel
    };
    let lengths =
        [(LENGTH.measured, "experiment"), (coarse, "Table 5, coarse"), (fine, "Table 5, fine")];
    let velocities = [(VELOCITY.measured, "experiment"), (VELOCITY.table_5[0], "Table 5")];
    let panels = vec![
        panel("length", "residual length, cm", &lengths),
        panel("velocity", "residual velocity, km/s", &velocities),
    ];
    let caption = "What is left of the rod: length and velocity of the largest connected set of live \
                   elements. Solid: `default`, dashed: `paper` with Table 4 \
                   `as-printed`; a colour for each size. Level lines: the experiment, \
                   and Table 5 of the paper.";
    Some(Figure::new("long-rod-residual", caption, panels))
}

/// Where the energy goes.
pub(super) fn energies(records: &Records) -> Option<Figure> {
    let record = records.get(&key(Preset::Default, SIZES[0]))?;
    let history = record.history.as_ref()?;
    let mut panel = Panel::new("", Axis::linear("time, µs"), Axis::log("energy, kJ"));
    for kind in ["kinetic", "internal", "shear", "tension", "residual"] {
        let sizes = history.points("time", kind).into_iter().map(|p| (p.0, p.1.abs()));
        // There is none of some kinds before the impact, and no logarithm of that.
        panel = panel.with(Curve::line(kind, sizes.filter(|p| p.1 > 0.0).collect()));
    }
    let failed = Panel::new("", Axis::linear("time, µs"), Axis::linear("failed elements"));
    let count = Curve::line("failed elements", history.points("time", "failed"));
    let failed = failed.with(count.styled(Dash::Solid, MAX_SERIES - 1));
    let caption = "Energy of rod and plate by kind, and elements that have failed; n = 5, `default`. \
                   The residual is the size of the work on elements that is neither stored nor heat.";
    Some(Figure::new("long-rod-energy", caption, vec![panel, failed]))
}
