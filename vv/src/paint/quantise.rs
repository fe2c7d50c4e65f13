//! From true colours to a palette of at most 256.

/// Bits per channel of the histogram.
const BITS: u32 = 6;

/// One cell of the histogram.
#[derive(Clone, Copy, Default)]
struct Cell {
    key: u32,
    count: f64,
    sum: [f64; 3],
}

impl Cell {
    fn mean(&self) -> [f64; 3] {
        self.sum.map(|s| s / self.count)
    }
}

/// A palette and the entry of every pixel.
pub(super) struct Indexed {
    pub(super) palette: Vec<[u8; 3]>,
    pub(super) pixels: Vec<u8>,
}

/// Chooses a palette of at most `most` entries that begins with the `fixed` colours. A pixel
/// takes the entry of its left or upper neighbour where that is within `slack` (a distance in
/// colour values), which makes a picture of noise compressible.
pub(super) fn quantise(
    pixels: &[[u8; 3]],
    width: usize,
    fixed: &[[u8; 3]],
    (most, slack): (usize, i32),
) -> Indexed {
    let mut cells = vec![Cell::default(); 1 << (3 * BITS)];
    for pixel in pixels.iter().filter(|p| !fixed.contains(p)) {
        let key = key(*pixel);
        let cell = &mut cells[key as usize];
        cell.key = key;
        cell.count += 1.0;
        for (sum, c) in cell.sum.iter_mut().zip(pixel) {
            *sum += f64::from(*c);
        }
    }
    cells.retain(|c| c.count > 0.0);
    let mut palette = fixed.to_vec();
    palette.extend(split(cells.clone(), most - fixed.len()));
    let mut entry = vec![0_u8; 1 << (3 * BITS)];
    for cell in &cells {
        entry[cell.key as usize] = nearest(&palette, cell.mean());
    }
    let mut out: Vec<u8> = Vec::with_capacity(pixels.len());
    for (i, pixel) in pixels.iter().enumerate() {
        let exact = fixed.iter().position(|f| f == pixel).map(|f| f as u8);
        let left = (i % width > 0).then(|| out[i - 1]);
        let above = (i >= width).then(|| out[i - width]);
        let close = |e: &u8| distance(palette[usize::from(*e)], *pixel) <= slack * slack;
        let neighbour = || left.filter(close).or(above.filter(close)).filter(|_| slack > 0);
        out.push(exact.or_else(neighbour).unwrap_or(entry[key(*pixel) as usize]));
    }
    Indexed { palette, pixels: out }
}

fn key(pixel: [u8; 3]) -> u32 {
    pixel.iter().fold(0, |key, c| key << BITS | u32::from(*c) >> (8 - BITS))
}

fn distance(a: [u8; 3], b: [u8; 3]) -> i32 {
    a.iter().zip(b).map(|(a, b)| (i32::from(*a) - i32::from(b)).pow(2)).sum()
}

fn nearest(palette: &[[u8; 3]], colour: [f64; 3]) -> u8 {
    let far = |p: &[u8; 3]| -> f64 {
        p.iter().zip(colour).map(|(p, c)| (f64::from(*p) - c).powi(2)).sum()
    };
    let ranked = palette.iter().enumerate().min_by(|a, b| far(a.1).total_cmp(&far(b.1)));
    ranked.map_or(0, |(i, _)| i as u8)
}

/// The means of boxes of cells; the box with the largest error is split until there are enough.
fn split(cells: Vec<Cell>, most: usize) -> Vec<[u8; 3]> {
    let mut boxes = vec![Spread::new(cells)];
    while boxes.len() < most {
        let worst = boxes.iter().enumerate().max_by(|a, b| a.1.error.total_cmp(&b.1.error));
        let Some(at) = worst.filter(|(_, b)| b.error > 0.0).map(|(i, _)| i) else {
            break;
        };
        let Spread { cells, axis, mean, .. } = boxes.swap_remove(at);
        let (low, high): (Vec<Cell>, Vec<Cell>) =
            cells.into_iter().partition(|c| c.mean()[axis] < mean[axis]);
        if low.is_empty() || high.is_empty() {
            // All cells have the same colour up to rounding.
            boxes.push(Spread { cells: [low, high].concat(), axis, mean, error: 0.0 });
        } else {
            boxes.extend([Spread::new(low), Spread::new(high)]);
        }
    }
    let mut colours: Vec<[u8; 3]> = boxes
        .iter()
        .filter(|b| !b.cells.is_empty())
        .map(|b| b.mean.map(|m| m.round() as u8))
        .collect();
    colours.sort_unstable();
    colours
}

/// A box of cells with its spread.
struct Spread {
    cells: Vec<Cell>,
    axis: usize,
    mean: [f64; 3],
    error: f64,
}

impl Spread {
    fn new(cells: Vec<Cell>) -> Self {
        // Rare colours (texts, small bodies) count more than their number.
        let weight = |c: &Cell| c.count.powf(0.6);
        let total: f64 = cells.iter().map(weight).sum();
        let mut mean = [0.0; 3];
        for cell in &cells {
            for (m, c) in mean.iter_mut().zip(cell.mean()) {
                *m += c * weight(cell) / total;
            }
        }
        let spread = [0, 1, 2].map(|axis| {
            let one = |c: &Cell| weight(c) * (c.mean()[axis] - mean[axis]).powi(2);
            cells.iter().map(one).sum::<f64>()
        });
        let axis = (0..3).max_by(|a, b| spread[*a].total_cmp(&spread[*b])).unwrap_or(0);
        Self { cells, axis, mean, error: spread.iter().sum() }
    }
}
