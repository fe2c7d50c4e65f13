//! Radix sort of keys with the index that they belong to.

use super::held;

/// Widest digit, in bits.
const WIDEST: u32 = 11;

/// Values of the widest digit.
const VALUES: usize = 1 << WIDEST;

/// Most digits of a key.
const DIGITS: usize = u64::BITS.div_ceil(WIDEST) as usize;

/// Room of the smallest buffer.
const FEW: usize = 4;

/// A key, and what it is the key of. There are many: no gap behind the index.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, packed(4))]
pub(super) struct Item {
    pub(super) key: u64,
    pub(super) id: u32,
}

/// Sorts by key; items of equal keys keep their order.
#[derive(Debug, Clone, Default)]
pub(super) struct Sorter {
    /// Items to be sorted, and sorted.
    pub(super) items: Vec<Item>,
    spare: Vec<Item>,
    counts: Vec<[u32; VALUES]>,
}

impl Sorter {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        held(&self.items) + held(&self.spare) + held(&self.counts)
    }

    /// Sorts the items by the lowest `bits` bits of their keys; the others must be zero.
    pub(super) fn sort(&mut self, bits: u32) {
        let passes = bits.div_ceil(WIDEST).max(1);
        let width = bits.div_ceil(passes).max(1);
        self.count(passes, width);
        roomy(&mut self.spare, self.items.len());
        self.spare.resize(self.items.len(), Item::default());
        for pass in 0..passes {
            let starts = &mut self.counts[pass as usize];
            let Some(first) = self.items.first() else { return };
            let only = starts[digit(first.key, pass * width, width)] as usize;
            if only == self.items.len() {
                continue;
            }
            let mut sum = 0;
            for start in starts.iter_mut() {
                (*start, sum) = (sum, sum + *start);
            }
            for item in &self.items {
                let place = &mut starts[digit(item.key, pass * width, width)];
                self.spare[*place as usize] = *item;
                *place += 1;
            }
            std::mem::swap(&mut self.items, &mut self.spare);
        }
    }

    fn count(&mut self, passes: u32, width: u32) {
        self.counts.resize(DIGITS, [0; VALUES]);
        let counts = &mut self.counts[..passes as usize];
        for count in counts.iter_mut() {
            count.fill(0);
        }
        for item in &self.items {
            for (pass, count) in (0..).zip(counts.iter_mut()) {
                count[digit(item.key, pass * width, width)] += 1;
            }
        }
    }
}

#[inline(always)]
fn digit(key: u64, shift: u32, width: u32) -> usize {
    (key >> shift) as usize & ((1 << width) - 1) & (VALUES - 1)
}

/// Length to which a buffer grows that has to hold `n`: an eighth more, so that it seldom grows, and not
/// twice what it was.
pub(in crate::space) fn roomy<T>(buffer: &mut Vec<T>, n: usize) {
    if buffer.capacity() < n {
        buffer.reserve_exact(n + n / 8 - buffer.len());
    }
}

/// Puts something into a buffer that grows like that.
#[inline(always)]
pub(in crate::space) fn put<T>(buffer: &mut Vec<T>, value: T) {
    if buffer.len() == buffer.capacity() {
        roomy(buffer, buffer.len() + FEW);
    }
    buffer.push(value);
}
