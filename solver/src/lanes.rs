//! Pairs side by side: the columns in which a sweep looks at a block of them at once.

use crate::chain::Side;
use crate::columns::{Bins, Rate};
use crate::forces::{PairSums, Pass, Tally};

/// Pairs of nearest neighbours that are looked at together: enough to fill vector units, few enough
/// for the first-level cache.
pub(crate) const BLOCK: usize = 32;

/// How far beyond its left particle a pair of a block may reach.
pub(crate) const AHEAD: usize = 8;

/// Particles of a block: those on the left of its pairs, and those that they reach.
pub(crate) const SPAN: usize = BLOCK + AHEAD;

/// A particle as one end of a pair: everything that a pair asks of it.
#[derive(Clone, Copy)]
pub(crate) struct End<E> {
    pub(crate) side: Side,
    pub(crate) eos: E,
    pub(crate) sound: f64,
    pub(crate) v: f64,
    pub(crate) drift: f64,
}

/// What two particles do to each other.
#[derive(Clone, Copy)]
pub(crate) struct Deal {
    /// Force between them, repulsive.
    pub(crate) force: f64,
    /// Power into each.
    pub(crate) power: [f64; 2],
    /// Density rate of each.
    pub(crate) rho_rate: [f64; 2],
    /// Power into the strain energy of the segment.
    pub(crate) strain_power: f64,
}

/// What a pair wants of the time step.
#[derive(Clone, Copy)]
pub(crate) struct Wish {
    /// Coefficients of viscosity and conduction, for each particle.
    pub(crate) damping: [f64; 2],
    /// Square of the time that sound takes.
    pub(crate) sound_squared: f64,
    /// Time until they meet.
    pub(crate) closing: f64,
}

/// The particles of a block, column by column.
pub(crate) struct Lanes {
    pub(crate) x: [f64; SPAN],
    pub(crate) v: [f64; SPAN],
    pub(crate) drift: [f64; SPAN],
    pub(crate) u: [f64; SPAN],
    pub(crate) rho: [f64; SPAN],
    pub(crate) m: [f64; SPAN],
    pub(crate) sound: [f64; SPAN],
    /// Jumps of the velocity: before the block, of its pairs, and behind it.
    pub(crate) jump: [f64; SPAN],
}

/// Results of the pairs of a block, column by column.
pub(crate) struct Deals {
    pub(crate) force: [f64; BLOCK],
    pub(crate) power: [[f64; BLOCK]; 2],
    pub(crate) rho_rate: [[f64; BLOCK]; 2],
    pub(crate) strain_power: [f64; BLOCK],
    pub(crate) damping: [[f64; BLOCK]; 2],
    pub(crate) sound_squared: [f64; BLOCK],
    pub(crate) closing: [f64; BLOCK],
}

impl Deal {
    /// The shares of both particles.
    #[inline(always)]
    pub(crate) fn tallies<K: Pass, R: Rate>(&self) -> (Tally<R>, Tally<R>) {
        let share = |sign: f64, k: usize| Tally {
            force: if K::FORCE { sign * self.force } else { 0.0 },
            power: self.power[k],
            damping: 0.0,
            rho_rate: R::of(self.rho_rate[k]),
        };
        (share(-1.0, 0), share(1.0, 1))
    }
}

impl Lanes {
    pub(crate) fn new() -> Self {
        let zero = [0.0; SPAN];
        Self { x: zero, v: zero, drift: zero, u: zero, rho: zero, m: zero, sound: zero, jump: zero }
    }
}

impl Deals {
    pub(crate) fn new() -> Self {
        let zero = [0.0; BLOCK];
        Self {
            force: zero,
            power: [zero; 2],
            rho_rate: [zero; 2],
            strain_power: zero,
            damping: [zero; 2],
            sound_squared: zero,
            closing: zero,
        }
    }

    #[inline(always)]
    pub(crate) fn enter<K: Pass>(&mut self, k: usize, deal: Deal) {
        self.force[k] = if K::FORCE { deal.force } else { 0.0 };
        if K::RATES {
            for side in [0, 1] {
                self.power[side][k] = deal.power[side];
                self.rho_rate[side][k] = deal.rho_rate[side];
            }
            self.strain_power[k] = deal.strain_power;
        }
    }

    #[inline(always)]
    pub(crate) fn wish(&mut self, k: usize, wish: Wish) {
        for side in [0, 1] {
            self.damping[side][k] = wish.damping[side];
        }
        self.sound_squared[k] = wish.sound_squared;
        self.closing[k] = wish.closing;
    }

    /// Adds up the pairs of every particle from `first` on with the one `offset` behind it.
    #[inline(always)]
    pub(crate) fn settle<K: Pass, R: Rate>(
        &self,
        (first, offset): (usize, usize),
        pairs: usize,
        bins: &mut Bins<'_, Tally<R>>,
        sums: &mut PairSums,
    ) {
        let mut from_left = Tally::default();
        for k in 0..pairs.min(BLOCK) {
            let share = |side: usize, sign: f64| Tally {
                force: sign * self.force[k],
                power: self.power[side][k],
                damping: self.damping[side][k],
                rho_rate: R::of(self.rho_rate[side][k]),
            };
            // Each particle is on the right of one pair and then on the left of the next.
            from_left += share(0, -1.0);
            bins.add(first + k, from_left);
            from_left = share(1, 1.0);
            if offset > 1 {
                bins.add(first + k + offset, from_left);
                from_left = Tally::default();
            }
            // The nearest pairs have the shortest times.
            if K::VOTES && offset == 1 {
                let [by_sound, by_closing] = &mut sums.votes;
                by_sound.consider(self.sound_squared[k], first + k);
                by_closing.consider(self.closing[k], first + k);
            }
        }
        if offset == 1 {
            bins.add(first + pairs, from_left);
        }
    }
}
