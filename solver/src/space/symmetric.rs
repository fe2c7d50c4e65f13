//! Symmetric matrices of three rows, in six numbers.

use std::ops::Add;

use super::lattice::dot;

/// The lower half by rows: 11, 21, 22, 31, 32, 33.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Symmetric([f64; 6]);

impl Add for Symmetric {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5]])
    }
}

impl Symmetric {
    /// The symmetric half of a matrix with these rows.
    #[inline(always)]
    #[must_use]
    pub fn half([x, y, z]: [[f64; 3]; 3]) -> Self {
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        Self([x[0], mean(y[0], x[1]), y[1], mean(z[0], x[2]), mean(z[1], y[2]), z[2]])
    }

    /// `sum_k s_k a_k a_k^T` over axes and what it is along them.
    #[inline(always)]
    #[must_use]
    pub fn along([a, b, c]: &[[f64; 3]; 3], s: [f64; 3]) -> Self {
        let [x, y, z] = [0, 1, 2].map(|d| [s[0] * a[d], s[1] * b[d], s[2] * c[d]]);
        let row = |d: usize| [a[d], b[d], c[d]];
        let [first, second, third] = [row(0), row(1), row(2)];
        Self([
            dot(x, first),
            dot(y, first),
            dot(y, second),
            dot(z, first),
            dot(z, second),
            dot(z, third),
        ])
    }

    /// The same along every axis.
    #[inline(always)]
    #[must_use]
    pub fn identity(s: f64) -> Self {
        Self([s, 0.0, s, 0.0, 0.0, s])
    }

    /// Times a number.
    #[inline(always)]
    #[must_use]
    pub fn scaled(self, s: f64) -> Self {
        let a = self.0;
        Self([s * a[0], s * a[1], s * a[2], s * a[3], s * a[4], s * a[5]])
    }

    /// Times a vector.
    #[inline(always)]
    #[must_use]
    pub fn times(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [xx, xy, yy, xz, yz, zz] = self.0;
        [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z]
    }

    /// Times itself.
    #[inline(always)]
    #[must_use]
    pub fn squared(&self) -> Self {
        let [xx, xy, yy, xz, yz, zz] = self.0;
        let (a, b, c) = (xy * xy, xz * xz, yz * yz);
        Self([
            xx * xx + a + b,
            xy * (xx + yy) + xz * yz,
            a + yy * yy + c,
            xz * (xx + zz) + xy * yz,
            yz * (yy + zz) + xy * xz,
            b + c + zz * zz,
        ])
    }

    /// Sum along the axes.
    #[inline(always)]
    #[must_use]
    pub fn trace(&self) -> f64 {
        let [xx, _, yy, _, _, zz] = self.0;
        xx + yy + zz
    }

    /// Adjugate and determinant.
    #[inline(always)]
    fn adjugate(&self) -> (Self, f64) {
        let [xx, xy, yy, xz, yz, zz] = self.0;
        let first = yy * zz - yz * yz;
        let second = xz * yz - xy * zz;
        let fourth = xy * yz - xz * yy;
        let all =
            Self([first, second, xx * zz - xz * xz, fourth, xy * xz - xx * yz, xx * yy - xy * xy]);
        (all, xx * first + xy * second + xz * fourth)
    }

    /// Its inverse; nothing where there is none.
    #[inline(always)]
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let (all, determinant) = self.adjugate();
        (determinant != 0.0).then(|| all.scaled(1.0 / determinant))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;

    use super::*;

    fn rows(a: Symmetric) -> Matrix3<f64> {
        let [xx, xy, yy, xz, yz, zz] = a.0;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    #[test]
    fn agrees_with_full_matrices() {
        let m = [[2.0, 0.3, -0.1], [0.7, 1.5, 0.4], [-0.5, 0.2, 3.0]];
        let full = Matrix3::from(m).transpose();
        let (own, half) = (Symmetric::half(m), 0.5 * (full + full.transpose()));
        let near = |a: Symmetric, b: Matrix3<f64>| assert!((rows(a) - b).norm() < 1e-14, "{a:?}");
        near(own, half);
        near(own.squared(), half * half);
        near(own + own.scaled(3.0), 4.0 * half);
        near(own.inverse().expect("regular"), half.try_inverse().expect("regular"));
        near(
            Symmetric::along(&m, [1.0, -2.0, 0.5]),
            full.transpose() * Matrix3::from_diagonal(&[1.0, -2.0, 0.5].into()) * full,
        );
        assert!((own.trace() - half.trace()).abs() < 1e-15);
        let given = own.times([1.0, -3.0, 0.2]);
        assert!(
            (half * nalgebra::Vector3::from([1.0, -3.0, 0.2]) - nalgebra::Vector3::from(given))
                .norm()
                < 1e-14
        );
        assert_eq!(Symmetric::identity(0.0).inverse(), None);
    }
}
