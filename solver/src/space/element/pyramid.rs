//! Pyramids from the centroid of a cell to its faces: their volumes, and tension.

use super::symmetric::Symmetric;
use super::{CENTRE, FACES, V3, cross, dot, sub};
use crate::space::cells::Cells;
use crate::space::lanes::{F8, Lanes, each};

/// A pyramid from the centroid to a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pyramid<F> {
    /// From the centroid to the middle of the face.
    pub(super) w: V3<F>,
    /// Diagonals of the face.
    pub(super) e: V3<F>,
    pub(super) g: V3<F>,
    /// Twice the area of the face, outwards.
    pub(super) area: V3<F>,
    /// Volume over the reference volume, less one, times the reference volume.
    pub(super) growth: F,
}

impl<F: Lanes> Pyramid<F> {
    #[inline(always)]
    pub(super) fn new(y: &[V3<F>; 9], [a, b, c, d]: [usize; 4], reference: F) -> Self {
        let w = each!(k in 3 => {
            ((y[a][k] + y[b][k]) + (y[c][k] + y[d][k])) * 0.25 - y[CENTRE][k]
        });
        let (e, g) = (sub(&y[c], &y[a]), sub(&y[d], &y[b]));
        let area = cross(&e, &g);
        // Exact for the bilinear face; nothing where nothing has moved.
        let growth = dot(&w, &area) * (1.0 / 6.0) - reference;
        Self { w, e, g, area, growth }
    }

    /// Rate of the volume.
    #[inline(always)]
    pub(super) fn rate(&self, v: &[V3<F>; 9], face: [usize; 4]) -> F {
        let [a, b, c, d] = face;
        let w = each!(k in 3 => {
            ((v[a][k] + v[b][k]) + (v[c][k] + v[d][k])) * 0.25 - v[CENTRE][k]
        });
        let (e, g) = (sub(&v[c], &v[a]), sub(&v[d], &v[b]));
        let turned = dot(&e, &cross(&self.g, &self.w)) + dot(&g, &cross(&self.w, &self.e));
        (dot(&w, &self.area) + turned) * (1.0 / 6.0)
    }

    /// Square of the gradient of the volume, each particle's part over its share of the cell's mass.
    #[inline(always)]
    pub(super) fn steepness(&self) -> F {
        let (gw, we) = (cross(&self.g, &self.w), cross(&self.w, &self.e));
        dot(&self.area, &self.area) * (1.0 / 6.0) + (dot(&gw, &gw) + dot(&we, &we)) * (8.0 / 9.0)
    }

    /// Adds `push` times the gradient of the volume.
    #[inline(always)]
    pub(super) fn push(&self, [a, b, c, d]: [usize; 4], push: F, force: &mut [V3<F>; 9]) {
        let sixth = push * (1.0 / 6.0);
        let w = self.w.map(|w| w * sixth);
        let (gw, we) = (cross(&self.g, &w), cross(&w, &self.e));
        for k in 0..3 {
            let own = self.area[k] * sixth;
            let fourth = own * 0.25;
            force[CENTRE][k] -= own;
            force[a][k] += fourth - gw[k];
            force[c][k] += fourth + gw[k];
            force[b][k] += fourth - we[k];
            force[d][k] += fourth + we[k];
        }
    }
}

/// Weights of a pyramid for the corners of its own face, on top of those for all corners, and for all
/// corners.
#[inline(always)]
pub(super) fn corner_weights(balance: f64) -> [f64; 2] {
    [0.125 * (1.0 + 2.0 * balance), -0.125 * balance]
}

/// Shares of nine particles in six pyramids.
#[inline(always)]
pub(super) fn shares<F: Lanes>(pyramids: &[F; 6], balance: f64) -> [F; 9] {
    let [own, other] = corner_weights(balance);
    let all =
        ((pyramids[0] + pyramids[1]) + (pyramids[2] + pyramids[3])) + (pyramids[4] + pyramids[5]);
    let mut share = [all * other; 9];
    share[CENTRE] = all * 0.5;
    for (k, face) in FACES.into_iter().enumerate() {
        let part = pyramids[k] * own;
        for slot in face {
            share[slot] += part;
        }
    }
    share
}

/// Volume and faces of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent<F> {
    pub(super) volume: F,
    /// Square of twice the largest face.
    pub(super) largest: F,
    /// Sum over the six faces `a a^T`, twice their areas.
    pub(super) faces: Symmetric<F>,
}

impl<F: Lanes> Extent<F> {
    #[inline(always)]
    pub(super) fn new(pyramids: &[Pyramid<F>; 6], volume: F) -> Self {
        let mut extent = Self { volume, largest: F::zero(), faces: Symmetric::zero() };
        for pyramid in pyramids {
            extent.largest = extent.largest.max(dot(&pyramid.area, &pyramid.area));
            extent.faces.add(&pyramid.area, F::splat(1.0));
            extent.volume += pyramid.growth;
        }
        extent
    }

    /// Squares of the frequencies of the cell's pressure, `4 c^2 (A_1 A_1^T + A_2 A_2^T + A_3 A_3^T) / V^2`: by
    /// axes, a bound for a lattice of such cells. Over the sum of the faces. Particles on the surface of a body have
    /// half of the mass or less, which adds the trace (decision 0020).
    #[inline(always)]
    pub(super) fn pressure_squared(&self, sound: &[F; 9]) -> F {
        let mut fastest = sound[CENTRE];
        for sound in &sound[..8] {
            fastest = fastest.max(*sound);
        }
        self.by_speed(fastest * fastest)
    }

    /// Squares of the frequencies of what resists changes of the volume with this square of a sound speed, over the
    /// sum of the faces.
    #[inline(always)]
    pub(super) fn by_speed(&self, squared: F) -> F {
        // Of three pairs of faces that come doubled.
        squared * 0.5 / (self.volume * self.volume)
    }

    /// Squares of the frequencies of tension, where a pyramid is open, over the sum of the faces: twice what pressure
    /// has of the same modulus, since it acts on the whole of a cell and not on the half of its centroid.
    #[inline(always)]
    pub(super) fn tension_squared<const MAPPED: bool>(
        &self,
        opening: &[F; 6],
        intact: F,
        cells: &Cells<'_, MAPPED>,
    ) -> F {
        let body = cells.body;
        let scale: F = cells.volume_as(|volume| body.solid.bulk / (body.rho_0 * volume * volume));
        let widest = opening.iter().fold(F::zero(), |widest, opening| widest.max(*opening));
        (scale * intact).keep(widest.gt(F::zero()))
    }
}

/// Volumes of the pyramids of a cell with these corners about its centre.
#[must_use]
pub fn pyramid_volumes(corners: &[[f64; 3]; 8]) -> [f64; 6] {
    let mut y = [[F8::ZERO; 3]; 9];
    for (slot, corner) in corners.iter().enumerate() {
        y[slot] = corner.map(F8::splat);
    }
    FACES.map(|face| Pyramid::new(&y, face, F8::ZERO).growth.0[0])
}

/// Volumes that the corners have of a cell with these pyramids.
#[must_use]
pub fn corner_volumes(pyramids: &[f64; 6], balance: f64) -> [f64; 8] {
    let share = shares(&pyramids.map(F8::splat), balance);
    std::array::from_fn(|slot| share[slot].0[0])
}

/// Tension of a pyramid, Eq. (25), with the bracket (26).
#[inline(always)]
pub(super) fn tension<F: Lanes>(opening: F, intact: F, bulk: f64) -> F {
    intact * bulk * opening.max(F::zero())
}

/// Energy of the pyramids in tension, damage apart.
#[inline(always)]
pub(super) fn tension_energy<F: Lanes, const MAPPED: bool>(
    cells: &Cells<'_, MAPPED>,
    opening: &[F; 6],
) -> F {
    let mut energy = F::zero();
    for (k, o) in opening.iter().enumerate() {
        let open = o.max(F::zero());
        energy += open * open * (cells.pyramid::<F>(k) * (0.5 * cells.body.solid.bulk));
    }
    energy
}
