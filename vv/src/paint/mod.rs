//! Pictures of states in space: spheres, ellipsoids and hexahedra seen by an orthographic camera,
//! with an optional section, coloured by body or by a field.
//!
//! [`paint`] turns a [`Model`] and the wishes in a [`Picture`] into a PNG file. The same model
//! gives the same bytes, on any number of threads.

mod annotate;
mod camera;
mod colour;
mod encode;
mod layout;
mod model;
mod picture;
mod primitive;
mod quantise;
mod raster;
mod resolve;
mod section;
mod surface;
mod text;
mod ticks;
mod vector;

pub use camera::Camera;
pub use colour::{ColourMap, MAX_CLASSES, Theme};
pub use model::{Ellipsoid, Hexahedron, Mark, Model, Sphere};
pub use picture::{Colouring, Field, Length, Picture};
pub use section::Plane;

use camera::{Extent, View};
use layout::Layout;
use primitive::{Particle, Style, Triangle};
use raster::Buffer;
use rayon::prelude::*;
use resolve::{Look, SAMPLES, resolve};
use resvg::tiny_skia::Pixmap;
use section::Cut;
use surface::Facet;
use thiserror::Error;
use vector::Vec3;

/// Why a picture could not be painted.
#[derive(Debug, Error)]
pub enum PaintError {
    /// There is nothing to paint.
    #[error("the model is empty")]
    EmptyModel,
    /// The section cuts everything away, or what is left has no extent.
    #[error("nothing of the model can be seen")]
    NothingVisible,
    /// A coordinate or size that is not finite, a size that is not positive, directions that are
    /// not orthonormal, or a node that does not exist.
    #[error("{what} {index} cannot be painted")]
    Primitive {
        /// Its kind.
        what: &'static str,
        /// Its index among its kind.
        index: usize,
    },
    /// A class without a name, or one too many.
    #[error("class {0} has no name or no colour; there are at most {MAX_CLASSES}")]
    Class(u8),
    /// A range that is not finite or not increasing.
    #[error("the range of `{0}` is not finite and increasing")]
    Range(String),
    /// Directions of no length or parallel to each other, or a box that is not finite.
    #[error("the camera has no proper directions or frame")]
    Camera,
    /// A plane without a normal, or one that is seen edge-on.
    #[error("the plane of section has no normal or is seen edge-on")]
    Section,
    /// A picture of no or unreasonable size, or too low for its texts.
    #[error("a picture of {width} × {height} pixels cannot be painted")]
    Size {
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels; zero if it was to follow from the contents.
        height: u32,
    },
    /// The file is too large even with the fewest colours.
    #[error("the picture needs {bytes} bytes, more than {limit}")]
    TooLarge {
        /// The smallest size that was reached.
        bytes: usize,
        /// The limit.
        limit: usize,
    },
    /// The annotation is not valid SVG.
    #[error("the annotation is not valid SVG")]
    Svg(#[from] resvg::usvg::Error),
    /// The file could not be encoded.
    #[error("the picture cannot be encoded")]
    Png(#[from] png::EncodingError),
}

/// A particle that is not cut away: centre, half-axes and mark.
type Body = (Vec3, [Vec3; 3], Mark);

/// Paints a model as a PNG file.
///
/// # Errors
/// The model or the wishes contradict themselves, or the file would be too large; see
/// [`PaintError`].
pub fn paint(model: &Model, picture: &Picture) -> Result<Vec<u8>, PaintError> {
    model.check()?;
    let tones = picture.tones(model)?;
    let axes = picture.camera.axes()?;
    let cut = picture.section.as_ref().map(|p| Cut::new(p, &axes)).transpose()?;
    let facets = surface::facets(model, cut.as_ref());
    let bodies: Vec<Body> =
        model.particles().filter(|b| cut.is_none_or(|c| c.lowest(b.0, &b.1) < 0.0)).collect();
    let extent = extent(picture, &axes, &facets, &bodies)?;
    let present = present(&facets, &bodies);
    let (width, height) = extent.size();
    let layout = Layout::new(picture, &present, height / width)?;
    let samples = (layout.size.0 * SAMPLES as u32, layout.scene.1 * SAMPLES as u32);
    let margin = 24.0 * layout.unit * SAMPLES as f64;
    let view = View::fit(axes, &extent, samples, margin).ok_or(PaintError::NothingVisible)?;

    let detail = layout.unit as f32;
    let style = |mark: Mark| Style { tone: tones.of(mark), class: mark.class };
    let line = if picture.edges { (2.6 * detail).max(1.5) } else { 0.0 };
    let triangles: Vec<Triangle> =
        facets.par_iter().map(|f| Triangle::new(f, &view, line, style(f.mark))).collect();
    let particles: Vec<Particle> = bodies
        .par_iter()
        .map(|(centre, axes, mark)| Particle::new(*centre, axes, &view, detail, style(*mark)))
        .collect();
    let plane = cut.map(|c| c.depth(&view));
    let buffer = Buffer::draw(samples, &triangles, &particles, plane.as_ref());
    let (lamp, occlusion) = match picture.colouring {
        Colouring::Classes(_) => ((0.76, 1.12), 0.5),
        Colouring::Field(_) => ((0.80, 1.08), 0.4),
    };
    let paper = picture.theme.paper();
    let range = tones.range.unwrap_or((0.0, 1.0));
    let svg = annotate::annotation(picture, &layout, &view, (range, beyond(model, range)))?;
    let exact = [paper, picture.theme.ink()];
    encode::smallest_loss(picture.max_bytes, |step| {
        let tones = &tones.colours;
        let rim = picture.theme.rim();
        let look = Look { tones, paper, rim, lamp, occlusion, scale: detail, calm: step.calm };
        let mut pixmap = canvas(&layout, &resolve(&buffer, &look), paper)?;
        text::stamp(&svg, &mut pixmap)?;
        let pixels: Vec<[u8; 3]> =
            pixmap.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
        encode::encode(&pixels, layout.size, (&exact, tones), step)
    })
}

/// The part of the picture plane to show.
fn extent(
    picture: &Picture,
    axes: &camera::Axes,
    facets: &[Facet],
    bodies: &[Body],
) -> Result<Extent, PaintError> {
    let mut extent = Extent::NONE;
    if facets.is_empty() && bodies.is_empty() {
        return Err(PaintError::NothingVisible);
    }
    if let Some(corners) = picture.camera.corners()? {
        corners.iter().for_each(|c| extent.add(axes.turn(*c), [0.0; 3]));
    } else {
        for corner in facets.iter().flat_map(|f| f.corners) {
            extent.add(axes.turn(corner), [0.0; 3]);
        }
        for (centre, half_axes, _) in bodies {
            let turned = half_axes.map(|a| axes.turn(a));
            let half = [0, 1, 2].map(|i| turned.iter().map(|a| a[i] * a[i]).sum::<f64>().sqrt());
            extent.add(axes.turn(*centre), half);
        }
        for end in picture.arrow.iter().flatten() {
            extent.add(axes.turn(*end), [0.0; 3]);
        }
    }
    let (width, height) = extent.size();
    // A line or a point has no picture.
    if width > 1e-9 * height && height > 1e-9 * width {
        Ok(extent)
    } else {
        Err(PaintError::NothingVisible)
    }
}

/// Which classes are drawn.
fn present(facets: &[Facet], bodies: &[Body]) -> Vec<bool> {
    let mut present = vec![false; 256];
    for mark in facets.iter().map(|f| f.mark).chain(bodies.iter().map(|b| b.2)) {
        present[usize::from(mark.class)] = true;
    }
    present
}

/// Whether there are values below and above a range.
fn beyond(model: &Model, (low, high): (f64, f64)) -> (bool, bool) {
    model.marks().map(|m| f64::from(m.value)).fold((false, false), |(below, above), v| {
        (below || v < low - 1e-6 * (high - low), above || v > high + 1e-6 * (high - low))
    })
}

/// Paper with the scene on it.
fn canvas(layout: &Layout, scene: &[[u8; 3]], paper: [u8; 3]) -> Result<Pixmap, PaintError> {
    let (width, height) = layout.size;
    let mut pixmap = Pixmap::new(width, height).ok_or(PaintError::Size { width, height })?;
    let start = width as usize * layout.scene.0 as usize;
    for (i, pixel) in pixmap.data_mut().chunks_exact_mut(4).enumerate() {
        let colour = i.checked_sub(start).and_then(|at| scene.get(at)).unwrap_or(&paper);
        pixel[..3].copy_from_slice(colour);
        pixel[3] = 255;
    }
    Ok(pixmap)
}

#[cfg(test)]
mod tests;
