//! Drag against hourglass modes, which keeps lattices of solids without strength from warping (decision
//! 0019).

use super::kinematics::{Frame, gradient, spread};
use super::{V3, dot};
use crate::space::cells::Cells;
use crate::space::hourglass::{corners, modes, resist};
use crate::space::lanes::Lanes;
use crate::space::mesh::Group;
use crate::space::method::Method;

/// Least volume ratio by which the shape of a cell is undone; one below is dying.
const LEAST: f64 = 1e-2;

/// Coefficient of the drag on the rates of the amplitudes, `kappa rho_o V_o^(2/3) c` with the sound speed
/// of the centroid, of elements that are volumes after the step too. What a solid has lost of its
/// strength has the drag of those without. A gas has none: there pyramids resist (decision 0017).
#[inline(always)]
pub(super) fn coefficient<F: Lanes, const MAPPED: bool>(
    method: &Method,
    (group, cells): (&Group, &Cells<'_, MAPPED>),
    sound: impl FnOnce() -> F,
) -> Option<F> {
    let body = cells.body;
    let [plain, strong] = [method.visc_hourglass, method.visc_hourglass_strong];
    let solid = body.solid.mu > 0.0;
    let whole = solid && group.failed & group.live == 0;
    if body.is_gas() || plain == 0.0 && strong == 0.0 || whole && strong == 0.0 {
        return None;
    }
    let lost = if solid { F::of(group.damage) } else { F::splat(1.0) };
    let kappa = lost * (plain - strong) + strong;
    // The area of the bonds is 3/4 of a face's.
    let face: F = cells.bond_area_as(0, |area| 4.0 / 3.0 * body.rho_0 * area);
    Some((sound() * kappa * face).keep(group.live & !group.dying))
}

/// The hourglass modes of cells as they are: the weights of D. P. Flanagan and T. Belytschko (1981), by
/// which every velocity field that is linear in the present positions has no amplitude. So no rotation
/// and no homogeneous flow is resisted, and no moment made, in a deformed cell either.
pub(super) struct Warp<F> {
    /// Amplitudes of position, through the inverse of the deformation: along the lattice axes, by mode.
    back: [V3<F>; 4],
    /// One over how much lighter a mode is than in a cube, where the deformation has an inverse; nothing
    /// elsewhere. The drag goes with it: however warped a cell, its modes are damped at the same rate.
    inertia: F,
}

impl<F: Lanes> Warp<F> {
    /// At displacements `u`, where the slots are at `y`.
    #[inline(always)]
    pub(super) fn new<const MAPPED: bool>(
        u: &[V3<F>; 9],
        y: &[V3<F>; 9],
        cells: &Cells<'_, MAPPED>,
    ) -> Self {
        let frame = Frame::new(gradient(u, cells), &cells.body.lattice.axes);
        let (jacobian, least) = (frame.jacobian(), F::splat(LEAST));
        let inverse = F::splat(1.0) / jacobian.max(least);
        let warp = amplitudes(y);
        let mut back = [[F::zero(); 3]; 4];
        for (back, warp) in back.iter_mut().zip(&warp) {
            for (back, across) in back.iter_mut().zip(&frame.across) {
                *back = dot(across, warp) * inverse;
            }
        }
        let mut added = F::zero();
        for axis in 0..3 {
            // Eight times the sum of the squares of the weights of the gradient.
            let weights = cells.gradient_squared::<F>(axis) * 8.0;
            for back in &back {
                added += back[axis] * back[axis] * weights;
            }
        }
        let inertia = (F::splat(1.0) / (added + 1.0)).keep(jacobian.gt(least));
        Self { back, inertia }
    }

    /// Rates of the amplitudes, but for what a linear field makes of them.
    #[inline(always)]
    pub(super) fn rates<const MAPPED: bool>(
        &self,
        v: &[V3<F>; 9],
        cells: &Cells<'_, MAPPED>,
    ) -> [V3<F>; 4] {
        let flow = gradient(v, cells);
        let mut rates = amplitudes(v);
        for (rates, back) in rates.iter_mut().zip(&self.back) {
            for (flow, back) in flow.iter().zip(back) {
                for d in 0..3 {
                    rates[d] -= flow[d] * *back;
                }
            }
        }
        rates
    }

    /// Adds the forces on the corners against rates.
    #[inline(always)]
    pub(super) fn push<const MAPPED: bool>(
        &self,
        rates: &[V3<F>; 4],
        (cells, coefficient): (&Cells<'_, MAPPED>, F),
        force: &mut [V3<F>; 9],
    ) {
        let coefficient = coefficient * self.inertia;
        let mut flow = [[F::zero(); 3]; 3];
        for (rates, back) in rates.iter().zip(&self.back) {
            for (flow, back) in flow.iter_mut().zip(back) {
                for d in 0..3 {
                    flow[d] += rates[d] * (*back * coefficient);
                }
            }
        }
        let linear = spread(&flow, cells);
        for d in 0..3 {
            let mut modes = [F::zero(); 4];
            for (mode, rates) in modes.iter_mut().zip(rates) {
                *mode = rates[d] * coefficient;
            }
            for ((force, own), linear) in force.iter_mut().zip(resist(modes)).zip(&linear) {
                force[d] += own + linear[d];
            }
        }
    }

    /// What forces with this coefficient against rates `made` take from motion per time, with rates `mean`.
    #[inline(always)]
    pub(super) fn power(&self, made: &[V3<F>; 4], mean: &[V3<F>; 4], coefficient: F) -> F {
        let mut sum = F::zero();
        for (made, mean) in made.iter().zip(mean) {
            sum += dot(made, mean);
        }
        sum * coefficient * self.inertia
    }
}

/// A bound of the rate at which modes are damped with this coefficient: half of the mass of a cell is at its
/// corners.
#[inline(always)]
pub(super) fn rate<F: Lanes, const MAPPED: bool>(coefficient: F, cells: &Cells<'_, MAPPED>) -> F {
    // Twice, since the weights of modes and of the gradient are not orthogonal in mapped cells.
    coefficient * cells.volume_as::<F>(|volume| 4.0 / (cells.body.rho_0 * volume))
}

#[inline(always)]
fn amplitudes<F: Lanes>(u: &[V3<F>; 9]) -> [V3<F>; 4] {
    let mut out = [[F::zero(); 3]; 4];
    for d in 0..3 {
        for (out, mode) in out.iter_mut().zip(modes(&corners(u, d))) {
            out[d] = mode;
        }
    }
    out
}
