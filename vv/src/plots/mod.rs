//! Charts: a neutral model ([`Figure`]) drawn once as SVG, from which the PNG and the copy for
//! light and dark pages are made.
//!
//! Points that cannot be drawn (not finite, or not positive on a logarithmic axis) are skipped
//! and counted in a remark above the panel. The output is the same, byte for byte, for the same
//! figure.

mod axes;
mod canvas;
mod draw;
mod guides;
mod layout;
mod legend;
mod model;
mod raster;
mod style;
mod svg;

pub use axes::superscript;
pub use model::{
    Along, Axis, Dash, Figure, Layer, MAX_SERIES, Marker, Panel, Point, Scale, Series, SlopeShape,
};
pub(crate) use raster::fonts;
pub use raster::svg_to_png;
pub use style::{THEME, themed};

use thiserror::Error;

use crate::words::counted;

/// Why a figure could not be drawn.
#[derive(Debug, Error)]
pub enum PlotError {
    /// A figure has one to four panels.
    #[error("a figure has one to four panels, not {0}")]
    Panels(usize),
    /// The palette has [`MAX_SERIES`] entries.
    #[error("a figure has at most {MAX_SERIES} differently named series, not {0}")]
    TooManySeries(usize),
    /// Fixed limits that are not finite, not increasing, or not positive on a logarithmic axis.
    #[error("axis `{0}` cannot have these limits")]
    Range(String),
    /// There must be one error bar per point, or none.
    #[error(
        "series `{name}` has {} but {}",
        counted(*points, ["point", "points"]),
        counted(*errors, ["error bar", "error bars"])
    )]
    ErrorBars {
        /// The series.
        name: String,
        /// Its number of points.
        points: usize,
        /// Its number of error bars.
        errors: usize,
    },
    /// An order of convergence is a slope only between logarithmic axes.
    #[error("a slope of order {0} needs two logarithmic axes")]
    Slope(f64),
    /// The bundled fonts could not be read.
    #[error("the bundled fonts cannot be read")]
    Font,
    /// A picture of no or unreasonable size.
    #[error("a picture of {width} × {height} pixels cannot be made")]
    PictureSize {
        /// Its width.
        width: f32,
        /// Its height.
        height: f32,
    },
    /// The text to rasterise is not SVG.
    #[error("the drawing is not valid SVG")]
    Svg(#[from] resvg::usvg::Error),
    /// The drawing library failed.
    #[error("the drawing library failed")]
    Draw(#[source] Box<dyn std::error::Error + Send + Sync>),
}

impl PlotError {
    fn draw(source: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Draw(Box::new(source))
    }
}

/// Draws a figure as a self-contained SVG in the light theme.
///
/// # Errors
/// The figure contradicts itself; see [`PlotError`]. Data alone never cause an error.
pub fn render_svg(figure: &Figure) -> Result<String, PlotError> {
    let slots = legend::Slots::new(figure);
    check(figure, &slots)?;
    let mut layout = layout::Layout::new(figure)?;
    let (width, height) = layout.size;
    let mut drawing = String::new();
    let canvas = canvas::Canvas::new(&mut drawing, layout.size)?;
    canvas.fill(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)], style::PAPER, 1.0)?;
    for plot in &mut layout.plots {
        draw::panel(&canvas, plot, &slots)?;
    }
    if let Some((strip, top)) = &layout.strip {
        strip.draw(&canvas, &slots, (width, *top))?;
    }
    canvas.finish()?;
    Ok(svg::finish(&drawing, layout.size, &figure.caption))
}

fn check(figure: &Figure, slots: &legend::Slots) -> Result<(), PlotError> {
    if !(1..=4).contains(&figure.panels.len()) {
        return Err(PlotError::Panels(figure.panels.len()));
    }
    if slots.len() > MAX_SERIES {
        return Err(PlotError::TooManySeries(slots.len()));
    }
    for panel in &figure.panels {
        if let Some(axis) = [&panel.x, &panel.y].into_iter().find(|axis| !axes::valid(axis)) {
            return Err(PlotError::Range(axis.label.clone()));
        }
        let logarithmic = panel.x.scale == Scale::Log10 && panel.y.scale == Scale::Log10;
        for layer in &panel.layers {
            match layer {
                Layer::Slope { order, .. } if !logarithmic || !order.is_finite() => {
                    return Err(PlotError::Slope(*order));
                }
                Layer::Series(s) if ![0, s.points.len()].contains(&s.errors.len()) => {
                    return Err(PlotError::ErrorBars {
                        name: s.name.clone(),
                        points: s.points.len(),
                        errors: s.errors.len(),
                    });
                }
                _ => {}
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
