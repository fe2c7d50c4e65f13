//! PNG pictures of rendered figures, by resvg with the bundled fonts only.

use super::PlotError;
use super::canvas::FONTS;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::sync::{Arc, OnceLock};

/// Largest picture side in pixels.
const LARGEST: f32 = 16_384.0;

/// Rasterises an SVG of [`render_svg`](super::render_svg), `scale` pixels per SVG pixel.
///
/// # Errors
/// The text is no SVG, or the picture would be empty or unreasonably large.
pub fn svg_to_png(svg: &str, scale: f32) -> Result<Vec<u8>, PlotError> {
    let options =
        Options { fontdb: fonts(), font_family: "DejaVu Sans".into(), ..Options::default() };
    let tree = Tree::from_str(svg, &options)?;
    let size = tree.size();
    let (width, height) = ((size.width() * scale).ceil(), (size.height() * scale).ceil());
    let fits = |side: f32| (1.0..=LARGEST).contains(&side);
    let pixmap = (fits(width) && fits(height)).then(|| Pixmap::new(width as u32, height as u32));
    let mut pixmap = pixmap.flatten().ok_or(PlotError::PictureSize { width, height })?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    pixmap.encode_png().map_err(|e| PlotError::Draw(e.into()))
}

/// The bundled fonts, loaded once.
pub(crate) fn fonts() -> Arc<fontdb::Database> {
    static LOADED: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    let load = || {
        let mut fonts = fontdb::Database::new();
        for (_, bytes) in FONTS {
            fonts.load_font_data(bytes.to_vec());
        }
        fonts.set_sans_serif_family("DejaVu Sans");
        Arc::new(fonts)
    };
    LOADED.get_or_init(load).clone()
}
