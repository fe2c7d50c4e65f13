//! Deformation of a cell, Eqs. (14)-(15), and the forces of its shear.

use super::symmetric::Symmetric;
use super::{CENTRE, V3, cross, dot};
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

/// The transpose of [`gradient`], at the nine slots.
#[inline(always)]
pub(super) fn spread<F: Lanes, const MAPPED: bool>(
    along: &[V3<F>; 3],
    cells: &Cells<'_, MAPPED>,
) -> [V3<F>; 9] {
    if MAPPED {
        let mut to = [[F::zero(); 3]; 9];
        for (slot, to) in to[..CENTRE].iter_mut().enumerate() {
            for (axis, along) in along.iter().enumerate() {
                let weight = cells.weight::<F>(slot, axis);
                for (to, along) in to.iter_mut().zip(along) {
                    *to += weight * *along;
                }
            }
        }
        return to;
    }
    let size = cells.body.lattice.size;
    let by_way = each!(d in 3 => {
        let (fast, mid) = (along[0][d] * (0.25 / size[0]), along[1][d] * (0.25 / size[1]));
        let up = along[2][d] * (0.25 / size[2]);
        let (plus, minus, down) = (mid + fast, mid - fast, -up);
        [
            down - plus,
            down - minus,
            down + minus,
            down + plus,
            up - plus,
            up - minus,
            up + minus,
            up + plus,
            F::zero(),
        ]
    });
    each!(slot in 9 => [by_way[0][slot], by_way[1][slot], by_way[2][slot]])
}

/// What the lattice axes of up to eight elements have become.
pub(super) struct Frame<F> {
    /// Where they point: `F` column by column, in global axes. `F F^T` is the sum of their squares.
    pub(super) axes: [V3<F>; 3],
    /// Of each two: the cofactors of `F`, column by column.
    pub(super) across: [V3<F>; 3],
}

impl<F: Lanes> Frame<F> {
    /// With this gradient of the displacement along the axes.
    #[inline(always)]
    pub(super) fn new(mut axes: [V3<F>; 3], undeformed: &[[f64; 3]; 3]) -> Self {
        for (own, axis) in axes.iter_mut().zip(undeformed) {
            for (own, axis) in own.iter_mut().zip(axis) {
                *own += F::splat(*axis);
            }
        }
        let [a, b, c] = &axes;
        Self { across: [cross(b, c), cross(c, a), cross(a, b)], axes }
    }

    /// `J = det F`.
    #[inline(always)]
    pub(super) fn jacobian(&self) -> F {
        dot(&self.axes[0], &self.across[0])
    }

    /// First Piola-Kirchhoff stress of the shear energy (24) by the strain (14)-(16), over `J^(-2/3)`: one vector an
    /// axis of the lattice.
    #[inline(always)]
    pub(super) fn piola(&self, s: &Sym<F>, jacobian: F) -> [V3<F>; 3] {
        let [a, b, c] = &self.axes;
        let full = [[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]];
        let mut out = each!(axis in 3 => {
            let s = full[axis];
            each!(d in 3 => a[d] * s[0] + b[d] * s[1] + c[d] * s[2])
        });
        let [on_a, on_b, on_c] = &out;
        let third = (dot(a, on_a) + dot(b, on_b) + dot(c, on_c)) * (1.0 / 3.0) / jacobian;
        for (out, across) in out.iter_mut().zip(&self.across) {
            for (out, across) in out.iter_mut().zip(across) {
                *out -= third * *across;
            }
        }
        out
    }
}

/// `J^(-1/3)`. An inverted element has no root; it is dying, and its shear is not used.
#[inline(always)]
pub(super) fn root<F: Lanes>(jacobian: F) -> F {
    jacobian.max(F::splat(1e-3)).inverse_cube_root()
}

/// Deformation of up to eight elements, Eqs. (14)-(15).
pub(super) struct Kinematics<F> {
    /// `F^T F` in lattice axes, exactly one without deformation.
    c: Sym<F>,
    /// `J = det F`.
    pub(super) jacobian: F,
    /// `J^(-1/3)`.
    root: F,
    frame: Frame<F>,
}

impl<F: Lanes> Kinematics<F> {
    #[inline(always)]
    pub(super) fn new<const MAPPED: bool>(u: &[V3<F>; 9], cells: &Cells<'_, MAPPED>) -> Self {
        let along = gradient(u, cells);
        let axes = &cells.body.lattice.axes;
        let f = each!(k in 9 => {
            let (g, axis) = (&along[k % 3], &axes[k / 3]);
            let b = g[0] * axis[0] + g[1] * axis[1] + g[2] * axis[2];
            b + if k / 3 == k % 3 { 1.0 } else { 0.0 }
        });
        let (a, b, c) = ([f[0], f[1], f[2]], [f[3], f[4], f[5]], [f[6], f[7], f[8]]);
        let jacobian = dot(&a, &cross(&b, &c));
        let c = each!(k in 6 => {
            let [i, j] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]][k];
            f[i] * f[j] + f[3 + i] * f[3 + j] + f[6 + i] * f[6 + j]
        });
        Self { c, jacobian, root: root(jacobian), frame: Frame::new(along, axes) }
    }

    /// `(J^(-2/3) C - I) / 2`, Eqs. (14)-(15).
    #[inline(always)]
    pub(super) fn shear_strain(&self) -> Sym<F> {
        let q = self.root * self.root * 0.5;
        each!(k in 6 => q * self.c[k] - if k < 3 { 0.5 } else { 0.0 })
    }

    /// Mean squared stretch without the volume, times the compression's.
    #[inline(always)]
    pub(super) fn stretch_squared(&self) -> F {
        let q = self.root * self.root;
        let mean = q * (self.c[0] + self.c[1] + self.c[2]) * (1.0 / 3.0);
        mean * q.max(F::splat(1.0))
    }

    /// Squares of the frequencies of shear in units of those of an undeformed cell, `J^(-4/3) F F^T`, whatever
    /// flow has undone of the strain (decision 0020).
    #[inline(always)]
    pub(super) fn shear_squared(&self, undeformed: F) -> Symmetric<F> {
        let q = self.root * self.root;
        let mut squares = Symmetric::zero();
        for axis in &self.frame.axes {
            squares.add(axis, q * q * undeformed);
        }
        squares
    }

    /// What a change of the volume meets of the shear modulus where flow has stretched a cell, beside what it meets in
    /// an undeformed one: over the modulus, `4/9 (J^(-4/3) C : C - 3)`. Strains of (14)-(15) grow with the square of a
    /// stretch, from which a change of the volume takes its root.
    #[inline(always)]
    pub(super) fn shear_bulk(&self) -> F {
        let q = self.root * self.root;
        (q * q * contract(&self.c, &self.c) - 3.0).max(F::zero()) * (4.0 / 9.0)
    }

    /// The corner forces of the shear stress, `-V_o P grad N`.
    #[inline(always)]
    pub(super) fn forces<const MAPPED: bool>(
        &self,
        stress: &Sym<F>,
        cells: &Cells<'_, MAPPED>,
        live: Mask,
    ) -> [V3<F>; 9] {
        let piola = self.frame.piola(stress, self.jacobian);
        let scale = self.root * self.root * -cells.volume::<F>();
        let along = piola.map(|axis| axis.map(|x| (x * scale).keep(live)));
        spread(&along, cells)
    }
}

/// Power of the shear stress against a velocity, over the volume, Eq. (24).
#[inline(always)]
pub(super) fn shear_power<F: Lanes, const MAPPED: bool>(
    (u, v): (&[V3<F>; 9], &[V3<F>; 9]),
    stress: &Sym<F>,
    cells: &Cells<'_, MAPPED>,
) -> F {
    let frame = Frame::new(gradient(u, cells), &cells.body.lattice.axes);
    let jacobian = frame.jacobian();
    let ([a, b, c], [u, v, w]) = (frame.piola(stress, jacobian), gradient(v, cells));
    let root = root(jacobian);
    (dot(&a, &u) + dot(&b, &v) + dot(&c, &w)) * (root * root)
}
