//! Pairs of all threads, joined and sorted.

use super::held;
use super::sort::roomy;

/// Memory for joining.
#[derive(Debug, Clone, Default)]
pub(super) struct Joiner {
    /// For each index, how many pairs have it; then where the next of them goes.
    places: Vec<u32>,
}

impl Joiner {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        held(&self.places)
    }

    /// Sorts the pairs that were found by first index and then by second, into `pairs`. What is left in
    /// `found` is of no use.
    ///
    /// Two passes of a counting sort: runs are too short, and too random, for comparisons to pay.
    pub(super) fn join(
        &mut self,
        found: &mut Vec<[u32; 2]>,
        members: usize,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        roomy(pairs, found.len());
        pairs.resize(found.len(), [0; 2]);
        for which in [1, 0] {
            self.count(members, found, which);
            for pair in &*found {
                let place = &mut self.places[pair[which] as usize];
                pairs[*place as usize] = *pair;
                *place += 1;
            }
            std::mem::swap(found, pairs);
        }
        std::mem::swap(found, pairs);
    }

    /// Finds where pairs begin that are sorted by their first or second index, of so many members.
    fn count(&mut self, members: usize, pairs: &[[u32; 2]], which: usize) {
        self.places.clear();
        roomy(&mut self.places, members);
        self.places.resize(members, 0);
        for pair in pairs {
            self.places[pair[which] as usize] += 1;
        }
        let mut sum = 0;
        for place in &mut self.places {
            (*place, sum) = (sum, sum + *place);
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
