//! What figures of cases share: the histories or profiles of runs as curves of a panel.

use crate::plots::{Figure, Layer, Panel, Point, Series as Curve};
use crate::record::{Records, RunKey, RunRecord, Series};

/// The histories of the runs that have one, with the names of the runs.
pub(super) fn histories<N: Into<String>>(
    records: &Records,
    runs: impl IntoIterator<Item = (N, RunKey)>,
) -> Vec<(String, &Series)> {
    series(records, runs, |record| record.history.as_ref())
}

/// The profiles of the runs that have one, with the names of the runs.
pub(super) fn profiles<N: Into<String>>(
    records: &Records,
    runs: impl IntoIterator<Item = (N, RunKey)>,
) -> Vec<(String, &Series)> {
    series(records, runs, |record| record.profile.as_ref())
}

fn series<N: Into<String>>(
    records: &Records,
    runs: impl IntoIterator<Item = (N, RunKey)>,
    of: fn(&RunRecord) -> Option<&Series>,
) -> Vec<(String, &Series)> {
    let found = |(name, key): (N, RunKey)| Some((name.into(), of(records.get(&key)?)?));
    runs.into_iter().filter_map(found).collect()
}

/// One column of every run over another.
pub(super) fn over<'a>(
    runs: &'a [(String, &Series)],
    x: &'a str,
    y: &'a str,
) -> impl Iterator<Item = (String, Vec<Point>)> + 'a {
    runs.iter().map(move |(name, series)| (name.clone(), series.points(x, y)))
}

/// A panel with a line for every run; none if there is no run.
pub(super) fn curves(
    panel: Panel,
    runs: impl IntoIterator<Item = (String, Vec<Point>)>,
) -> Option<Panel> {
    let mut runs = runs.into_iter().peekable();
    runs.peek()?;
    Some(runs.fold(panel, |panel, (name, points)| panel.with(Curve::line(name, points))))
}

/// One column of every run over another, beside the exact field over the range that they take.
pub(super) fn beside_exact<E>(
    panel: Panel,
    runs: &[(String, &Series)],
    [x, y]: [&str; 2],
    name: &str,
    field: impl Fn(f64) -> Result<f64, E>,
) -> Option<Panel> {
    let panel = curves(panel, over(runs, x, y))?;
    Some(panel.with(exact_line(name, extent(runs, x), field)))
}

/// Least and greatest number of a column of all runs.
pub(super) fn extent(runs: &[(String, &Series)], column: &str) -> Point {
    let all = runs.iter().filter_map(|(_, series)| series.0.get(column)).flatten();
    all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
}

/// Intervals of a range in which an exact field is looked at first.
const INTERVALS: usize = 200;
/// How often one of them is halved at most.
const HALVINGS: u32 = 7;
/// How far a field may lie off the line between two points, over its range.
const NEAR: f64 = 1e-3;

/// An exact field at points of its own, as close as it bends and jumps; left out where it has no value.
pub(super) fn exact_line<E>(
    name: &str,
    (from, to): Point,
    field: impl Fn(f64) -> Result<f64, E>,
) -> Layer {
    let at = |x: f64| field(x).ok().map(|y| (x, y));
    let step = (to - from) / INTERVALS as f64;
    let coarse: Vec<Point> = (0..=INTERVALS).filter_map(|k| at(from + step * k as f64)).collect();
    let heights = coarse.iter().map(|p| p.1);
    let (low, high) = heights
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    let mut points = Vec::new();
    for pair in coarse.windows(2) {
        points.push(pair[0]);
        halve(&at, [pair[0], pair[1]], (NEAR * (high - low), HALVINGS), &mut points);
    }
    points.extend(coarse.last());
    Layer::exact(name, points)
}

/// Adds points between two until their lines are near enough, or were halved often enough.
fn halve(
    at: &impl Fn(f64) -> Option<Point>,
    [a, b]: [Point; 2],
    (near, times): (f64, u32),
    points: &mut Vec<Point>,
) {
    let Some(middle) = at(0.5 * (a.0 + b.0)) else { return };
    if times == 0 || (middle.1 - 0.5 * (a.1 + b.1)).abs() <= near {
        return;
    }
    halve(at, [a, middle], (near, times - 1), points);
    points.push(middle);
    halve(at, [middle, b], (near, times - 1), points);
}

/// The largest of a curve about each of its points, as many points to either side.
pub(super) fn envelope(points: &[Point], reach: usize) -> Vec<Point> {
    let about = |k: usize| &points[k.saturating_sub(reach)..(k + reach + 1).min(points.len())];
    let largest = |k: usize| about(k).iter().map(|p| p.1).fold(f64::NEG_INFINITY, f64::max);
    (0..points.len()).map(|k| (points[k].0, largest(k))).collect()
}

/// A figure of the panels that there are; none without a panel.
pub(super) fn figure(
    id: impl Into<String>,
    caption: &str,
    panels: impl IntoIterator<Item = Panel>,
) -> Vec<Figure> {
    let panels: Vec<Panel> = panels.into_iter().collect();
    if panels.is_empty() { Vec::new() } else { vec![Figure::new(id, caption, panels)] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(layer: Layer) -> Vec<Point> {
        match layer {
            Layer::Exact { points, .. } => points,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn jumps_of_exact_fields_stand_upright() {
        let step = |x: f64| if x < 0.0 { Err(()) } else { Ok(if x < 0.3137 { 4.0 } else { 1.0 }) };
        let points = points(exact_line("exact", (-0.5, 1.5), step));
        assert!(points.iter().all(|p| p.0 >= 0.0) && points.len() < 250);
        let jump = points.windows(2).find(|w| w[0].1 != w[1].1).map(|w| [w[0].0, w[1].0]);
        let [before, after] = jump.unwrap();
        assert!(before < 0.3137 && 0.3137 <= after && after - before < 1e-4, "{before} {after}");
    }

    #[test]
    fn straight_fields_need_no_more_points() {
        let line = |x: f64| Ok::<_, ()>(2.0 * x);
        assert_eq!(points(exact_line("exact", (0.0, 1.0), line)).len(), INTERVALS + 1);
        let bent = |x: f64| Ok::<_, ()>((400.0 * x).sin());
        assert!(points(exact_line("exact", (0.0, 1.0), bent)).len() > 2 * INTERVALS);
    }

    #[test]
    fn envelopes_lie_on_the_crests() {
        let wave: Vec<Point> = [0.0, 2.0, 0.0, 1.0, 0.0].into_iter().map(|y| (y, y)).collect();
        let heights: Vec<f64> = envelope(&wave, 1).into_iter().map(|p| p.1).collect();
        assert_eq!(heights, [2.0, 2.0, 2.0, 1.0, 1.0]);
    }
}
