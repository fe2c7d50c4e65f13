//! Symmetric matrices of cells, for what resists motion along one axis more than along another, and the
//! time step that a stiffness and a damping allow together (decision 0020).

use super::{V3, dot};
use crate::space::lanes::{Lanes, Mask};

/// A symmetric matrix that is nowhere negative.
#[derive(Debug, Clone, Copy)]
pub(super) struct Symmetric<F> {
    diagonal: [F; 3],
    /// (0,1), (0,2), (1,2).
    off: [F; 3],
}

impl<F: Lanes> Symmetric<F> {
    #[inline(always)]
    pub(super) fn zero() -> Self {
        Self { diagonal: [F::zero(); 3], off: [F::zero(); 3] }
    }

    /// Adds `weight r r^T`.
    #[inline(always)]
    pub(super) fn add(&mut self, r: &V3<F>, weight: F) {
        let [x, y, z] = r.map(|r| r * weight);
        self.diagonal[0] += x * r[0];
        self.diagonal[1] += y * r[1];
        self.diagonal[2] += z * r[2];
        self.off[0] += x * r[1];
        self.off[1] += x * r[2];
        self.off[2] += y * r[2];
    }

    /// Adds the same along every axis.
    #[inline(always)]
    pub(super) fn widen(&mut self, by: F) {
        for diagonal in &mut self.diagonal {
            *diagonal += by;
        }
    }

    #[inline(always)]
    pub(super) fn trace(&self) -> F {
        self.diagonal[0] + self.diagonal[1] + self.diagonal[2]
    }

    #[inline(always)]
    pub(super) fn times(&self, factor: F) -> Self {
        Self { diagonal: self.diagonal.map(|x| x * factor), off: self.off.map(|x| x * factor) }
    }

    #[inline(always)]
    pub(super) fn plus(&self, other: &Self) -> Self {
        let sum = |a: &V3<F>, b: &V3<F>| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        Self { diagonal: sum(&self.diagonal, &other.diagonal), off: sum(&self.off, &other.off) }
    }

    /// A bound of the largest eigenvalue, met where two of the three are equal: mean plus `sqrt 2` times
    /// the standard deviation (H. Wolkowicz and G. P. H. Styan, *Bounds for eigenvalues using traces*, 1980).
    #[inline(always)]
    pub(super) fn largest(&self) -> F {
        let mean = self.trace() * (1.0 / 3.0);
        let own = self.diagonal.map(|x| x - mean);
        let squares = dot(&own, &own) + dot(&self.off, &self.off) * 2.0;
        mean + (squares * (2.0 / 3.0)).sqrt()
    }
}

/// Part of the damping that meets stiffness in one motion: bonds damp nodes that move against centroids most, and
/// what is stiffest moves planes of nodes against each other (decision 0020).
const SHARED: f64 = 0.75;

/// Inverse of a time step at which neither `K dt^2/4 + 3/4 D dt/2` nor `D dt/2` has an eigenvalue above one in any lane
/// that is asked for: what leapfrog with the damping `D` of the last velocities bears in a lattice of such cells, with
/// the safety of 0.9, whatever the axes of the two. Nothing if it is surely below what others ask for.
#[inline(always)]
pub(super) fn rate<F: Lanes>(
    (stiffness, damping): (&Symmetric<F>, &Symmetric<F>),
    (lanes, others): (Mask, f64),
) -> f64 {
    // As if both were largest along the same axis; then they are less than one by `slack`, and a step
    // longer by its root is still safe, since no term grows by more than the square.
    let alone = damping.largest() * 0.5;
    let half = alone * SHARED;
    let rate = (half + (half * half + stiffness.largest()).sqrt()) * 0.5;
    // The slack may be above one by round-off.
    if rate.max(alone).gt(F::splat(others * (1.0 - 1e-12))) & lanes == 0 {
        return 0.0;
    }
    let step = F::splat(1.0) / rate.max(F::splat(f64::MIN_POSITIVE.sqrt()));
    let slack =
        stiffness.times(step * step * 0.25).plus(&damping.times(step * (0.5 * SHARED))).largest();
    (rate * slack.sqrt()).max(alone).keep(lanes).largest()
}

#[cfg(test)]
mod tests {
    use super::super::F8;
    use super::*;

    fn matrix(vectors: &[[f64; 3]]) -> Symmetric<F8> {
        let mut sum = Symmetric::zero();
        for v in vectors {
            sum.add(&v.map(F8::splat), F8::splat(1.0));
        }
        sum
    }

    fn largest(matrix: &Symmetric<F8>) -> f64 {
        matrix.largest().0[0]
    }

    #[test]
    fn the_largest_eigenvalue_is_met_where_two_are_equal_and_bounded_elsewhere() {
        let cube = matrix(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert!((largest(&cube) - 1.0).abs() < 1e-15);
        let line = matrix(&[[1.0, -2.0, 2.0]]);
        assert!((largest(&line) - 9.0).abs() < 1e-14);
        // Eigenvalues 9, 4, 1.
        let box_of_three = matrix(&[[3.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]]);
        let bound = largest(&box_of_three);
        assert!(bound > 9.0 && bound < 9.4, "{bound}");
    }

    #[test]
    fn stiffness_and_damping_along_one_axis_add_up_and_along_two_do_not() {
        let [x, y] = [matrix(&[[2.0, 0.0, 0.0]]), matrix(&[[0.0, 2.0, 0.0]])];
        let both = |a: &Symmetric<F8>, b: &Symmetric<F8>| rate((a, b), (Mask::MAX, 0.0));
        // omega^2 = 4, three quarters of the damping 4: 1/dt = (1.5 + sqrt(6.25))/2, which the damping alone meets too.
        assert!((both(&x, &x) - 2.0).abs() < 1e-14);
        let stiff = x.times(F8::splat(4.0));
        // omega^2 = 16, three quarters of the damping 4: 1/dt = (1.5 + sqrt(18.25))/2.
        let along = 0.75 + 0.5 * 18.25f64.sqrt();
        assert!((both(&stiff, &x) - along).abs() < 1e-14);
        let apart = both(&stiff, &y);
        assert!((2.0..along).contains(&apart), "{apart}");
        assert!((both(&x, &Symmetric::zero()) - 1.0).abs() < 1e-14);
        assert!((both(&Symmetric::zero(), &x) - 2.0).abs() < 1e-14);
        assert!(both(&Symmetric::zero(), &Symmetric::zero()).abs() < 1e-100);
    }
}
