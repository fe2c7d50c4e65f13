//! Stiffness against the modes of a cell that strain, volumes and pyramids hardly see: the four
//! hourglass modes of its corners, and the motion of its centroid against them.
//!
//! An amplitude is a sum of positions with weights that vanish for every affine motion of the lattice,
//! and the energy depends on its size alone. So translation, rotation and homogeneous strain stay free
//! of force, and momentum, angular momentum and energy are kept.

use super::cells::Cells;
use super::lanes::Lanes;
use super::method::Method;

type V3<F> = [F; 3];

/// Weight of a corner in an amplitude.
const SHARE: f64 = 0.125;

/// Amplitudes of the hourglass modes of one component at the eight corners: the products of the signs of
/// the corner along two axes, in cyclic order, and along all three.
#[inline(always)]
pub fn modes<F: Lanes>(u: &[F; 8]) -> [F; 4] {
    // Differences and sums along the first axis, by the bits of the other two.
    let (mut apart, mut both) = ([F::zero(); 4], [F::zero(); 4]);
    for k in 0..4 {
        let (low, high) = (u[2 * k], u[2 * k + 1]);
        (apart[k], both[k]) = (high - low, high + low);
    }
    let (along, across) = (apart[3] - apart[0], apart[1] - apart[2]);
    [
        (along + across) * SHARE,
        ((both[3] + both[0]) - (both[1] + both[2])) * SHARE,
        (along - across) * SHARE,
        ((apart[3] + apart[0]) - (apart[1] + apart[2])) * SHARE,
    ]
}

/// One component of the corners' forces against the modes: minus the transpose of [`modes`].
#[inline(always)]
pub fn resist<F: Lanes>([ab, bc, ca, abc]: [F; 4]) -> [F; 8] {
    let [ab, bc, ca, abc] = [ab * SHARE, bc * SHARE, ca * SHARE, abc * SHARE];
    let (along, across) = (ab + ca, ab - ca);
    let odd = [abc - along, across - abc, -across - abc, along + abc];
    let even = [bc, -bc, -bc, bc];
    let mut out = [F::zero(); 8];
    for k in 0..4 {
        (out[2 * k], out[2 * k + 1]) = (odd[k] - even[k], -odd[k] - even[k]);
    }
    out
}

/// One component at the corners.
#[inline(always)]
pub fn corners<F: Lanes>(u: &[V3<F>; 9], d: usize) -> [F; 8] {
    let mut out = [F::zero(); 8];
    for (out, u) in out.iter_mut().zip(u) {
        *out = u[d];
    }
    out
}

/// Stiffness of the modes of cells.
#[derive(Debug, Clone, Copy)]
pub struct Hourglass<F> {
    /// Of the hourglass modes: energy over the square of an amplitude, twice.
    corners: F,
    /// Of the centroid against the corners.
    centroid: F,
}

impl<F: Lanes> Hourglass<F> {
    /// As a method has it; none if it has none, and none of a gas, whose modes have no elastic modulus.
    #[inline(always)]
    pub fn of<const MAPPED: bool>(method: &Method, cells: &Cells<'_, MAPPED>) -> Option<Self> {
        let body = cells.body;
        let none = method.hourglass == 0.0 && method.centring == 0.0;
        if none || body.solid.sound == 0.0 {
            return None;
        }
        let sound = body.solid.sound;
        let mass_rate: F = cells.volume_as(|volume| body.rho_0 * sound * sound * volume);
        let unit = mass_rate / cells.edge_as(|edge| edge * edge);
        Some(Self { corners: unit * method.hourglass, centroid: unit * method.centring })
    }

    /// Amplitudes of the corners' modes and of the centroid's.
    #[inline(always)]
    fn amplitudes(u: &[V3<F>; 9]) -> [V3<F>; 5] {
        let mut out = [[F::zero(); 3]; 5];
        for d in 0..3 {
            for (out, mode) in out.iter_mut().zip(modes(&corners(u, d))) {
                out[d] = mode;
            }
            let corners = ((u[0][d] + u[1][d]) + (u[2][d] + u[3][d]))
                + ((u[4][d] + u[5][d]) + (u[6][d] + u[7][d]));
            out[4][d] = u[8][d] - corners * SHARE;
        }
        out
    }

    #[inline(always)]
    fn stiffness(&self, mode: usize) -> F {
        if mode < 4 { self.corners } else { self.centroid }
    }

    /// Energy of displacements.
    #[inline(always)]
    pub fn energy(&self, u: &[V3<F>; 9]) -> F {
        let mut energy = F::zero();
        for (mode, a) in Self::amplitudes(u).iter().enumerate() {
            energy += dot(a, a) * (self.stiffness(mode) * 0.5);
        }
        energy
    }

    /// Rate of that energy with velocities.
    #[inline(always)]
    pub fn power(&self, u: &[V3<F>; 9], v: &[V3<F>; 9]) -> F {
        let mut power = F::zero();
        let (a, b) = (Self::amplitudes(u), Self::amplitudes(v));
        for mode in 0..5 {
            power += dot(&a[mode], &b[mode]) * self.stiffness(mode);
        }
        power
    }

    /// Adds the forces, of as much of the stiffness as is left.
    #[inline(always)]
    pub fn push(&self, u: &[V3<F>; 9], left: F, force: &mut [V3<F>; 9]) {
        let a = Self::amplitudes(u);
        for d in 0..3 {
            let back = a[4][d] * left * self.centroid;
            let scale = left * self.corners;
            let push = [a[0][d] * scale, a[1][d] * scale, a[2][d] * scale, a[3][d] * scale];
            for (force, own) in force.iter_mut().zip(resist(push)) {
                force[d] += own + back * SHARE;
            }
            force[8][d] -= back;
        }
    }

    /// Square of the fastest rate of the modes.
    #[inline(always)]
    pub fn rate_squared<const MAPPED: bool>(&self, cells: &Cells<'_, MAPPED>) -> F {
        // Half of the mass of a cell is at its corners, half at its centroid.
        let mass: F = cells.volume_as(|volume| 0.5 * cells.body.rho_0 * volume);
        (self.corners + self.centroid * 2.0) / mass
    }
}

#[inline(always)]
fn dot<F: Lanes>(a: &V3<F>, b: &V3<F>) -> F {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::super::lanes::F8;
    use super::*;

    fn slots(f: impl Fn([f64; 3]) -> [f64; 3]) -> [V3<F8>; 9] {
        std::array::from_fn(|slot| {
            let sign = |d: usize| if slot >> d & 1 == 1 { 1.0 } else { -1.0 };
            let x = if slot == 8 { [0.0; 3] } else { std::array::from_fn(sign) };
            f(x).map(F8::splat)
        })
    }

    #[test]
    fn affine_motions_have_no_energy_and_the_modes_have() {
        let glass = Hourglass { corners: F8::splat(2.0), centroid: F8::splat(2.0) };
        let affine = slots(|[x, y, z]| [1.0 + 2.0 * x - y, 0.5 * z + 3.0 * y, x + y + z]);
        assert!(glass.energy(&affine).0[0].abs() < 1e-28);
        let bent = slots(|[x, y, _]| [x * y, 0.0, 0.0]);
        assert!((glass.energy(&bent).0[0] - 1.0).abs() < 1e-15);
        let twisted = slots(|[x, y, z]| [0.0, x * y * z, 0.0]);
        assert!((glass.energy(&twisted).0[0] - 1.0).abs() < 1e-15);
    }

    #[test]
    fn forces_are_minus_the_gradient_of_the_energy() {
        let glass = Hourglass { corners: F8::splat(2.0), centroid: F8::splat(0.7) };
        let u = slots(|[x, y, z]| [x * y + z, x * z * y + y, 0.3 * z * y - x * x]);
        let mut force = [[F8::zero(); 3]; 9];
        glass.push(&u, F8::splat(1.0), &mut force);
        let step = 1e-6;
        for slot in 0..9 {
            for d in 0..3 {
                let shifted = |by: f64| {
                    let mut w = u;
                    w[slot][d] += F8::splat(by);
                    glass.energy(&w).0[0]
                };
                let slope = (shifted(step) - shifted(-step)) / (2.0 * step);
                assert!((force[slot][d].0[0] + slope).abs() < 1e-9, "{slot} {d}");
                let v = slots(|_| [0.0; 3]);
                let mut v = v;
                v[slot][d] = F8::splat(1.0);
                assert!((glass.power(&u, &v).0[0] - slope).abs() < 1e-9);
            }
        }
    }
}
