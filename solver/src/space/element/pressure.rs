//! Pressure of the particles on the pyramids, and what resists their collapse.

use super::bonds::Seen;
use super::pyramid::{Pyramid, corner_weights};
use super::{CENTRE, FACES, Laws, Read, V3, dot};
use crate::space::cells::Cells;
use crate::space::lanes::Lanes;
use crate::space::mesh::Group;
use crate::space::method::Method;

/// Smallest pyramid, over its share of the cell, to which the elastic pressure rises.
const SLIVER: f64 = 0.25;

impl Group {
    /// Pressure of the particles on the pyramids: half of that of the centroid, the rest of the corners
    /// of its face and, by `balance`, of the opposite face (decision 0013).
    #[inline(always)]
    pub(super) fn carry<F: Lanes>(&self, (laws, read): (&Laws, &Read<'_>), push: &mut [F; 6]) {
        let grip: [F; 9] = self.gather(read.grip);
        let [own, other] = corner_weights(laws.method.balance);
        let all = ((grip[0] + grip[1]) + (grip[2] + grip[3]))
            + ((grip[4] + grip[5]) + (grip[6] + grip[7]));
        let base = grip[CENTRE] * 0.5 + all * other;
        for (push, face) in push.iter_mut().zip(FACES) {
            let corners = (grip[face[0]] + grip[face[1]]) + (grip[face[2]] + grip[face[3]]);
            *push += (base + corners * own).keep(self.live);
        }
    }

    /// What pyramids press with beside the pressure of their particles. Returns the square of the
    /// frequency that it adds.
    #[inline(always)]
    pub(super) fn stiffen<F: Lanes, const MAPPED: bool>(
        &mut self,
        pyramids: &[Pyramid<F>; 6],
        (volume, opening): (F, &[F; 6]),
        (seen, cells, method): (&Seen<'_, F>, &Cells<'_, MAPPED>, &Method),
        push: &mut [F; 6],
    ) -> F {
        let mut own = [F::zero(); 6];
        let mut rate_squared = F::zero();
        if method.visc_volume > 0.0 {
            collapse(pyramids, opening, (seen.v, cells.body.rho_0, method), &mut own);
        }
        if cells.body.zonal(method) > 0.0 {
            rate_squared = crowd(pyramids, (volume, opening), (seen, cells, method), &mut own);
        }
        for (k, own) in own.into_iter().enumerate() {
            let own = own.keep(self.live);
            push[k] += own;
            if let Some(stiff) = &mut self.stiff {
                stiff[k] = own.pack();
            }
        }
        rate_squared
    }
}

/// Viscous pressure of pyramids that collapse: `rho q w^2` with the closing speed `w` over their
/// height (decision 0013).
#[inline(always)]
fn collapse<F: Lanes>(
    pyramids: &[Pyramid<F>; 6],
    opening: &[F; 6],
    (v, rho_0, method): (&[V3<F>; 9], f64, &Method),
    own: &mut [F; 6],
) {
    let factor = 9.0 * method.visc_volume * rho_0;
    for (k, face) in FACES.into_iter().enumerate() {
        let closing = (-pyramids[k].rate(v, face)).max(F::zero());
        let volume = (opening[k] + 1.0).max(F::splat(0.05));
        let area = dot(&pyramids[k].area, &pyramids[k].area).max(F::splat(f64::MIN_POSITIVE));
        own[k] += closing * closing / area * factor / (volume * volume);
    }
}

/// Elastic pressure of pyramids of gas that are denser than their cell, `rho c^2 (V_k / V - 1)` with
/// the volume `V` of a pyramid and its share `V_k` of the cell (decision 0017). Returns the square of
/// its frequency.
#[inline(always)]
fn crowd<F: Lanes, const MAPPED: bool>(
    pyramids: &[Pyramid<F>; 6],
    (volume, opening): (F, &[F; 6]),
    (seen, cells, method): (&Seen<'_, F>, &Cells<'_, MAPPED>, &Method),
    own: &mut [F; 6],
) -> F {
    let body = cells.body;
    let mass = |volume: f64| body.rho_0 * volume;
    let volume = volume.max(cells.volume_as(|volume| body.solid.least * volume));
    let corners = ((seen.sound[0] + seen.sound[1]) + (seen.sound[2] + seen.sound[3]))
        + ((seen.sound[4] + seen.sound[5]) + (seen.sound[6] + seen.sound[7]));
    let sound = seen.sound[CENTRE] * 0.5 + corners * 0.0625;
    let modulus =
        sound * sound * cells.volume_as::<F>(|volume| mass(volume) * body.zonal(method)) / volume;
    let mut fastest = F::zero();
    for k in 0..6 {
        let even = volume * cells.part::<F>(k);
        let thick = ((opening[k] + 1.0) * cells.pyramid::<F>(k)).max(even * SLIVER);
        own[k] += modulus * (even / thick - 1.0);
        fastest = fastest.max(pyramids[k].steepness() * modulus * even / (thick * thick));
    }
    // Two opposite pyramids act on the same particles.
    fastest * cells.volume_as::<F>(|volume| 2.0 / mass(volume))
}
