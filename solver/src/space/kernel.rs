//! The rival of the paper's density: a sum over a kernel, `rho = rho_o (W(0) + sum W(zeta)) / D`.
//!
//! `D` is the sum over the particle's own neighbours at the start, so that every body begins at its
//! reference density, surfaces included. It costs one more sweep over all neighbours a step; force and
//! work come from the same derivative, as with the paper's scheme.

use super::mesh::Mesh;

/// The cubic spline and the sums at the start.
#[derive(Debug, Clone, Default)]
pub struct Kernel {
    /// Distance, in contact lengths, at which it ends.
    support: f64,
    /// One over the sum at the start of every particle.
    scale: Vec<f64>,
}

impl Kernel {
    /// The kernel on a mesh at the start.
    #[must_use]
    pub fn new(mesh: &Mesh, support: f64) -> Self {
        let mut kernel = Self { support, scale: vec![0.0; mesh.len] };
        for i in mesh.real() {
            let (body, at) = mesh.place(i);
            let own = &mesh.bodies[body];
            let lengths = own.ellipsoid.unwrap_or([own.length; 3]);
            let per_step: [f64; 3] =
                std::array::from_fn(|d| 0.5 * own.lattice.size[d] / lengths[d]);
            let zeta = |other: usize| {
                let to = mesh.place(other).1;
                let square = |d: usize| (per_step[d] * f64::from(at[d] - to[d])).powi(2);
                (0..3).map(square).sum::<f64>().sqrt()
            };
            let others = mesh.within(2, body, at).filter(|&other| other != i);
            let sum: f64 = others.map(|other| kernel.value(zeta(other))).sum();
            kernel.scale[i] = 1.0 / (kernel.value(0.0) + sum);
        }
        kernel
    }

    /// `W(zeta)`.
    #[inline(always)]
    #[must_use]
    pub fn value(&self, zeta: f64) -> f64 {
        let q = 2.0 * zeta / self.support;
        if q < 1.0 {
            1.0 - q * q * (1.5 - 0.75 * q)
        } else if q < 2.0 {
            0.25 * (2.0 - q).powi(3)
        } else {
            0.0
        }
    }

    /// `-dW/dzeta`.
    #[inline(always)]
    #[must_use]
    pub fn slope(&self, zeta: f64) -> f64 {
        let q = 2.0 * zeta / self.support;
        let slope = if q < 1.0 {
            q * (3.0 - 2.25 * q)
        } else if q < 2.0 {
            0.75 * (2.0 - q).powi(2)
        } else {
            0.0
        };
        slope * 2.0 / self.support
    }

    /// Distance, in contact lengths, at which it ends.
    #[must_use]
    pub fn support(&self) -> f64 {
        self.support
    }

    /// One over the sum at the start.
    #[inline(always)]
    #[must_use]
    pub fn scale(&self, i: usize) -> f64 {
        self.scale[i]
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        8 * self.scale.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_is_the_derivative() {
        let kernel = Kernel { support: 1.7, scale: Vec::new() };
        for k in 1..60 {
            let zeta = 0.03 * f64::from(k);
            let step = 1e-6;
            let difference = (kernel.value(zeta - step) - kernel.value(zeta + step)) / (2.0 * step);
            assert!((difference - kernel.slope(zeta)).abs() < 1e-8, "{zeta}");
        }
    }
}
