//! Pairs of all chunks, joined and sorted.

use super::held;
use super::sort::roomy;

/// Memory for joining.
#[derive(Debug, Clone, Default)]
pub(super) struct Joiner {
    /// For each index, how many pairs have it first and second; then where the next of them goes.
    places: Vec<[u32; 2]>,
    by_second: Vec<[u32; 2]>,
}

impl Joiner {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        held(&self.places) + held(&self.by_second)
    }

    /// Joins the pairs of the chunks, sorted by first index and then by second.
    ///
    /// Two passes of a counting sort: runs are too short, and too random, for comparisons to pay.
    pub(super) fn join<'a>(
        &mut self,
        chunks: impl Iterator<Item = &'a [[u32; 2]]> + Clone,
        members: usize,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        let Self { places, by_second } = self;
        places.clear();
        roomy(places, members);
        places.resize(members, [0; 2]);
        for chunk in chunks.clone() {
            for &[first, second] in chunk {
                places[first as usize][0] += 1;
                places[second as usize][1] += 1;
            }
        }
        let mut sums = [0; 2];
        for place in places.iter_mut() {
            let counts = *place;
            *place = sums;
            sums = [sums[0] + counts[0], sums[1] + counts[1]];
        }
        let found = sums[0] as usize;
        for buffer in [&mut *by_second, &mut *pairs] {
            roomy(buffer, found);
            buffer.resize(found, [0; 2]);
        }
        for chunk in chunks {
            for pair in chunk {
                let place = &mut places[pair[1] as usize][1];
                by_second[*place as usize] = *pair;
                *place += 1;
            }
        }
        for pair in by_second {
            let place = &mut places[pair[0] as usize][0];
            pairs[*place as usize] = *pair;
            *place += 1;
        }
    }
}

/// Merges sorted pairs into others; returns how many were new. `batch` is sorted, and loses what is
/// listed already.
pub(super) fn merge(pairs: &mut Vec<[u32; 2]>, batch: &mut Vec<[u32; 2]>) -> usize {
    batch.sort_unstable();
    batch.dedup();
    batch.retain(|pair| pairs.binary_search(pair).is_err());
    let mut from = pairs.len();
    roomy(pairs, from + batch.len());
    pairs.resize(from + batch.len(), [0; 2]);
    // From the back: no pair is overwritten before it has moved.
    for (ahead, &new) in batch.iter().enumerate().rev() {
        let place = pairs[..from].partition_point(|pair| *pair < new);
        pairs.copy_within(place..from, place + ahead + 1);
        pairs[place + ahead] = new;
        from = place;
    }
    batch.len()
}
