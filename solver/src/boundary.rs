//! What the ends of the chain do to the outermost particles.

use std::ops::AddAssign;

use crate::chain::Chain;
use crate::forces::Tally;
use crate::scene::{Boundaries, Boundary};
use crate::timestep::{Limiter, Vote};

/// The ends of a chain.
#[derive(Debug, Clone, Copy)]
pub struct Ends(Boundaries);

impl Ends {
    pub(crate) fn new(boundaries: Boundaries) -> Self {
        Self(boundaries)
    }

    /// The particles that are held where they are.
    pub(crate) fn held(&self, chain: &Chain) -> impl Iterator<Item = usize> + use<> {
        let real = chain.real();
        let ends = [(self.0.left, real.start), (self.0.right, real.end - 1)];
        ends.into_iter().filter(|(kind, _)| *kind == Boundary::Fixed).map(|(_, i)| i)
    }

    /// Applies the ends to the forces and returns the force that they exert.
    pub(crate) fn load<R: Copy + AddAssign>(&self, chain: &Chain, tally: &mut [Tally<R>]) -> f64 {
        let real = chain.real();
        let last = real.end - 1;
        let (left, right) = (0..real.start, real.end..tally.len());
        self.end(self.0.left, (real.start, 1.0), left, tally)
            + self.end(self.0.right, (last, -1.0), right, tally)
    }

    /// One end: its outermost particle, the direction into the chain, and its images.
    fn end<R: Copy + AddAssign>(
        &self,
        kind: Boundary,
        (outermost, inward): (usize, f64),
        images: std::ops::Range<usize>,
        tally: &mut [Tally<R>],
    ) -> f64 {
        match kind {
            Boundary::Free => 0.0,
            // The images feel the opposite of what they do; among themselves they cancel.
            Boundary::Mirror(_) => -tally[images].iter().map(|t| t.force).sum::<f64>(),
            Boundary::Fixed => {
                let reaction = -tally[outermost].force;
                tally[outermost].force = 0.0;
                reaction
            }
            Boundary::Pressure(p) => {
                tally[outermost].force += inward * p;
                inward * p
            }
        }
    }

    /// Time in which a pressure would push its particle over a spacing from rest.
    pub(crate) fn vote<R>(&self, chain: &Chain, x: &[f64], tally: &[Tally<R>]) -> Vote {
        let real = chain.real();
        let (first, last) = (real.start, real.end - 1);
        let mut vote = Vote::none(Limiter::Load);
        for (kind, i, spacing) in [
            (self.0.left, first, x[first + 1] - x[first]),
            (self.0.right, last, x[last] - x[last - 1]),
        ] {
            if matches!(kind, Boundary::Pressure(_)) {
                vote.consider((spacing * chain.mass(i) / tally[i].force.abs()).sqrt(), i);
            }
        }
        vote
    }

    /// Power of the ends at the velocities of a step: walls and held particles do no work.
    pub(crate) fn power(&self, chain: &Chain, drift: &[f64]) -> f64 {
        let real = chain.real();
        let work = |kind, i: usize, inward: f64| match kind {
            Boundary::Pressure(p) => inward * p * drift[i],
            _ => 0.0,
        };
        work(self.0.left, real.start, 1.0) + work(self.0.right, real.end - 1, -1.0)
    }
}
