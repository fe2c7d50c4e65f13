//! Geometry in and around the frame: clipping of lines, slope guides, room for labels.

use super::axes::{Mapping, drawable};
use super::model::{Layer, Panel, Point, Scale, SlopeShape};

/// A rectangle in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Frame {
    /// Whether a pixel lies inside or on the edge.
    pub(super) fn holds(&self, (x, y): Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    /// The frame reduced by a margin on all sides.
    pub(super) fn shrunk(&self, by: f64) -> Self {
        Self {
            left: self.left + by,
            top: self.top + by,
            right: self.right - by,
            bottom: self.bottom - by,
        }
    }

    /// The visible pieces of a line; points that cannot be drawn interrupt it.
    pub(super) fn clip(&self, line: &[Option<Point>]) -> Vec<Vec<Point>> {
        let mut pieces: Vec<Vec<Point>> = Vec::new();
        for pair in line.windows(2) {
            let (Some(a), Some(b)) = (pair[0], pair[1]) else {
                continue;
            };
            let Some((from, to)) = self.cut(a, b) else {
                continue;
            };
            match pieces.last_mut() {
                Some(piece) if piece.last() == Some(&from) => piece.push(to),
                _ => pieces.push(vec![from, to]),
            }
        }
        pieces
    }

    /// The part of a straight line inside the frame (Liang and Barsky).
    fn cut(&self, a: Point, b: Point) -> Option<(Point, Point)> {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let sides = [
            (-dx, a.0 - self.left),
            (dx, self.right - a.0),
            (-dy, a.1 - self.top),
            (dy, self.bottom - a.1),
        ];
        for (speed, room) in sides {
            match speed {
                s if s < 0.0 => enter = enter.max(room / s),
                s if s > 0.0 => leave = leave.min(room / s),
                _ if room < 0.0 => return None,
                _ => {}
            }
        }
        let at = |t: f64| match t {
            0.0 => a,
            1.0 => b,
            t => (a.0 + t * dx, a.1 + t * dy),
        };
        (enter <= leave).then(|| (at(enter), at(leave)))
    }
}

/// What labels and legends should not cover.
#[derive(Default)]
pub(super) struct Obstacles(Vec<Point>);

impl Obstacles {
    /// Adds a line, sampled every few pixels.
    pub(super) fn line(&mut self, line: &[Point]) {
        for pair in line.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let steps = ((b.0 - a.0).hypot(b.1 - a.1) / 3.0).ceil().max(1.0);
            let at = |i: i32| f64::from(i) / steps;
            let point = |t: f64| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
            self.0.extend((0..=steps as i32).map(|i| point(at(i))));
        }
    }

    /// Adds a rectangle that is taken.
    pub(super) fn taken(&mut self, f: Frame) {
        let rows = ((f.bottom - f.top) / 4.0) as i32;
        for y in (0..=rows).map(|i| f.top + 4.0 * f64::from(i)) {
            self.line(&[(f.left, y), (f.right, y)]);
        }
    }

    /// How much of it a rectangle would cover.
    pub(super) fn hits(&self, frame: Frame) -> usize {
        self.0.iter().filter(|p| frame.holds(**p)).count()
    }

    /// The first of the candidates that covers least.
    pub(super) fn freest(&self, candidates: impl IntoIterator<Item = Frame>) -> Option<Frame> {
        candidates.into_iter().min_by_key(|c| self.hits(*c))
    }
}

/// A slope guide in data coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Slope {
    /// Vertices of the line or closed triangle.
    pub(super) path: Vec<Point>,
    /// The corner at the right angle, or the end of a line.
    pub(super) corner: Point,
    /// The exponent.
    pub(super) order: f64,
    /// Its form.
    pub(super) shape: SlopeShape,
}

impl Slope {
    /// All slope guides of a panel, kept below its series and out of each other's way.
    pub(super) fn all(panel: &Panel) -> Vec<Self> {
        let series: Vec<Vec<Point>> = panel.layers.iter().filter_map(logarithms).collect();
        let guides = panel.layers.iter().filter_map(|layer| match layer {
            Layer::Slope { order, shape, anchor } => Some((*order, *shape, *anchor)),
            _ => None,
        });
        guides.enumerate().filter_map(|(i, guide)| Self::place(i, guide, &series)).collect()
    }

    fn place(
        index: usize,
        (order, shape, anchor): (f64, SlopeShape, Option<Point>),
        series: &[Vec<Point>],
    ) -> Option<Self> {
        let (x, y) = (extent(series, |p| p.0), extent(series, |p| p.1));
        let (wide, high) = (x.map_or(1.0, |(a, b)| b - a), y.map_or(1.0, |(a, b)| b - a));
        let (start, width) = match shape {
            SlopeShape::Line => (0.0, wide),
            SlopeShape::Triangle => {
                let fit = 0.35 * high / order.abs().max(1e-9);
                ([0.56, 0.3, 0.06][index % 3] * wide, (0.22 * wide).min(fit.max(0.08 * wide)))
            }
        };
        let anchor = anchor.filter(|a| a.0 > 0.0 && a.1 > 0.0).map(|a| (a.0.log10(), a.1.log10()));
        let (a, foot) = match (shape, anchor) {
            (SlopeShape::Triangle, Some(anchor)) => anchor,
            (SlopeShape::Line, Some(anchor)) => {
                let a = x.map_or(anchor.0, |x| x.0);
                (a, anchor.1 + order * (a - anchor.0))
            }
            (_, None) => {
                let a = x?.0 + start;
                (a, below(series, order, (a, a + width))? - 0.08 * high.max(0.5))
            }
        };
        let (b, top) = (a + width, foot + order * width);
        let corner = if order < 0.0 { (a, top) } else { (b, foot) };
        let path = match shape {
            SlopeShape::Line => vec![(a, foot), (b, top)],
            SlopeShape::Triangle => vec![(a, foot), (b, top), corner, (a, foot)],
        };
        let corner = if shape == SlopeShape::Line { (b, top) } else { corner };
        let raise = |p: Point| (10f64.powf(p.0), 10f64.powf(p.1));
        Some(Self {
            path: path.into_iter().map(raise).collect(),
            corner: raise(corner),
            order,
            shape,
        })
    }

    /// The exponent as text.
    pub(super) fn text(&self) -> String {
        let text = format!("{:.2}", self.order);
        text.trim_end_matches('0').trim_end_matches('.').replace('-', "−")
    }
}

/// The drawable points of a series as logarithms, by increasing abscissa.
fn logarithms(layer: &Layer) -> Option<Vec<Point>> {
    let Layer::Series(series) = layer else {
        return None;
    };
    let fits = |p: &&Point| drawable(Scale::Log10, p.0) && drawable(Scale::Log10, p.1);
    let points = series.points.iter().filter(fits).map(|p| (p.0.log10(), p.1.log10()));
    let mut points: Vec<Point> = points.collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    (!points.is_empty()).then_some(points)
}

fn extent(series: &[Vec<Point>], pick: impl Fn(&Point) -> f64) -> Option<(f64, f64)> {
    let values = || series.iter().flatten().map(&pick);
    Some((values().reduce(f64::min)?, values().reduce(f64::max)?))
}

/// Ordinate at the left end of a window of the line of given slope that touches the data there
/// from below.
fn below(series: &[Vec<Point>], slope: f64, (from, to): (f64, f64)) -> Option<f64> {
    let mut heights = Vec::new();
    for pair in series.iter().flat_map(|points| points.windows(2)) {
        let (a, b) = (pair[0], pair[1]);
        for x in (0..=8).map(|i| from + (to - from) * f64::from(i) / 8.0) {
            if b.0 > a.0 && (a.0 - 1e-9..=b.0 + 1e-9).contains(&x) {
                let y = a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0);
                heights.push(y - slope * (x - from));
            }
        }
    }
    let alone = || series.iter().flatten().map(|p| p.1 - slope * (p.0 - from)).reduce(f64::min);
    heights.into_iter().reduce(f64::min).or_else(alone)
}

/// Maps data points to pixels.
pub(super) fn pixels(points: &[Point], (x, y): (Mapping, Mapping)) -> Vec<Option<Point>> {
    points.iter().map(|p| Some((x.at(p.0)?, y.at(p.1)?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::{Axis, Series};

    const FRAME: Frame = Frame { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };

    #[test]
    fn lines_are_cut_at_the_frame_and_at_gaps() {
        let line = [Some((-5.0, 5.0)), Some((5.0, 5.0)), None, Some((5.0, 2.0)), Some((5.0, 20.0))];
        let pieces = FRAME.clip(&line);
        assert_eq!(pieces, [[(0.0, 5.0), (5.0, 5.0)], [(5.0, 2.0), (5.0, 10.0)]]);
        assert!(FRAME.clip(&[Some((-1.0, -1.0)), Some((11.0, -1.0))]).is_empty());
    }

    #[test]
    fn triangles_stay_below_the_data() {
        let data = vec![(1.0, 1.0), (10.0, 0.1), (100.0, 0.01)];
        let panel = Panel::new("", Axis::log("n"), Axis::log("e"))
            .with(Series::marked("a", data))
            .with(Layer::slope(-1.0));
        for (x, y) in Slope::all(&panel).remove(0).path {
            assert!(y < 0.9 / x, "{x} {y}");
        }
    }
}
