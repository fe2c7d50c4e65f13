//! What a cell resists with, and how it fails: plastic flow, damage (47), energy of shear (24).

use super::kinematics::Kinematics;
use super::pyramid::{Extent, tension_energy};
use crate::space::cells::Cells;
use crate::space::lanes::{Lanes, each};
use crate::space::mesh::Group;
use crate::space::strength::{Flowing, Load, Sym, contract};

/// Expansion at which a failed element ceases to count as a volume.
const OPEN: f64 = 1.2;

impl Group {
    /// Marks lanes that fail, and those that cease to be volumes after this step.
    #[inline(always)]
    pub(super) fn fail<F: Lanes, const MAPPED: bool>(
        &mut self,
        cells: &Cells<'_, MAPPED>,
        motion: &Kinematics<F>,
        (opening, extent): (&[F; 6], &Extent<F>),
        theta: F,
    ) {
        let solid = &cells.body.solid;
        let mut smallest = opening[0];
        let mut widest = opening[0];
        for o in &opening[1..] {
            smallest = smallest.min(*o);
            widest = widest.max(*o);
        }
        let crushed = smallest.lt(F::splat(solid.crushed - 1.0))
            | extent.volume.lt(cells.volume_as(|volume| solid.least * volume))
            | motion.jacobian.lt(F::splat(solid.compression));
        let cold = (F::splat(1.0) - F::of(self.damage)) * solid.bulk * widest;
        let pulled = (cold - solid.thermal(theta)).gt(F::splat(solid.spall));
        let failing = solid.spent(F::of(self.strain), theta) | crushed | pulled;
        self.failed |= failing & self.live;
        let stretched = motion.stretch_squared().gt(F::splat(solid.torn * solid.torn));
        let open = motion.jacobian.gt(F::splat(OPEN)) & self.failed;
        // Faces come doubled.
        let [sound, failed] = solid.flat;
        let sound: F = cells.edge_as(|edge| (0.5 * sound * edge).powi(2));
        let failed: F = cells.edge_as(|edge| (0.5 * failed * edge).powi(2));
        let least = F::select(self.failed, failed, sound);
        let flat = (extent.volume * extent.volume).lt(extent.largest * least);
        self.dying = (crushed | stretched | open | flat) & self.live;
        self.failed |= self.dying;
    }

    /// Damage of failed lanes, Eqs. (47), (49)-(50), and the energy that it sets free, (31) times the step
    /// of the damage. A dying element loses all of its strength at once, so that no stored energy is left
    /// in it.
    #[inline(always)]
    pub(super) fn damage<F: Lanes, const MAPPED: bool>(
        &mut self,
        cells: &Cells<'_, MAPPED>,
        (opening, held): (&[F; 6], F),
        dt: f64,
    ) -> F {
        if self.failed & self.live == 0 {
            return F::zero();
        }
        let one = F::splat(1.0);
        let before = F::of(self.damage);
        let step = F::select(self.dying, one, F::splat(cells.body.solid.damage_step(dt)));
        let after = F::select(self.failed & self.live, (before + step).min(one), before);
        let stored = self.shear_energy::<F, MAPPED>(cells) + tension_energy(cells, opening) + held;
        let released = stored * (after - before);
        self.tearing |= after.gt(before);
        let left = (one - after) / (one - before).max(F::splat(1e-300));
        for stress in &mut self.stress {
            *stress = (F::of(*stress) * left).pack();
        }
        self.damage = after.pack();
        released
    }

    /// Shear energy per damage, `Gamma^d` of Eq. (31), from the stress of the last step.
    #[inline(always)]
    pub(super) fn shear_energy<F: Lanes, const MAPPED: bool>(
        &self,
        cells: &Cells<'_, MAPPED>,
    ) -> F {
        let intact = F::splat(1.0) - F::of(self.damage);
        let stiffness = intact * intact * (4.0 * cells.body.solid.mu);
        let some = stiffness.gt(F::zero());
        let stress: Sym<F> = each!(k in 6 => F::of(self.stress[k]));
        let energy = contract(&stress, &stress) / F::select(some, stiffness, F::splat(1.0));
        (energy * cells.volume::<F>()).keep(some)
    }

    /// Shear stress (30) and plastic flow (48); the heat of the flow, the last term of Eq. (61), by the mean
    /// stress of the step.
    #[inline(always)]
    pub(super) fn shear<F: Lanes, const MAPPED: bool>(
        &mut self,
        cells: &Cells<'_, MAPPED>,
        motion: &Kinematics<F>,
        (theta, intact, dt): (F, F, f64),
    ) -> F {
        let total = motion.shear_strain();
        let before: Sym<F> = each!(k in 6 => F::of(self.plastic[k]));
        let old: Sym<F> = each!(k in 6 => F::of(self.stress[k]));
        let mut plastic = before;
        let solid = &cells.body.solid;
        let modulus = intact * (2.0 * solid.mu);
        let load = Load { modulus, intact, theta, live: self.live, dt };
        let mut own =
            Flowing { strain: &mut self.strain, flow: &mut self.flow, rate: &mut self.rate };
        let stress = solid.flow(&total, &mut plastic, &mut own, &load);
        let step: Sym<F> = each!(k in 6 => plastic[k] - before[k]);
        let mut flowed = 0;
        for k in 0..6 {
            self.stress[k] = stress[k].pack();
            flowed |= step[k].lt(F::zero()) | step[k].gt(F::zero());
        }
        // Most elements do not flow, and what does not change need not be written.
        if flowed == 0 {
            return F::zero();
        }
        for (own, plastic) in self.plastic.iter_mut().zip(plastic) {
            *own = plastic.pack();
        }
        let mean: Sym<F> = each!(k in 6 => (stress[k] + old[k]) * 0.5);
        contract(&mean, &step) * cells.volume::<F>()
    }
}
