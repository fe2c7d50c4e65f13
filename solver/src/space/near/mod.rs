//! Neighbour search: pairs of members that may come into contact, kept until they are stale.
//!
//! A pair is listed if at least one of the two is exposed, their distance is less than their reach,
//! `factor * max(length) + skin`, and the caller keeps it. The list serves until two members that
//! are not on it may be closer than `factor * max(length)`.
//!
//! Invariant: what is found and the order of the list do not depend on the number of threads.

mod grid;
mod join;
mod motion;
mod search;
mod sort;
#[cfg(test)]
mod tests;
mod trace;
mod windows;

use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use grid::{Grid, SLACK};
use join::Joiner;
use motion::{Free, Motion};
use search::{CHUNK, Finder};
use sort::Sorter;

pub(super) use sort::{put, roomy};

/// Flag of a member that can be in contact with any other.
pub const EXPOSED: u8 = 1;

/// Flag of a member without live elements, for which the lattice says nothing.
pub const DEBRIS: u8 = 2;

/// Members, column by column, all of the same length.
#[derive(Debug, Clone, Copy)]
pub struct Points<'a> {
    /// Positions along x.
    pub x: &'a [f64],
    /// Positions along y.
    pub y: &'a [f64],
    /// Positions along z.
    pub z: &'a [f64],
    /// Contact lengths.
    pub length: &'a [f32],
    /// [`EXPOSED`] and [`DEBRIS`].
    pub flags: &'a [u8],
    /// Bodies that the members belong to.
    pub body: &'a [u16],
    /// Places in the lattices of the bodies. If given, a pair may be left out if both belong
    /// to the same body, neither is debris, and they are at most 12 apart along each lattice axis:
    /// the caller promises to have no use for such pairs.
    pub lattice: Option<&'a [[i16; 3]]>,
}

/// How far to look for pairs.
#[derive(Debug, Clone, Copy, Default)]
pub struct Reach {
    /// Distance of contact, in contact lengths.
    pub factor: f64,
    /// By how much the list reaches further than contact.
    pub skin: f64,
}

impl Reach {
    /// Whether members with these contact lengths are to be listed, at these places. However a pair is come
    /// upon, this alone decides: a list does not depend on how it came to be.
    fn holds(&self, [a, b]: [[f64; 3]; 2], [p, q]: [f32; 2]) -> bool {
        // The slack is for the motion that is measured from here on.
        let far = (self.factor * f64::from(p.max(q)) + self.skin) * (1.0 + SLACK);
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>() < far * far
    }
}

/// What the search has done so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Lists made.
    pub rebuilds: u64,
    /// Distances compared.
    pub tests: u64,
    /// Pairs listed, inserted ones included.
    pub pairs: u64,
}

/// List of pairs, with the memory that it takes to make it.
///
/// Buffers are kept: a rebuild allocates only if there is more to hold than ever before.
#[derive(Debug, Clone, Default)]
pub struct PairList {
    grid: Grid,
    motion: Motion,
    sorter: Sorter,
    /// What is found, thread by thread.
    finders: Vec<OneThread>,
    joiner: Joiner,
    pairs: Vec<[u32; 2]>,
    /// Pairs to be added.
    batch: Vec<[u32; 2]>,
    counters: Counters,
    /// Reach that the list was made for.
    reach: Reach,
    /// Members that the list was made for.
    members: Option<usize>,
}

/// Memory of one thread; the lock is never waited for.
#[derive(Debug, Default)]
struct OneThread(Mutex<Finder>);

impl OneThread {
    // Of a thread that panicked nothing is left that matters: what it found is cleared before a search.
    fn lock(&self) -> MutexGuard<'_, Finder> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn get(&mut self) -> &mut Finder {
        self.0.get_mut().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Clone for OneThread {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Points<'_> {
    #[inline(always)]
    fn is_exposed(&self, i: u32) -> bool {
        self.flags[i as usize] & EXPOSED != 0
    }

    #[inline(always)]
    fn at(&self, i: u32) -> [f64; 3] {
        [self.x, self.y, self.z].map(|x| x[i as usize])
    }

    fn has_columns_of(&self, n: usize) -> bool {
        let lattice = self.lattice.is_none_or(|lattice| lattice.len() == n);
        let flags = self.length.len() == n && self.flags.len() == n && self.body.len() == n;
        lattice && flags && self.y.len() == n && self.z.len() == n
    }
}

impl PairList {
    /// A list of nothing, which is stale.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes the list anew. `keep(i, j)`, with `i < j`, is asked about each pair within reach.
    ///
    /// Pairs are listed with a reach enlarged by 1e-5 of it, because of rounding.
    ///
    /// # Panics
    /// If columns differ in length.
    pub fn rebuild(
        &mut self,
        points: &Points<'_>,
        reach: Reach,
        keep: impl Fn(u32, u32) -> bool + Sync,
    ) {
        let n = points.x.len();
        assert!(points.has_columns_of(n), "columns of members differ in length");
        self.members = Some(n);
        self.counters.rebuilds += 1;
        let longest = points.length.iter().fold(0.0_f32, |a, &b| if b > a { b } else { a });
        let contact = reach.factor * f64::from(longest);
        let reach = Reach { skin: reach.skin.max(0.0), ..reach };
        self.reach = reach;
        let skin = reach.skin;
        let far = contact + skin;
        if far > 0.0 {
            self.grid.build(points, (far, reach), &mut self.sorter);
        } else {
            self.grid.clear();
        }
        let chunks = self.grid.keys.len().div_ceil(CHUNK);
        self.motion.limit(Free { skin, contact: contact + SLACK * far });
        let holds = |i: u32, j: u32| {
            let lengths = [i, j].map(|i| points.length[i as usize]);
            reach.holds([i, j].map(|i| points.at(i)), lengths)
        };
        self.search(chunks, &|i, j| keep(i, j) && holds(i, j));
        let Self { finders, joiner, pairs, counters, .. } = self;
        let Some((first, others)) = finders.split_first_mut() else { return };
        let first = first.get();
        for other in others {
            first.take(other.get());
        }
        counters.tests += first.tests;
        joiner.join(&mut first.pairs, n, pairs);
        self.counters.pairs += self.pairs.len() as u64;
    }

    fn search(&mut self, chunks: usize, keep: &(impl Fn(u32, u32) -> bool + Sync)) {
        let threads = rayon::current_num_threads();
        if self.finders.len() < threads {
            self.finders.resize_with(threads, OneThread::default);
        }
        let Self { grid, motion, sorter, finders, .. } = self;
        finders.iter_mut().for_each(|finder| finder.get().clear());
        let chunks = (0..chunks).into_par_iter();
        rayon::join(
            || {
                chunks.for_each(|c| {
                    let own = rayon::current_thread_index().unwrap_or(0);
                    finders[own].lock().search(grid, c, keep);
                });
            },
            || motion.start(grid, sorter),
        );
    }

    /// The pairs `[i, j]` with `i < j`, sorted by `i` and then by `j`.
    #[must_use]
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// Adds pairs found otherwise, which must have `i < j`, at their places in the order; those
    /// that are listed already are left out. `batch` is left sorted, with the pairs that were new.
    ///
    /// The list is merged from the back once, whatever the size of the batch.
    pub fn insert(&mut self, batch: &mut Vec<[u32; 2]>) {
        self.counters.pairs += join::merge(&mut self.pairs, batch) as u64;
    }

    /// Adds the pairs of members that have become able to touch, at the places and within the reach
    /// for which the list was made: what a list made anew at those places would have besides.
    /// `keep(i, j)`, with `i < j`, is asked about each; one of the two is `fresh`. Contact lengths are
    /// those that the list was made for.
    pub fn extend(
        &mut self,
        length: &[f32],
        fresh: impl Fn(u32) -> bool,
        keep: impl Fn(u32, u32) -> bool,
    ) {
        let mut batch = std::mem::take(&mut self.batch);
        batch.clear();
        for cell in 0..self.grid.keys.len() {
            for member in self.grid.members(cell as u32).iter().filter(|one| fresh(one.id)) {
                for other in self.grid.round(cell).filter(|other| other.id != member.id) {
                    let pair = [member.id.min(other.id), member.id.max(other.id)];
                    let lengths = pair.map(|i| length[i as usize]);
                    let holds = self.reach.holds([member.at, other.at], lengths);
                    if holds && keep(pair[0], pair[1]) {
                        put(&mut batch, pair);
                    }
                }
            }
        }
        self.insert(&mut batch);
        self.batch = batch;
    }

    /// Whether two members not listed may be closer than `factor * max(length)`: never `false` if
    /// they are. Always `true` before the first rebuild and if the number of members has changed.
    pub fn is_stale(&mut self, points: &Points<'_>) -> bool {
        self.members != Some(points.x.len()) || self.motion.is_large(&self.grid, points)
    }

    /// Members and where they were when the list was made.
    pub fn made_at(&self) -> impl Iterator<Item = (u32, [f64; 3])> + '_ {
        self.grid.all.iter().map(|member| (member.id, member.at))
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let found: usize = self.finders.iter().map(|finder| finder.lock().bytes()).sum();
        let found = found + held(&self.finders);
        let lists = held(&self.pairs) + held(&self.batch) + self.joiner.bytes();
        self.grid.bytes() + self.motion.bytes() + self.sorter.bytes() + found + lists
    }

    /// What the search has done so far.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }
}

/// Bytes that a buffer holds.
fn held<T>(buffer: &Vec<T>) -> usize {
    buffer.capacity() * std::mem::size_of::<T>()
}
