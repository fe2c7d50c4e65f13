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

/// The same with the exact column of the last run, of which every run has its own.
pub(super) fn beside_exact(
    panel: Panel,
    runs: &[(String, &Series)],
    [x, y, exact]: [&str; 3],
    name: &str,
) -> Option<Panel> {
    let (_, last) = runs.last()?;
    let panel = curves(panel, over(runs, x, y))?;
    Some(panel.with(Layer::exact(name, last.points(x, exact))))
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
