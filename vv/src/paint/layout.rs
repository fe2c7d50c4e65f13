//! Where the parts of a picture stand, in pixels.

use super::colour::body;
use super::picture::{Colouring, Picture};
use super::{PaintError, text};

/// Smallest and largest side of a picture.
const SIDES: std::ops::RangeInclusive<u32> = 200..=8192;
/// Largest and smallest height of the scene per width, if the height is free.
const TALLEST: f64 = 1.1;
const FLATTEST: f64 = 0.2;
/// Width for which sizes are given.
const NOMINAL: f64 = 1400.0;
/// Size of the texts at the nominal width: 8.5 points in a figure 17 cm wide.
pub(super) const TEXT: f64 = 25.0;
/// Height of a row of a legend.
const ROW: f64 = 40.0;
/// Height below the scene with a colour bar.
const FOOT: f64 = 112.0;

/// An entry of the legend of classes.
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) colour: [u8; 3],
    /// Left end and middle.
    pub(super) place: (f64, f64),
}

/// The parts of a picture.
pub(super) struct Layout {
    /// Size of the picture.
    pub(super) size: (u32, u32),
    /// Size of all details relative to the nominal one.
    pub(super) unit: f64,
    /// First row and height of the scene, which is as wide as the picture.
    pub(super) scene: (u32, u32),
    /// Top of the strip below the scene.
    pub(super) foot: f64,
    /// Height of that strip.
    pub(super) strip: f64,
    /// Entries of the legend.
    pub(super) legend: Vec<Entry>,
}

impl Layout {
    /// Lays out a picture whose scene has a height of `aspect` widths.
    pub(super) fn new(
        picture: &Picture,
        present: &[bool],
        aspect: f64,
    ) -> Result<Self, PaintError> {
        let width = picture.width;
        let refuse = |height| Err(PaintError::Size { width, height });
        if !SIDES.contains(&width) || picture.height.is_some_and(|h| !SIDES.contains(&h)) {
            return refuse(picture.height.unwrap_or(0));
        }
        let unit = f64::from(width) / NOMINAL;
        let heading = !(picture.title.is_empty() && picture.time.is_empty());
        let top = (unit * if heading { 70.0 } else { 16.0 }).round() as u32;
        let (mut legend, rows) = match &picture.colouring {
            Colouring::Classes(names) => entries(names, present, f64::from(width), unit)?,
            Colouring::Field(_) => (Vec::new(), 0),
        };
        let scale_bar: f64 = if picture.length.unit.is_empty() { 0.0 } else { 84.0 };
        let strip = match &picture.colouring {
            Colouring::Classes(_) => scale_bar.max(ROW * rows as f64 + 16.0),
            Colouring::Field(_) => FOOT,
        } * unit;
        let free = (f64::from(width) * aspect.clamp(FLATTEST, TALLEST)).round() as u32;
        let bands = top + strip.ceil() as u32;
        let scene = picture.height.map_or(Some(free), |h| h.checked_sub(bands));
        let Some(scene) = scene.filter(|h| *h >= 32) else {
            return refuse(picture.height.unwrap_or(0));
        };
        let foot = f64::from(top + scene);
        let first = foot + 0.5 * (strip - rows.saturating_sub(1) as f64 * ROW * unit);
        for entry in &mut legend {
            entry.place.1 += first;
        }
        let size = (width, scene + bands);
        Ok(Self { size, unit, scene: (top, scene), foot, strip, legend })
    }

    /// The left and right margin of texts.
    pub(super) fn margins(&self) -> (f64, f64) {
        (30.0 * self.unit, f64::from(self.size.0) - 30.0 * self.unit)
    }
}

/// The entries of the classes that are present, aligned to the right in rows that leave room for
/// the scale bar, and the number of rows.
fn entries(
    names: &[String],
    present: &[bool],
    width: f64,
    unit: f64,
) -> Result<(Vec<Entry>, usize), PaintError> {
    let room = width * 0.66;
    let right = width - 30.0 * unit;
    let mut rows: Vec<(f64, Vec<(Entry, f64)>)> = Vec::new();
    for (class, name) in names.iter().enumerate() {
        if !present.get(class).is_some_and(|p| *p) {
            continue;
        }
        let length = text::width(name, TEXT * unit, false)? + 74.0 * unit;
        let entry = Entry { name: name.clone(), colour: body(class), place: (0.0, 0.0) };
        match rows.last_mut().filter(|(used, _)| used + length <= room) {
            Some((used, row)) => {
                *used += length;
                row.push((entry, length));
            }
            None => rows.push((length, vec![(entry, length)])),
        }
    }
    let count = rows.len();
    let mut placed = Vec::new();
    for (at, (used, row)) in rows.into_iter().enumerate() {
        // The last gap is no part of the row.
        let mut x = right - used + 34.0 * unit;
        for (mut entry, length) in row {
            entry.place = (x, at as f64 * ROW * unit);
            x += length;
            placed.push(entry);
        }
    }
    Ok((placed, count))
}
