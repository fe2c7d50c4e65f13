//! Figures of a sweep and of the search for a limit.

use crate::cli::Failure;
use crate::plots::{Axis, Figure, Layer, Panel, Series, render_svg, svg_to_png};

/// Pixels of the PNG figure over those of the SVG.
const SCALE: f32 = 2.0;

/// Most panels of a figure.
const PANELS: usize = 4;

/// Least change of a finding over its size that counts as one.
const CHANGES: f64 = 1e-6;

/// Runs of a sweep as numbers: the key along which they are drawn, and what was found.
pub(super) struct Sweep {
    /// Name of the key with its unit.
    pub key: String,
    /// Of each run its place along the key, what the other keys are, and its findings in the order of `names`.
    pub runs: Vec<(f64, String, Vec<Option<f64>>)>,
    /// Names of the findings, and what they are with their units.
    pub names: Vec<[String; 2]>,
}

/// The figure of a sweep: of these findings, or of the first that change over it. None where nothing does.
pub(super) fn sweep(sweep: &Sweep, wanted: &[String]) -> Option<Figure> {
    let values = |k: usize| sweep.runs.iter().filter_map(move |run| run.2[k]);
    let changes = |k: &usize| {
        let (low, high) = values(*k)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        high - low > CHANGES * high.abs().max(low.abs())
    };
    let all = 0..sweep.names.len();
    let chosen: Vec<usize> = if wanted.is_empty() {
        all.filter(changes).take(PANELS).collect()
    } else {
        all.filter(|&k| wanted.contains(&sweep.names[k][0])).take(PANELS).collect()
    };
    let mut lines: Vec<&String> = sweep.runs.iter().map(|run| &run.1).collect();
    lines.sort();
    lines.dedup();
    let panels: Vec<Panel> = chosen
        .into_iter()
        .map(|k| {
            let panel = Panel::new("", Axis::linear(&sweep.key), Axis::linear(&sweep.names[k][1]));
            lines.iter().fold(panel, |panel, &line| {
                let own = sweep.runs.iter().filter(|run| run.1 == *line);
                let mut points: Vec<(f64, f64)> =
                    own.filter_map(|run| Some((run.0, run.2[k]?))).collect();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                let name = if line.is_empty() { "runs" } else { line };
                panel.with(Series::marked(name, points))
            })
        })
        .collect();
    let caption = format!("Findings of the runs of a sweep over {}.", sweep.key);
    (!panels.is_empty()).then(|| Figure::new("sweep", caption, panels))
}

/// The figure of a search: its runs in their order, and the middle of what is left.
pub(super) fn limit(key: &str, runs: &[(f64, bool)], middle: f64) -> Figure {
    let of = |wanted: bool| {
        let points = runs.iter().enumerate().filter(move |(_, run)| run.1 == wanted);
        points.map(|(k, run)| ((k + 1) as f64, run.0)).collect::<Vec<_>>()
    };
    let panel = Panel::new("", Axis::linear("run"), Axis::linear(key))
        .with(Series::scatter("met", of(true)))
        .with(Series::scatter("not met", of(false)))
        .with(Layer::horizontal(middle, "middle of the last two"));
    Figure::new("limit", format!("Search for the limit of {key} by halves."), vec![panel])
}

/// A figure as files: SVG and PNG.
pub(super) fn files(figure: &Figure) -> Result<[(String, Vec<u8>); 2], Failure> {
    let svg = render_svg(figure).map_err(Failure::usage)?;
    let png = svg_to_png(&svg, SCALE).map_err(Failure::usage)?;
    let name = |end: &str| format!("{}.{end}", figure.id);
    Ok([(name("svg"), svg.into_bytes()), (name("png"), png)])
}
