//! Members sorted by cell.
//!
//! Cells are as long as the longest reach. Rows of cells along x follow each other in the sorted
//! order, and the cells of a row within reach of another cell stand side by side. Distances
//! are always taken between true positions: two members far apart may share a cell (see [`fold`]),
//! which costs time and changes no answer.

use super::held;
use super::sort::{Item, Sorter, Stand, roomy};
use super::trace::Trace;
use super::{Points, Reach};

/// Cells per axis, beyond which cells are folded onto each other.
const MOST: i64 = (1 << 21) - 8;

/// Free cells in front of the first and behind the last of a row, so that no end of a window can
/// fall into another row.
pub(super) const MARGIN: u64 = 1;

/// By how much the reach is enlarged, once for what is listed and once more before it is compared in `f32`.
pub(super) const SLACK: f64 = 1e-5;

/// A member in the order of the cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member {
    pub(super) at: [f64; 3],
    /// Square of its reach, in units of the longest.
    pub(super) limit: f32,
    pub(super) id: u32,
}

/// While members are sorted, they are not known.
impl Stand for Member {
    #[inline(always)]
    fn of(item: Item) -> Self {
        Self { at: [f64::from_bits(item.key), 0.0, 0.0], limit: 0.0, id: item.id }
    }

    #[inline(always)]
    fn item(&self) -> Item {
        Item { key: self.at[0].to_bits(), id: self.id }
    }
}

/// The occupied cells and their members.
#[derive(Debug, Clone, Default)]
pub(super) struct Grid {
    /// Bits of a key for each axis.
    pub(super) bits: [u32; 3],
    /// Key of each occupied cell, in order.
    pub(super) keys: Vec<u64>,
    /// Members in front of each cell, and of all.
    pub(super) start: Vec<u32>,
    /// Exposed members in front of each cell, and of all.
    pub(super) start_exposed: Vec<u32>,
    /// What is in each cell; empty without lattice coordinates.
    pub(super) traces: Vec<Trace>,
    /// All members; in each cell the exposed ones first, and then by index.
    pub(super) all: Vec<Member>,
    /// Inverse of the longest reach.
    pub(super) scale: f64,
}

impl Grid {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        let cells = held(&self.keys) + held(&self.start) + held(&self.start_exposed);
        held(&self.all) + cells + held(&self.traces)
    }

    /// Members of a cell.
    #[inline(always)]
    pub(super) fn members(&self, cell: u32) -> &[Member] {
        let cell = cell as usize;
        &self.all[self.start[cell] as usize..self.start[cell + 1] as usize]
    }

    /// Exposed members of a cell.
    #[inline(always)]
    pub(super) fn exposed(&self, cell: usize) -> &[Member] {
        let (start, before) = (self.start[cell] as usize, &self.start_exposed[cell..cell + 2]);
        &self.all[start..start + (before[1] - before[0]) as usize]
    }

    /// Members of a cell and of all cells that touch it.
    pub(super) fn round(&self, cell: usize) -> impl Iterator<Item = &Member> {
        let row = 1 << self.bits[0];
        let plane = 1 << (self.bits[0] + self.bits[1]);
        let key = self.keys[cell];
        let first = |key: u64| self.keys.partition_point(|&own| own < key);
        let round = |step: u64| [0u64.wrapping_sub(step), 0, step];
        round(plane).into_iter().flat_map(move |out| {
            round(row).into_iter().flat_map(move |up| {
                // Cells have a margin on all sides: no row begins before the first key.
                let middle = key.wrapping_add(out).wrapping_add(up);
                let cells = [middle - MARGIN, middle + MARGIN + 1].map(first);
                &self.all[self.start[cells[0]] as usize..self.start[cells[1]] as usize]
            })
        })
    }

    /// Takes all members out.
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.keys.clear();
        self.start.clear();
        self.start.push(0);
    }

    /// Sorts the members into cells, with the memory of a sorter. The longest reach, `far`, must be positive.
    pub(super) fn build(
        &mut self,
        points: &Points<'_>,
        (far, reach): (f64, Reach),
        sorter: &mut Sorter,
    ) {
        self.sort(points, far, sorter);
        self.cells(points, &sorter.items);
        self.scale = 1.0 / far;
        self.all.clear();
        roomy(&mut self.all, points.x.len());
        for item in &sorter.items {
            let i = item.id as usize;
            let own = (reach.factor * f64::from(points.length[i]) + reach.skin) * self.scale;
            // The last term covers the rounding of positions in `f32`, relative to the longest reach: what
            // is listed is decided in `f64`.
            let limit = (own * (1.0 + SLACK) + SLACK).powi(2) as f32;
            let at = [points.x[i], points.y[i], points.z[i]];
            self.all.push(Member { at, limit, id: item.id });
        }
    }

    fn sort(&mut self, points: &Points<'_>, far: f64, sorter: &mut Sorter) {
        // Wider than the reach by more than the slack of the comparison and the rounding here.
        let per = 1.0 / (far * (1.0 + 4.0 * SLACK));
        let axes = [points.x, points.y, points.z];
        let mut corner = [0.0; 3];
        for k in 0..3 {
            let [low, high] = range(axes[k]);
            let last = ((high - low) * per).max(0.0) as u64;
            // A corner at the other end of the world would cost the others their last digits.
            corner[k] = if last < MOST as u64 { low } else { -0.5 * MOST as f64 / per };
            let last = last.min(MOST as u64 - 1);
            self.bits[k] = u64::BITS - (last + 2 * MARGIN).leading_zeros();
        }
        let shift = [0, self.bits[0], self.bits[0] + self.bits[1]];
        let key = |i: usize| {
            let at = |k: usize| {
                let cell = fold((axes[k][i] - corner[k]) * per);
                (cell + MARGIN) << shift[k]
            };
            at(0) | at(1) | at(2)
        };
        let items = &mut sorter.items;
        items.clear();
        roomy(items, points.x.len());
        // The sort keeps the order of equal keys: exposed members come first in each cell.
        for first in [true, false] {
            let chosen = (0..).zip(points.flags).filter(|&(i, _)| points.is_exposed(i) == first);
            items.extend(chosen.map(|(i, _)| Item { key: key(i as usize), id: i }));
        }
        sorter.sort(self.bits.iter().sum(), &mut self.all);
    }

    fn cells(&mut self, points: &Points<'_>, items: &[Item]) {
        let cells = items.chunk_by(|&a, &b| { a.key } == { b.key }).count();
        for buffer in [&mut self.start, &mut self.start_exposed] {
            buffer.clear();
            roomy(buffer, cells + 1);
        }
        self.keys.clear();
        roomy(&mut self.keys, cells);
        self.traces.clear();
        if points.lattice.is_some() {
            roomy(&mut self.traces, cells);
        }
        let mut exposed = 0;
        let mut before = None;
        for (k, item) in (0..).zip(items) {
            if before != Some(item.key) {
                before = Some(item.key);
                self.keys.push(item.key);
                self.start.push(k);
                self.start_exposed.push(exposed);
                if points.lattice.is_some() {
                    self.traces.push(Trace::NOTHING);
                }
            }
            exposed += u32::from(points.is_exposed(item.id));
            if let (Some(lattice), Some(trace)) = (points.lattice, self.traces.last_mut()) {
                trace.add(points, lattice, item.id as usize);
            }
        }
        self.start.push(items.len() as u32);
        self.start_exposed.push(exposed);
    }
}

/// Lowest and highest value.
fn range(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &v| {
        [if v < low { v } else { low }, if v > high { v } else { high }]
    })
}

/// Number of the cell at a place. Where they go beyond `0..MOST`, cells are folded like a strip of
/// paper: neighbours remain neighbours.
#[inline(always)]
fn fold(place: f64) -> u64 {
    let cell = place as i64;
    if place >= 0.0 && cell < MOST {
        return cell as u64;
    }
    let floor = cell.saturating_sub(i64::from((cell as f64) > place));
    let along = floor.rem_euclid(2 * MOST);
    along.min(2 * MOST - 1 - along) as u64
}
