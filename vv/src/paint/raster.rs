//! The buffer of samples and the depth test; rows are shared out in bands, so the result does not
//! depend on the number of threads.

use super::primitive::{Particle, Triangle};
use rayon::prelude::*;

/// Rows in a band.
const BAND: usize = 16;

/// What is seen at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Distance from the eye in samples; infinite for the background.
    pub(super) depth: f32,
    /// Index into the colours of the picture.
    pub(super) tone: u16,
    /// Brightness by the lamp, 0 to 255.
    pub(super) light: u8,
    /// Strength of an element edge, 0 to 255.
    pub(super) line: u8,
    /// Radius of the particle in samples, at most 255; elements count as large.
    pub(super) size: u8,
    /// The body.
    pub(super) class: u8,
    /// Belongs to the section plane.
    pub(super) cap: bool,
}

impl Sample {
    /// The background.
    pub(super) const NONE: Self =
        Self { depth: f32::INFINITY, tone: 0, light: 0, line: 0, size: 0, class: 0, cap: false };
}

/// All samples of a picture, row by row.
pub(super) struct Buffer {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) samples: Vec<Sample>,
}

/// A run of columns of one row.
pub(super) struct Row<'a> {
    pub(super) y: usize,
    pub(super) samples: &'a mut [Sample],
}

impl Row<'_> {
    /// The columns whose sample points lie between two places.
    pub(super) fn columns(&self, from: f32, to: f32) -> std::ops::Range<usize> {
        let start = (from - 0.5).ceil().max(0.0) as usize;
        let end = ((to - 0.5).floor() + 1.0).clamp(0.0, self.samples.len() as f32) as usize;
        start..end.max(start)
    }
}

/// Something that covers rows of the picture.
pub(super) trait Drawable: Sync {
    /// Top and bottom, in samples.
    fn span(&self) -> (f32, f32);
    /// Draws the samples of one row that are nearer than what is there.
    fn draw(&self, row: &mut Row, plane: Option<&[f64; 3]>);
}

impl Buffer {
    /// Draws everything; `plane` is the depth of the section plane.
    pub(super) fn draw(
        size: (u32, u32),
        triangles: &[Triangle],
        particles: &[Particle],
        plane: Option<&[f64; 3]>,
    ) -> Self {
        let (width, height) = (size.0 as usize, size.1 as usize);
        let mut samples = vec![Sample::NONE; width * height];
        let by_triangle = bands(triangles, height);
        let by_particle = bands(particles, height);
        samples.par_chunks_mut(width * BAND).enumerate().for_each(|(band, samples)| {
            let mut painter = Band { top: band * BAND, width, samples, plane };
            painter.draw(triangles, &by_triangle[band]);
            painter.draw(particles, &by_particle[band]);
        });
        Self { width, height, samples }
    }
}

struct Band<'a> {
    top: usize,
    width: usize,
    samples: &'a mut [Sample],
    plane: Option<&'a [f64; 3]>,
}

impl Band<'_> {
    fn draw<D: Drawable>(&mut self, all: &[D], chosen: &[u32]) {
        let rows = self.samples.len() / self.width;
        for item in chosen.iter().map(|i| &all[*i as usize]) {
            let (first, last) = rows_of(item, self.top + rows);
            for y in first.max(self.top)..last {
                let start = (y - self.top) * self.width;
                let samples = &mut self.samples[start..start + self.width];
                item.draw(&mut Row { y, samples }, self.plane);
            }
        }
    }
}

/// The rows whose sample points an item covers, as a range that ends at most at `height`.
fn rows_of<D: Drawable>(item: &D, height: usize) -> (usize, usize) {
    let (top, bottom) = item.span();
    let first = (top - 0.5).ceil().max(0.0) as usize;
    let last = ((bottom - 0.5).floor() + 1.0).clamp(0.0, height as f32) as usize;
    (first, last)
}

/// The items in every band, in their order.
fn bands<D: Drawable>(items: &[D], height: usize) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); height.div_ceil(BAND)];
    for (i, item) in items.iter().enumerate() {
        let (first, last) = rows_of(item, height);
        if first < last {
            for band in &mut bands[first / BAND..=(last - 1) / BAND] {
                band.push(i as u32);
            }
        }
    }
    bands
}
