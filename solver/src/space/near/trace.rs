//! What a group of cells holds, as far as it tells whether contacts can arise in it.

use super::{DEBRIS, Points};

/// Lattice cells over which members of one body may spread without contact.
pub(super) const SPAN: i16 = 12;

/// Ranges of the lattice coordinates and, as the fourth, of the body numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trace {
    low: [i16; 4],
    high: [i16; 4],
}

impl Trace {
    /// Of no member.
    pub(super) const NOTHING: Self = Self { low: [i16::MAX; 4], high: [i16::MIN; 4] };

    /// Adds a member. Debris counts as all bodies at once.
    pub(super) fn add(&mut self, points: &Points<'_>, lattice: &[[i16; 3]], i: usize) {
        if points.flags[i] & DEBRIS != 0 {
            *self = Self { low: [i16::MIN; 4], high: [i16::MAX; 4] };
            return;
        }
        let [x, y, z] = lattice[i];
        // Only equality of bodies matters: the change of sign does no harm.
        let at = [x, y, z, points.body[i].cast_signed()];
        *self = self.join(&Self { low: at, high: at });
    }

    /// The trace of both.
    #[inline(always)]
    pub(super) fn join(&self, other: &Self) -> Self {
        let mut all = *self;
        for k in 0..4 {
            all.low[k] = all.low[k].min(other.low[k]);
            all.high[k] = all.high[k].max(other.high[k]);
        }
        all
    }

    /// No pair of the members can be a contact.
    #[inline(always)]
    pub(super) fn is_quiet(&self) -> bool {
        let mut quiet = self.low[3] >= self.high[3];
        for k in 0..3 {
            quiet &= self.high[k].saturating_sub(self.low[k]) <= SPAN;
        }
        quiet
    }
}
