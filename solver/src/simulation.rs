//! A scene in motion: the state, and the step that advances it.

use rayon::prelude::*;

use crate::audit::{Ledger, Totals};
use crate::boundary::Ends;
use crate::chain::Chain;
use crate::columns::{CHUNK, Column, Rate, Scratch};
use crate::counters::Counters;
use crate::density::DensityScheme;
use crate::elements::Solid;
use crate::elements::series;
use crate::eos::Eos;
use crate::error::{SceneError, StepError};
use crate::forces::{Forces, Heating, Laws, Middle, Opening, PairSums, Pass, Tally, View, Work};
use crate::heat::Heat;
use crate::method::Integrator;
use crate::physics::Physics;
use crate::scene::Scene;
use crate::sweep::Sweep;
use crate::timestep::{Decided, Limiter, SMALLEST_STEP, Vote};
use crate::viscosity::ViscousLaw;

/// Share of the mean specific energy by which round-off may push cold material below its floor.
const COLD: f64 = 1e-9;

type ColumnOf<P> = <<P as Physics<1>>::Density as DensityScheme<1>>::Column;
type RateOf<P> = <<P as Physics<1>>::Density as DensityScheme<1>>::Rate;

/// Positions, velocities, energies and densities at one time, images included.
#[derive(Debug, Clone)]
struct State<C> {
    x: Vec<f64>,
    v: Vec<f64>,
    u: Vec<f64>,
    rho: C,
}

/// A simulation of a one-dimensional scene.
pub struct Simulation<P: Physics<1>> {
    laws: Laws<P>,
    chain: Chain,
    ends: Ends,
    integrator: Integrator,
    cfl: f64,
    smallest_step: f64,

    time: f64,
    state: State<ColumnOf<P>>,
    /// The state at the middle of a step; at its end, the next state before it is accepted.
    middle: State<ColumnOf<P>>,
    /// Mean velocity of a step.
    mean: Vec<f64>,
    tally: Vec<Tally<RateOf<P>>>,
    scratch: Scratch<Tally<RateOf<P>>, PairSums>,
    totals: Vec<ChunkTotals>,

    ledger: Ledger,
    counters: Counters,
    decided: Decided,
    vote: Vote,
}

/// Which state and velocities a sweep uses.
#[derive(Clone, Copy)]
enum At {
    Start,
    Middle,
    MiddleOverMean,
}

#[derive(Debug, Clone, Copy, Default)]
struct ChunkTotals {
    totals: Totals,
    /// Whether all its particles passed the checks.
    sound: bool,
}

impl<P: Physics<1>> Simulation<P> {
    /// Freezes a scene into a simulation at t = 0.
    ///
    /// # Errors
    /// What [`Scene::validate`] finds.
    pub fn new(scene: &Scene, density: P::Density) -> Result<Self, SceneError> {
        scene.validate()?;
        let method = &scene.method;
        let heat = P::Heat::new(method);
        let viscosity = ViscousLaw::new(method);
        let conducting = if P::Heat::CONDUCTS { heat.support() } else { 0.0 };
        let support = viscosity.support().max(conducting);
        let eos = |m: &crate::scene::Material| {
            P::Eos::new(m.density, &m.eos, method.sound_speed).ok_or_else(|| {
                let wanted = "all materials of a scene need the same form of equation of state";
                SceneError::new("materials", &m.name, wanted)
            })
        };
        let eos = scene.materials.iter().map(eos).collect::<Result<Vec<_>, _>>()?;
        let heating = Heating::new(method.heating);
        let mut laws: Laws<P> = Laws { density, eos, viscosity, heat, heating, support };
        let (chain, x) = Chain::new(scene, laws.reach_far());
        let n = chain.len();

        let mut state = State { v: vec![0.0; n], u: vec![0.0; n], rho: ColumnOf::<P>::zeros(n), x };
        for i in chain.real() {
            let body = &scene.bodies[chain.body(i)];
            state.v[i] = body.velocity.at(state.x[i], (body.from, body.to));
            state.u[i] = body.energy.at(state.x[i], (body.from, body.to));
        }
        for i in Ends::new(scene.boundaries).held(&chain) {
            state.v[i] = 0.0;
        }
        reflect(&chain, &mut state);
        laws.density.start(&chain, &state.x, &mut state.rho);

        let mut simulation = Self {
            laws,
            ends: Ends::new(scene.boundaries),
            integrator: method.integrator,
            cfl: method.cfl,
            smallest_step: SMALLEST_STEP * scene.stop_time,
            time: 0.0,
            middle: state.clone(),
            state,
            mean: vec![0.0; n],
            tally: vec![Tally::default(); n],
            scratch: Scratch::new(n),
            totals: vec![ChunkTotals::default(); n.div_ceil(CHUNK)],
            ledger: Ledger::default(),
            counters: Counters::default(),
            decided: Decided::default(),
            vote: Vote::none(Limiter::Landing),
            chain,
        };
        let initial = simulation.audit();
        simulation.ledger = Ledger::new(initial);
        Ok(simulation)
    }

    /// Takes one step, at most to the time `until`: densities (36), momenta (63), (74), positions
    /// (76) with the velocities (37), and energies (58). At that time or later there is no step.
    ///
    /// # Errors
    /// The first numerical failure. The state is then the one before the step.
    pub fn step(&mut self, until: f64) -> Result<(), StepError> {
        if until <= self.time {
            return Ok(());
        }
        let opening = self.sweep::<Opening>(At::Start)?;
        self.ends.load(&self.chain, &mut self.tally);
        let dt = self.elect(&opening.votes, until)?;
        self.predict(0.5 * dt);

        let (end_force, flow) = match self.integrator {
            Integrator::SinglePass => {
                let flow = self.sweep::<Middle>(At::Middle)?;
                let end_force = self.ends.load(&self.chain, &mut self.tally);
                self.kick(dt);
                (end_force, flow)
            }
            Integrator::Compatible => {
                self.sweep::<Forces>(At::Middle)?;
                let end_force = self.ends.load(&self.chain, &mut self.tally);
                self.kick(dt);
                (end_force, self.sweep::<Work>(At::MiddleOverMean)?)
            }
        };
        self.drift(dt);
        self.accept(dt, until, end_force, flow.strain_power)
    }

    /// Steps until `time`, which is reached exactly.
    ///
    /// # Errors
    /// The first numerical failure.
    pub fn advance_to(&mut self, time: f64) -> Result<(), StepError> {
        while self.time < time {
            self.step(time)?;
        }
        Ok(())
    }

    /// Sums the contacts of every particle, Eqs. (36), (58)-(62), (67), (78) and (51).
    fn sweep<K: Pass>(&mut self, at: At) -> Result<PairSums, StepError> {
        let state = if matches!(at, At::Start) { &mut self.state } else { &mut self.middle };
        if !matches!(at, At::MiddleOverMean) {
            self.laws.density.resum(&self.chain, &state.x, &mut state.rho, &mut self.counters);
        }
        let drift = if matches!(at, At::MiddleOverMean) { &self.mean } else { &state.v };
        let sweep = Sweep {
            laws: &self.laws,
            chain: &self.chain,
            state: View { x: &state.x, v: &state.v, drift, u: &state.u, rho: &state.rho },
        };
        let chunks = self.scratch.over_pairs(&mut self.tally, |bins| sweep.chunk::<K>(bins));

        let mut sums = PairSums::default();
        for chunk in chunks {
            sums.pairs += chunk.pairs;
            sums.strain_power += chunk.strain_power;
            sums.overflow = sums.overflow.or(chunk.overflow);
            for (vote, other) in sums.votes.iter_mut().zip(chunk.votes) {
                *vote = vote.min(other);
            }
        }
        if K::FORCE {
            self.counters.stages += 1;
            self.counters.sweeps += 1;
            self.counters.pairs += sums.pairs;
        } else {
            self.counters.work_sweeps += 1;
        }
        match sums.overflow {
            Some(i) => Err(StepError::Neighbours {
                particle: self.label(i),
                time: self.time,
                room: crate::columns::REACH - 1,
            }),
            None => Ok(sums),
        }
    }

    /// Takes the smallest of all votes and lands on `until`.
    fn elect(&mut self, votes: &[Vote; 2], until: f64) -> Result<f64, StepError> {
        let mut damped = Vote::none(Limiter::Diffusion);
        for i in self.chain.real() {
            damped.consider(self.chain.mass(i) / self.tally[i].damping, i);
        }
        // The sweep votes with the square of the time that sound takes, to save it the root.
        let sound = Vote { dt: votes[0].dt.sqrt(), ..votes[0] };
        let load = self.ends.vote(&self.chain, &self.state.x, &self.tally);
        let voted = Vote::together(sound.min(votes[1]).min(load), damped).scaled(self.cfl);
        if voted.dt.is_nan() || voted.dt < self.smallest_step {
            return Err(StepError::TimeStep {
                particle: self.label(voted.particle),
                time: self.time,
                value: voted.dt,
                floor: self.smallest_step,
                limiter: voted.limiter.name(),
            });
        }
        let rest = until - self.time;
        let landing = |dt| Vote { dt, limiter: Limiter::Landing, particle: voted.particle };
        self.vote = if voted.dt >= rest {
            landing(rest)
        } else if voted.dt > 0.5 * rest {
            // Two equal steps rather than a full one and a sliver.
            landing(0.5 * rest)
        } else {
            voted
        };
        self.decided.count(self.vote.limiter);
        Ok(self.vote.dt)
    }

    /// State at the middle of the step from the rates at its start.
    fn predict(&mut self, half: f64) {
        let (chain, state, tally) = (&self.chain, &self.state, &self.tally);
        let State { x, v, u, rho } = &mut self.middle;
        rho.advance(&state.rho, |i| half * tally[i].rho_rate.value());
        zipped(x, v, u, |start, x, v, u| {
            let range = start..start + x.len();
            let (x_0, v_0) = (&state.x[range.clone()], &state.v[range.clone()]);
            let (u_0, m) = (&state.u[range.clone()], &chain.masses()[range.clone()]);
            let tally = &tally[range];
            for k in 0..x.len() {
                let per_mass = half / m[k];
                x[k] = x_0[k] + half * v_0[k];
                v[k] = v_0[k] + per_mass * tally[k].force;
                u[k] = u_0[k] + per_mass * tally[k].power;
            }
        });
        reflect(chain, &mut self.middle);
    }

    /// Mean velocity of the step from the forces at its middle.
    fn kick(&mut self, dt: f64) {
        let (chain, state, tally) = (&self.chain, &self.state, &self.tally);
        crate::columns::chunks(&mut self.mean, |start, mean| {
            let range = start..start + mean.len();
            let (v_0, m) = (&state.v[range.clone()], &chain.masses()[range.clone()]);
            let tally = &tally[range];
            for (k, mean) in mean.iter_mut().enumerate() {
                *mean = v_0[k] + 0.5 * dt / m[k] * tally[k].force;
            }
        });
        for (image, of) in chain.images() {
            self.mean[image] = -self.mean[of];
        }
    }

    /// State at the end of the step, into the place of the one at its middle.
    fn drift(&mut self, dt: f64) {
        let (chain, state, tally, mean) = (&self.chain, &self.state, &self.tally, &self.mean);
        let over_mean = self.integrator == Integrator::Compatible;
        let State { x, v, u, rho } = &mut self.middle;
        rho.advance(&state.rho, |i| dt * tally[i].rho_rate.value());
        zipped(x, v, u, |start, x, v, u| {
            let range = start..start + x.len();
            let (x_0, v_0) = (&state.x[range.clone()], &state.v[range.clone()]);
            let (u_0, m) = (&state.u[range.clone()], &chain.masses()[range.clone()]);
            let (tally, mean) = (&tally[range.clone()], &mean[range]);
            for k in 0..x.len() {
                let drift = if over_mean { mean[k] } else { v[k] };
                x[k] = x_0[k] + dt * drift;
                v[k] = 2.0 * mean[k] - v_0[k];
                u[k] = u_0[k] + dt / m[k] * tally[k].power;
            }
        });
        reflect(chain, &mut self.middle);
    }

    /// Checks the new state, enters it in the ledger, and makes it the present one.
    fn accept(
        &mut self,
        dt: f64,
        until: f64,
        end_force: f64,
        strain_power: f64,
    ) -> Result<(), StepError> {
        let now = if self.vote.dt >= until - self.time { until } else { self.time + dt };
        std::mem::swap(&mut self.state, &mut self.middle);
        let totals = self.audit();
        if let Some(error) = self.complaint(now) {
            std::mem::swap(&mut self.state, &mut self.middle);
            return Err(error);
        }
        self.ledger.boundary_impulse += end_force * dt;
        self.ledger.boundary_work += self.ends.power(&self.chain, &self.mean) * dt;
        self.ledger.strain += strain_power * dt;
        self.ledger.enter(totals);
        self.time = now;
        self.counters.steps += 1;
        self.counters.particle_steps += self.chain.real().len() as u64;
        Ok(())
    }

    /// Sums the particles of the state and checks each.
    fn audit(&mut self) -> Totals {
        let (laws, chain, state) = (&self.laws, &self.chain, &self.state);
        let cold = self.ledger.initial.round_off(COLD);
        let real = chain.real();
        let one = |c: usize, out: &mut ChunkTotals| {
            let (start, end) = (real.start.max(c * CHUNK), real.end.min((c + 1) * CHUNK));
            let mut totals = Totals::default();
            let mut sound = true;
            for i in start..end {
                let (m, v, u) = (chain.mass(i), state.v[i], state.u[i]);
                totals.mass += m;
                totals.kinetic += 0.5 * m * v * v;
                totals.internal += m * u;
                totals.momentum += m * v;
                totals.momentum_scale += m * v.abs();
                let floor = laws.eos[chain.material(i)].floor() - cold;
                let apart = i + 1 >= state.x.len() || state.x[i + 1] > state.x[i];
                // A comparison with NaN is false, so that NaN does not pass.
                let finite = (state.x[i] + v + u).is_finite();
                let rho = state.rho.get(i);
                sound &= finite & apart & (u >= floor) & (rho >= 0.0) & rho.is_finite();
            }
            // The wall of the first particle; those of the others are their right neighbours.
            if start == real.start && start > 0 {
                sound &= state.x[start] > state.x[start - 1];
            }
            *out = ChunkTotals { totals, sound };
        };
        if self.totals.len() == 1 {
            one(0, &mut self.totals[0]);
        } else {
            self.totals.par_iter_mut().enumerate().for_each(|(c, out)| one(c, out));
        }
        let mut totals = Totals::default();
        for chunk in &self.totals {
            totals.add(&chunk.totals);
        }
        totals
    }

    /// What is wrong with the state, if anything; named by particle, time and value.
    fn complaint(&self, time: f64) -> Option<StepError> {
        if self.totals.iter().all(|c| c.sound) {
            return None;
        }
        let state = &self.state;
        let cold = self.ledger.initial.round_off(COLD);
        self.chain.real().find_map(|i| {
            let particle = self.label(i);
            let not_finite = [("position", state.x[i]), ("velocity", state.v[i])]
                .into_iter()
                .chain([("internal energy", state.u[i]), ("density", state.rho.get(i))])
                .find(|(_, value)| !value.is_finite());
            if let Some((quantity, value)) = not_finite {
                return Some(StepError::NotFinite { quantity, particle, time, value });
            }
            if state.rho.get(i) < 0.0 {
                return Some(StepError::Density { particle, time, value: state.rho.get(i) });
            }
            let floor = self.laws.eos[self.chain.material(i)].floor();
            if state.u[i] < floor - cold {
                return Some(StepError::Energy { particle, time, value: state.u[i], floor });
            }
            // Images included: a particle may not pass its wall either.
            let pair = [(i.wrapping_sub(1), i), (i, i + 1)];
            pair.into_iter().filter(|&(a, b)| a < b && b < state.x.len()).find_map(|(a, b)| {
                let value = state.x[b] - state.x[a];
                let (particle, next) = (self.label(a), self.label(b));
                (value <= 0.0).then_some(StepError::Crossed { particle, next, time, value })
            })
        })
    }

    /// Index of a particle as the user counts: from 0, images as what they are images of.
    fn label(&self, mut i: usize) -> usize {
        while let Some((_, of)) = self.chain.images().find(|&(image, _)| image == i) {
            i = of;
        }
        i - self.chain.real().start
    }
}

/// Reading access, for harnesses.
impl<P: Physics<1>> Simulation<P> {
    /// Present time.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Number of particles.
    #[must_use]
    pub fn particles(&self) -> usize {
        self.chain.real().len()
    }

    /// Work done so far.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Balance of the conserved quantities.
    #[must_use]
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// How often each limiter decided the time step.
    #[must_use]
    pub fn decided(&self) -> Decided {
        self.decided
    }

    /// The vote that decided the last step.
    #[must_use]
    pub fn vote(&self) -> Vote {
        self.vote
    }

    /// Velocity of particle `i`.
    #[must_use]
    pub fn velocity(&self, i: usize) -> f64 {
        self.state.v[self.chain.real().start + i]
    }

    /// Strain energy of the segments, from the positions.
    #[must_use]
    pub fn strain_energy(&self) -> f64 {
        if !P::Solid::RESISTS {
            return 0.0;
        }
        let real = self.chain.real();
        let energy = |i: usize| {
            let contact = self.chain.contact_at(&self.state.x, i, i + 1);
            if !contact.bonded {
                return 0.0;
            }
            let stretch = (contact.zeta - 1.0).max(0.0);
            let bulk = |i: usize| self.laws.eos[self.chain.material(i)].bulk();
            0.5 * series(bulk(i), bulk(i + 1)) * stretch * stretch * contact.length
        };
        // Half of the segment to an image is of this world.
        let [left, right] = self.chain.walled();
        let before = if left { 0.5 * energy(real.start - 1) } else { 0.0 };
        let behind = if right { 0.5 * energy(real.end - 1) } else { 0.0 };
        before + (real.start..real.end - 1).map(energy).sum::<f64>() + behind
    }

    /// All fields of all particles.
    #[must_use]
    pub fn snapshot(&self) -> crate::output::Snapshot {
        let mut out = crate::output::Snapshot::new(self.time, self.particles());
        for i in self.chain.real() {
            let eos = &self.laws.eos[self.chain.material(i)];
            let (x, u) = (&self.state.x, self.state.u[i]);
            let rho = self.laws.density.report(&self.chain, x, &self.state.rho, i);
            out.x.push(x[i]);
            out.v.push(self.state.v[i]);
            out.u.push(u);
            out.rho.push(rho);
            out.pressure.push(P::Solid::carried(eos.pressure(rho, u)));
            out.theta.push(eos.temperature(u));
            out.m.push(self.chain.mass(i));
        }
        out
    }
}

/// Puts the images of a state in their places.
fn reflect<C: Column>(chain: &Chain, state: &mut State<C>) {
    chain.reflect(&mut state.x, &mut state.v);
    for (image, of) in chain.images() {
        state.u[image] = state.u[of];
        state.rho.copy(of, image);
    }
}

/// Runs `work(start, x, v, u)` over the chunks of three columns.
fn zipped(
    x: &mut [f64],
    v: &mut [f64],
    u: &mut [f64],
    work: impl Fn(usize, &mut [f64], &mut [f64], &mut [f64]) + Sync,
) {
    if x.len() <= CHUNK {
        return work(0, x, v, u);
    }
    x.par_chunks_mut(CHUNK)
        .zip(v.par_chunks_mut(CHUNK))
        .zip(u.par_chunks_mut(CHUNK))
        .enumerate()
        .for_each(|(c, ((x, v), u))| work(c * CHUNK, x, v, u));
}
