//! Texts and shapes over a picture, by resvg with the bundled fonts only.

use super::PaintError;
use crate::plots::fonts;
use crate::xml::{escape, is_odd};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

/// Draws the elements of an SVG over a picture.
pub(super) fn stamp(elements: &str, pixmap: &mut Pixmap) -> Result<(), PaintError> {
    let tree = parse(elements, (pixmap.width(), pixmap.height()))?;
    resvg::render(&tree, Transform::identity(), &mut pixmap.as_mut());
    Ok(())
}

/// Width of a text in pixels.
pub(super) fn width(text: &str, size: f64, bold: bool) -> Result<f64, PaintError> {
    // Only the box around the text matters, not the picture.
    let tree =
        parse(&element(text, (0.0, 50.0), &Face { size, bold, anchor: "start" }), (100, 100))?;
    Ok(f64::from(tree.root().abs_bounding_box().right()).max(0.0))
}

/// How a text is set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) size: f64,
    pub(super) bold: bool,
    /// `start`, `middle` or `end`.
    pub(super) anchor: &'static str,
}

/// One line of text as an SVG element; its colour is that of the surrounding group.
pub(super) fn element(text: &str, (x, y): (f64, f64), face: &Face) -> String {
    let weight = if face.bold { "bold" } else { "normal" };
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{:.1}\" font-weight=\"{weight}\" \
         text-anchor=\"{}\">{}</text>\n",
        face.size,
        face.anchor,
        escape(&plain(text))
    )
}

fn parse(elements: &str, (width, height): (u32, u32)) -> Result<Tree, PaintError> {
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         font-family=\"DejaVu Sans\">\n{elements}</svg>\n"
    );
    let options =
        Options { fontdb: fonts(), font_family: "DejaVu Sans".into(), ..Options::default() };
    Ok(Tree::from_str(&svg, &options)?)
}

/// Characters that XML forbids become spaces.
fn plain(text: &str) -> String {
    text.replace(is_odd, " ")
}
