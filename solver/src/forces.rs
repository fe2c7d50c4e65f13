//! The one pair sweep: density rates, pressure, tension, viscosity and heat of every contact.
//!
//! Each contact is evaluated once. Its force goes to both particles with opposite signs, and its
//! power follows from the same numbers, so that momentum and energy balance pair by pair.

use std::ops::AddAssign;

use crate::chain::{Chain, Contact, Side};
use crate::columns::{Bins, Column, REACH, Rate};
use crate::density::{DensityScheme, Row};
use crate::elements::Solid;
use crate::eos::Eos;
use crate::heat::Heat;
use crate::method::Heating;
use crate::physics::Physics;
use crate::timestep::{Limiter, Vote};
use crate::viscosity::{Closing, ViscousLaw};

/// Pairs that are prepared together: enough to amortise the loops, few enough for the cache.
const BLOCK: usize = 32;

/// Particles behind a block that are prepared with it, for pairs beyond the nearest.
const AHEAD: usize = 8;

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
    /// Split of the viscous heat, Eq. (60).
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

/// Sums over the contacts of one particle.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tally<R> {
    /// Force `dp/dt`, Eq. (74).
    pub force: f64,
    /// Power `dU/dt`, Eq. (58).
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
        Self { pairs: 0, strain_power: 0.0, votes, overflow: None }
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

/// A particle as one end of pairs: everything that a pair asks of it, read once.
struct End<'a, E> {
    side: Side,
    eos: &'a E,
    sound: f64,
    x: f64,
    v: f64,
    drift: f64,
}

impl<E> Copy for End<'_, E> {}

impl<E> Clone for End<'_, E> {
    fn clone(&self) -> Self {
        *self
    }
}

/// A pair of nearest neighbours.
#[derive(Clone, Copy)]
struct Link {
    contact: Contact,
    /// Closing speed, zero where the two do not touch.
    jump: f64,
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
    /// Sweeps a chunk, block by block: particles are read once, then looked at pair by pair.
    pub fn chunk<K: Pass>(&self, bins: &mut Bins<'_, Tally<RateOf<P>>>) -> PairSums {
        let mut sums = PairSums::default();
        let far = self.laws.reach_far();
        let last = self.chain.len() - 1;
        let (start, end) = (bins.start(), bins.end().min(last));
        if start >= end {
            return sums;
        }
        let mut ends = [self.end(start); BLOCK + AHEAD];
        let mut links = [self.link(&ends[0], &self.end(start + 1)); BLOCK + 1];
        // Beyond an end the velocity goes on as it does before it.
        let mut before = if start > 0 { self.jump_at(start - 1) } else { links[0].jump };
        for first in (start..end).step_by(BLOCK) {
            let pairs = BLOCK.min(end - first);
            // One pair more, and a few particles, unless the chain ends here.
            let known = (pairs + 1).min(last - first);
            let read = if far { pairs + AHEAD - 1 } else { pairs + 1 }.min(last - first);
            for (k, slot) in ends[..=read].iter_mut().enumerate() {
                *slot = self.end(first + k);
            }
            for (link, pair) in links[..known].iter_mut().zip(ends.windows(2)) {
                *link = self.link(&pair[0], &pair[1]);
            }
            for k in 0..pairs {
                let (own, after) = (links[k].jump, links[(k + 1).min(known - 1)].jump);
                let seen = self.laws.viscosity.seen([before, own, after]);
                before = own;
                let (left, right) = (&ends[k], &ends[k + 1]);
                let (on_left, on_right) =
                    self.pair::<K>(&links[k].contact, seen, [left, right], &mut sums);
                bins.add(first + k, on_left);
                bins.add(first + k + 1, on_right);
                if far {
                    self.beyond::<K>(left, &ends[k + 1..=read], bins, &mut sums);
                }
            }
        }
        sums
    }

    /// Pairs of a particle with those beyond its right neighbour.
    ///
    /// `prepared`: the particles that follow it, as far as they are read already.
    fn beyond<K: Pass>(
        &self,
        left: &End<'_, P::Eos>,
        prepared: &[End<'_, P::Eos>],
        bins: &mut Bins<'_, Tally<RateOf<P>>>,
        sums: &mut PairSums,
    ) {
        let mut on_left = Tally::default();
        let i = left.side.index;
        let range = self.laws.support * self.chain.longest();
        let extent = self.laws.density.extent(i);
        for j in i + 2..self.chain.len() {
            let r = self.state.x[j] - left.x;
            if r >= range && j > extent {
                break;
            }
            if j - i >= REACH {
                sums.overflow.get_or_insert(i);
                break;
            }
            let right = prepared.get(j - i - 1).copied().unwrap_or_else(|| self.end(j));
            let contact = self.chain.contact(&left.side, &right.side, r);
            if contact.zeta < self.laws.support || j <= extent {
                let seen = left.v - right.v;
                let (on_i, on_j) = self.pair::<K>(&contact, seen, [left, &right], sums);
                on_left += on_i;
                bins.add(j, on_j);
            }
        }
        bins.add(i, on_left);
    }

    /// Velocity jump between particle `i` and the next.
    fn jump_at(&self, i: usize) -> f64 {
        self.link(&self.end(i), &self.end(i + 1)).jump
    }

    #[inline(always)]
    fn link(&self, left: &End<'_, P::Eos>, right: &End<'_, P::Eos>) -> Link {
        let contact = self.chain.contact(&left.side, &right.side, right.x - left.x);
        Link { contact, jump: if contact.nearest { left.v - right.v } else { 0.0 } }
    }

    #[inline(always)]
    fn end(&self, i: usize) -> End<'_, P::Eos> {
        let state = &self.state;
        let u = state.u[i];
        let side = self.chain.side(i, state.rho.get(i), u);
        let eos = &self.laws.eos[usize::from(side.material)];
        End { side, eos, sound: eos.sound_speed(u), x: state.x[i], v: state.v[i], drift: state.drift[i] }
    }

    /// All that two particles do to each other.
    #[inline(always)]
    fn pair<K: Pass>(
        &self,
        contact: &Contact,
        seen: f64,
        [i, j]: [&End<'_, P::Eos>; 2],
        sums: &mut PairSums,
    ) -> (Tally<RateOf<P>>, Tally<RateOf<P>>) {
        sums.pairs += 1;
        let (row_i, row_j) =
            (self.laws.density.row(&i.side, contact), self.laws.density.row(&j.side, contact));
        let push_i = row_i.lever * P::Solid::carried(i.eos.pressure(row_i.rho, i.side.u));
        let push_j = row_j.lever * P::Solid::carried(j.eos.pressure(row_j.rho, j.side.u));

        let sound = [i.sound, j.sound];
        let closing =
            Closing { jump: seen, rho: [&i.side, &j.side].map(|s| s.rho_0 / contact.zeta), sound };
        let sides = [(&i.side, i.eos), (&j.side, j.eos)];
        let viscous = seen * self.laws.viscosity.coefficient(contact, &closing, sides);
        let tension = if P::Solid::RESISTS && contact.bonded {
            P::Solid::tension(series(i.eos.bulk(), j.eos.bulk()), contact.zeta)
        } else {
            0.0
        };

        let (mut on_i, mut on_j) = (Tally::default(), Tally::default());
        if K::FORCE {
            let force = push_i + push_j + tension + viscous;
            on_i.force = -force;
            on_j.force = force;
        }
        if K::RATES {
            let approach = i.drift - j.drift;
            let (heat_i, heat_j) = match self.laws.heating {
                Heating::Pair => (0.5 * viscous * approach, 0.5 * viscous * approach),
                Heating::Printed => (viscous * i.drift, -viscous * j.drift),
            };
            on_i.power = push_i * approach + heat_i;
            on_j.power = push_j * approach + heat_j;
            if P::Heat::CONDUCTS {
                let transfer = self.laws.heat.transfer(contact, &closing, sides);
                let flow = transfer * (i.eos.temperature(i.side.u) - j.eos.temperature(j.side.u));
                on_i.power -= flow;
                on_j.power += flow;
            }
            on_i.rho_rate = Rate::of(row_i.slope * approach);
            on_j.rho_rate = Rate::of(row_j.slope * approach);
            sums.strain_power += tension * approach;
        }
        if K::VOTES {
            let speed = i.v - j.v;
            let free = Closing { jump: speed, ..closing };
            let viscous = self.laws.viscosity.bound(contact, &free, sides);
            let transfer = self.laws.heat.transfer(contact, &free, sides);
            on_i.damping = viscous + transfer / i.eos.c_v();
            on_j.damping = viscous + transfer / j.eos.c_v();
            // The stiffness of a contact, rho c^2 / r, on its lighter particle: c / r among equals.
            let stiff = |row: &Row, c: f64| row.rho * c * c;
            let stiffness = 0.5 * (stiff(&row_i, sound[0]) + stiff(&row_j, sound[1]));
            let inertia = contact.r * i.side.m.min(j.side.m);
            let [by_sound, by_closing] = &mut sums.votes;
            by_sound.consider(inertia / stiffness, i.side.index);
            by_closing.consider(contact.r / speed.abs(), i.side.index);
        }
        (on_i, on_j)
    }
}

/// Stiffness of two halves of a segment in series.
#[inline(always)]
fn series(a: f64, b: f64) -> f64 {
    2.0 * a * b / (a + b)
}
