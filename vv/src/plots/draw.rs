//! Draws a laid-out panel, from the back to the front.

use super::PlotError;
use super::canvas::{Canvas, HPos, Label, Pen, VPos};
use super::guides::{Frame, Slope, pixels};
use super::layout::{LABEL, Plot, TICK, rule, tick_label};
use super::legend::{self, Slots};
use super::model::{Along, Layer, Point, Series, SlopeShape};
use super::style::{self, AXIS, GRID, INK, MUTED, SHADE};

const SMALL: f64 = 10.5;

type Drawn = Result<(), PlotError>;

/// Draws a panel, with its legend unless that stands below the panels.
pub(super) fn panel(canvas: &Canvas, plot: &mut Plot, slots: &Slots) -> Drawn {
    axes(canvas, plot)?;
    let layers = &plot.panel.layers;
    layers.iter().try_for_each(|layer| shades(canvas, plot, slots, layer))?;
    layers.iter().try_for_each(|layer| rules(canvas, plot, layer))?;
    plot.slopes.iter().try_for_each(|slope| outline(canvas, plot, slope))?;
    for layer in layers {
        if let Layer::Series(s) = layer {
            series(canvas, plot, s, slots.looks(s))?;
        }
    }
    for layer in layers {
        if let Layer::Exact { points, .. } = layer {
            curve(canvas, plot, points, legend::exact())?;
        }
    }
    frame(canvas, plot)?;
    labels(canvas, plot)?;
    let Some(place) = plot.legend else {
        return Ok(());
    };
    legend::draw_in(canvas, &legend::entries([plot.panel]), slots, place)
}

/// Grid, ticks and their labels.
fn axes(canvas: &Canvas, plot: &Plot) -> Drawn {
    let Frame { left, top, right, bottom } = plot.frame;
    let (grid, tick) = (Pen::solid(GRID, 0.75), Pen::solid(AXIS, 0.9));
    let (xs, ys) = (&plot.ticks.0, &plot.ticks.1);
    for x in xs.major.iter().filter_map(|t| plot.map.0.at(t.at)) {
        canvas.line(&[(x, top), (x, bottom)], grid)?;
        canvas.line(&[(x, bottom), (x, bottom + 4.0)], tick)?;
    }
    for y in ys.major.iter().filter_map(|t| plot.map.1.at(t.at)) {
        canvas.line(&[(left, y), (right, y)], grid)?;
        canvas.line(&[(left - 4.0, y), (left, y)], tick)?;
    }
    for x in xs.minor.iter().filter_map(|v| plot.map.0.at(*v)) {
        canvas.line(&[(x, bottom), (x, bottom + 2.25)], tick)?;
    }
    for y in ys.minor.iter().filter_map(|v| plot.map.1.at(*v)) {
        canvas.line(&[(left - 2.25, y), (left, y)], tick)?;
    }
    // Labels that would touch one of lower rank are left out; their ticks stay.
    let mut taken: Vec<(f64, f64)> = Vec::new();
    for rank in 0..=1 {
        for t in xs.major.iter().filter(|t| t.rank == rank) {
            let Some(x) = plot.map.0.at(t.at) else {
                continue;
            };
            let label = Label::new(&t.label, TICK, AXIS, (HPos::Center, VPos::Top));
            let half = 0.5 * label.length()? + 3.0;
            if taken.iter().all(|(a, b)| x + half < *a || x - half > *b) {
                taken.push((x - half, x + half));
                canvas.text(&label, (x, bottom + 7.0))?;
            }
        }
    }
    let mut taken: Vec<f64> = Vec::new();
    for rank in 0..=1 {
        for t in ys.major.iter().filter(|t| t.rank == rank) {
            let Some(y) = plot.map.1.at(t.at) else {
                continue;
            };
            if taken.iter().all(|other| (y - other).abs() > 1.2 * TICK) {
                taken.push(y);
                canvas.text(&tick_label(&t.label), (left - 7.0, y))?;
            }
        }
    }
    Ok(())
}

/// The frame, the axis labels, the title and remarks above the frame.
fn frame(canvas: &Canvas, plot: &Plot) -> Drawn {
    let Frame { left, top, right, bottom } = plot.frame;
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
    canvas.line(&corners, Pen::solid(AXIS, 0.9))?;
    let text =
        |text: &str, at: Point, anchor, ink| canvas.text(&Label::new(text, SMALL, ink, anchor), at);
    let x_label = Label::new(&plot.panel.x.label, LABEL, INK, (HPos::Center, VPos::Bottom));
    canvas.text(&x_label, (0.5 * (left + right), bottom + 40.0))?;
    let y_label = Label::new(&plot.panel.y.label, LABEL, INK, (HPos::Center, VPos::Top));
    canvas.text(&Label { upright: true, ..y_label }, (plot.left + 8.0, 0.5 * (top + bottom)))?;
    let title = Label::new(&plot.panel.title, 12.5, INK, (HPos::Center, VPos::Bottom));
    canvas.text(&Label { bold: true, ..title }, (0.5 * (left + right), top - 7.0))?;
    if let Some(factor) = &plot.ticks.1.factor {
        text(factor, (left, top - 6.0), (HPos::Left, VPos::Bottom), AXIS)?;
    }
    if let Some(factor) = &plot.ticks.0.factor {
        text(factor, (right, bottom + 36.0), (HPos::Right, VPos::Bottom), AXIS)?;
    }
    if plot.empty {
        let centre = (0.5 * (left + right), 0.5 * (top + bottom));
        text("no data", centre, (HPos::Center, VPos::Center), MUTED)?;
    }
    if plot.skipped > 0 {
        let remark = format!("{} not drawable", plot.skipped);
        text(&remark, (right, top - 6.0), (HPos::Right, VPos::Bottom), MUTED)?;
    }
    Ok(())
}

/// Bands and strips.
fn shades(canvas: &Canvas, plot: &Plot, slots: &Slots, layer: &Layer) -> Drawn {
    let Frame { left, top, right, bottom } = plot.frame;
    match layer {
        Layer::Span { along, limits, .. } => {
            let map = if *along == Along::Horizontal { plot.map.1 } else { plot.map.0 };
            let (Some(a), Some(b)) = (map.at(limits.0), map.at(limits.1)) else {
                return Ok(());
            };
            let corners = match along {
                Along::Horizontal => {
                    let (a, b) = (a.clamp(top, bottom), b.clamp(top, bottom));
                    [(left, a), (right, a), (right, b), (left, b)]
                }
                Along::Vertical => {
                    let (a, b) = (a.clamp(left, right), b.clamp(left, right));
                    [(a, top), (b, top), (b, bottom), (a, bottom)]
                }
            };
            canvas.fill(&corners, SHADE, 0.22)
        }
        Layer::Band { name, edges } => {
            let ink = slots.ink(name);
            // Each strip on its own: a gap in the data then stays a gap in the band.
            for pair in edges.windows(2) {
                let [(x0, a0, b0), (x1, a1, b1)] = [pair[0], pair[1]];
                let ends = [(x0, a0), (x1, a1), (x1, b1), (x0, b0)];
                let corners: Option<Vec<Point>> = pixels(&ends, plot.map).into_iter().collect();
                let inside = |(x, y): Point| (x.clamp(left, right), y.clamp(top, bottom));
                if let Some(corners) = corners {
                    let corners: Vec<Point> = corners.into_iter().map(inside).collect();
                    canvas.fill(&corners, ink, 0.22)?;
                }
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Straight reference lines.
fn rules(canvas: &Canvas, plot: &Plot, layer: &Layer) -> Drawn {
    let Layer::Rule { along, at, .. } = layer else {
        return Ok(());
    };
    let pen = Pen { ink: MUTED, width: 1.0, dash: &[4.5, 3.0] };
    rule(*along, *at, plot.map, plot.frame).map_or(Ok(()), |(a, b)| canvas.line(&[a, b], pen))
}

/// A slope guide without its labels.
fn outline(canvas: &Canvas, plot: &Plot, slope: &Slope) -> Drawn {
    let pen = match slope.shape {
        SlopeShape::Triangle => Pen::solid(MUTED, 1.0),
        SlopeShape::Line => Pen { ink: MUTED, width: 1.0, dash: &[2.0, 2.5] },
    };
    curve(canvas, plot, &slope.path, pen)
}

fn curve(canvas: &Canvas, plot: &Plot, points: &[Point], pen: Pen) -> Drawn {
    let pieces = plot.frame.clip(&pixels(points, plot.map));
    pieces.iter().try_for_each(|piece| canvas.line(piece, pen))
}

/// Error bars, then the line, then the markers of a series.
fn series(canvas: &Canvas, plot: &Plot, series: &Series, slot: usize) -> Drawn {
    let ink = style::colour(slot);
    let pen = Pen::solid(ink, 1.0);
    for ((x, y), (minus, plus)) in series.points.iter().zip(&series.errors) {
        let low = if plot.map.1.at(y - minus).is_some() { y - minus } else { *y };
        let ends = [(*x, low), (*x, y + plus)];
        for piece in plot.frame.clip(&pixels(&ends, plot.map)) {
            canvas.line(&piece, pen)?;
            for end in piece.iter().filter(|p| plot.frame.shrunk(0.5).holds(**p)) {
                canvas.line(&[(end.0 - 3.0, end.1), (end.0 + 3.0, end.1)], pen)?;
            }
        }
    }
    if let Some(pen) = legend::stroke(series, slot) {
        curve(canvas, plot, &series.points, pen)?;
    }
    if let Some(marker) = series.marker {
        let (shape, r) = (style::marker(marker, slot), style::radius(series.points.len()));
        let spots = pixels(&series.points, plot.map).into_iter().flatten();
        for at in spots.filter(|at| plot.frame.holds(*at)) {
            canvas.marker(shape, at, r, ink)?;
        }
    }
    Ok(())
}

/// The texts inside the frame; each takes the freest of a few places and blocks it.
fn labels(canvas: &Canvas, plot: &mut Plot) -> Drawn {
    for slope in plot.slopes.clone() {
        slope_labels(canvas, plot, &slope)?;
    }
    let Frame { left, top, right, bottom } = plot.frame;
    for layer in &plot.panel.layers {
        let (text, anchors) = match layer {
            Layer::Note { at, text } => {
                let Some(&Some((x, y))) = pixels(&[*at], plot.map).first() else {
                    continue;
                };
                let near = [(x + 7.0, y - 7.0), (x + 7.0, y + 7.0)];
                (text, near.map(|p| (p, HPos::Left)).to_vec())
            }
            Layer::Rule { along, at, label } => {
                let Some((a, _)) = rule(*along, *at, plot.map, plot.frame) else {
                    continue;
                };
                let places = match along {
                    Along::Horizontal => [a.1 - 8.0, a.1 + 8.0]
                        .into_iter()
                        .flat_map(|y| {
                            [((right - 6.0, y), HPos::Right), ((left + 6.0, y), HPos::Left)]
                        })
                        .collect(),
                    Along::Vertical => [top + 11.0, bottom - 11.0, 0.5 * (top + bottom)]
                        .into_iter()
                        .flat_map(|y| [((a.0 + 5.0, y), HPos::Left), ((a.0 - 5.0, y), HPos::Right)])
                        .collect(),
                };
                (label, places)
            }
            _ => continue,
        };
        if !text.is_empty() {
            write(canvas, plot, text, &anchors)?;
        }
    }
    Ok(())
}

fn slope_labels(canvas: &Canvas, plot: &mut Plot, slope: &Slope) -> Drawn {
    let ends = pixels(&[slope.path[0], slope.path[1], slope.corner], plot.map);
    let [Some(a), Some(b), Some(corner)] = ends[..] else {
        return Ok(());
    };
    let order = slope.text();
    match slope.shape {
        SlopeShape::Line => {
            // Below the line: right of it if it rises, left of it if it falls.
            let (side, anchor) = if b.1 < a.1 { (6.0, HPos::Left) } else { (-6.0, HPos::Right) };
            let along = |t: f64| (a.0 + t * (b.0 - a.0) + side, a.1 + t * (b.1 - a.1) + 9.0);
            let places = [0.5, 0.7, 0.3, 0.85, 0.15].map(|t| (along(t), anchor));
            write(canvas, plot, &format!("order {order}"), &places)
        }
        SlopeShape::Triangle => {
            let rises = corner.0 > 0.5 * (a.0 + b.0);
            let (side, anchor) = if rises { (6.0, HPos::Left) } else { (-6.0, HPos::Right) };
            write(canvas, plot, &order, &[((corner.0 + side, 0.5 * (a.1 + b.1)), anchor)])?;
            let base = (0.5 * (a.0 + b.0), corner.1 + 8.0);
            write(canvas, plot, "1", &[(base, HPos::Center)])
        }
    }
}

/// Writes a small text at the freest of some anchors that lie inside the frame.
fn write(canvas: &Canvas, plot: &mut Plot, text: &str, anchors: &[(Point, HPos)]) -> Drawn {
    let label = |h| Label::new(text, SMALL, MUTED, (h, VPos::Center));
    let length = label(HPos::Left).length()?;
    let place = |((x, y), h): &(Point, HPos)| {
        let left = match h {
            HPos::Left => *x,
            HPos::Center => x - 0.5 * length,
            HPos::Right => x - length,
        };
        Frame { left, top: y - 6.5, right: left + length, bottom: y + 6.5 }
    };
    let fits =
        |f: &Frame| plot.frame.holds((f.left, f.top)) && plot.frame.holds((f.right, f.bottom));
    let places: Vec<Frame> = anchors.iter().map(place).filter(fits).collect();
    let Some(best) = plot.obstacles.freest(places) else {
        return Ok(());
    };
    let Some((at, h)) = anchors.iter().find(|a| place(a) == best) else {
        return Ok(());
    };
    plot.obstacles.taken(best);
    canvas.text(&label(*h), *at)
}
