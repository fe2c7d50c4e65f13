//! Legends: which entries there are, where they cover nothing, and how they look.

use super::PlotError;
use super::canvas::{Canvas, HPos, Label, Pen, VPos};
use super::guides::{Frame, Obstacles};
use super::model::{Figure, Layer, Panel, Point, Series};
use super::style::{self, INK, Ink, PAPER, SHADE};

const SIZE: f64 = 11.5;
const ROW: f64 = 17.0;
const SAMPLE: f64 = 30.0;
const GAP: f64 = 7.0;
const PAD: f64 = 7.0;

/// The series names of a figure in order: the place of a name decides its looks.
pub(super) struct Slots<'a>(Vec<&'a str>);

impl<'a> Slots<'a> {
    /// Collects the names of a figure.
    pub(super) fn new(figure: &'a Figure) -> Self {
        let mut names: Vec<&str> = Vec::new();
        for layer in figure.panels.iter().flat_map(|p| &p.layers) {
            if let Layer::Series(series) = layer
                && !names.contains(&series.name.as_str())
            {
                names.push(&series.name);
            }
        }
        Self(names)
    }

    /// The number of names.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// The place of a name.
    pub(super) fn of(&self, name: &str) -> Option<usize> {
        self.0.iter().position(|n| *n == name)
    }

    /// The colour of a series or band.
    pub(super) fn ink(&self, name: &str) -> Ink {
        self.of(name).map_or(SHADE, style::colour)
    }

    /// Where the looks of a series stand in the palette.
    pub(super) fn looks(&self, series: &Series) -> usize {
        series.hue.or_else(|| self.of(&series.name)).unwrap_or(0)
    }
}

/// A named layer in a legend.
#[derive(Clone, Copy)]
pub(super) struct Entry<'a> {
    name: &'a str,
    layer: &'a Layer,
}

impl Entry<'_> {
    fn length(&self) -> Result<f64, PlotError> {
        Ok(SAMPLE + GAP + self.label().length()?)
    }

    fn label(&self) -> Label<'_> {
        Label::new(self.name, SIZE, INK, (HPos::Left, VPos::Center))
    }

    fn draw(&self, canvas: &Canvas, slots: &Slots, (x, y): Point) -> Result<(), PlotError> {
        let line = [(x, y), (x + SAMPLE, y)];
        match self.layer {
            Layer::Series(series) => {
                let slot = slots.looks(series);
                if let Some(pen) = stroke(series, slot) {
                    canvas.line(&line, pen)?;
                }
                if let Some(marker) = series.marker {
                    let shape = style::marker(marker, slot);
                    let r = style::radius(series.points.len()).max(2.6);
                    canvas.marker(shape, (x + SAMPLE / 2.0, y), r, style::colour(slot))?;
                }
            }
            Layer::Exact { .. } => canvas.line(&line, exact())?,
            _ => {
                let (top, bottom) = (y - 4.5, y + 4.5);
                let corners = [(x, top), (x + SAMPLE, top), (x + SAMPLE, bottom), (x, bottom)];
                canvas.fill(&corners, slots.ink(self.name), 0.3)?;
            }
        }
        canvas.text(&self.label(), (x + SAMPLE + GAP, y))
    }
}

/// The stroke of a series, if it has one.
pub(super) fn stroke(series: &Series, slot: usize) -> Option<Pen> {
    let dash = style::pattern(series.line?, slot);
    Some(Pen { ink: style::colour(slot), width: 1.5, dash })
}

/// The stroke of exact solutions.
pub(super) fn exact() -> Pen {
    Pen { ink: INK, width: 1.25, dash: &[6.0, 3.0] }
}

/// The legend entries of panels, each name once.
pub(super) fn entries<'a>(panels: impl IntoIterator<Item = &'a Panel>) -> Vec<Entry<'a>> {
    let mut entries: Vec<Entry> = Vec::new();
    let named = |layer: &'a Layer| match layer {
        Layer::Series(s) => Some(s.name.as_str()),
        Layer::Exact { name, .. } | Layer::Span { name, .. } | Layer::Band { name, .. } => {
            Some(name.as_str())
        }
        _ => None,
    };
    let all: Vec<(&str, &Layer)> = panels
        .into_iter()
        .flat_map(|p| &p.layers)
        .filter_map(|layer| Some((named(layer)?, layer)))
        .collect();
    for (name, layer) in &all {
        // A band steps back behind the series of its name, wherever that stands.
        let is_series = |layer: &Layer| matches!(layer, Layer::Series(_));
        let behind = !is_series(layer) && all.iter().any(|(n, l)| n == name && is_series(l));
        if !name.is_empty() && !behind && !entries.iter().any(|e| e.name == *name) {
            entries.push(Entry { name, layer });
        }
    }
    entries
}

/// Whether two legends say the same.
pub(super) fn same(a: &[Entry], b: &[Entry]) -> bool {
    a.iter().map(|e| e.name).eq(b.iter().map(|e| e.name))
}

/// Finds a place inside a frame where a legend covers nothing.
pub(super) fn place(
    entries: &[Entry],
    frame: Frame,
    obstacles: &Obstacles,
) -> Result<Option<Frame>, PlotError> {
    if entries.is_empty() {
        return Ok(None);
    }
    let lengths: Vec<f64> = entries.iter().map(Entry::length).collect::<Result<_, _>>()?;
    let width = lengths.into_iter().fold(0.0, f64::max) + 2.0 * PAD;
    let height = entries.len() as f64 * ROW + 2.0 * PAD - 4.0;
    let room = frame.shrunk(7.0);
    let (left, top) = (room.right - width, room.bottom - height);
    if left < room.left || top < room.top {
        return Ok(None);
    }
    let (centre, middle) = (0.5 * (room.left + left), 0.5 * (room.top + top));
    let corners = [(left, room.top), (room.left, room.top), (room.left, top), (left, top)];
    let edges = [(centre, room.top), (left, middle), (room.left, middle), (centre, top)];
    let candidates = corners.into_iter().chain(edges).map(|(x, y)| Frame {
        left: x,
        top: y,
        right: x + width,
        bottom: y + height,
    });
    Ok(obstacles.freest(candidates).filter(|place| obstacles.hits(*place) == 0))
}

/// Draws a legend in a free place, on paper that hides what lies below.
pub(super) fn draw_in(
    canvas: &Canvas,
    entries: &[Entry],
    slots: &Slots,
    place: Frame,
) -> Result<(), PlotError> {
    let Frame { left, top, right, bottom } = place;
    canvas.fill(&[(left, top), (right, top), (right, bottom), (left, bottom)], PAPER, 1.0)?;
    let rows = (0..).map(|i| top + PAD - 2.0 + ROW * (f64::from(i) + 0.5));
    entries.iter().zip(rows).try_for_each(|(e, y)| e.draw(canvas, slots, (left + PAD, y)))
}

/// A legend in centred rows below the panels.
pub(super) struct Strip<'a> {
    rows: Vec<(f64, Vec<(f64, Entry<'a>)>)>,
}

impl<'a> Strip<'a> {
    /// Breaks the entries into rows of at most the given width.
    pub(super) fn new(entries: Vec<Entry<'a>>, width: f64) -> Result<Self, PlotError> {
        let mut rows: Vec<(f64, Vec<(f64, Entry)>)> = Vec::new();
        for entry in entries {
            let length = entry.length()? + 22.0;
            match rows.last_mut() {
                Some((end, row)) if *end + length <= width => {
                    row.push((*end, entry));
                    *end += length;
                }
                _ => rows.push((length, vec![(0.0, entry)])),
            }
        }
        Ok(Self { rows })
    }

    /// Its height in pixels.
    pub(super) fn height(&self) -> f64 {
        self.rows.len() as f64 * (ROW + 1.0) + 6.0
    }

    /// Draws it in the middle of a width, from `top` downwards.
    pub(super) fn draw(
        &self,
        canvas: &Canvas,
        slots: &Slots,
        (width, top): Point,
    ) -> Result<(), PlotError> {
        for ((end, row), y) in self.rows.iter().zip((0..).map(|i| top + (ROW + 1.0) * f64::from(i)))
        {
            let left = 0.5 * (width - end) + 8.0;
            for (x, entry) in row {
                entry.draw(canvas, slots, (left + x, y + 0.5 * ROW))?;
            }
        }
        Ok(())
    }
}
