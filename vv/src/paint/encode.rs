//! PNG files of a limited size.

use super::PaintError;
use super::quantise::{Indexed, quantise};
use super::resolve::Calm;
use png::{BitDepth, ColorType, DeflateCompression, Encoder, Filter};

/// One way to trade detail for a smaller file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// How small particles are drawn.
    pub(super) calm: Calm,
    /// Number of colours.
    pub(super) colours: usize,
    /// Largest error of a colour that is made for the sake of compression.
    pub(super) slack: i32,
}

const FULL: Calm = Calm { plain: 3.0, floor: 0.25 };
const LESS: Calm = Calm { plain: 5.0, floor: 0.1 };
const LITTLE: Calm = Calm { plain: 7.0, floor: 0.0 };
const LEAST: Calm = Calm { plain: 11.0, floor: 0.0 };
const NONE: Calm = Calm { plain: 254.0, floor: 0.0 };

const fn step(calm: Calm, colours: usize, slack: i32) -> Step {
    Step { calm, colours, slack }
}

/// From the best picture to the smallest file.
const LADDER: [Step; 11] = [
    step(FULL, 256, 0),
    step(FULL, 128, 0),
    step(FULL, 64, 0),
    step(LESS, 64, 0),
    step(LITTLE, 64, 0),
    step(LITTLE, 32, 0),
    step(LEAST, 32, 0),
    step(NONE, 64, 0),
    step(NONE, 32, 0),
    step(NONE, 24, 25),
    step(NONE, 16, 50),
];

/// The first file on the way from the best picture to the smallest file that has at most `limit`
/// bytes, found by bisection; `make` makes the file of a step.
pub(super) fn smallest_loss(
    limit: usize,
    mut make: impl FnMut(&Step) -> Result<Vec<u8>, PaintError>,
) -> Result<Vec<u8>, PaintError> {
    let best = make(&LADDER[0])?;
    if best.len() <= limit {
        return Ok(best);
    }
    let (mut failed, mut open) = (0, LADDER.len());
    let mut found = None;
    let mut bytes = best.len();
    while failed + 1 < open {
        let middle = (failed + open) / 2;
        let file = make(&LADDER[middle])?;
        bytes = bytes.min(file.len());
        if file.len() <= limit {
            found = Some(file);
            open = middle;
        } else {
            failed = middle;
        }
    }
    found.ok_or(PaintError::TooLarge { bytes, limit })
}

/// Encodes a picture with the colours of a step. It keeps the `exact` colours and
/// evenly chosen ones of the `wanted`, as far as there is room for them.
pub(super) fn encode(
    pixels: &[[u8; 3]],
    (width, height): (u32, u32),
    (exact, wanted): (&[[u8; 3]], &[[u8; 3]]),
    step: &Step,
) -> Result<Vec<u8>, PaintError> {
    let mut fixed = exact.to_vec();
    let room = step.colours / 4;
    let every = wanted.len().div_ceil(room).max(1);
    for colour in wanted.iter().step_by(every) {
        if !fixed.contains(colour) {
            fixed.push(*colour);
        }
    }
    write(&quantise(pixels, width as usize, &fixed, (step.colours, step.slack)), width, height)
}

fn write(indexed: &Indexed, width: u32, height: u32) -> Result<Vec<u8>, PaintError> {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width, height);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(indexed.palette.concat());
    encoder.set_deflate_compression(DeflateCompression::Level(9));
    // Differences of palette entries mean nothing.
    encoder.set_filter(Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&indexed.pixels)?;
    writer.finish()?;
    Ok(file)
}
