//! Columns of numbers, one per particle, and the loops that hand pieces of them to threads.
//!
//! Invariant: pieces are the same whatever the number of threads, so the same bits come out.

use std::ops::{Deref, DerefMut, Range};

use super::lanes::Lanes;

/// Particles of a piece of a particle loop.
pub const PIECE: usize = 512;

/// Numbers by which a column begins later than the one before in its memory page. Columns of a page's
/// multiple of bytes would all meet in the same few lines of the cache.
const STAGGER: usize = 16;

/// One number a particle.
#[derive(Debug, Clone, Default)]
pub struct Column {
    memory: Vec<f64>,
    skip: usize,
}

impl Column {
    fn zeros(n: usize, turn: usize) -> Self {
        let skip = STAGGER * turn;
        Self { memory: vec![0.0; n + skip], skip }
    }
}

impl Deref for Column {
    type Target = [f64];

    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.memory[self.skip..]
    }
}

impl DerefMut for Column {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.memory[self.skip..]
    }
}

/// Declares a set of columns, and the same set as mutable slices that can be split.
macro_rules! columns {
    ($(#[$doc:meta])* $name:ident, $slices:ident, $first:literal { $($(#[$fdoc:meta])* $field:ident),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Default)]
        pub struct $name {
            $($(#[$fdoc])* pub $field: Column,)*
        }

        #[doc = concat!("[`", stringify!($name), "`] as slices, of all particles or of some.")]
        #[derive(Debug)]
        pub struct $slices<'a> {
            $($(#[$fdoc])* pub $field: &'a mut [f64],)*
        }

        impl $name {
            /// Columns of `n` zeros.
            #[must_use]
            pub fn zeros(n: usize) -> Self {
                let mut turn = $first;
                $(
                    let $field = Column::zeros(n, turn);
                    turn += 1;
                )*
                let _ = turn;
                Self { $($field,)* }
            }

            /// All of them.
            pub fn slices(&mut self) -> $slices<'_> {
                $slices { $($field: &mut self.$field,)* }
            }

            /// Names and contents.
            pub fn named(&self) -> impl Iterator<Item = (&'static str, &Column)> {
                [$((stringify!($field), &self.$field)),*].into_iter()
            }

            /// Names and contents, to be filled.
            pub fn named_mut(&mut self) -> impl Iterator<Item = (&'static str, &mut Column)> {
                [$((stringify!($field), &mut self.$field)),*].into_iter()
            }

            /// Bytes that they take.
            #[must_use]
            pub fn bytes(&self) -> usize {
                self.named().map(|(_, column)| 8 * column.memory.capacity()).sum()
            }
        }

        impl<'a> $slices<'a> {
            /// The first `at` particles and the others.
            #[must_use]
            pub fn split_at(self, at: usize) -> (Self, Self) {
                $(let $field = self.$field.split_at_mut(at);)*
                ($slices { $($field: $field.0,)* }, $slices { $($field: $field.1,)* })
            }

            /// Asks for the particle at `at`, if there is one.
            #[inline(always)]
            pub fn fetch<F: Lanes>(&self, at: usize) {
                $(F::fetch(self.$field.get(at..).unwrap_or_default());)*
            }
        }
    };
}

columns! {
    /// What a particle is and how it moves: the state that a run continues from.
    State, StateSlices, 0 {
        /// Displacement relative to the translation of the body.
        dx,
        /// Displacement, second component.
        dy,
        /// Displacement, third component.
        dz,
        /// Velocity relative to the translation of the body.
        vx,
        /// Velocity, second component.
        vy,
        /// Velocity, third component.
        vz,
        /// Density `rho`.
        rho,
        /// Internal energy per mass `u`, Eq. (23).
        u,
    }
}

columns! {
    /// What follows from the state within a step, and what is kept for the next.
    Derived, DerivedSlices, 8 {
        /// Pressure `P`.
        pressure,
        /// Pressure on the volumes of elements: `P m / (rho V)`.
        grip,
        /// Density over the volume of the live elements' shares.
        dilate,
        /// Temperature `theta`.
        theta,
        /// Sound speed `c_s`.
        sound,
        /// Density at the time of the positions.
        rho,
        /// Change of the volume of the live elements' shares, at the positions before the last drift.
        volume,
    }
}

columns! {
    /// Sums over elements and contacts.
    Sums, SumsSlices, 15 {
        /// Force; once the particle is kicked, the mean velocity of the step.
        fx,
        /// The same, second component.
        fy,
        /// The same, third component.
        fz,
        /// Change of the volume of the live elements' shares.
        volume,
        /// Its rate over the mean velocity of the step.
        volume_rate,
        /// Heat, but for the work of the elements' volumes.
        heat,
        /// Density rate by contacts.
        rho_rate,
    }
}

impl State {
    /// Displacements and velocities.
    #[must_use]
    pub fn motion(&self) -> ([&[f64]; 3], [&[f64]; 3]) {
        ([&self.dx, &self.dy, &self.dz], [&self.vx, &self.vy, &self.vz])
    }
}

impl StateSlices<'_> {
    /// Displacements.
    #[inline(always)]
    #[must_use]
    pub fn displacement(&self) -> [&[f64]; 3] {
        [self.dx, self.dy, self.dz]
    }

    /// Velocities.
    #[inline(always)]
    #[must_use]
    pub fn velocity(&self) -> [&[f64]; 3] {
        [self.vx, self.vy, self.vz]
    }
}

impl SumsSlices<'_> {
    /// Mean velocities of the step, of particles that are kicked.
    #[inline(always)]
    #[must_use]
    pub fn mean(&self) -> [&[f64]; 3] {
        [self.fx, self.fy, self.fz]
    }
}

/// All columns of the same particles.
pub type AllSlices<'a> = (StateSlices<'a>, DerivedSlices<'a>, SumsSlices<'a>);

/// Something that can be cut in two.
pub trait Cut: Sized + Send {
    /// The first `at` particles and the others.
    fn cut(self, at: usize) -> (Self, Self);
}

impl Cut for StateSlices<'_> {
    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at(at)
    }
}

impl Cut for DerivedSlices<'_> {
    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at(at)
    }
}

impl Cut for SumsSlices<'_> {
    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at(at)
    }
}

impl<T: Send> Cut for &mut [T] {
    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }
}

impl<A: Cut, B: Cut> Cut for (A, B) {
    fn cut(self, at: usize) -> (Self, Self) {
        let (a, b) = (self.0.cut(at), self.1.cut(at));
        ((a.0, b.0), (a.1, b.1))
    }
}

impl<A: Cut, B: Cut, C: Cut> Cut for (A, B, C) {
    fn cut(self, at: usize) -> (Self, Self) {
        let (a, b, c) = (self.0.cut(at), self.1.cut(at), self.2.cut(at));
        ((a.0, b.0, c.0), (a.1, b.1, c.1))
    }
}

/// Cuts columns at the starts of pieces, gives each piece its part, in parallel, and joins the
/// results in an order that the number of pieces alone decides.
///
/// Piece `k` begins at particle `work.start(k)`; pieces ascend and do not overlap; `from` is the first
/// particle of `columns`. No piece, no result.
pub fn pieces<C: Cut, W: Work<C>>(
    columns: C,
    from: usize,
    range: Range<usize>,
    work: &W,
) -> Option<W::Output> {
    if range.is_empty() {
        return None;
    }
    if range.len() == 1 {
        let (_, own) = columns.cut(work.start(range.start) - from);
        return Some(work.run(range.start, own));
    }
    let middle = range.start + range.len() / 2;
    let at = work.start(middle);
    let (low, high) = columns.cut(at - from);
    let (low, high) = rayon::join(
        || pieces(low, from, range.start..middle, work),
        || pieces(high, at, middle..range.end, work),
    );
    match (low, high) {
        (Some(low), Some(high)) => Some(work.join(low, high)),
        (one, other) => one.or(other),
    }
}

/// What is done with each piece.
pub trait Work<C>: Sync {
    /// Result of a piece.
    type Output: Send;
    /// First particle of a piece.
    fn start(&self, piece: usize) -> usize;
    /// Does it.
    fn run(&self, piece: usize, columns: C) -> Self::Output;
    /// Joins the results of neighbours.
    fn join(&self, low: Self::Output, high: Self::Output) -> Self::Output;
}
