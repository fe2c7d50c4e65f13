//! Deformation of a cell, Eqs. (14)-(15), and the forces of its shear.

use super::{V3, cross, dot};
use crate::space::cells::Cells;
use crate::space::lanes::{Lanes, Mask, each};
use crate::space::strength::{Sym, contract};

/// Gradient of a corner field along the lattice axes, one vector an axis: one-point integration.
#[inline(always)]
pub(super) fn gradient<F: Lanes, const MAPPED: bool>(
    u: &[V3<F>; 9],
    cells: &Cells<'_, MAPPED>,
) -> [V3<F>; 3] {
    let mut out = [[F::zero(); 3]; 3];
    if MAPPED {
        for slot in 0..8 {
            for (axis, out) in out.iter_mut().enumerate() {
                let weight = cells.weight::<F>(slot, axis);
                for (out, u) in out.iter_mut().zip(&u[slot]) {
                    *out += weight * *u;
                }
            }
        }
        return out;
    }
    let size = cells.body.lattice.size;
    for d in 0..3 {
        let s = |slot: usize| u[slot][d];
        // Sums and differences along the fast axis serve all three.
        let plus = [s(1) + s(0), s(3) + s(2), s(5) + s(4), s(7) + s(6)];
        let minus = [s(1) - s(0), s(3) - s(2), s(5) - s(4), s(7) - s(6)];
        out[0][d] = ((minus[0] + minus[1]) + (minus[2] + minus[3])) * (0.25 / size[0]);
        out[1][d] = ((plus[1] - plus[0]) + (plus[3] - plus[2])) * (0.25 / size[1]);
        out[2][d] = ((plus[2] - plus[0]) + (plus[3] - plus[1])) * (0.25 / size[2]);
    }
    out
}

/// Adds to the corners the transpose of [`gradient`].
#[inline(always)]
pub(super) fn spread<F: Lanes, const MAPPED: bool>(
    along: &[V3<F>; 3],
    cells: &Cells<'_, MAPPED>,
    to: &mut [V3<F>; 9],
) {
    if MAPPED {
        for (slot, to) in to[..8].iter_mut().enumerate() {
            for (axis, along) in along.iter().enumerate() {
                let weight = cells.weight::<F>(slot, axis);
                for (to, along) in to.iter_mut().zip(along) {
                    *to += weight * *along;
                }
            }
        }
        return;
    }
    let size = cells.body.lattice.size;
    for d in 0..3 {
        let (fast, mid) = (along[0][d] * (0.25 / size[0]), along[1][d] * (0.25 / size[1]));
        let up = along[2][d] * (0.25 / size[2]);
        let (plus, minus, down) = (mid + fast, mid - fast, -up);
        to[0][d] += down - plus;
        to[1][d] += down - minus;
        to[2][d] += down + minus;
        to[3][d] += down + plus;
        to[4][d] += up - plus;
        to[5][d] += up - minus;
        to[6][d] += up + minus;
        to[7][d] += up + plus;
    }
}

/// Deformation of up to eight elements, Eqs. (14)-(15), in lattice axes.
pub(super) struct Kinematics<F> {
    /// `F`, row by row.
    pub(super) f: [F; 9],
    /// Cofactors of `F`, row by row.
    pub(super) cofactor: [F; 9],
    /// `F^T F`.
    pub(super) c: Sym<F>,
    /// `J = det F`.
    pub(super) jacobian: F,
    /// `J^(-1/3)`.
    pub(super) root: F,
}

/// `F^T F`.
#[inline(always)]
pub(super) fn right_cauchy_green<F: Lanes>(f: &[F; 9]) -> Sym<F> {
    let mut c = [F::zero(); 6];
    for (c, [i, j]) in c.iter_mut().zip([[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]]) {
        *c = f[i] * f[j] + f[3 + i] * f[3 + j] + f[6 + i] * f[6 + j];
    }
    c
}

impl<F: Lanes> Kinematics<F> {
    #[inline(always)]
    pub(super) fn new<const MAPPED: bool>(u: &[V3<F>; 9], cells: &Cells<'_, MAPPED>) -> Self {
        let along = gradient(u, cells);
        let mut f = [F::zero(); 9];
        for (row, axis) in cells.body.lattice.axes.iter().enumerate() {
            for column in 0..3 {
                let g = &along[column];
                let b = g[0] * axis[0] + g[1] * axis[1] + g[2] * axis[2];
                f[3 * row + column] = b + if row == column { 1.0 } else { 0.0 };
            }
        }
        let (a, b, c) = ([f[0], f[1], f[2]], [f[3], f[4], f[5]], [f[6], f[7], f[8]]);
        let (bc, ca, ab) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
        let jacobian = dot(&a, &bc);
        Self {
            cofactor: [bc[0], bc[1], bc[2], ca[0], ca[1], ca[2], ab[0], ab[1], ab[2]],
            c: right_cauchy_green(&f),
            f,
            jacobian,
            // An inverted element has no root; it is dying, and its shear is not used.
            root: jacobian.max(F::splat(1e-3)).inverse_cube_root(),
        }
    }

    /// `(J^(-2/3) C - I) / 2`, Eqs. (14)-(15).
    #[inline(always)]
    pub(super) fn shear_strain(&self) -> Sym<F> {
        let q = self.root * self.root * 0.5;
        each!(k => q * self.c[k] - if k < 3 { 0.5 } else { 0.0 })
    }

    /// Mean squared stretch without the volume, times the compression's.
    #[inline(always)]
    pub(super) fn stretch_squared(&self) -> F {
        let q = self.root * self.root;
        let mean = q * (self.c[0] + self.c[1] + self.c[2]) * (1.0 / 3.0);
        mean * q.max(F::splat(1.0))
    }

    /// First Piola-Kirchhoff stress of the shear energy (24) by the strain (14)-(16), rows turned to global
    /// axes.
    #[inline(always)]
    pub(super) fn piola(&self, s: &Sym<F>, axes: &[[f64; 3]; 3]) -> [F; 9] {
        let q = self.root * self.root;
        let third = contract(s, &self.c) * (1.0 / 3.0) / self.jacobian;
        let full = [s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2]];
        let mut out = [F::zero(); 9];
        for column in 0..3 {
            let mut own = [F::zero(); 3];
            for (row, own) in own.iter_mut().enumerate() {
                let f = &self.f[3 * row..3 * row + 3];
                let fs = f[0] * full[column] + f[1] * full[3 + column] + f[2] * full[6 + column];
                *own = q * (fs - third * self.cofactor[3 * row + column]);
            }
            for row in 0..3 {
                out[3 * row + column] =
                    own[0] * axes[0][row] + own[1] * axes[1][row] + own[2] * axes[2][row];
            }
        }
        out
    }

    /// Adds the corner forces of the shear stress, `-V_o P grad N`.
    #[inline(always)]
    pub(super) fn forces<const MAPPED: bool>(
        &self,
        stress: &Sym<F>,
        cells: &Cells<'_, MAPPED>,
        live: Mask,
        force: &mut [V3<F>; 9],
    ) {
        let piola = self.piola(stress, &cells.body.lattice.axes);
        let volume = -cells.volume::<F>();
        let mut along = [[F::zero(); 3]; 3];
        for (axis, along) in along.iter_mut().enumerate() {
            for (d, along) in along.iter_mut().enumerate() {
                *along = (piola[3 * d + axis] * volume).keep(live);
            }
        }
        spread(&along, cells, force);
    }
}
