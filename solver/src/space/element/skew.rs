//! Bonds of cells with unequal edges (decision 0021).
//!
//! A force along the diagonal of a long cell acts along its long edge most, whichever way a shock comes. The bond that
//! resists is that of the cell with its long edges shortened, `n = r + sum_k (d_k - 1) X_k f_k`: `r` the diagonal, `X_k`
//! its undeformed components along the axes `f_k` of the deformed cell. Its length depends on the corners alone and not
//! on how the cell lies in space, so the forces that do its work have neither resultant nor moment.

use super::kinematics::gradient;
use super::{CENTRE, V3, dot, sub};
use crate::space::cells::Cells;
use crate::space::lanes::{F8, Lanes};

/// What bonds differ by from the diagonals of a cell.
pub(super) trait Skewed<F> {
    /// The bond to a corner, where the diagonal is `r`.
    fn bond(&self, slot: usize, r: V3<F>) -> V3<F>;
    /// Its rate, where the corner moves against the centroid with velocity `w`.
    fn rate(&self, slot: usize, w: V3<F>) -> V3<F>;
    /// Adds a force `bond n` on it.
    fn pull(&mut self, slot: usize, n: &V3<F>, bond: F);
    /// Forces on the axes of the cell.
    fn pulled(&self) -> Option<[V3<F>; 3]>;
}

/// Of cubes: nothing.
impl<F: Lanes> Skewed<F> for () {
    #[inline(always)]
    fn bond(&self, _: usize, r: V3<F>) -> V3<F> {
        r
    }

    #[inline(always)]
    fn rate(&self, _: usize, w: V3<F>) -> V3<F> {
        w
    }

    #[inline(always)]
    fn pull(&mut self, _: usize, _: &V3<F>, _: F) {}

    #[inline(always)]
    fn pulled(&self) -> Option<[V3<F>; 3]> {
        None
    }
}

/// Of cells with unequal edges.
pub(super) struct Skew<F> {
    factors: [f64; 3],
    /// `(d_k - 1) X_k f_k` at the last corner.
    ways: [V3<F>; 3],
    /// Their rates.
    rates: [V3<F>; 3],
    /// Forces on them.
    forces: [V3<F>; 3],
}

impl<F: Lanes> Skew<F> {
    /// With these [`factors`], of cells with displacements `u` and velocities `v`.
    #[inline(always)]
    pub(super) fn new<const MAPPED: bool>(
        factors: [f64; 3],
        (u, v): (&[V3<F>; 9], &[V3<F>; 9]),
        cells: &Cells<'_, MAPPED>,
    ) -> Self {
        let (mut ways, mut rates) = (gradient(u, cells), gradient(v, cells));
        for (axis, factor) in factors.into_iter().enumerate() {
            let undeformed = cells.body.lattice.axes[axis];
            for d in 0..3 {
                ways[axis][d] = (ways[axis][d] + F::splat(undeformed[d])) * factor;
                rates[axis][d] = rates[axis][d] * factor;
            }
        }
        Self { factors, ways, rates, forces: [[F::zero(); 3]; 3] }
    }

    /// Adds the parts along the three axes, with the signs of a corner.
    #[inline(always)]
    fn at(parts: &[V3<F>; 3], slot: usize, mut to: V3<F>) -> V3<F> {
        for (axis, part) in parts.iter().enumerate() {
            for (to, part) in to.iter_mut().zip(part) {
                *to = if slot >> axis & 1 == 1 { *to + *part } else { *to - *part };
            }
        }
        to
    }
}

impl<F: Lanes> Skewed<F> for Skew<F> {
    #[inline(always)]
    fn bond(&self, slot: usize, r: V3<F>) -> V3<F> {
        Self::at(&self.ways, slot, r)
    }

    #[inline(always)]
    fn rate(&self, slot: usize, w: V3<F>) -> V3<F> {
        Self::at(&self.rates, slot, w)
    }

    #[inline(always)]
    fn pull(&mut self, slot: usize, n: &V3<F>, bond: F) {
        for (axis, force) in self.forces.iter_mut().enumerate() {
            let factor =
                if slot >> axis & 1 == 1 { self.factors[axis] } else { -self.factors[axis] };
            let bond = bond * factor;
            for (force, n) in force.iter_mut().zip(n) {
                *force += bond * *n;
            }
        }
    }

    #[inline(always)]
    fn pulled(&self) -> Option<[V3<F>; 3]> {
        Some(self.forces)
    }
}

/// Half of the power of forces `bonds` on the bonds over these velocities, times `factor`: of corners and centroid.
#[inline(always)]
pub(super) fn half_powers<F: Lanes>(
    skew: &impl Skewed<F>,
    (y, v): (&[V3<F>; 9], &[V3<F>; 9]),
    (bonds, factor): (&[F8; 8], f64),
) -> [F; 9] {
    let mut powers = [F::zero(); 9];
    for slot in 0..CENTRE {
        let n = skew.bond(slot, sub(&y[slot], &y[CENTRE]));
        let rate = skew.rate(slot, sub(&v[slot], &v[CENTRE]));
        let half = F::of(bonds[slot]) * dot(&n, &rate) * (0.5 * factor);
        powers[slot] = half;
        powers[CENTRE] += half;
    }
    powers
}

/// Half edges of a cell times `d_k - 1`, for a viscosity that is the same along its axes: the viscous force on a face
/// goes with `d_k^4 a_k^3`, and the closing speed along the shortest edge is that of a cube (decision 0021).
#[must_use]
pub fn factors(edges: [f64; 3]) -> [f64; 3] {
    let shortest = edges.into_iter().fold(f64::INFINITY, f64::min);
    let roots: f64 = edges.iter().map(|a| a.sqrt()).sum();
    let power = (shortest * roots / 3.0).sqrt();
    edges.map(|a| 0.5 * a * (power / a.powf(0.75) - 1.0))
}
