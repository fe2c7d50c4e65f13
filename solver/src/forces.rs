//! The one pair sweep: density rates, pressure, tension, viscosity and heat of every contact.
//!
//! Each contact is evaluated once. Its force goes to both particles with opposite signs, and its
//! power follows from the same numbers, so that momentum and energy balance pair by pair.

use std::ops::AddAssign;

use crate::chain::{Chain, Contact, Side};
use crate::columns::{Bins, Column, REACH, Rate};
use crate::density::DensityScheme;
use crate::elements::{Solid, series};
use crate::eos::Eos;
use crate::heat::Heat;
use crate::method;
use crate::physics::Physics;
use crate::timestep::{Limiter, Vote};
use crate::viscosity::{Closing, ViscousLaw};

/// The laws of a scene: constant during a run.
pub struct Laws<P: Physics<1>> {
    /// Density scheme.
    pub density: P::Density,
    /// Equations of state, one a material.
    pub eos: Vec<P::Eos>,
    /// Viscosity.
    pub viscosity: ViscousLaw,
    /// Conduction.
    pub heat: P::Heat,
    /// Split of the viscous heat.
    pub heating: Heating,
    /// Largest zeta at which viscosity and conduction act beyond the nearest; zero when they do not.
    pub support: f64,
}

impl<P: Physics<1>> Laws<P> {
    /// Whether pairs beyond the nearest act at all.
    pub fn reach_far(&self) -> bool {
        self.support > 0.0 || P::Density::SWEEPS > 1
    }
}

/// Shares of a particle in the heat of its viscous forces: with the closing speed `a` of the pair
/// and its own velocity `v`, it is heated by `q (common a + own v)`.
#[derive(Debug, Clone, Copy)]
pub struct Heating {
    /// Share in the dissipation of the pair.
    pub common: f64,
    /// Share in the power of the force on itself, Eq. (60) as printed.
    pub own: f64,
}

impl Heating {
    pub(crate) fn new(method: method::Heating) -> Self {
        match method {
            method::Heating::Pair => Self {
                common: 0.5,
                own: 0.0,
            },
            method::Heating::Printed => Self {
                common: 0.0,
                own: 1.0,
            },
        }
    }
}

/// Sums over the contacts of one particle.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tally<R> {
    /// Force `dp/dt`, Eq. (74).
    pub force: f64,
    /// Power `dU/dt`, Eq. (58): work (59), viscous heat (60) and conduction (62). Its multiplier in
    /// the Lagrange equations is 1, Eq. (70), so that all of it comes out of the motion.
    pub power: f64,
    /// Coefficients of viscosity and conduction, for the time step.
    pub damping: f64,
    /// Density rate, Eq. (36), where the scheme integrates one.
    pub rho_rate: R,
}

impl<R: AddAssign> AddAssign for Tally<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.force += other.force;
        self.power += other.power;
        self.damping += other.damping;
        self.rho_rate += other.rho_rate;
    }
}

/// What a chunk of pairs adds up to beside the particles.
#[derive(Debug, Clone, Copy)]
pub struct PairSums {
    /// Pairs visited.
    pub pairs: u64,
    /// Power that goes into the strain energy of the segments.
    pub strain_power: f64,
    /// Votes of the pairs on the time step.
    pub votes: [Vote; 2],
    /// A particle with neighbours beyond [`REACH`] in range.
    pub overflow: Option<usize>,
}

impl Default for PairSums {
    fn default() -> Self {
        let votes = [Vote::none(Limiter::Sound), Vote::none(Limiter::Closing)];
        Self {
            pairs: 0,
            strain_power: 0.0,
            votes,
            overflow: None,
        }
    }
}

/// What one sweep is for. What it is not for, it does not compute.
pub trait Pass: Send + Sync {
    /// Whether forces are wanted.
    const FORCE: bool;
    /// Whether powers and density rates are wanted.
    const RATES: bool;
    /// Whether the pairs vote on the time step.
    const VOTES: bool;
}

/// The sweep at the start of a step.
pub struct Opening;
/// The sweep at its middle, where the rates use the velocities there.
pub struct Middle;
/// The sweep at its middle for the forces alone.
pub struct Forces;
/// The sweep that turns the forces at the middle into work, with the mean velocities of the step.
pub struct Work;

impl Pass for Opening {
    const FORCE: bool = true;
    const RATES: bool = true;
    const VOTES: bool = true;
}
impl Pass for Middle {
    const FORCE: bool = true;
    const RATES: bool = true;
    const VOTES: bool = false;
}
impl Pass for Forces {
    const FORCE: bool = true;
    const RATES: bool = false;
    const VOTES: bool = false;
}
impl Pass for Work {
    const FORCE: bool = false;
    const RATES: bool = true;
    const VOTES: bool = false;
}

/// The state that a sweep sees.
pub struct View<'a, C> {
    /// Positions.
    pub x: &'a [f64],
    /// Velocities that the viscosity sees.
    pub v: &'a [f64],
    /// Velocities over which the forces do work.
    pub drift: &'a [f64],
    /// Internal energies per mass.
    pub u: &'a [f64],
    /// Densities, where stored.
    pub rho: &'a C,
}

/// Pairs of nearest neighbours that are looked at together: enough to fill vector units, few enough
/// for the first-level cache.
const BLOCK: usize = 32;

/// Particles of a block: one more than pairs, and one more for the jump behind the last pair.
const SPAN: usize = BLOCK + 2;

/// A particle as one end of a pair: everything that a pair asks of it.
#[derive(Clone, Copy)]
struct End<E> {
    side: Side,
    eos: E,
    sound: f64,
    v: f64,
    drift: f64,
}

/// What two particles do to each other.
#[derive(Clone, Copy)]
struct Deal {
    /// Force between them, repulsive.
    force: f64,
    /// Power into each.
    power: [f64; 2],
    /// Density rate of each.
    rho_rate: [f64; 2],
    /// Power into the strain energy of the segment.
    strain_power: f64,
}

/// What a pair wants of the time step.
#[derive(Clone, Copy)]
struct Wish {
    /// Coefficients of viscosity and conduction, for each particle.
    damping: [f64; 2],
    /// Square of the time that sound takes.
    sound_squared: f64,
    /// Time until they meet.
    closing: f64,
}

/// The particles of a block, column by column.
struct Lanes {
    x: [f64; SPAN],
    v: [f64; SPAN],
    drift: [f64; SPAN],
    u: [f64; SPAN],
    rho: [f64; SPAN],
    m: [f64; SPAN],
    sound: [f64; SPAN],
    /// Jumps of the velocity: before the block, of its pairs, and behind it.
    jump: [f64; SPAN],
}

/// Results of the pairs of a block, column by column.
struct Deals {
    force: [f64; BLOCK],
    power: [[f64; BLOCK]; 2],
    rho_rate: [[f64; BLOCK]; 2],
    strain_power: [f64; BLOCK],
    damping: [[f64; BLOCK]; 2],
    sound_squared: [f64; BLOCK],
    closing: [f64; BLOCK],
}

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
        let last = self.chain.len() - 1;
        let (start, end) = (bins.start(), bins.end().min(last));
        let mut lanes = Lanes::new();
        let mut deals = Deals::new();
        for first in (start..end).step_by(BLOCK) {
            let pairs = BLOCK.min(end - first);
            let body = self.gather(first, (pairs + 1).min(last - first), &mut lanes);
            let law = self.laws.viscosity;
            // One body has one material and no faces inside: its lanes differ in nothing but their
            // numbers. A block across faces looks everything up.
            match body {
                Some(side) => {
                    let eos = self.laws.eos[usize::from(side.material)];
                    let of = |k: usize| {
                        (
                            Side {
                                index: first + k,
                                ..side
                            },
                            eos,
                        )
                    };
                    if far {
                        self.lanes::<K>(&lanes, pairs, law, &mut deals, of);
                    } else {
                        // Known to the compiler, so that it fills vector units.
                        self.lanes::<K>(&lanes, pairs, law.near(), &mut deals, of);
                    }
                }
                None => self.lanes::<K>(&lanes, pairs, law, &mut deals, |k| {
                    let side = self.chain.side(first + k, 0.0, 0.0);
                    (side, self.laws.eos[usize::from(side.material)])
                }),
            }
            deals.settle::<K, RateOf<P>>(first, pairs, bins, &mut sums);
            if far {
                for i in first..first + pairs {
                    self.beyond::<K>(i, bins, &mut sums);
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
        let body = self
            .chain
            .one_body(range)
            .then(|| self.chain.side(first, 0.0, 0.0));
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
        // Beyond an end the velocity goes on as it does before it.
        lanes.jump[0] = if first > 0 {
            self.jump(first - 1)
        } else {
            lanes.jump[1]
        };
        if known < BLOCK + 1 {
            lanes.jump[known + 1] = lanes.jump[known];
        }
        body
    }

    /// Closing speed of particle `i` and the next, zero where they do not touch.
    fn jump(&self, i: usize) -> f64 {
        let contact = self.chain.contact_at(self.state.x, i, i + 1);
        if contact.nearest {
            self.state.v[i] - self.state.v[i + 1]
        } else {
            0.0
        }
    }

    /// All nearest pairs of a block, with the sides and equations of state that `of` gives.
    #[inline(always)]
    fn lanes<K: Pass>(
        &self,
        lanes: &Lanes,
        pairs: usize,
        law: ViscousLaw,
        deals: &mut Deals,
        of: impl Fn(usize) -> (Side, P::Eos),
    ) {
        let end = |k: usize| {
            let (side, eos) = of(k);
            let side = Side {
                m: lanes.m[k],
                rho: lanes.rho[k],
                u: lanes.u[k],
                ..side
            };
            End {
                side,
                eos,
                sound: lanes.sound[k],
                v: lanes.v[k],
                drift: lanes.drift[k],
            }
        };
        for k in 0..pairs.min(BLOCK) {
            let ends = [end(k), end(k + 1)];
            let r = lanes.x[k + 1] - lanes.x[k];
            let contact = self.chain.contact(&ends[0].side, &ends[1].side, r);
            let jumps = [lanes.jump[k], lanes.jump[k + 1], lanes.jump[k + 2]];
            deals.enter::<K>(k, self.deal::<K>(&contact, (law, law.seen(jumps)), &ends));
            if K::VOTES {
                deals.wish(k, self.wish(&contact, law, &ends));
            }
        }
    }

    /// Pairs of particle `i` with those beyond its right neighbour.
    fn beyond<K: Pass>(
        &self,
        i: usize,
        bins: &mut Bins<'_, Tally<RateOf<P>>>,
        sums: &mut PairSums,
    ) {
        let range = self.laws.support * self.chain.longest();
        let extent = self.laws.density.extent(i);
        let (real, walled) = (self.chain.real(), self.chain.walled());
        let mut left = None;
        for j in i + 2..self.chain.len() {
            let r = self.state.x[j] - self.state.x[i];
            if r >= range && j > extent {
                break;
            }
            // Beyond the last image the wall would be forgotten.
            let forgotten = (i == 0 && walled[0] && j >= real.start)
                || (j + 1 == self.chain.len() && walled[1] && i < real.end);
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
                sums.strain_power += deal.strain_power;
            }
        }
    }

    #[inline(always)]
    fn end(&self, i: usize) -> End<P::Eos> {
        let state = &self.state;
        let u = state.u[i];
        let side = self.chain.side(i, state.rho.get(i), u);
        let eos = self.laws.eos[usize::from(side.material)];
        End {
            side,
            eos,
            sound: eos.sound_speed(u),
            v: state.v[i],
            drift: state.drift[i],
        }
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
            return Deal {
                force,
                power: [0.0; 2],
                rho_rate: [0.0; 2],
                strain_power: 0.0,
            };
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
        Deal {
            force,
            power,
            rho_rate,
            strain_power: tension * approach,
        }
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
    Closing {
        jump,
        rho,
        sound: [i.sound, j.sound],
    }
}

impl Deal {
    /// The shares of both particles.
    #[inline(always)]
    fn tallies<K: Pass, R: Rate>(&self) -> (Tally<R>, Tally<R>) {
        let share = |sign: f64, k: usize| Tally {
            force: if K::FORCE { sign * self.force } else { 0.0 },
            power: self.power[k],
            damping: 0.0,
            rho_rate: R::of(self.rho_rate[k]),
        };
        (share(-1.0, 0), share(1.0, 1))
    }
}

impl Lanes {
    fn new() -> Self {
        let zero = [0.0; SPAN];
        Self {
            x: zero,
            v: zero,
            drift: zero,
            u: zero,
            rho: zero,
            m: zero,
            sound: zero,
            jump: zero,
        }
    }
}

impl Deals {
    fn new() -> Self {
        let zero = [0.0; BLOCK];
        Self {
            force: zero,
            power: [zero; 2],
            rho_rate: [zero; 2],
            strain_power: zero,
            damping: [zero; 2],
            sound_squared: zero,
            closing: zero,
        }
    }

    #[inline(always)]
    fn enter<K: Pass>(&mut self, k: usize, deal: Deal) {
        self.force[k] = if K::FORCE { deal.force } else { 0.0 };
        if K::RATES {
            for side in [0, 1] {
                self.power[side][k] = deal.power[side];
                self.rho_rate[side][k] = deal.rho_rate[side];
            }
            self.strain_power[k] = deal.strain_power;
        }
    }

    #[inline(always)]
    fn wish(&mut self, k: usize, wish: Wish) {
        for side in [0, 1] {
            self.damping[side][k] = wish.damping[side];
        }
        self.sound_squared[k] = wish.sound_squared;
        self.closing[k] = wish.closing;
    }

    /// Adds the pairs up: each particle has what its left pair gives it and what its right one does.
    #[inline(always)]
    fn settle<K: Pass, R: Rate>(
        &self,
        first: usize,
        pairs: usize,
        bins: &mut Bins<'_, Tally<R>>,
        sums: &mut PairSums,
    ) {
        let mut from_left = Tally::default();
        for k in 0..pairs.min(BLOCK) {
            let share = |side: usize, sign: f64| Tally {
                force: sign * self.force[k],
                power: self.power[side][k],
                damping: self.damping[side][k],
                rho_rate: R::of(self.rho_rate[side][k]),
            };
            from_left += share(0, -1.0);
            bins.add(first + k, from_left);
            from_left = share(1, 1.0);
            sums.strain_power += self.strain_power[k];
            if K::VOTES {
                let [by_sound, by_closing] = &mut sums.votes;
                by_sound.consider(self.sound_squared[k], first + k);
                by_closing.consider(self.closing[k], first + k);
            }
        }
        bins.add(first + pairs, from_left);
        sums.pairs += pairs as u64;
    }
}
