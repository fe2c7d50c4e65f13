//! Pairs within reach, found cell by cell.
//!
//! The members of a cell share their candidates: the windows of five rows of cells, copied side by
//! side and relative to the cell, in `f32`. Windows look forward only, and no pair is met twice.
//! Exposed members look at all candidates, the others at the exposed ones.

use super::grid::{Grid, Member};
use super::held;
use super::sort::{put, roomy};
use super::windows::Windows;

/// Cells per chunk.
pub(super) const CHUNK: usize = 128;

/// Candidates that are looked at together.
const LANES: usize = 32;

/// Distance from the origin, in reaches, that no two members of one true cell have.
const FAR: f32 = 4.0;

/// What a thread found, and the memory it needs for that.
#[derive(Debug, Default)]
pub(super) struct Finder {
    /// Pairs, the lower index first.
    pub(super) pairs: Vec<[u32; 2]>,
    /// Distances compared.
    pub(super) tests: u64,
    block: Block,
}

/// Candidates of a cell, relative to it, in units of the longest reach.
#[derive(Debug, Default)]
struct Block {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    limit: Vec<f32>,
    id: Vec<u32>,
    /// Candidates in the columns, which may be longer.
    used: usize,
}

/// Origin and inverse unit of a block.
#[derive(Clone, Copy)]
struct Frame {
    origin: [f64; 3],
    scale: f64,
}

impl Frame {
    #[inline(always)]
    fn place(&self, member: &Member) -> [f32; 3] {
        [0, 1, 2].map(|k| ((member.at[k] - self.origin[k]) * self.scale) as f32)
    }
}

impl Block {
    /// Bytes that it takes.
    fn bytes(&self) -> usize {
        let columns = [&self.x, &self.y, &self.z, &self.limit].map(held);
        columns.iter().sum::<usize>() + held(&self.id)
    }

    /// Makes room for that many candidates and those that fill the last group of lanes.
    fn reserve(&mut self, n: usize) {
        let n = n.next_multiple_of(LANES);
        if self.id.len() < n {
            for column in [&mut self.x, &mut self.y, &mut self.z, &mut self.limit] {
                column.resize(n, 0.0);
            }
            self.id.resize(n, 0);
        }
    }

    fn add(&mut self, members: &[Member], frame: &Frame) {
        let range = self.used..self.used + members.len();
        self.used = range.end;
        let to = self.x[range.clone()].iter_mut().zip(&mut self.y[range.clone()]);
        let to = to.zip(&mut self.z[range.clone()]).zip(&mut self.limit[range.clone()]);
        let to = to.zip(&mut self.id[range]);
        for (((((x, y), z), limit), id), member) in to.zip(members) {
            [*x, *y, *z] = frame.place(member);
            (*limit, *id) = (member.limit, member.id);
        }
    }

    /// Fills with the members of several ranges, and the last group of lanes with candidates that
    /// nothing can reach.
    fn fill<'a>(&mut self, ranges: impl Iterator<Item = &'a [Member]> + Clone, frame: &Frame) {
        self.reserve(ranges.clone().map(<[Member]>::len).sum());
        self.used = 0;
        for members in ranges {
            self.add(members, frame);
        }
        self.x[self.used..self.used.next_multiple_of(LANES)].fill(f32::INFINITY);
    }
}

impl Finder {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        held(&self.pairs) + self.block.bytes()
    }

    /// Forgets what it found.
    pub(super) fn clear(&mut self) {
        self.pairs.clear();
        self.tests = 0;
    }

    /// Adds what another found.
    pub(super) fn take(&mut self, other: &Self) {
        let all = self.pairs.len() + other.pairs.len();
        roomy(&mut self.pairs, all);
        self.pairs.extend_from_slice(&other.pairs);
        self.tests += other.tests;
    }

    /// Searches chunk `c` of the cells.
    pub(super) fn search(&mut self, grid: &Grid, c: usize, keep: &impl Fn(u32, u32) -> bool) {
        let mut windows = Windows::new(grid, c * CHUNK);
        for cell in c * CHUNK..((c + 1) * CHUNK).min(grid.keys.len()) {
            windows.advance(grid, cell);
            self.cell(grid, cell, &windows, keep);
        }
    }

    fn cell(
        &mut self,
        grid: &Grid,
        cell: usize,
        windows: &Windows,
        keep: &impl Fn(u32, u32) -> bool,
    ) {
        let members = range(&grid.all, &grid.start, [cell, cell + 1]);
        let (exposed, hidden) = members.split_at(grid.exposed(cell).len());
        let frame = Frame { origin: members[0].at, scale: grid.scale };
        let own = if windows.own { members } else { &[] };
        let others = windows.cells.iter().map(|&cells| range(&grid.all, &grid.start, cells));
        let all = std::iter::once(own).chain(others);
        self.scan_all(exposed, &all, (&frame, windows.own), keep);
        let cells = windows.cells.iter().flat_map(|&[from, to]| from..to);
        let others = cells.map(|cell| grid.exposed(cell));
        self.scan_all(hidden, &others, (&frame, false), keep);
    }

    /// Compares members with the candidates in the ranges, of which they are the first if `own`.
    fn scan_all<'a>(
        &mut self,
        members: &[Member],
        ranges: &(impl Iterator<Item = &'a [Member]> + Clone),
        (frame, own): (&Frame, bool),
        keep: &impl Fn(u32, u32) -> bool,
    ) {
        if members.is_empty() {
            return;
        }
        self.block.fill(ranges.clone(), frame);
        let mut frame = *frame;
        for (k, member) in members.iter().enumerate() {
            let first = if own { k + 1 } else { 0 };
            if first >= self.block.used {
                return;
            }
            if frame.place(member).iter().any(|along| along.abs() > FAR) {
                // Only by folding are they in the same cell: `f32` needs an origin nearby.
                frame.origin = member.at;
                self.block.fill(ranges.clone(), &frame);
            }
            self.tests += (self.block.used - first) as u64;
            self.scan((frame.place(member), member), first, keep);
        }
    }

    /// Compares a member with the candidates from `first` on.
    #[inline(always)]
    fn scan(
        &mut self,
        (at, member): ([f32; 3], &Member),
        first: usize,
        keep: &impl Fn(u32, u32) -> bool,
    ) {
        let Self { pairs, block: Block { x, y, z, limit, id, used }, .. } = self;
        let columns = x[..used.next_multiple_of(LANES)]
            .as_chunks()
            .0
            .iter()
            .zip(y.as_chunks().0)
            .zip(z.as_chunks().0);
        let columns = columns.zip(limit.as_chunks().0).zip(id.as_chunks::<LANES>().0);
        let mut hidden = u32::MAX << (first % LANES);
        for ((((x, y), z), limit), id) in columns.skip(first / LANES) {
            let mut hits = hits(at, member.limit, [x, y, z, limit]) & hidden;
            hidden = u32::MAX;
            while hits != 0 {
                let other = id[hits.trailing_zeros() as usize % LANES];
                hits &= hits - 1;
                let pair = [member.id.min(other), member.id.max(other)];
                if keep(pair[0], pair[1]) {
                    put(pairs, pair);
                }
            }
        }
    }
}

/// One bit for each candidate within reach.
#[inline(always)]
fn hits(at: [f32; 3], own: f32, [x, y, z, limit]: [&[f32; LANES]; 4]) -> u32 {
    let mut bits = [0; LANES];
    for k in 0..LANES {
        let [dx, dy, dz] = [x[k] - at[0], y[k] - at[1], z[k] - at[2]];
        let limit = if limit[k] > own { limit[k] } else { own };
        let near = dx * dx + dy * dy + dz * dz < limit;
        bits[k] = u32::from(near) << k;
    }
    bits.iter().fold(0, |all, bit| all | bit)
}

/// Members of a range of cells.
#[inline(always)]
fn range<'a>(table: &'a [Member], start: &[u32], [a, b]: [usize; 2]) -> &'a [Member] {
    &table[start[a] as usize..start[b] as usize]
}
