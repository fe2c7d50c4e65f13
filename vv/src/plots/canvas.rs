//! Drawing in floating-point pixels on a plotters area, which only knows integers.

use super::PlotError;
use super::model::{Marker, Point};
use super::style::Ink;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::Pos;
pub(super) use plotters::style::text_anchor::{HPos, VPos};
use std::sync::OnceLock;

/// Drawing units per pixel: plotters rounds to whole units, so this makes quarter pixels.
pub(super) const UNITS: f64 = 4.0;

/// plotters' font sizes are line heights; this turns an em into one.
const LINE: f64 = 1.24;

/// The regular and bold fonts of all figures.
pub(super) const FONTS: [(FontStyle, &[u8]); 2] = [
    (FontStyle::Normal, include_bytes!("../../assets/fonts/DejaVuSans.ttf")),
    (FontStyle::Bold, include_bytes!("../../assets/fonts/DejaVuSans-Bold.ttf")),
];

/// A stroke.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    pub(super) ink: Ink,
    pub(super) width: f64,
    /// Lengths of strokes and gaps; empty for an unbroken line.
    pub(super) dash: &'static [f64],
}

impl Pen {
    /// An unbroken stroke.
    pub(super) fn solid(ink: Ink, width: f64) -> Self {
        Self { ink, width, dash: &[] }
    }
}

/// One line of text.
#[derive(Clone, Copy)]
pub(super) struct Label<'a> {
    pub(super) text: &'a str,
    pub(super) size: f64,
    pub(super) ink: Ink,
    pub(super) bold: bool,
    pub(super) anchor: (HPos, VPos),
    /// Reads upwards.
    pub(super) upright: bool,
}

impl<'a> Label<'a> {
    /// Horizontal text in the regular face.
    pub(super) fn new(text: &'a str, size: f64, ink: Ink, anchor: (HPos, VPos)) -> Self {
        Self { text, size, ink, bold: false, anchor, upright: false }
    }

    /// The length of the text, slightly overestimated so that other fonts fit as well.
    pub(super) fn length(&self) -> Result<f64, PlotError> {
        register()?;
        let ((left, _), (right, _)) = self.font().layout_box(self.text).map_err(PlotError::draw)?;
        Ok(f64::from(right - left) / UNITS)
    }

    fn font(&self) -> FontDesc<'static> {
        let face = if self.bold { FontStyle::Bold } else { FontStyle::Normal };
        // Not `into_font().style(..)`, which would keep the regular outlines.
        FontDesc::new(FontFamily::SansSerif, self.size * LINE * UNITS, face)
    }

    fn style(&self) -> TextStyle<'a> {
        let turn = if self.upright { FontTransform::Rotate270 } else { FontTransform::None };
        TextStyle {
            font: self.font().transform(turn),
            color: rgb(self.ink).to_backend_color(),
            pos: Pos::new(self.anchor.0, self.anchor.1),
        }
    }
}

/// The drawing surface of a figure.
pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

impl<'a> Canvas<'a> {
    /// A surface of the given pixels which writes to `svg`.
    pub(super) fn new(svg: &'a mut String, (width, height): Point) -> Result<Self, PlotError> {
        register()?;
        let size = ((width * UNITS) as u32, (height * UNITS) as u32);
        Ok(Self { area: SVGBackend::with_string(svg, size).into_drawing_area() })
    }

    /// Ends the drawing.
    pub(super) fn finish(self) -> Result<(), PlotError> {
        self.area.present().map_err(PlotError::draw)
    }

    /// Writes a text at its anchor.
    pub(super) fn text(&self, label: &Label, at: Point) -> Result<(), PlotError> {
        if label.text.is_empty() {
            return Ok(());
        }
        self.area.draw_text(label.text, &label.style(), units(at)).map_err(PlotError::draw)
    }

    /// Draws a line through points.
    pub(super) fn line(&self, points: &[Point], pen: Pen) -> Result<(), PlotError> {
        let style = rgb(pen.ink).stroke_width((pen.width * UNITS).round().max(1.0) as u32);
        let dashes =
            if pen.dash.is_empty() { vec![points.to_vec()] } else { dashes(points, pen.dash) };
        for dash in dashes.iter().filter(|d| d.len() > 1) {
            let mut path: Vec<_> = dash.iter().map(|p| units(*p)).collect();
            path.dedup();
            if let [only] = path[..] {
                path.push(only);
            }
            self.area.draw(&PathElement::new(path, style)).map_err(PlotError::draw)?;
        }
        Ok(())
    }

    /// Fills a polygon.
    pub(super) fn fill(&self, corners: &[Point], ink: Ink, opacity: f64) -> Result<(), PlotError> {
        let corners: Vec<_> = corners.iter().map(|p| units(*p)).collect();
        let polygon = Polygon::new(corners, rgb(ink).mix(opacity).filled());
        self.area.draw(&polygon).map_err(PlotError::draw)
    }

    /// Draws a marker of half size `r`.
    pub(super) fn marker(
        &self,
        shape: Marker,
        at: Point,
        r: f64,
        ink: Ink,
    ) -> Result<(), PlotError> {
        let place = |points: &[Point]| -> Vec<Point> {
            points.iter().map(|(x, y)| (at.0 + r * x, at.1 + r * y)).collect()
        };
        let pen = Pen::solid(ink, (0.42 * r).clamp(0.75, 1.4));
        match shape {
            Marker::Auto | Marker::Circle => {
                let radius = (r * UNITS).round() as u32;
                let circle = Circle::new(units(at), radius, rgb(ink).filled());
                self.area.draw(&circle).map_err(PlotError::draw)
            }
            Marker::Square => {
                self.fill(&place(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]), ink, 1.0)
            }
            Marker::Triangle => {
                self.fill(&place(&[(0.0, -1.25), (1.15, 0.8), (-1.15, 0.8)]), ink, 1.0)
            }
            Marker::Diamond => {
                self.fill(&place(&[(0.0, -1.35), (1.15, 0.0), (0.0, 1.35), (-1.15, 0.0)]), ink, 1.0)
            }
            Marker::Ring => {
                let turn = |i: i32| f64::from(i) * std::f64::consts::TAU / 16.0;
                let ring: Vec<_> = (0..=16).map(|i| (turn(i).cos(), turn(i).sin())).collect();
                self.line(&place(&ring), pen)
            }
            Marker::Down => {
                let corners = [(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8), (0.0, 1.2)];
                self.line(&place(&corners), pen)
            }
            Marker::Cross => {
                self.line(&place(&[(-0.9, -0.9), (0.9, 0.9)]), pen)?;
                self.line(&place(&[(-0.9, 0.9), (0.9, -0.9)]), pen)
            }
            Marker::Plus => {
                self.line(&place(&[(-1.2, 0.0), (1.2, 0.0)]), pen)?;
                self.line(&place(&[(0.0, -1.2), (0.0, 1.2)]), pen)
            }
        }
    }
}

/// Makes the bundled fonts known to plotters, once.
fn register() -> Result<(), PlotError> {
    static DONE: OnceLock<bool> = OnceLock::new();
    let register = || FONTS.iter().all(|(s, f)| register_font("sans-serif", *s, f).is_ok());
    DONE.get_or_init(register).then_some(()).ok_or(PlotError::Font)
}

fn rgb(ink: Ink) -> RGBColor {
    let (r, g, b) = ink.rgb();
    RGBColor(r, g, b)
}

fn units((x, y): Point) -> (i32, i32) {
    ((x * UNITS).round() as i32, (y * UNITS).round() as i32)
}

/// Cuts a line into dashes; the pattern runs on around corners.
fn dashes(points: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    let mut done = Vec::new();
    let mut dash: Vec<Point> = points.first().copied().into_iter().collect();
    let (mut phase, mut left) = (0, pattern[0]);
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        let mut length = (to.0 - from.0).hypot(to.1 - from.1);
        while length > left {
            let t = left / length;
            from = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            length -= left;
            dash.push(from);
            if phase % 2 == 0 {
                done.push(std::mem::take(&mut dash));
            }
            dash = vec![from];
            phase = (phase + 1) % pattern.len();
            left = pattern[phase];
        }
        left -= length;
        dash.push(to);
    }
    if phase % 2 == 0 {
        done.push(dash);
    }
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_run_around_corners() {
        let cut = dashes(&[(0.0, 0.0), (5.0, 0.0), (5.0, 5.0)], &[4.0, 2.0]);
        assert_eq!(cut, [vec![(0.0, 0.0), (4.0, 0.0)], vec![(5.0, 1.0), (5.0, 5.0)]]);
        let straight = dashes(&[(0.0, 0.0), (10.0, 0.0)], &[4.0, 2.0]);
        assert_eq!(straight, [[(0.0, 0.0), (4.0, 0.0)], [(6.0, 0.0), (10.0, 0.0)]]);
    }
}
