//! From samples to pixels: light, occlusion, outlines and the mean over a pixel.

use super::colour::darkness;
use super::raster::{Buffer, Sample};
use rayon::prelude::*;

/// Samples along the side of a pixel.
pub(super) const SAMPLES: usize = 2;
/// Outlines are as wide as this number of samples.
const OUTLINE: isize = 2;
/// Steps in depth between which an outline fades in, in samples at a width of 1400 pixels.
const STEP: (f32, f32) = (7.0, 20.0);
/// Brightness of lines on dark colours, and how far edges and outlines go towards it: dense edges
/// must not look like a higher value.
const GLOW: (f32, [f32; 2]) = (235.0, [0.4, 0.6]);
/// Light on a particle without shading.
const PLAIN: f32 = 0.75;
/// Directions in which occlusion is looked for; the opposite ones belong to them.
const DIRECTIONS: [(f32, f32); 6] =
    [(1.0, 0.0), (0.866, 0.5), (0.5, 0.866), (0.0, 1.0), (-0.5, 0.866), (-0.866, 0.5)];
/// Distances at which occlusion is looked for, in samples at a width of 1400 pixels.
const REACH: [f32; 2] = [9.0, 24.0];

/// The colours of a picture.
pub(super) struct Look<'a> {
    /// Colour of every tone.
    pub(super) tones: &'a [[u8; 3]],
    /// Background.
    pub(super) paper: [u8; 3],
    /// How far outlines of dark bodies are light, 0 to 1.
    pub(super) rim: f32,
    /// Darkest and brightest factor of the lamp.
    pub(super) lamp: (f32, f32),
    /// Darkening of hollows.
    pub(super) occlusion: f32,
    /// Size of details relative to a picture 1400 pixels wide.
    pub(super) scale: f32,
    /// What is done about the noise of small particles.
    pub(super) calm: Calm,
}

/// How plainly small particles are drawn: their shading is noise in print, and noise makes large
/// files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Calm {
    /// Particles up to this radius in samples have no shading; larger ones have more and more.
    pub(super) plain: f32,
    /// Least strength of occlusion and outlines at small particles, 0 to 1.
    pub(super) floor: f32,
}

impl Look<'_> {
    /// How much of its shading a sample shows, 0 to 1.
    fn detail(&self, sample: &Sample) -> f32 {
        ((f32::from(sample.size) - self.calm.plain) / 10.0).clamp(0.0, 1.0)
    }
}

/// The pixels, row by row.
pub(super) fn resolve(buffer: &Buffer, look: &Look) -> Vec<[u8; 3]> {
    let width = buffer.width / SAMPLES;
    let mut pixels = vec![look.paper; width * (buffer.height / SAMPLES)];
    pixels.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
        for (x, pixel) in row.iter_mut().enumerate() {
            *pixel = mean(buffer, look, x * SAMPLES, y * SAMPLES);
        }
    });
    pixels
}

fn mean(buffer: &Buffer, look: &Look, x: usize, y: usize) -> [u8; 3] {
    let all = (0..SAMPLES * SAMPLES).map(|i| (x + i % SAMPLES, y + i / SAMPLES));
    let nearest =
        all.clone().min_by(|a, b| buffer.at(a.0, a.1).depth.total_cmp(&buffer.at(b.0, b.1).depth));
    let Some(place) = nearest.filter(|p| buffer.at(p.0, p.1).depth.is_finite()) else {
        return look.paper;
    };
    // Occlusion between particles of a few samples is noise like their shading.
    let detail = look.detail(buffer.at(place.0, place.1)).max(look.calm.floor);
    let shade = 1.0 - look.occlusion * detail * buffer.occlusion(place, look.scale);
    let mut sum = [0.0_f32; 3];
    for (x, y) in all {
        let colour = colour(buffer, look, (x, y), shade);
        for (s, c) in sum.iter_mut().zip(colour) {
            *s += c;
        }
    }
    sum.map(|s| (s / (SAMPLES * SAMPLES) as f32).round() as u8)
}

fn colour(buffer: &Buffer, look: &Look, (x, y): (usize, usize), shade: f32) -> [f32; 3] {
    let sample = buffer.at(x, y);
    if sample.depth == f32::INFINITY {
        return look.paper.map(f32::from);
    }
    let tone = look.tones[usize::from(sample.tone)];
    let base = tone.map(f32::from);
    let lit = if sample.cap {
        1.0
    } else {
        let (low, high) = look.lamp;
        let detail = look.detail(sample);
        let light = detail * f32::from(sample.light) / 255.0 + (1.0 - detail) * PLAIN;
        (low + (high - low) * light) * shade
    };
    let edge = f32::from(sample.line) / 255.0 * if sample.cap { 0.35 } else { 0.5 };
    let outline =
        look.detail(sample).max(look.calm.floor) * buffer.outline(x, y, sample, look.scale);
    // Edges within a dark body are light on any paper, its outline on dark paper only.
    let (ink, light, glow) =
        if edge < outline { (outline, look.rim, GLOW.1[1]) } else { (edge, 1.0, GLOW.1[0]) };
    let light = if ink > 0.0 { light * darkness(tone) } else { 0.0 };
    base.map(|c| {
        // Brighter than the colour itself means closer to white.
        let c = if lit <= 1.0 { c * lit } else { c + (255.0 - c) * (lit - 1.0) };
        let (dark, bright) = (c * (1.0 - 0.8 * ink), c + (GLOW.0 - c) * glow * ink);
        dark + (bright - dark) * light
    })
}

impl Buffer {
    fn at(&self, x: usize, y: usize) -> &Sample {
        &self.samples[y * self.width + x]
    }

    fn near(&self, (x, y): (usize, usize), (dx, dy): (isize, isize)) -> Option<&Sample> {
        let (x, y) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
        (x < self.width && y < self.height).then(|| self.at(x, y))
    }

    /// How much nearer the surroundings are than a sample, 0 to 1. Opposite places are taken
    /// together, so that a flat slope does not hide itself.
    fn occlusion(&self, place: (usize, usize), scale: f32) -> f32 {
        let depth = self.at(place.0, place.1).depth;
        let mut sum = 0.0;
        for reach in REACH.map(|r| r * scale) {
            let nearer = |x: f32, y: f32| {
                let step = ((x * reach).round() as isize, (y * reach).round() as isize);
                let other = self.near(place, step).map_or(f32::INFINITY, |s| s.depth);
                ((depth - other) / reach).clamp(-1.5, 1.5)
            };
            for (x, y) in DIRECTIONS {
                sum += (nearer(x, y) + nearer(-x, -y)).clamp(0.0, 1.5);
            }
        }
        sum / (1.5 * (REACH.len() * DIRECTIONS.len()) as f32)
    }

    /// Strength of the outline at a sample: where the surface behind is much farther away, or
    /// another body or the plane of section begins.
    fn outline(&self, x: usize, y: usize, sample: &Sample, scale: f32) -> f32 {
        let mut step = 0.0_f32;
        let mut border = false;
        let limit = STEP.1 * scale;
        for (dx, dy) in [(1, 0), (0, 1), (1, 1), (1, -1)] {
            let mut farther = |sign: isize| {
                let side = (sign * dx * OUTLINE, sign * dy * OUTLINE);
                let Some(other) = self.near((x, y), side) else {
                    return 0.0;
                };
                border |= other.depth < f32::INFINITY
                    && (other.class != sample.class || other.cap != sample.cap);
                (other.depth - sample.depth).clamp(-limit, limit)
            };
            step = step.max(farther(1) + farther(-1));
        }
        let rise = ((step - STEP.0 * scale) / (limit - STEP.0 * scale)).clamp(0.0, 1.0);
        (rise * rise * (3.0 - 2.0 * rise)).max(if border { 0.6 } else { 0.0 })
    }
}
