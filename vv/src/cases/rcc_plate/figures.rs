//! Figures of the histories and of the fragments.

use super::claims::{EQUATION, angles, nasa};
use super::problem::{ID, SIZES, degrees};
use crate::cases::{default_run, figures};
use crate::plots::{Axis, Figure, Layer, Panel, Point, Series as Curve};
use crate::record::{Records, RunKey};
use crate::report::sig;

/// All figures, of what the records have.
pub(super) fn all(records: &Records) -> Vec<Figure> {
    [holes(records), clouds(records), fragments(records)].into_iter().flatten().collect()
}

/// The angles, by name.
fn by_angle() -> impl Iterator<Item = (String, RunKey)> {
    angles().into_iter().map(|key| (format!("{}°", sig(degrees(&key.variant), 2)), key))
}

/// The sizes, by name.
fn by_size() -> impl Iterator<Item = (String, RunKey)> {
    SIZES.into_iter().map(|n| (format!("n = {n}"), default_run(ID, n)))
}

/// A column of the histories of some runs over time.
fn over_time(
    records: &Records,
    runs: impl Iterator<Item = (String, RunKey)>,
    [title, column, label]: [&str; 3],
) -> Option<Panel> {
    let runs = figures::histories(records, runs);
    let panel = Panel::new(title, Axis::linear("time, µs"), Axis::linear(label));
    figures::curves(panel, figures::over(&runs, "time", column))
}

/// The hole over time, by angle and by size.
fn holes(records: &Records) -> Option<Figure> {
    let axis = "diameter of the hole, cm";
    let angles = over_time(records, by_angle(), ["four angles, n = 4", "hole", axis])?;
    let angles = by_angle().fold(angles, |panel, (name, key)| {
        panel.with(Layer::horizontal(nasa(&key.variant), format!("equation, {name}")))
    });
    let sizes = over_time(records, by_size(), ["45°, three sizes", "hole", axis])?;
    let sizes = sizes.with(Layer::horizontal(nasa(""), EQUATION));
    let caption = "Diameter of the hole over time, `default`, by angle and by cells through the plate. \
                   Level lines: NASA's equation, of the hole that is left.";
    Some(Figure::new("rcc-plate-hole", caption, vec![angles, sizes]))
}

/// What is behind the plate over time.
fn clouds(records: &Records) -> Option<Figure> {
    let plate =
        over_time(records, by_angle(), ["", "plate_behind", "mass of the plate behind, g"])?;
    let front = over_time(records, by_angle(), ["", "front", "front of the cloud, km/s"])?;
    let caption = "Behind the plate, four angles, n = 4, `default`: mass of the plate, and the velocity \
                   along the normal than which a hundredth of all mass behind is faster.";
    Some(Figure::new("rcc-plate-cloud", caption, vec![plate, front]))
}

/// How many fragments are at least so heavy.
fn fragments(records: &Records) -> Option<Figure> {
    let runs = figures::profiles(records, by_size());
    let axes = |title: &str| {
        Panel::new(title, Axis::log("mass, g"), Axis::log("fragments at least so heavy"))
    };
    // There is no logarithm of none.
    let counts = |column: &'static str| {
        figures::over(&runs, "fragment", column)
            .map(|(name, points)| (name, points.into_iter().filter(|p| p.1 > 0.0).collect()))
            .filter(|(_, points): &(String, Vec<_>)| !points.is_empty())
    };
    let panels = [("sphere", "sphere_fragments"), ("plate", "plate_fragments")];
    let panel = |(title, column)| {
        let mut panel = None;
        for (name, points) in counts(column) {
            let drawn = panel
                .unwrap_or_else(|| axes(title))
                .with(Curve::line(name.clone(), steps(&points)));
            panel = Some(drawn.with(Curve::scatter(name, drops(&points))));
        }
        panel
    };
    let panels: Vec<Panel> = panels.into_iter().filter_map(panel).collect();
    let caption = "Fragments of sphere and plate at 10 µs: connected live elements that have not failed, \
                   without what is left of the plate; three sizes, 45 degrees, `default`. Masses are counted in doublings from that of \
                   half a cell on; a marker stands at each that some fragments have. A panel or size that is missing \
                   has none. Particles in no such element are dust, most of the debris.";
    (!panels.is_empty()).then(|| Figure::new("rcc-plate-fragments", caption, panels))
}

/// How many are at least so heavy, as stairs: the number stays until the mass of the next drop.
fn steps(points: &[Point]) -> Vec<Point> {
    let stairs = points.windows(2).flat_map(|pair| [pair[0], (pair[0].0, pair[1].1)]);
    stairs.chain(points.last().copied()).collect()
}

/// The masses that some fragments have: where fewer are heavier.
fn drops(points: &[Point]) -> Vec<Point> {
    let next = points.iter().skip(1).map(|point| point.1).chain([0.0]);
    points
        .iter()
        .zip(next)
        .filter(|(point, next)| point.1 > *next)
        .map(|(point, _)| *point)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three fragments: one of the second mass, two of the fourth.
    #[test]
    fn fragments_are_stairs_with_a_marker_for_each_mass() {
        let counts = [(1.0, 3.0), (2.0, 3.0), (4.0, 2.0), (8.0, 2.0)];
        let wanted =
            [(1.0, 3.0), (1.0, 3.0), (2.0, 3.0), (2.0, 2.0), (4.0, 2.0), (4.0, 2.0), (8.0, 2.0)];
        assert_eq!(steps(&counts), wanted);
        assert_eq!(drops(&counts), [(2.0, 3.0), (8.0, 2.0)]);
        let one = [(1.0, 1.0)];
        assert_eq!((steps(&one), drops(&one)), (one.to_vec(), one.to_vec()));
    }
}
