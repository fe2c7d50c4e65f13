//! Where everything goes: ranges, ticks and frames of the panels, and the place of the legends.

use super::PlotError;
use super::axes::{self, Mapping, Ticks, drawable};
use super::canvas::{HPos, Label, VPos};
use super::guides::{Frame, Obstacles, Slope, pixels};
use super::legend::{self, Entry, Strip};
use super::model::{Along, Axis, Figure, Layer, Panel, Point};
use super::style::AXIS;

/// Size of tick labels.
pub(super) const TICK: f64 = 11.0;
/// Size of axis labels.
pub(super) const LABEL: f64 = 12.0;
/// Height below a frame for tick labels and the axis label.
const FOOT: f64 = 48.0;
/// Room right of a frame for half a tick label.
const RIGHT: f64 = 22.0;

/// A panel with everything decided but the legend.
pub(super) struct Plot<'a> {
    /// What is drawn.
    pub(super) panel: &'a Panel,
    /// Horizontal and vertical mapping.
    pub(super) map: (Mapping, Mapping),
    /// Horizontal and vertical ticks.
    pub(super) ticks: (Ticks, Ticks),
    /// The coordinate frame.
    pub(super) frame: Frame,
    /// Left edge of the panel with its labels.
    pub(super) left: f64,
    /// Slope guides.
    pub(super) slopes: Vec<Slope>,
    /// Number of points that cannot be drawn.
    pub(super) skipped: usize,
    /// Nothing at all to draw.
    pub(super) empty: bool,
    /// Where its own legend stands, if it has one.
    pub(super) legend: Option<Frame>,
    /// Pixels covered by data, reference lines and texts.
    pub(super) obstacles: Obstacles,
}

/// A figure laid out.
pub(super) struct Layout<'a> {
    /// The panels in reading order.
    pub(super) plots: Vec<Plot<'a>>,
    /// Width and height.
    pub(super) size: Point,
    /// Common legend below the panels, and its top.
    pub(super) strip: Option<(Strip<'a>, f64)>,
}

impl<'a> Layout<'a> {
    /// Lays out a figure.
    pub(super) fn new(figure: &'a Figure) -> Result<Self, PlotError> {
        let (columns, (width, height)) = match figure.panels.len() {
            1 => (1, (680.0, 420.0)),
            2 => (2, (480.0, 370.0)),
            3 => (3, (360.0, 330.0)),
            _ => (2, (480.0, 310.0)),
        };
        let drafts: Vec<Draft> =
            figure.panels.iter().map(|p| Draft::new(p, (width, height))).collect();
        let margins: Vec<f64> = drafts.iter().map(Draft::margin).collect::<Result<_, _>>()?;
        let mut plots: Vec<Plot> = (0..)
            .zip(drafts)
            .map(|(i, draft): (usize, Draft)| {
                // Frames of one column share their left edge.
                let column = margins.iter().skip(i % columns).step_by(columns);
                let margin = column.copied().fold(0.0, f64::max);
                let (left, top) = ((i % columns) as f64 * width, (i / columns) as f64 * height);
                let title = if draft.headed() { 32.0 } else { 14.0 };
                let frame = Frame {
                    left: left + margin,
                    top: top + title,
                    right: left + width - RIGHT,
                    bottom: top + height - FOOT,
                };
                draft.finish(frame, left)
            })
            .collect();
        let rows = figure.panels.len().div_ceil(columns);
        let (width, height) = (width * columns as f64, height * rows as f64);
        let entries: Vec<Vec<Entry>> = plots.iter().map(|p| legend::entries([p.panel])).collect();
        let places =
            plots.iter().zip(&entries).map(|(p, e)| legend::place(e, p.frame, &p.obstacles));
        let places = places.collect::<Result<Vec<_>, _>>()?;
        // One legend below the panels serves all if they share it, or if it would cover data.
        let shared = entries.len() > 1
            && entries[0].len() > 1
            && entries.iter().all(|other| legend::same(other, &entries[0]));
        let covers = places.iter().zip(&entries).any(|(p, e)| p.is_none() && !e.is_empty());
        let strip = if shared || covers {
            Some((Strip::new(legend::entries(&figure.panels), width - 40.0)?, height + 2.0))
        } else {
            for (plot, place) in plots.iter_mut().zip(places) {
                place.into_iter().for_each(|place| plot.obstacles.taken(place));
                plot.legend = place;
            }
            None
        };
        let foot = strip.as_ref().map_or(0.0, |(strip, _)| strip.height() + 4.0);
        Ok(Self { plots, size: (width, height + foot), strip })
    }
}

/// A panel before its frame is known.
struct Draft<'a> {
    panel: &'a Panel,
    size: Point,
    ranges: (Point, Point),
    ticks: (Ticks, Ticks),
    slopes: Vec<Slope>,
    skipped: usize,
    empty: bool,
}

impl<'a> Draft<'a> {
    fn new(panel: &'a Panel, size: Point) -> Self {
        let slopes = Slope::all(panel);
        let mut values = (Vec::new(), Vec::new());
        let mut skipped = 0;
        for layer in &panel.layers {
            for (x, y) in extremes(layer) {
                let fits = |axis: &Axis, v: Option<f64>| v.is_none_or(|v| drawable(axis.scale, v));
                match fits(&panel.x, x) && fits(&panel.y, y) {
                    true => {
                        values.0.extend(x);
                        values.1.extend(y);
                    }
                    false => skipped += 1,
                }
            }
            values.1.extend(error_ends(layer));
        }
        for slope in &slopes {
            values.0.extend(slope.path.iter().map(|p| p.0));
            // A little more below, for the label of the base.
            values.1.extend(slope.path.iter().flat_map(|p| [p.1, 0.7 * p.1]));
        }
        let least = values.0.iter().copied().fold(f64::INFINITY, f64::min);
        let empty = values.0.is_empty() && values.1.is_empty();
        let mut ranges = (
            axes::range(&panel.x, values.0.into_iter()),
            axes::range(&panel.y, values.1.into_iter()),
        );
        // A position or time that starts at zero starts at the frame.
        if panel.x.range.is_none() && least >= 0.0 && ranges.0.0 < 0.0 {
            ranges.0.0 = 0.0;
        }
        let ticks = ticks(panel, ranges, size);
        Self { panel, size, ranges, ticks, slopes, skipped, empty }
    }

    /// Room for the labels of the vertical axis.
    fn margin(&self) -> Result<f64, PlotError> {
        let lengths = self.ticks.1.major.iter().map(|t| tick_label(&t.label).length());
        let longest = lengths.collect::<Result<Vec<_>, _>>()?.into_iter().fold(0.0, f64::max);
        Ok(longest + 15.0 + if self.panel.y.label.is_empty() { 0.0 } else { 2.0 * LABEL })
    }

    /// Whether there is anything above the frame.
    fn headed(&self) -> bool {
        !self.panel.title.is_empty() || self.ticks.1.factor.is_some() || self.skipped > 0
    }

    fn finish(mut self, frame: Frame, left: f64) -> Plot<'a> {
        if self.panel.equal {
            self.ranges = equalised(self.ranges, frame);
            self.ticks = ticks(self.panel, self.ranges, self.size);
        }
        let map = (
            Mapping::new(self.panel.x.scale, self.ranges.0, (frame.left, frame.right)),
            Mapping::new(self.panel.y.scale, self.ranges.1, (frame.bottom, frame.top)),
        );
        let mut obstacles = Obstacles::default();
        for layer in &self.panel.layers {
            block(&mut obstacles, layer, map, frame);
        }
        for piece in self.slopes.iter().flat_map(|s| frame.clip(&pixels(&s.path, map))) {
            obstacles.line(&piece);
        }
        let Self { panel, ticks, slopes, skipped, empty, .. } = self;
        Plot { panel, map, ticks, frame, left, slopes, skipped, empty, legend: None, obstacles }
    }
}

/// Ticks of both axes of a panel of a size.
fn ticks(panel: &Panel, ranges: (Point, Point), (width, height): Point) -> (Ticks, Ticks) {
    (
        axes::ticks(panel.x.scale, ranges.0, (width / 70.0) as usize),
        axes::ticks(panel.y.scale, ranges.1, (height / 48.0) as usize),
    )
}

/// Ranges of which one is widened about its middle, so that a unit is as long on either axis.
fn equalised((x, y): (Point, Point), frame: Frame) -> (Point, Point) {
    let (width, height) = (frame.right - frame.left, frame.bottom - frame.top);
    let unit = ((x.1 - x.0) / width).max((y.1 - y.0) / height);
    let widened = |range: Point, length: f64| {
        let (middle, half) = (0.5 * (range.0 + range.1), 0.5 * unit * length);
        (middle - half, middle + half)
    };
    (widened(x, width), widened(y, height))
}

/// A tick label of the vertical axis.
pub(super) fn tick_label(text: &str) -> Label<'_> {
    Label::new(text, TICK, AXIS, (HPos::Right, VPos::Center))
}

/// The coordinates of a layer which its panel should show.
fn extremes(layer: &Layer) -> Vec<(Option<f64>, Option<f64>)> {
    let both = |(x, y): &Point| (Some(*x), Some(*y));
    let across = |along: &Along, v: f64| match along {
        Along::Horizontal => (None, Some(v)),
        Along::Vertical => (Some(v), None),
    };
    match layer {
        Layer::Series(series) => series.points.iter().map(both).collect(),
        Layer::Exact { points, .. } => points.iter().map(both).collect(),
        Layer::Rule { along, at, .. } => vec![across(along, *at)],
        Layer::Span { along, limits, .. } => vec![across(along, limits.0), across(along, limits.1)],
        Layer::Band { edges, .. } => edges
            .iter()
            .flat_map(|(x, a, b)| [(Some(*x), Some(*a)), (Some(*x), Some(*b))])
            .collect(),
        Layer::Note { at, .. } => vec![both(at)],
        Layer::Slope { .. } => Vec::new(),
    }
}

/// The ordinates of the ends of error bars.
pub(super) fn error_ends(layer: &Layer) -> Vec<f64> {
    let Layer::Series(series) = layer else {
        return Vec::new();
    };
    let bars = series.points.iter().zip(&series.errors);
    bars.flat_map(|((_, y), (minus, plus))| [y - minus, y + plus]).collect()
}

/// Marks the pixels of a layer as taken.
fn block(obstacles: &mut Obstacles, layer: &Layer, map: (Mapping, Mapping), frame: Frame) {
    let mut line = |points: &[Point]| {
        for piece in frame.clip(&pixels(points, map)) {
            obstacles.line(&piece);
        }
    };
    match layer {
        Layer::Series(series) if series.line.is_some() => line(&series.points),
        Layer::Exact { points, .. } => line(points),
        Layer::Band { edges, .. } => {
            line(&edges.iter().map(|e| (e.0, e.1)).collect::<Vec<_>>());
            line(&edges.iter().map(|e| (e.0, e.2)).collect::<Vec<_>>());
        }
        Layer::Rule { along, at, .. } => {
            if let Some((a, b)) = rule(*along, *at, map, frame) {
                obstacles.line(&[a, b]);
            }
        }
        _ => {}
    }
    let single: &[Point] = match layer {
        Layer::Series(series) => &series.points,
        Layer::Note { at, .. } => std::slice::from_ref(at),
        _ => &[],
    };
    for at in pixels(single, map).into_iter().flatten().filter(|p| frame.holds(*p)) {
        // A marker is about as wide as this cross.
        obstacles.line(&[(at.0 - 4.0, at.1), (at.0 + 4.0, at.1)]);
        obstacles.line(&[(at.0, at.1 - 4.0), (at.0, at.1 + 4.0)]);
    }
    if let Layer::Series(series) = layer {
        for ((x, y), (minus, plus)) in series.points.iter().zip(&series.errors) {
            let ends = pixels(&[(*x, y - minus), (*x, y + plus)], map);
            frame.clip(&ends).iter().for_each(|piece| obstacles.line(piece));
        }
    }
}

/// The ends of a straight reference line, if it is inside the frame.
pub(super) fn rule(
    along: Along,
    at: f64,
    (x, y): (Mapping, Mapping),
    frame: Frame,
) -> Option<(Point, Point)> {
    let ends = match along {
        Along::Horizontal => y.at(at).map(|y| ((frame.left, y), (frame.right, y))),
        Along::Vertical => x.at(at).map(|x| ((x, frame.bottom), (x, frame.top))),
    };
    ends.filter(|(a, b)| frame.holds(*a) && frame.holds(*b))
}
