//! How far members may have come towards each other since the list was made.
//!
//! Members are put into blocks, and blocks two by two into a tree. Of each block and each node are
//! known the box that held it when the list was made, and, at every question, the box of its
//! displacements. Two nodes need no closer look if no member of one can have moved, relative to any
//! of the other, by more than the skin, or by more than the gap that was between them leaves free.
//! Common motion, however fast, costs nothing.

use rayon::prelude::*;

use super::Points;
use super::grid::{Grid, Member};
use super::held;
use super::sort::{Item, Sorter, put, roomy};

/// Blocks per chunk.
const CHUNK: usize = 64;

/// Lowest level of the tree at which the two parts of a node are worth two threads.
const SPLIT: usize = 8;

/// Cells per block along each axis, as powers of two: two reaches each way.
const COARSE: [u32; 3] = [1, 1, 1];

/// A box: lowest and highest corner.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

/// Limits of the relative motion.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Free {
    /// Of any two members.
    pub(super) skin: f64,
    /// Longest contact length: what the gap between two boxes must not fall below.
    pub(super) contact: f64,
}

/// One level of the tree.
#[derive(Debug, Clone, Default)]
struct Level {
    /// Where the members of each node were.
    places: Vec<Bounds>,
    /// How they have moved.
    moves: Vec<Bounds>,
}

/// State of the members when the list was made.
#[derive(Debug, Clone, Default)]
pub(super) struct Motion {
    /// Members of the grid that stand side by side in a block, from the first to the one behind the last.
    runs: Vec<[u32; 2]>,
    /// Runs in front of each block, and of all.
    start: Vec<u32>,
    /// Memory to sort cells with.
    spare: Vec<Item>,
    /// Blocks, pairs of blocks, and so on up to a single node.
    levels: Vec<Level>,
    depth: usize,
    free: Free,
}

impl Bounds {
    const NOTHING: Self = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };

    #[inline(always)]
    fn add(&mut self, at: [f64; 3]) {
        self.join(&Self { low: at, high: at });
    }

    #[inline(always)]
    fn join(&mut self, other: &Self) {
        for k in 0..3 {
            self.low[k] = if other.low[k] < self.low[k] { other.low[k] } else { self.low[k] };
            self.high[k] = if other.high[k] > self.high[k] { other.high[k] } else { self.high[k] };
        }
    }

    /// Square of the shortest distance between points of two boxes.
    #[inline(always)]
    fn gap(&self, other: &Self) -> f64 {
        let along =
            |k: usize| (other.low[k] - self.high[k]).max(self.low[k] - other.high[k]).max(0.0);
        along(0).powi(2) + along(1).powi(2) + along(2).powi(2)
    }

    /// Square of the longest distance between points of two boxes.
    #[inline(always)]
    fn spread(&self, other: &Self) -> f64 {
        let along = |k: usize| (other.high[k] - self.low[k]).max(self.high[k] - other.low[k]);
        along(0).powi(2) + along(1).powi(2) + along(2).powi(2)
    }
}

impl Motion {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        let levels: usize =
            self.levels.iter().map(|level| held(&level.places) + held(&level.moves)).sum();
        let all = held(&self.runs) + held(&self.start) + held(&self.spare);
        all + held(&self.levels) + levels
    }

    /// Sets the limits for the list to come.
    pub(super) fn limit(&mut self, free: Free) {
        self.free = free;
    }

    /// Remembers where the members are, with the memory of a sorter.
    pub(super) fn start(&mut self, grid: &Grid, sorter: &mut Sorter) {
        self.sort(grid, sorter);
        self.start.clear();
        self.runs.clear();
        let mut block = None;
        for item in &sorter.items {
            let [first, end] = [0, 1].map(|k| grid.start[item.id as usize + k]);
            let same = block == Some(item.key);
            match self.runs.last_mut().filter(|run| same && run[1] == first) {
                Some(run) => run[1] = end,
                None => {
                    if !same {
                        put(&mut self.start, self.runs.len() as u32);
                    }
                    put(&mut self.runs, [first, end]);
                }
            }
            block = Some(item.key);
        }
        put(&mut self.start, self.runs.len() as u32);
        self.grow(grid);
    }

    /// Puts the cells into the order of a space-filling curve over the blocks.
    fn sort(&mut self, grid: &Grid, sorter: &mut Sorter) {
        let items = &mut sorter.items;
        items.clear();
        roomy(items, grid.keys.len());
        let most = (0..3).map(|k| grid.bits[k].saturating_sub(COARSE[k])).max().unwrap_or(0);
        let shift = [0, grid.bits[0], grid.bits[0] + grid.bits[1]];
        for (cell, &key) in (0..).zip(&grid.keys) {
            let part = |k: usize| {
                let along = (key >> shift[k]) & ((1 << grid.bits[k]) - 1);
                part_bits(along >> COARSE[k]) << k
            };
            items.push(Item { key: part(0) | part(1) | part(2), id: cell });
        }
        sorter.sort(3 * most, &mut self.spare);
    }

    /// Builds the tree over the blocks.
    fn grow(&mut self, grid: &Grid) {
        let mut nodes = self.start.len() - 1;
        self.depth = 0;
        while nodes > 0 {
            if self.levels.len() == self.depth {
                self.levels.push(Level::default());
            }
            let level = &mut self.levels[self.depth];
            for column in [&mut level.places, &mut level.moves] {
                column.clear();
                roomy(column, nodes);
                column.resize(nodes, Bounds::NOTHING);
            }
            self.depth += 1;
            nodes = if nodes == 1 { 0 } else { nodes.div_ceil(2) };
        }
        let Self { runs, start, levels, depth, .. } = self;
        let Some(leaves) = levels.first_mut() else { return };
        for (place, range) in leaves.places.iter_mut().zip(start.windows(2)) {
            members(grid, runs, range).for_each(|member| place.add(member.at));
        }
        climb(&mut levels[..*depth], |level| &mut level.places);
    }

    /// Whether two members that were apart by more than the skin may be in contact.
    pub(super) fn is_large(&mut self, grid: &Grid, points: &Points<'_>) -> bool {
        let Self { runs, start, levels, depth, .. } = self;
        if *depth == 0 {
            return false;
        }
        levels[0].moves.par_chunks_mut(CHUNK).enumerate().for_each(|(c, moves)| {
            for (own, range) in moves.iter_mut().zip(start[c * CHUNK..].windows(2)) {
                *own = Bounds::NOTHING;
                for Member { at, id, .. } in members(grid, runs, range) {
                    let i = *id as usize;
                    own.add([points.x[i] - at[0], points.y[i] - at[1], points.z[i] - at[2]]);
                }
            }
        });
        climb(&mut levels[..*depth], |level| &mut level.moves);
        !self.is_free(self.depth - 1, 0, 0)
    }

    /// Whether no member of node `a` can have come into contact with one of node `b`.
    fn is_free(&self, level: usize, a: usize, b: usize) -> bool {
        let Level { places, moves } = &self.levels[level];
        let spread = moves[a].spread(&moves[b]);
        if spread <= self.free.skin.powi(2) {
            return true;
        }
        let gap = places[a].gap(&places[b]);
        let needed = self.free.contact + spread.sqrt();
        if gap > needed.powi(2) {
            return true;
        }
        if level == 0 {
            return false;
        }
        let end = self.levels[level - 1].places.len();
        let children = |node: usize| 2 * node..(2 * node + 2).min(end);
        let with = |i: usize| {
            let others = if a == b { i..children(b).end } else { children(b) };
            others.into_iter().all(|j| self.is_free(level - 1, i, j))
        };
        if level < SPLIT {
            return children(a).all(with);
        }
        let last = children(a).end - 1;
        let (first, second) = rayon::join(|| with(2 * a), || last == 2 * a || with(last));
        first && second
    }
}

/// Members of a range of runs.
#[inline(always)]
fn members<'a>(
    grid: &'a Grid,
    runs: &'a [[u32; 2]],
    range: &[u32],
) -> impl Iterator<Item = &'a Member> {
    let runs = &runs[range[0] as usize..range[1] as usize];
    runs.iter().flat_map(|run| &grid.all[run[0] as usize..run[1] as usize])
}

/// Joins the boxes of two nodes each, from the blocks upwards.
fn climb(levels: &mut [Level], boxes: impl Fn(&mut Level) -> &mut Vec<Bounds>) {
    for k in 1..levels.len() {
        let (below, above) = levels.split_at_mut(k);
        let below = boxes(&mut below[k - 1]);
        for (node, parts) in boxes(&mut above[0]).iter_mut().zip(below.chunks(2)) {
            *node = Bounds::NOTHING;
            for part in parts {
                node.join(part);
            }
        }
    }
}

/// Spreads the bits of a number: two free ones behind each.
#[inline(always)]
fn part_bits(number: u64) -> u64 {
    let mut bits = number & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x1f_0000_0000_ffff),
        (16, 0x1f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        bits = (bits | (bits << shift)) & mask;
    }
    bits
}
