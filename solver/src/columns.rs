//! Columns of the particle state, absent ones included, and the loops over them.
//!
//! Invariant: every parallel loop runs over chunks of [`CHUNK`] particles whatever the number of
//! threads, and sums over particles are taken within a chunk and then over the chunks in order. The
//! same bits come out of 1, 2 or 8 threads.

use std::fmt::Debug;
use std::ops::AddAssign;

use rayon::prelude::*;

/// Particles per chunk.
pub const CHUNK: usize = 1024;

/// Most particles on one side that a particle can act on.
pub const REACH: usize = 64;

/// A value per particle: a vector, or `()` where a scene has no such value.
pub trait Column: Clone + Debug + Default + Send + Sync + 'static {
    /// A column for `n` particles.
    fn zeros(n: usize) -> Self;
    /// Value of particle `i`; zero where there is none.
    fn get(&self, i: usize) -> f64;
    /// Sets the value of particle `i`.
    fn set(&mut self, i: usize, value: f64);
    /// `self[i] = base[i] + dt * rate(i)`, in parallel.
    fn advance(&mut self, base: &Self, rate: impl Fn(usize) -> f64 + Sync);
    /// Copies the value of particle `from` to particle `to`.
    fn copy(&mut self, from: usize, to: usize) {
        self.set(to, self.get(from));
    }
}

impl Column for Vec<f64> {
    fn zeros(n: usize) -> Self {
        vec![0.0; n]
    }

    #[inline(always)]
    fn get(&self, i: usize) -> f64 {
        self[i]
    }

    #[inline(always)]
    fn set(&mut self, i: usize, value: f64) {
        self[i] = value;
    }

    fn advance(&mut self, base: &Self, rate: impl Fn(usize) -> f64 + Sync) {
        chunks(self, |start, own| {
            for (k, value) in own.iter_mut().enumerate() {
                *value = base[start + k] + rate(start + k);
            }
        });
    }
}

impl Column for () {
    fn zeros(_: usize) -> Self {}

    #[inline(always)]
    fn get(&self, _: usize) -> f64 {
        0.0
    }

    #[inline(always)]
    fn set(&mut self, _: usize, _: f64) {}

    fn advance(&mut self, (): &Self, _: impl Fn(usize) -> f64 + Sync) {}
}

/// A rate that exists, or does not.
pub trait Rate: Copy + Debug + Default + AddAssign + Send + Sync + 'static {
    /// The rate, if the scheme has one.
    fn of(value: f64) -> Self;
    /// Its value; zero where there is none.
    fn value(self) -> f64;
}

impl Rate for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
}

/// The rate that does not exist.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoRate;

impl AddAssign for NoRate {
    #[inline(always)]
    fn add_assign(&mut self, _: Self) {}
}

impl Rate for NoRate {
    #[inline(always)]
    fn of(_: f64) -> Self {
        Self
    }

    #[inline(always)]
    fn value(self) -> f64 {
        0.0
    }
}

/// Runs `work(start, chunk)` over the chunks of a column; on one thread where there is one chunk.
pub fn chunks<T: Send>(column: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    if column.len() <= CHUNK {
        return work(0, column);
    }
    column.par_chunks_mut(CHUNK).enumerate().for_each(|(c, own)| work(c * CHUNK, own));
}

/// What the pairs of a chunk add up to: its own particles, and those of the next chunk that are in
/// reach.
pub struct Bins<'a, T> {
    start: usize,
    own: &'a mut [T],
    spill: &'a mut Spill<T>,
}

/// Sums of a chunk for the particles of the next.
#[derive(Debug, Clone)]
struct Spill<T> {
    values: [T; REACH],
    /// Length of the part in use.
    used: usize,
}

impl<T: AddAssign> Bins<'_, T> {
    /// Index of the first particle of the chunk.
    #[must_use]
    pub fn start(&self) -> usize {
        self.start
    }

    /// Index past the last particle of the chunk.
    #[must_use]
    pub fn end(&self) -> usize {
        self.start + self.own.len()
    }

    /// Adds to particle `i`, which must be in the chunk or within [`REACH`] behind it.
    #[inline(always)]
    pub fn add(&mut self, i: usize, value: T) {
        let k = i - self.start;
        if k < self.own.len() {
            self.own[k] += value;
        } else {
            let k = k - self.own.len();
            self.spill.values[k] += value;
            self.spill.used = self.spill.used.max(k + 1);
        }
    }
}

/// Memory for sums over pairs: made once, used in every sweep.
#[derive(Debug)]
pub struct Scratch<T, S> {
    spill: Vec<Spill<T>>,
    sums: Vec<S>,
}

impl<T: Copy + Default + AddAssign + Send, S: Default + Send> Scratch<T, S> {
    /// Memory for columns of `n` particles.
    #[must_use]
    pub fn new(n: usize) -> Self {
        let chunks = n.div_ceil(CHUNK);
        Self {
            spill: vec![Spill { values: [T::default(); REACH], used: 0 }; chunks],
            sums: (0..chunks).map(|_| S::default()).collect(),
        }
    }

    /// Sums over pairs. `work` goes through the pairs whose left particle is in the chunk, adds to
    /// the bins of both, and returns what else it counted; that is handed back chunk by chunk.
    pub fn over_pairs(
        &mut self,
        column: &mut [T],
        work: impl Fn(&mut Bins<'_, T>) -> S + Sync,
    ) -> &[S] {
        let one = |c: usize, own: &mut [T], spill: &mut Spill<T>, sum: &mut S| {
            own.fill(T::default());
            spill.values[..spill.used].fill(T::default());
            spill.used = 0;
            *sum = work(&mut Bins { start: c * CHUNK, own, spill });
        };
        if column.len() <= CHUNK {
            one(0, column, &mut self.spill[0], &mut self.sums[0]);
            return &self.sums;
        }
        column
            .par_chunks_mut(CHUNK)
            .zip(self.spill.par_iter_mut())
            .zip(self.sums.par_iter_mut())
            .enumerate()
            .for_each(|(c, ((own, spill), sum))| one(c, own, spill, sum));
        for (c, spill) in self.spill.iter().enumerate() {
            let behind = ((c + 1) * CHUNK).min(column.len());
            for (value, add) in column[behind..].iter_mut().zip(&spill.values[..spill.used]) {
                *value += *add;
            }
        }
        &self.sums
    }
}
