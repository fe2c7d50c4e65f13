//! Bonds between the corners of a cell and its centroid: viscosity and conduction.

use super::kinematics::spread;
use super::skew::Skewed;
use super::symmetric::Symmetric;
use super::{CENTRE, Laws, Read, V3, dot, sub};
use crate::space::cells::Cells;
use crate::space::lanes::{Lanes, Mask};
use crate::space::mesh::Group;

/// Steepness of the damping of receding bonds: it is whole from where the closing neighbours, over the
/// bond's own jump, reach half the inverse of this and of the limiter's.
const RINGING: f64 = 4.0;

/// Jump of a bond over the sound speed below which it does not ask for a shorter step. What grows from
/// there without a vote gets one as soon as it is larger, and material that round-off moves has none.
const QUIET: f64 = 1e-9;

/// Speed over that of sound `c` at which heat that alternates between corners and centroids flows between them. Through bonds
/// of 3/4 of a face between masses of half a cell a difference goes at 24 times this over the time `h / c` of a cell, of which
/// a step is less than a third: by a sixth in a step.
const LEVELLING: f64 = 0.02;

/// Part of a difference that is levelled in a step at most, so that nothing overshoots where material is denser or the
/// step is longer: each end of a bond has half of the mass of a cell, and eight bonds.
const LEVELLED: f64 = 1.0 / 6.0;

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

    /// Forces on the nine.
    #[inline(always)]
    fn add(&mut self, forces: &[V3<F>; 9]) {
        for (own, force) in self.force.iter_mut().zip(forces) {
            for (own, force) in own.iter_mut().zip(force) {
                *own += *force;
            }
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
    /// A corner from the centroid.
    #[inline(always)]
    fn diagonal(&self, slot: usize) -> V3<F> {
        sub(&self.y[slot], &self.y[CENTRE])
    }

    /// Speed, over that of sound, at which heat flows along all bonds because it alternates between corners and
    /// centroids, which changes no volume, so that no motion levels it (decision 0023): by the part of the difference
    /// that the spread of the corners does not explain.
    #[inline(always)]
    fn alternating(&self) -> F {
        let theta = self.theta;
        let (mut sum, mut low, mut high) = (theta[0], theta[0], theta[0]);
        for corner in &theta[1..CENTRE] {
            sum += *corner;
            low = low.min(*corner);
            high = high.max(*corner);
        }
        let off = (theta[CENTRE] - sum * 0.125).abs();
        let unexplained = (off - (high - low)).max(F::zero());
        unexplained / off.max(F::splat(f64::MIN_POSITIVE)) * LEVELLING
    }
}

/// How fast a bond `n` closes where one end moves against the other, times its length. No closure: one that is not inlined
/// is compiled without the vector registers of its caller.
#[inline(always)]
fn closing<F: Lanes>(
    (skew, slot): (&impl Skewed<F>, usize),
    n: &V3<F>,
    to: &V3<F>,
    from: &V3<F>,
) -> F {
    -dot(n, &skew.rate(slot, sub(to, from)))
}

/// Least square of a length, whose inverse bears factors.
const LEAST_SQUARE: f64 = 1e-200;

/// Viscosity of the bonds of a cell.
struct Damping<F> {
    /// Of each, where it acts.
    nu: [F; 8],
    /// Inverse squares of their lengths.
    inverse: [F; 8],
}

impl<F: Lanes> Damping<F> {
    #[inline(always)]
    fn none() -> Self {
        Self { nu: [F::zero(); 8], inverse: [F::zero(); 8] }
    }

    /// Rates at which corners and centroid, moving against each other, are damped: each has half of the mass
    /// of a cell, and a bond takes from either what it takes from both. The centroid is damped by the bonds that act,
    /// `sum nu n n^T`; a corner, which has a bond in each of its cells, at most by all eight with the largest `nu`
    /// that acts. Corners on edges of a body are as much lighter as they have fewer bonds, which then point one way:
    /// three times that, and a third more so that they are turned round by half of their motion at most, with the safety of
    /// 0.9 (in sample, decision 0020).
    #[inline(always)]
    fn rates<const MAPPED: bool>(
        &self,
        (seen, skew): (&Seen<'_, F>, &impl Skewed<F>),
        light: Mask,
        cells: &Cells<'_, MAPPED>,
    ) -> Symmetric<F> {
        let most = self.nu.iter().fold(F::zero(), |most, nu| most.max(*nu));
        let corner = most * F::select(light, F::splat(4.0), F::splat(1.0));
        let per_mass: F = cells.volume_as(|volume| 2.0 / (cells.body.rho_0 * volume));
        let mut rates = Symmetric::zero();
        for slot in 0..8 {
            rates.add(
                &skew.bond(slot, seen.diagonal(slot)),
                (self.nu[slot] + corner) * self.inverse[slot] * per_mass,
            );
        }
        rates
    }
}

impl Group {
    /// Viscosity (51)-(53) and conduction (56)-(57) as printed, between the centroid and the corners.
    /// Returns the rates of damping.
    #[inline(always)]
    pub(super) fn pairwise<F: Lanes, const MAPPED: bool>(
        &mut self,
        seen: &Seen<'_, F>,
        (cells, laws): (&Cells<'_, MAPPED>, &Laws),
        loads: &mut Loads<F>,
    ) -> Symmetric<F> {
        let (body, method) = (cells.body, &laws.method);
        let half: F = cells.bond_area_as(1, |area| 0.5 * method.visc_linear * (body.rho_0 * area));
        let conduct: F = cells.bond_area_as(1, |area| {
            0.5 * method.heat_coeff * (body.rho_0 * area) * body.eos.c_v() * laws.dt
        });
        let conducts = method.heat_coeff * laws.dt > 0.0;
        let mut damping = Damping::none();
        for slot in 0..8 {
            let (r, w) = (seen.diagonal(slot), sub(&seen.v[slot], &seen.v[CENTRE]));
            let square = dot(&r, &r).max(F::splat(LEAST_SQUARE));
            let near = square.lt(cells.reach_squared(slot)) & self.live;
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
            damping.nu[slot] = nu.keep(speed.gt(pair * QUIET));
            damping.inverse[slot] = inverse;
            loads.pull(slot, &r, bond);
            if conducts {
                let difference = seen.theta[slot] - seen.theta[CENTRE];
                loads.conduct(slot, (pair * difference).keep(near) * conduct);
            }
        }
        damping.rates((seen, &()), self.light, cells)
    }

    /// Viscosity on what neighbouring jumps along the diagonal do not explain, and the heat flux in
    /// shocks (decision 0013). Returns the rates of damping.
    #[inline(always)]
    pub(super) fn limited<F: Lanes, const MAPPED: bool>(
        &mut self,
        (seen, mut skew): (&Seen<'_, F>, impl Skewed<F>),
        (cells, laws, read): (&Cells<'_, MAPPED>, &Laws, &Read<'_>),
        loads: &mut Loads<F>,
    ) -> Symmetric<F> {
        let (body, method) = (cells.body, &laws.method);
        let zero = F::zero();
        let half_area: F = cells.bond_area_as(0, |area| 0.5 * area);
        // The heat coefficient goes with the area, and so does the mass flux that it multiplies.
        let conduct: F = cells
            .bond_area_as(0, |area| method.heat_coeff * area * body.eos.c_v() * laws.dt / area);
        let conducts = method.heat_coeff * laws.dt > 0.0;
        let alternating = if conducts { seen.alternating() } else { zero };
        let most: F =
            cells.volume_as(|volume| LEVELLED * body.rho_0 * volume * body.eos.c_v() / 32.0);
        let rho: [F; 9] = self.gather(read.rho);
        let mut damping = Damping::none();
        for slot in 0..8 {
            let r = skew.bond(slot, seen.diagonal(slot));
            // The centroid of a dead element may lie on a corner.
            let inverse = F::splat(1.0) / dot(&r, &r).max(F::splat(LEAST_SQUARE));
            // Jumps times the separation: of the bond, of the one before and of the one beyond.
            let own = closing((&skew, slot), &r, &seen.v[slot], &seen.v[CENTRE]);
            let before = closing((&skew, slot), &r, &seen.v[CENTRE], &seen.v[7 - slot]);
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
            let beyond =
                closing((&skew, slot), &r, &next, &seen.v[slot]).keep(self.has_beyond[slot]);
            let (behind, ahead) = (before * own, beyond * own);
            let mean = before * beyond * method.limiter / ((before + beyond) * own);
            let explained = mean.min(F::splat(1.0)).keep(behind.gt(zero) & ahead.gt(zero));
            // What recedes is damped only as far as both neighbours close: it rings, and does not flow.
            let rings = (mean * -RINGING).min(F::splat(1.0)).keep(behind.lt(zero) & ahead.lt(zero));
            let part = F::select(own.gt(zero), F::splat(1.0) - explained, rings);
            let jump = (own * part).keep(self.live);
            let speed = jump * inverse.sqrt();
            let closes = speed.gt(zero);
            let sound = (seen.sound[slot] + seen.sound[CENTRE]) * 0.5;
            let mass = (rho[slot] + rho[CENTRE]) * half_area;
            let steep = speed * (method.visc_quad * body.slope);
            let linear = sound * method.visc_linear;
            let shock = steep + (steep * steep + linear * linear).sqrt();
            let nu = mass * F::select(closes, shock, sound * method.visc_expansion);
            let bond = nu * jump * inverse;
            self.bonds[slot] = bond.pack();
            damping.nu[slot] = nu.keep(speed.abs().gt(sound * QUIET));
            damping.inverse[slot] = inverse;
            loads.pull(slot, &r, bond);
            skew.pull(slot, &r, bond);
            if conducts {
                let difference = seen.theta[slot] - seen.theta[CENTRE];
                let levelling = (mass * sound * alternating * conduct).min(most).keep(self.live);
                let shock = mass * speed.max(zero) * conduct;
                loads.conduct(slot, (shock + levelling) * difference);
            }
        }
        if let Some(along) = skew.pulled() {
            loads.add(&spread(&along, cells));
        }
        damping.rates((seen, &skew), self.light, cells)
    }
}
