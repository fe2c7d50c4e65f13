//! Two runs side by side: their scenes, findings and ledgers.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use serde_json::Value;

use super::ledger::Ledger;
use crate::plots::{Axis, Figure, Panel, Series};
use crate::record::RunRecord;

/// Difference over the scale of a quantity up to which two runs are equal: beyond round-off, and far below
/// what any physics changes.
pub const EQUAL: f64 = 1e-9;

/// A key of the scene with its values in both runs; none where it is not there.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Changed {
    /// Names and numbers of list entries, with dots between.
    pub key: String,
    /// Values of both.
    pub values: [Option<Value>; 2],
}

/// A number of both runs; NaN where one has none.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Difference {
    /// Finding, or column of the ledger.
    pub name: String,
    /// Values of both.
    pub values: [f64; 2],
    /// Difference over the scale of the quantity; infinite where one run alone has it.
    pub relative: f64,
    /// Of a history, the time of the greatest difference.
    pub time: Option<f64>,
}

impl Difference {
    fn new(name: &str, values: [f64; 2], scale: f64) -> Self {
        let [a, b] = values;
        let relative = match [a, b].map(f64::is_nan) {
            [true, true] => 0.0,
            [false, false] if a == b => 0.0,
            [false, false] => (b - a).abs() / scale.max(f64::MIN_POSITIVE),
            _ => f64::INFINITY,
        };
        Self { name: name.to_owned(), values, relative, time: None }
    }

    /// Whether it is more than round-off.
    #[must_use]
    pub fn matters(&self) -> bool {
        self.relative > EQUAL
    }
}

/// Keys whose values differ between the scenes of two records.
#[must_use]
pub fn scenes(records: [&RunRecord; 2]) -> Vec<Changed> {
    let [a, b] = records.map(|record| {
        let mut leaves = BTreeMap::new();
        flatten("", &serde_json::to_value(&record.scene).unwrap_or_default(), &mut leaves);
        leaves
    });
    let keys: BTreeSet<&String> = a.keys().chain(b.keys()).collect();
    let pairs =
        keys.into_iter().map(|key| (key, [a.get(key), b.get(key)].map(Option::<&Value>::cloned)));
    let differing = pairs.filter(|(_, [a, b])| a != b);
    differing.map(|(key, values)| Changed { key: key.clone(), values }).collect()
}

fn flatten(path: &str, value: &Value, leaves: &mut BTreeMap<String, Value>) {
    let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match value {
        Value::Object(all) => all.iter().for_each(|(k, v)| flatten(&below(k), v, leaves)),
        Value::Array(all) => {
            all.iter().enumerate().for_each(|(k, v)| flatten(&below(&k.to_string()), v, leaves));
        }
        leaf => {
            leaves.insert(path.to_owned(), leaf.clone());
        }
    }
}

/// All findings of two records. The scale of one is the largest of those that measure the same: whose names
/// have the same last part, such as the speeds of all bodies.
#[must_use]
pub fn findings(records: [&RunRecord; 2]) -> Vec<Difference> {
    let last = |name: &str| name.rsplit('.').next().unwrap_or(name).to_owned();
    let mut scales: BTreeMap<String, f64> = BTreeMap::new();
    for (name, value) in records.iter().flat_map(|record| &record.norms) {
        let scale = scales.entry(last(name)).or_default();
        *scale = scale.max(value.abs());
    }
    let names: BTreeSet<&String> = records.iter().flat_map(|record| record.norms.keys()).collect();
    let found = |name: &String| records.map(|r| r.norms.get(name).copied().unwrap_or(f64::NAN));
    names.into_iter().map(|name| Difference::new(name, found(name), scales[&last(name)])).collect()
}

/// Columns of the ledger that state energies.
const ENERGIES: [&str; 8] = [
    "kinetic",
    "internal",
    "shear",
    "tension",
    "element_work",
    "element_heat",
    "residual",
    "wall_work",
];

/// The farthest that bodies of two records reach from the origin at the start: the lever of angular momenta.
#[must_use]
pub fn reach(records: [&RunRecord; 2]) -> f64 {
    let size = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let scenes = records.into_iter().filter_map(|record| record.scene.as_ref()?.space());
    let bodies = scenes.flat_map(|scene| &scene.bodies);
    bodies.map(|body| size(body.centre) + 0.5 * size(body.shape.extent())).fold(0.0, f64::max)
}

/// The scale of what a column of ledgers measures; none of columns that only tell of the numerics.
fn scale(name: &str, ledgers: [&Ledger; 2], reach: f64) -> Option<f64> {
    let largest = |name: &str| {
        let all = ledgers.into_iter().flat_map(|ledger| ledger.column(name));
        all.filter(|x| x.is_finite()).fold(0.0, |most: f64, x| most.max(x.abs()))
    };
    let kind = name.rsplit('.').next().unwrap_or(name);
    if ENERGIES.contains(&kind) {
        return Some(largest("total.kinetic").max(largest("total.internal")));
    }
    // No sum of m |v| is larger.
    let momentum = || (2.0 * largest("total.mass") * largest("total.kinetic")).sqrt();
    let of = |start: &str| kind.starts_with(start) && !kind.ends_with("drift");
    if of("momentum_") || of("wall_impulse") {
        return Some(momentum());
    }
    if of("angular_") || of("wall_moment") {
        return Some(momentum() * reach);
    }
    match kind {
        "mass" => Some(largest("total.mass")),
        "failed_elements" | "dead_elements" => Some(largest(kind)),
        _ => None,
    }
}

/// The greatest difference of every column over the times of both ledgers that both have come to, straight
/// between rows; the largest first. `reach` is the lever of angular momenta, see [`reach`].
#[must_use]
pub fn histories(ledgers: [&Ledger; 2], reach: f64) -> Vec<Difference> {
    let end = ledgers.map(|ledger| ledger.last("time")).into_iter().fold(f64::INFINITY, f64::min);
    let mut times: Vec<f64> = ledgers
        .iter()
        .flat_map(|ledger| ledger.column("time"))
        .copied()
        .filter(|t| *t <= end)
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let names: BTreeSet<&String> = ledgers.iter().flat_map(|ledger| ledger.names()).collect();
    let mut all = Vec::new();
    for name in names {
        let Some(scale) = scale(name, ledgers, reach) else { continue };
        let at = |time: &f64| {
            let values = ledgers.map(|ledger| ledger.at(name, *time));
            Difference { time: Some(*time), ..Difference::new(name, values, scale) }
        };
        all.extend(times.iter().map(at).max_by(|a, b| a.relative.total_cmp(&b.relative)));
    }
    all.sort_by(|a, b| b.relative.total_cmp(&a.relative));
    all
}

/// Energies of both runs over time, and the largest component of the first body's momentum.
#[must_use]
pub fn figure(ledgers: [&Ledger; 2], names: [&str; 2], units: [&str; 3]) -> Figure {
    let label = |what: &str, unit: &str| {
        if unit.is_empty() { what.to_owned() } else { format!("{what} / {unit}") }
    };
    let [time, energy, momentum] = units;
    // That of all changes by walls alone.
    let bodies = ledgers[0].names().iter().filter_map(|name| name.strip_suffix(".kinetic"));
    let first = { bodies }.find(|name| *name != "total").unwrap_or("total");
    let along = ["x", "y", "z"].map(|axis| format!("{first}.momentum_{axis}"));
    let most =
        |name: &String| ledgers[0].column(name).iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let main = along.iter().max_by(|a, b| most(a).total_cmp(&most(b))).map_or("", String::as_str);
    let of_first = format!("momentum of {first} along {}", &main[main.len().saturating_sub(1)..]);
    let panels = [
        ("kinetic energy", "total.kinetic", energy),
        ("internal energy", "total.internal", energy),
        ("energy stored in shear", "total.shear", energy),
        (&of_first, main, momentum),
    ];
    let panels = panels.map(|(title, column, unit)| {
        let axes = [label("time", time), label(title, unit)].map(Axis::linear);
        let [x, y] = axes;
        let series = |k: usize| {
            let points = ledgers[k].column("time").iter().zip(ledgers[k].column(column));
            Series::line(names[k], points.map(|(t, v)| (*t, *v)).collect())
        };
        Panel::new("", x, y).with(series(0)).with(series(1))
    });
    Figure::new("compare", format!("Histories of {} and {}", names[0], names[1]), panels.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: &str = "time,step,total.mass,total.kinetic,total.internal,total.momentum_x\n\
                     0.0,0,2.0,1.0,0.0,1e-17\n1.0,1,2.0,0.5,0.5,3e-17\n";

    #[test]
    fn round_off_is_no_difference_and_a_change_is() {
        let a = Ledger::of(A).expect("a ledger");
        let noise = A.replace("3e-17", "-4e-17").replace("1.0,1,", "1.0,7,");
        let noise = Ledger::of(&noise).expect("a ledger");
        assert!(histories([&a, &noise], 1.0).iter().all(|d| !d.matters()));
        let other = Ledger::of(&A.replace("0.5,0.5", "0.4,0.6")).expect("a ledger");
        let found = histories([&a, &other], 1.0);
        let moved: Vec<&str> =
            found.iter().filter(|d| d.matters()).map(|d| d.name.as_str()).collect();
        assert_eq!(moved.len(), 2, "{moved:?}");
        assert!((found[0].relative - 0.1).abs() < 1e-12 && found[0].time == Some(1.0));
    }

    #[test]
    fn what_one_run_alone_has_matters() {
        assert!(Difference::new("a", [1.0, f64::NAN], 1.0).matters());
        assert!(!Difference::new("a", [f64::NAN; 2], 1.0).matters());
        assert!(!Difference::new("a", [0.0; 2], 0.0).matters());
        assert!(Difference::new("a", [1.0, 1.0 + 1e-6], 1.0).matters());
    }
}
