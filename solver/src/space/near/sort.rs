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

/// Something in whose memory an item can stand while items are sorted.
pub(super) trait Stand: Copy {
    /// An item as such.
    fn of(item: Item) -> Self;
    /// The item.
    fn item(&self) -> Item;
}

impl Stand for Item {
    #[inline(always)]
    fn of(item: Item) -> Self {
        item
    }

    #[inline(always)]
    fn item(&self) -> Item {
        *self
    }
}

/// Sorts by key; items of equal keys keep their order.
#[derive(Debug, Clone, Default)]
pub(super) struct Sorter {
    /// Items to be sorted, and sorted.
    pub(super) items: Vec<Item>,
    counts: Vec<[u32; VALUES]>,
}

impl Sorter {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        held(&self.items) + held(&self.counts)
    }

    /// Sorts the items by the lowest `bits` bits of their keys; the others must be zero. What is in `spare`
    /// is lost: every other pass leaves the items there.
    pub(super) fn sort<S: Stand>(&mut self, bits: u32, spare: &mut Vec<S>) {
        let passes = bits.div_ceil(WIDEST).max(1);
        let width = bits.div_ceil(passes).max(1);
        self.count(passes, width);
        let Self { items, counts } = self;
        let Some(first) = items.first().map(|item| item.key) else { return };
        spare.clear();
        roomy(spare, items.len());
        spare.resize(items.len(), S::of(Item::default()));
        let mut away = false;
        for (pass, starts) in (0..passes).zip(counts) {
            let of = |key| digit(key, pass * width, width);
            if starts[of(first)] as usize == items.len() {
                continue;
            }
            let mut sum = 0;
            for start in starts.iter_mut() {
                (*start, sum) = (sum, sum + *start);
            }
            if away {
                deal(spare, items, starts, of);
            } else {
                deal(items, spare, starts, of);
            }
            away = !away;
        }
        if away {
            items.iter_mut().zip(spare).for_each(|(item, own)| *item = own.item());
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

/// Puts items where those of their digit go.
fn deal<A: Stand, B: Stand>(
    from: &[A],
    to: &mut [B],
    starts: &mut [u32],
    digit: impl Fn(u64) -> usize,
) {
    for item in from {
        let item = item.item();
        let place = &mut starts[digit(item.key)];
        to[*place as usize] = B::of(item);
        *place += 1;
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
