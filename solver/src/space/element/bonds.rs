//! Bonds between the corners of a cell and its centroid: viscosity and conduction.

use super::{CENTRE, Laws, Read, V3, dot, sub};
use crate::space::lanes::Lanes;
use crate::space::mesh::{Body, Group};

/// Steepness of the damping of receding bonds: it is whole from where the closing neighbours, over the
/// bond's own jump, reach half the inverse of this and of the limiter's.
const RINGING: f64 = 4.0;

/// Forces and heat of nine particles.
pub(super) struct Loads<F> {
    pub(super) force: [V3<F>; 9],
    pub(super) heat: [F; 9],
}

impl<F: Lanes> Loads<F> {
    /// A force along a bond, on the corner and against the centroid.
    #[inline(always)]
    pub(super) fn pull(&mut self, slot: usize, r: &V3<F>, bond: F) {
        for (d, r) in r.iter().enumerate() {
            let f = bond * *r;
            self.force[slot][d] += f;
            self.force[CENTRE][d] -= f;
        }
    }

    /// Heat from the corner to the centroid.
    #[inline(always)]
    pub(super) fn conduct(&mut self, slot: usize, flux: F) {
        self.heat[slot] -= flux;
        self.heat[CENTRE] += flux;
    }
}

/// What the bonds of up to eight elements see of their particles.
pub(super) struct Seen<'a, F> {
    pub(super) y: &'a [V3<F>; 9],
    pub(super) v: &'a [V3<F>; 9],
    pub(super) sound: &'a [F; 9],
    pub(super) theta: &'a [F; 9],
}

impl<F: Lanes> Seen<'_, F> {
    /// Separation and velocity of a corner from the centroid.
    #[inline(always)]
    pub(super) fn bond(&self, slot: usize) -> (V3<F>, V3<F>) {
        (sub(&self.y[slot], &self.y[CENTRE]), sub(&self.v[slot], &self.v[CENTRE]))
    }
}

impl Group {
    /// Viscosity (51)-(53) and conduction (56)-(57) as printed, between the centroid and the corners.
    /// Returns the rate of damping.
    #[inline(always)]
    pub(super) fn pairwise<F: Lanes>(
        &mut self,
        seen: &Seen<'_, F>,
        (body, laws): (&Body, &Laws),
        loads: &mut Loads<F>,
    ) -> F {
        let method = &laws.method;
        let impedance = body.rho_0 * body.bond_areas[1];
        let half = 0.5 * method.visc_linear * impedance;
        let conduct = 0.5 * method.heat_coeff * impedance * body.eos.c_v() * laws.dt;
        let reach = F::splat(body.length * body.length);
        let mut most = F::zero();
        for slot in 0..8 {
            let (r, w) = seen.bond(slot);
            let square = dot(&r, &r).max(F::splat(f64::MIN_POSITIVE));
            let near = square.lt(reach) & self.live;
            let approach = (-dot(&r, &w)).max(F::zero()).keep(near);
            let inverse = F::splat(1.0) / square;
            let pair = if body.solid.bulk > 0.0 {
                F::splat(2.0 * body.sound())
            } else {
                seen.sound[slot] + seen.sound[CENTRE]
            };
            let speed = approach * inverse.sqrt();
            let nu = (pair + speed * (2.0 * method.visc_quad)) * half;
            let bond = nu * approach * inverse;
            self.bonds[slot] = bond.pack();
            most = most.max(nu);
            loads.pull(slot, &r, bond);
            if conduct > 0.0 {
                let difference = seen.theta[slot] - seen.theta[CENTRE];
                loads.conduct(slot, (pair * difference).keep(near) * conduct);
            }
        }
        most * body.damping()
    }

    /// Viscosity on what neighbouring jumps along the diagonal do not explain, and the heat flux in
    /// shocks (decision 0013). Returns the rate of damping.
    #[inline(always)]
    pub(super) fn limited<F: Lanes>(
        &mut self,
        seen: &Seen<'_, F>,
        (body, laws, read): (&Body, &Laws, &Read<'_>),
        loads: &mut Loads<F>,
    ) -> F {
        let method = &laws.method;
        let zero = F::zero();
        let area = body.bond_areas[0];
        let conduct = method.heat_coeff * area * body.eos.c_v() * laws.dt;
        let rho: [F; 9] = self.gather(read.rho);
        let mut most = zero;
        for slot in 0..8 {
            let (r, w) = seen.bond(slot);
            // The centroid of a dead element may lie on a corner.
            let inverse = F::splat(1.0) / dot(&r, &r).max(F::splat(f64::MIN_POSITIVE));
            // Jumps times the separation: of the bond, of the one before and of the one beyond.
            let own = -dot(&r, &w);
            let before = dot(&r, &sub(&seen.v[7 - slot], &seen.v[CENTRE]));
            let at = self.beyond[slot] as usize;
            let mut next = [
                F::load(read.velocity[0], at),
                F::load(read.velocity[1], at),
                F::load(read.velocity[2], at),
            ];
            if self.mirrored[slot] != 0 {
                for (d, next) in next.iter_mut().enumerate() {
                    *next = if self.mirrored[slot] >> d & 1 == 1 { -*next } else { *next };
                }
            }
            let beyond = dot(&r, &sub(&seen.v[slot], &next)).keep(self.has_beyond[slot]);
            let (behind, ahead) = (before * own, beyond * own);
            let mean = before * beyond * method.limiter / ((before + beyond) * own);
            let explained = mean.min(F::splat(1.0)).keep(behind.gt(zero) & ahead.gt(zero));
            // What recedes is damped only as far as both neighbours close: it rings, and does not flow.
            let rings = (mean * -RINGING).min(F::splat(1.0)).keep(behind.lt(zero) & ahead.lt(zero));
            let part = F::select(own.gt(zero), F::splat(1.0) - explained, rings);
            let jump = (own * part).keep(self.live);
            let speed = jump * inverse.sqrt();
            let closing = speed.gt(zero);
            let sound = (seen.sound[slot] + seen.sound[CENTRE]) * 0.5;
            let mass = (rho[slot] + rho[CENTRE]) * (0.5 * area);
            let steep = speed * (method.visc_quad * body.slope);
            let linear = sound * method.visc_linear;
            let shock = steep + (steep * steep + linear * linear).sqrt();
            let nu = mass * F::select(closing, shock, sound * method.visc_expansion);
            let bond = nu * jump * inverse;
            self.bonds[slot] = bond.pack();
            // A bond that pulls at nothing damps nothing: material at rest asks for no shorter step.
            most = most.max(nu.keep(closing | speed.lt(zero)));
            loads.pull(slot, &r, bond);
            if conduct > 0.0 {
                let difference = seen.theta[slot] - seen.theta[CENTRE];
                loads.conduct(slot, mass * speed.max(zero) * (difference * (conduct / area)));
            }
        }
        most * body.damping()
    }
}
