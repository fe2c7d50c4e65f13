//! The sweep over the pairs: who meets whom, and what they do to each other.
//!
//! Each contact is evaluated once. Its force goes to both particles with opposite signs, and its
//! power follows from the same numbers, so that momentum and energy balance pair by pair.

use crate::chain::{Chain, Contact, Side};
use crate::columns::{Bins, Column, REACH};
use crate::density::DensityScheme;
use crate::elements::{Solid, series};
use crate::eos::Eos;
use crate::forces::{Heating, Laws, PairSums, Pass, Tally, View};
use crate::heat::Heat;
use crate::lanes::{AHEAD, BLOCK, Deal, Deals, End, Lanes, SPAN, Wish};
use crate::physics::Physics;
use crate::viscosity::{Closing, ViscousLaw};

/// One sweep over the pairs whose left particle is in a chunk.
pub struct Sweep<'a, P: Physics<1>> {
    /// The laws.
    pub laws: &'a Laws<P>,
    /// Topology.
    pub chain: &'a Chain,
    /// State.
    pub state: View<'a, <P::Density as DensityScheme<1>>::Column>,
}

type RateOf<P> = <<P as Physics<1>>::Density as DensityScheme<1>>::Rate;

impl<P: Physics<1>> Sweep<'_, P> {
    /// Sweeps a chunk, block by block: the nearest pairs of a block side by side, then, where there
    /// are any, those beyond.
    pub fn chunk<K: Pass>(&self, bins: &mut Bins<'_, Tally<RateOf<P>>>) -> PairSums {
        let mut sums = PairSums::default();
        let far = self.laws.reach_far();
        // A scheme that sums its densities has pairs of its own to look at, one by one.
        let support = if P::Density::SWEEPS > 1 { 0.0 } else { self.laws.support };
        let last = self.chain.len() - 1;
        let (start, end) = (bins.start(), bins.end().min(last));
        let mut lanes = Lanes::new();
        let mut deals = Deals::new();
        for first in (start..end).step_by(BLOCK) {
            let pairs = BLOCK.min(end - first);
            let behind = if far { AHEAD - 1 } else { 1 };
            let body = self.gather(first, (pairs + behind).min(last - first), &mut lanes);
            let law = self.laws.viscosity;
            let mut reached = 1;
            // One body has one material and no faces inside: its lanes differ in nothing but their
            // numbers. A block across faces looks everything up.
            match body {
                Some(side) => {
                    let eos = self.laws.eos[usize::from(side.material)];
                    let of = |k: usize| (Side { index: first + k, ..side }, eos);
                    // The form of the viscosity is named here, so that the compiler knows it and fills
                    // vector units.
                    match law.far() {
                        Some(law) => {
                            self.lanes::<K>((&lanes, 1, false), pairs, law, &mut deals, of);
                        }
                        None => {
                            self.lanes::<K>((&lanes, 1, false), pairs, law.near(), &mut deals, of);
                        }
                    }
                    deals.settle::<K, RateOf<P>>((first, 1), pairs, bins, &mut sums);
                    sums.strain_power += self.strain_power(&deals, first, pairs);
                    let in_range = |offset: usize| {
                        let pairs = pairs.min((last + 1 - first).saturating_sub(offset));
                        let near = |k: &usize| lanes.x[k + offset] - lanes.x[*k] < side.l * support;
                        (pairs, (0..pairs).filter(near).count() as u64)
                    };
                    while support > 0.0 && reached + 2 < AHEAD {
                        let (pairs, near) = in_range(reached + 1);
                        if near == 0 {
                            break;
                        }
                        reached += 1;
                        let far = (&lanes, reached, false);
                        self.lanes::<K>(far, pairs, law, &mut deals, of);
                        deals.settle::<K, RateOf<P>>((first, reached), pairs, bins, &mut sums);
                        sums.pairs += near;
                    }
                }
                None => {
                    self.lanes::<K>((&lanes, 1, true), pairs, law, &mut deals, |k| {
                        let side = self.chain.side(first + k, 0.0, 0.0);
                        (side, self.laws.eos[usize::from(side.material)])
                    });
                    deals.settle::<K, RateOf<P>>((first, 1), pairs, bins, &mut sums);
                    sums.strain_power += self.strain_power(&deals, first, pairs);
                }
            }
            sums.pairs += pairs as u64;
            if far {
                for i in first..first + pairs {
                    self.beyond::<K>(i, reached, bins, &mut sums);
                }
            }
        }
        sums
    }

    /// Reads the particles from `first` to `known` behind it, and the jumps around them. Returns
    /// what they share if they are all of one body.
    #[inline(always)]
    fn gather(&self, first: usize, known: usize, lanes: &mut Lanes) -> Option<Side> {
        let state = &self.state;
        let range = first..first + known + 1;
        lanes.x[..=known].copy_from_slice(&state.x[range.clone()]);
        lanes.v[..=known].copy_from_slice(&state.v[range.clone()]);
        lanes.drift[..=known].copy_from_slice(&state.drift[range.clone()]);
        lanes.u[..=known].copy_from_slice(&state.u[range.clone()]);
        lanes.m[..=known].copy_from_slice(&self.chain.masses()[range.clone()]);
        for (k, rho) in lanes.rho[..=known].iter_mut().enumerate() {
            *rho = state.rho.get(first + k);
        }
        let body = self.chain.one_body(range).then(|| self.chain.side(first, 0.0, 0.0));
        match &body {
            Some(side) => {
                let eos = self.laws.eos[usize::from(side.material)];
                for (sound, &u) in lanes.sound.iter_mut().zip(&lanes.u) {
                    *sound = eos.sound_speed(u);
                }
                for k in 0..known {
                    lanes.jump[k + 1] = lanes.v[k] - lanes.v[k + 1];
                }
            }
            None => {
                for k in 0..=known {
                    let eos = &self.laws.eos[self.chain.material(first + k)];
                    lanes.sound[k] = eos.sound_speed(lanes.u[k]);
                }
                for k in 0..known {
                    lanes.jump[k + 1] = self.jump(first + k);
                }
            }
        }
        // Beyond a gap or an end the velocity goes on as it does before it: what is out of reach has
        // no say.
        let before = if first > 0 { self.jump(first - 1) } else { f64::NAN };
        let own = body.is_some() && before.is_nan();
        lanes.jump[0] = if own { lanes.jump[1] } else { before };
        if known + 1 < SPAN {
            lanes.jump[known + 1] = if body.is_some() { lanes.jump[known] } else { f64::NAN };
        }
        body
    }

    /// Closing speed of particle `i` and the next, NaN where they do not touch.
    fn jump(&self, i: usize) -> f64 {
        let contact = self.chain.contact_at(self.state.x, i, i + 1);
        if contact.nearest { self.state.v[i] - self.state.v[i + 1] } else { f64::NAN }
    }

    /// All pairs of a block with the particle `offset` behind, with the sides and equations of state
    /// that `of` gives. Pairs out of range come out as nothing. `faces`: whether there may be gaps.
    #[inline(always)]
    fn lanes<K: Pass>(
        &self,
        (lanes, offset, faces): (&Lanes, usize, bool),
        pairs: usize,
        law: ViscousLaw,
        deals: &mut Deals,
        of: impl Fn(usize) -> (Side, P::Eos),
    ) {
        let end = |k: usize| {
            let (side, eos) = of(k);
            let side = Side { m: lanes.m[k], rho: lanes.rho[k], u: lanes.u[k], ..side };
            End { side, eos, sound: lanes.sound[k], v: lanes.v[k], drift: lanes.drift[k] }
        };
        let offset = offset.min(AHEAD - 1);
        for k in 0..pairs.min(BLOCK) {
            let ends = [end(k), end(k + offset)];
            let r = lanes.x[k + offset] - lanes.x[k];
            let contact = self.chain.contact(&ends[0].side, &ends[1].side, r);
            let own = ends[0].v - ends[1].v;
            let jumps = [lanes.jump[k], own, lanes.jump[k + 2]];
            let seen = match offset {
                1 if faces => law.seen(jumps.map(|jump| if jump.is_nan() { own } else { jump })),
                1 => law.seen(jumps),
                _ => own,
            };
            deals.enter::<K>(k, self.deal::<K>(&contact, (law, seen), &ends));
            if K::VOTES {
                deals.wish(k, self.wish(&contact, law, &ends));
            }
        }
    }

    /// Power into the strain of the segments of a block. Half of a segment belongs to either particle;
    /// what belongs to an image is not of this world.
    fn strain_power(&self, deals: &Deals, first: usize, pairs: usize) -> f64 {
        if !P::Solid::RESISTS {
            return 0.0;
        }
        let real = self.chain.real();
        let share = |i: usize| if real.contains(&i) { 0.5 } else { 0.0 };
        let of = |k: usize| (share(first + k) + share(first + k + 1)) * deals.strain_power[k];
        (0..pairs).map(of).sum()
    }

    /// Pairs of particle `i` with those more than `reached` behind it.
    fn beyond<K: Pass>(
        &self,
        i: usize,
        reached: usize,
        bins: &mut Bins<'_, Tally<RateOf<P>>>,
        sums: &mut PairSums,
    ) {
        let range = self.laws.support * self.chain.longest();
        let extent = self.laws.density.extent(i);
        let (real, unending) = (self.chain.real(), self.chain.unending());
        let mut left = None;
        for j in i + reached + 1..self.chain.len() {
            let r = self.state.x[j] - self.state.x[i];
            if r >= range && j > extent {
                break;
            }
            // Beyond the last image the wall would be forgotten.
            let forgotten = (i == 0 && unending[0] && j >= real.start)
                || (j + 1 == self.chain.len() && unending[1] && i < real.end);
            if j - i >= REACH || forgotten {
                sums.overflow.get_or_insert(i);
                break;
            }
            let ends = [*left.get_or_insert_with(|| self.end(i)), self.end(j)];
            let contact = self.chain.contact(&ends[0].side, &ends[1].side, r);
            if contact.zeta < self.laws.support || j <= extent {
                let law = self.laws.viscosity;
                let deal = self.deal::<K>(&contact, (law, ends[0].v - ends[1].v), &ends);
                let (mut on_i, mut on_j) = deal.tallies::<K, RateOf<P>>();
                if K::VOTES {
                    // The nearest pairs have the shorter times; only the damping adds up.
                    let wish = self.wish(&contact, law, &ends);
                    [on_i.damping, on_j.damping] = wish.damping;
                }
                bins.add(i, on_i);
                bins.add(j, on_j);
                sums.pairs += 1;
            }
        }
    }

    #[inline(always)]
    fn end(&self, i: usize) -> End<P::Eos> {
        let state = &self.state;
        let u = state.u[i];
        let side = self.chain.side(i, state.rho.get(i), u);
        let eos = self.laws.eos[usize::from(side.material)];
        End { side, eos, sound: eos.sound_speed(u), v: state.v[i], drift: state.drift[i] }
    }

    /// All that two particles do to each other, with the jump `seen` by the viscosity.
    #[inline(always)]
    fn deal<K: Pass>(
        &self,
        contact: &Contact,
        (law, seen): (ViscousLaw, f64),
        ends: &[End<P::Eos>; 2],
    ) -> Deal {
        let [i, j] = ends;
        let rows = [i, j].map(|e| self.laws.density.row(&e.side, contact));
        let push = [0, 1].map(|k| {
            let End { side, eos, .. } = &ends[k];
            rows[k].lever * P::Solid::carried(eos.pressure(rows[k].rho, side.u))
        });
        let closing = closing(contact, seen, ends);
        let sides = [(&i.side, &i.eos), (&j.side, &j.eos)];
        let viscous = seen * law.coefficient(contact, &closing, sides);
        let tension = if P::Solid::RESISTS && contact.bonded {
            P::Solid::tension(series(i.eos.bulk(), j.eos.bulk()), contact.zeta)
        } else {
            0.0
        };
        let force = push[0] + push[1] + tension + viscous;
        if !K::RATES {
            return Deal { force, power: [0.0; 2], rho_rate: [0.0; 2], strain_power: 0.0 };
        }

        let approach = i.drift - j.drift;
        let Heating { common, own } = self.laws.heating;
        let mut power = [
            push[0] * approach + viscous * (common * approach + own * i.drift),
            push[1] * approach + viscous * (common * approach - own * j.drift),
        ];
        if P::Heat::CONDUCTS {
            let transfer = self.laws.heat.transfer(contact, &closing, sides);
            let flow = transfer * (i.eos.temperature(i.side.u) - j.eos.temperature(j.side.u));
            power[0] -= flow;
            power[1] += flow;
        }
        let rho_rate = rows.map(|row| row.slope * approach);
        Deal { force, power, rho_rate, strain_power: tension * approach }
    }

    /// What a pair wants of the time step. The limiter of the viscosity has no say: round-off in it
    /// would reach the time step.
    #[inline(always)]
    fn wish(&self, contact: &Contact, law: ViscousLaw, ends: &[End<P::Eos>; 2]) -> Wish {
        let [i, j] = ends;
        let speed = i.v - j.v;
        let closing = closing(contact, speed, ends);
        let sides = [(&i.side, &i.eos), (&j.side, &j.eos)];
        let viscous = law.bound(contact, &closing, sides);
        let transfer = self.laws.heat.transfer(contact, &closing, sides);
        // The stiffness of a contact, rho c^2 / r, on its lighter particle: c / r among equals.
        let stiff =
            |e: &End<P::Eos>| self.laws.density.row(&e.side, contact).rho * e.sound * e.sound;
        let inertia = contact.r * i.side.m.min(j.side.m);
        Wish {
            damping: [i, j].map(|e| viscous + transfer / e.eos.c_v()),
            sound_squared: inertia / (0.5 * (stiff(i) + stiff(j))),
            closing: contact.r / speed.abs(),
        }
    }
}

/// What viscosity and conduction see of a pair.
#[inline(always)]
fn closing<E>(contact: &Contact, jump: f64, [i, j]: &[End<E>; 2]) -> Closing {
    let rho = [i.side.rho_0 / contact.zeta, j.side.rho_0 / contact.zeta];
    Closing { jump, rho, sound: [i.sound, j.sound] }
}
