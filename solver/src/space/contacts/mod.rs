//! Contacts between particles that are not neighbours in live material: Eqs. (34)-(36), the force (67) in
//! the form (78), the viscosity (51)-(53) and the conduction (56)-(57), (62).
//!
//! Members are the particles that can take part: with elements that carry the pressure, those on
//! surfaces and of dead elements, and two layers below; without, all. A list of pairs in reach is
//! kept until motion makes it stale. Where `surfaces` keep two particles apart, no pair does.

use rayon::prelude::*;

use crate::method::Viscosity;

use super::columns::{Derived, State, Sums};
use super::kernel::Kernel;
use super::lattice::NONE;
use super::mesh::Mesh;
use super::method::Method;
use super::near::{DEBRIS, EXPOSED, PairList, Points, Reach, put};
use super::surfaces;

/// Pairs that one task evaluates.
const BLOCK: usize = 4096;

/// Margin of the list over the reach of contacts, in contact lengths.
const SKIN: f64 = 0.8;

/// Flag of members whose pairs are to be looked for.
const FRESH: u8 = 4;

/// Half cells between parts of a body that may touch by folding.
const FOLD: i16 = 12;

/// Smallest sound speed over the velocity of approach.
const COLDEST: f64 = 1e-9;

/// Overlap beyond which the force of a contact rises no more, as a share of the distance of contact.
const DEEPEST: f64 = 0.8;

/// The particles that can touch, and the pairs of them that might.
#[derive(Debug, Clone, Default)]
pub struct Contacts {
    members: Vec<u32>,
    /// Member that a particle is.
    index: Vec<u32>,
    position: [Vec<f64>; 3],
    length: Vec<f32>,
    flags: Vec<u8>,
    body: Vec<u16>,
    place: Vec<[i16; 3]>,
    list: PairList,
    blocks: Vec<Vec<Active>>,
    kernel: Option<Kernel>,
    /// Whether elements carry the pressure of the particles that they hold.
    volumes: bool,
    terms: Vec<Vec<[f64; 2]>>,
    /// Changes of the list so far.
    changes: u64,
    /// Whether the list must be renewed whatever has moved.
    changed: bool,
    longest: f64,
}

/// A particle that can take part in contacts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member {
    /// Particle.
    pub(super) particle: usize,
    /// Its body.
    pub(super) body: usize,
    /// Its place in the lattice.
    pub(super) place: [i16; 3],
}

/// What contacts keep from step to step, particle by particle.
pub(super) struct Memory {
    /// Member that a particle is, or [`NONE`].
    pub(super) index: Vec<u32>,
    /// Flags of the members.
    pub(super) flags: Vec<u8>,
    /// Where the members were when the list was made.
    pub(super) places: [Vec<f64>; 3],
    /// Whether the list is to be made anew.
    pub(super) stale: bool,
}

/// The first entry of an index of members, by particle, that cannot be: they are numbered without
/// gaps, and only real particles are members.
pub(super) fn no_order(mesh: &Mesh, index: &[u32]) -> Option<u32> {
    let mut real = vec![false; mesh.len];
    mesh.real().for_each(|i| real[i] = true);
    let members = index.iter().filter(|&&at| at != NONE).count();
    let mut seen = vec![false; members];
    let mut bad = |(&at, &real): (&u32, &bool)| match seen.get_mut(at as usize) {
        Some(seen) => !real || std::mem::replace(seen, true),
        None => at != NONE,
    };
    index.iter().zip(&real).find(|&pair| bad(pair)).map(|(&at, _)| at)
}

/// The members in order, from where each stands.
fn in_order(index: &[u32]) -> Vec<u32> {
    let mut members: Vec<u32> =
        (0..index.len() as u32).filter(|&i| index[i as usize] != NONE).collect();
    members.sort_unstable_by_key(|&i| index[i as usize]);
    members
}

/// Members as the search sees them.
fn points<'a>(
    [x, y, z]: &'a [Vec<f64>; 3],
    length: &'a [f32],
    flags: &'a [u8],
    body: &'a [u16],
    lattice: Option<&'a [[i16; 3]]>,
) -> Points<'a> {
    Points { x, y, z, length, flags, body, lattice }
}

/// Whether two members are ever to be looked at; `place` if elements carry the pressure.
fn may_touch<'a>(
    mesh: &'a Mesh,
    (flags, body): (&'a [u8], &'a [u16]),
    place: Option<&'a [[i16; 3]]>,
) -> impl Fn(u32, u32) -> bool + Sync + 'a {
    move |a, b| {
        let (a, b) = (a as usize, b as usize);
        let Some(place) = place.filter(|_| body[a] == body[b]) else { return true };
        // Live material carries its own pressure: only the far ends of a body that folds touch.
        let span = (0..3).map(|d| (place[a][d] - place[b][d]).abs()).max();
        // A gas flows, and what stands side by side in it may come from far away.
        let near = span <= Some(FOLD) || mesh.bodies[body[a] as usize].is_gas();
        let together = near && (flags[a] | flags[b]) & DEBRIS == 0;
        !together && !mesh.bonded(body[a] as usize, place[a], place[b])
    }
}

/// A pair in contact in this step.
#[derive(Debug, Clone, Copy)]
pub struct Active {
    /// Particles.
    pair: [u32; 2],
    /// Their bodies.
    bodies: [u16; 2],
    /// From the second to the first.
    r: [f64; 3],
    /// `3/8 rho_o g` of each: density rate per closing rate of `r^2 / 2`.
    row: [f64; 2],
    /// Pressure force over separation, and its share of the first particle.
    push: [f64; 2],
    /// Viscous force over separation.
    drag: f64,
    /// Heat flux from the first to the second.
    flux: f64,
}

impl Active {
    /// Whether it does anything: particles at rest beside each other do not.
    fn moves(&self, mesh: &Mesh) -> bool {
        self.bodies[0] != self.bodies[1]
            && mesh.bodies[self.bodies[0] as usize].velocity
                != mesh.bodies[self.bodies[1] as usize].velocity
            || self.push != [0.0; 2]
            || self.drag != 0.0
            || self.flux != 0.0
    }
}

/// What a contact sees.
struct View<'a> {
    mesh: &'a Mesh,
    state: &'a State,
    derived: &'a Derived,
    method: &'a Method,
    kernel: Option<&'a Kernel>,
    /// Whether elements carry the pressure of the particles that they hold.
    volumes: bool,
}

impl Contacts {
    /// Chooses members: all particles, or where elements carry the pressure, those near surfaces.
    #[must_use]
    pub fn new(mesh: &Mesh, volumes: bool, kernel: Option<Kernel>) -> Self {
        let mut contacts = Self {
            kernel,
            volumes,
            index: vec![NONE; mesh.len],
            longest: mesh.bodies.iter().map(|b| b.length).fold(0.0, f64::max),
            ..Self::default()
        };
        // In the order of the particles, so that steps go through memory in one direction.
        let exposed = |i: &usize| !volumes || mesh.exposed(*i);
        let mut chosen = vec![!volumes; mesh.len];
        for i in mesh.real().filter(|i| volumes && exposed(i)) {
            let (body, place) = mesh.place(i);
            chosen[i] = true;
            mesh.within_two_cells(body, place).for_each(|near| chosen[near] = true);
        }
        let members = mesh.real().filter(|&i| chosen[i]).count();
        contacts.reserve(mesh.particles.min(members + members / 8));
        for i in mesh.real().filter(|&i| chosen[i]) {
            contacts.admit(mesh, i);
        }
        for i in mesh.real().filter(exposed) {
            contacts.expose(mesh, i);
        }
        contacts
    }

    /// Makes room for so many more members.
    fn reserve(&mut self, n: usize) {
        self.members.reserve_exact(n);
        self.position.iter_mut().for_each(|x| x.reserve_exact(n));
        self.length.reserve_exact(n);
        self.flags.reserve_exact(n);
        self.body.reserve_exact(n);
        self.place.reserve_exact(n);
    }

    /// Makes a particle able to touch any other, and members of those within two cells.
    pub fn expose(&mut self, mesh: &Mesh, i: usize) {
        let (body, place) = mesh.place(i);
        let member = self.admit(mesh, i);
        let hidden = self.flags[member] & EXPOSED == 0;
        // Without elements that carry the pressure all pairs are listed as it is.
        if !self.volumes && !hidden {
            return;
        }
        let debris = if mesh.whole(i) { 0 } else { DEBRIS };
        self.flags[member] |= EXPOSED | FRESH | debris;
        if hidden {
            for near in mesh.within_two_cells(body, place) {
                self.admit(mesh, near);
            }
        }
    }

    /// The member that a particle is.
    fn admit(&mut self, mesh: &Mesh, i: usize) -> usize {
        if self.index[i] != NONE {
            return self.index[i] as usize;
        }
        let (body, place) = mesh.place(i);
        let member = self.members.len();
        self.changed = true;
        if member == self.members.capacity() {
            self.reserve((member + member / 8).min(mesh.particles) - member);
        }
        self.index[i] = member as u32;
        self.members.push(i as u32);
        let x = mesh.bodies[body].lattice.position(place);
        for (position, x) in self.position.iter_mut().zip(x) {
            position.push(x);
        }
        self.length.push(mesh.bodies[body].length as f32);
        self.flags.push(0);
        self.body.push(body as u16);
        self.place.push(place);
        member
    }

    /// Every member: particle, body and position along an axis.
    pub fn along(&self, axis: usize) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let bodies = self.body.iter().map(|&b| b as usize);
        let particles = self.members.iter().map(|&i| i as usize);
        particles.zip(bodies).zip(&self.position[axis]).map(|((i, body), &x)| (i, body, x))
    }

    /// Pairs of the list that both can touch any other.
    pub(super) fn exposed_pairs(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let exposed = |at: u32| self.flags[at as usize] & EXPOSED != 0;
        self.list.pairs().iter().copied().filter(move |&[a, b]| exposed(a) && exposed(b))
    }

    /// How often the list has changed.
    pub(super) fn changes(&self) -> u64 {
        self.changes
    }

    /// Body of a member.
    #[inline(always)]
    pub(super) fn body(&self, at: u32) -> usize {
        self.body[at as usize] as usize
    }

    /// A member.
    pub(super) fn member(&self, at: usize) -> Member {
        Member {
            particle: self.members[at] as usize,
            body: self.body[at] as usize,
            place: self.place[at],
        }
    }

    /// Where a member is.
    #[inline(always)]
    pub(super) fn position(&self, at: u32) -> [f64; 3] {
        self.position.each_ref().map(|x| x[at as usize])
    }

    /// Particle that a member is.
    #[inline(always)]
    pub(super) fn particle(&self, at: u32) -> usize {
        self.members[at as usize] as usize
    }

    /// The member that a particle is, if it is one.
    pub(super) fn find(&self, i: usize) -> Option<usize> {
        (self.index[i] != NONE).then_some(self.index[i] as usize)
    }

    /// Number of members.
    #[must_use]
    pub fn members(&self) -> usize {
        self.members.len()
    }

    /// Pairs in the list.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.list.pairs().len()
    }

    /// Pairs of the list that act on each other in this step.
    #[must_use]
    pub fn acting(&self) -> usize {
        self.blocks.iter().map(Vec::len).sum()
    }

    /// What the search for pairs has done so far.
    #[must_use]
    pub fn searches(&self) -> super::near::Counters {
        self.list.counters()
    }

    /// Moves the members to their present positions and renews the list if it is stale.
    pub fn refresh(&mut self, mesh: &Mesh, state: &State, method: &Method) {
        self.follow(mesh, state);
        let lattice = self.volumes.then_some(&self.place[..]);
        let points = points(&self.position, &self.length, &self.flags, &self.body, lattice);
        if self.changed || self.list.is_stale(&points) {
            self.renew(mesh, method);
        }
    }

    /// Moves the members to their present positions.
    fn follow(&mut self, mesh: &Mesh, state: &State) {
        let own = [&state.dx, &state.dy, &state.dz];
        let Self { position: [x, y, z], members, body, place, .. } = self;
        let columns = (x.par_chunks_mut(BLOCK), y.par_chunks_mut(BLOCK), z.par_chunks_mut(BLOCK));
        columns.into_par_iter().enumerate().for_each(|(block, (x, y, z))| {
            let mut at = block * BLOCK;
            let mut to = x.iter_mut().zip(y).zip(z);
            for run in body[at..at + to.len()].chunk_by(|a, b| a == b) {
                let body = &mesh.bodies[run[0] as usize];
                let steps = body.lattice.steps();
                let each = members[at..].iter().zip(&place[at..]).zip(to.by_ref());
                if body.lattice.is_mapped() {
                    for ((&i, &place), ((x, y), z)) in each.take(run.len()) {
                        let start = body.lattice.position(place);
                        for (d, x) in [x, y, z].into_iter().enumerate() {
                            *x = start[d] + (body.way[d] + own[d][i as usize]);
                        }
                    }
                    at += run.len();
                    continue;
                }
                for ((&i, place), ((x, y), z)) in each.take(run.len()) {
                    let place = place.map(f64::from);
                    for (d, x) in [x, y, z].into_iter().enumerate() {
                        let along = |k: usize| steps[k][d] * place[k];
                        let start = body.lattice.origin[d] + along(0) + along(1) + along(2);
                        *x = start + (body.way[d] + own[d][i as usize]);
                    }
                }
                at += run.len();
            }
        });
    }

    /// After elements died: lists the pairs of the particles that were exposed.
    pub fn open(&mut self, mesh: &Mesh, state: &State, method: &Method) {
        if self.changed {
            self.refresh(mesh, state, method);
            return;
        }
        let Self { list, length, flags, body, place, volumes, .. } = self;
        let keep = may_touch(mesh, (flags, body), volumes.then_some(place));
        list.extend(length, |member| flags[member as usize] & FRESH != 0, keep);
        self.settle();
    }

    /// What follows from a list that has changed.
    fn settle(&mut self) {
        self.flags.iter_mut().for_each(|flags| *flags &= !FRESH);
        self.changes += 1;
    }

    /// Makes the list anew from the present positions.
    fn renew(&mut self, mesh: &Mesh, method: &Method) {
        self.changed = false;
        let lattice = self.volumes.then_some(&self.place[..]);
        let points = points(&self.position, &self.length, &self.flags, &self.body, lattice);
        let surfaces = if self.volumes { surfaces::REACH } else { 0.0 };
        let factor = method.reach().max(surfaces);
        let reach = Reach { factor, skin: SKIN * self.longest };
        self.list.rebuild(&points, reach, may_touch(mesh, (&self.flags, &self.body), lattice));
        self.settle();
    }

    /// What must outlast a restart.
    pub(super) fn memory(&self) -> Memory {
        let by_particle = |member: &u32| (*member != NONE).then_some(*member as usize);
        let flags = self.index.iter().map(|at| by_particle(at).map_or(0, |at| self.flags[at]));
        let flags = flags.collect();
        let mut places = [0; 3].map(|_| vec![0.0; self.index.len()]);
        if !self.changed {
            for (member, at) in self.list.made_at() {
                for (places, at) in places.iter_mut().zip(at) {
                    places[self.members[member as usize] as usize] = at;
                }
            }
        }
        Memory { index: self.index.clone(), flags, places, stale: self.changed }
    }

    /// The members, and the list as it was made.
    pub(super) fn recall(&mut self, mesh: &Mesh, memory: &Memory, method: &Method) {
        let (longest, kernel, volumes) = (self.longest, self.kernel.take(), self.volumes);
        *self = Self { index: vec![NONE; mesh.len], longest, kernel, volumes, ..Self::default() };
        let order = in_order(&memory.index);
        self.reserve(mesh.particles.min(order.len() + order.len() / 8));
        for i in order {
            let member = self.admit(mesh, i as usize);
            self.flags[member] = memory.flags[i as usize];
            for (position, places) in self.position.iter_mut().zip(&memory.places) {
                position[member] = places[i as usize];
            }
        }
        if memory.stale {
            self.changed = true;
        } else {
            self.renew(mesh, method);
        }
    }

    /// The sweep that the paper's scheme removes: density from the positions, if by a kernel.
    pub fn sum_density(&mut self, mesh: &Mesh, rho: &mut [f64]) -> u64 {
        let Some(kernel) = &self.kernel else { return 0 };
        let pairs = self.list.pairs();
        self.terms.resize_with(pairs.len().div_ceil(BLOCK), Vec::new);
        let (position, members, body) = (&self.position, &self.members, &self.body);
        self.terms.par_iter_mut().zip(pairs.par_chunks(BLOCK)).for_each(|(terms, pairs)| {
            terms.clear();
            terms.extend(pairs.iter().map(|&[a, b]| {
                let (a, b) = (a as usize, b as usize);
                let square = |d: usize| (position[d][a] - position[d][b]).powi(2);
                let distance = (square(0) + square(1) + square(2)).sqrt();
                let term = |other: usize| {
                    kernel.value(distance / mesh.bodies[body[other] as usize].length)
                };
                [term(b), term(a)]
            }));
        });
        for &i in members {
            rho[i as usize] = kernel.value(0.0);
        }
        for (&[a, b], term) in pairs.iter().zip(self.terms.iter().flatten()) {
            rho[members[a as usize] as usize] += term[0];
            rho[members[b as usize] as usize] += term[1];
        }
        for (&i, &body) in members.iter().zip(body) {
            rho[i as usize] *= kernel.scale(i as usize) * mesh.bodies[body as usize].rho_0;
        }
        2 * pairs.len() as u64
    }

    /// Forces, conduction and the marks of touched particles.
    pub fn push(
        &mut self,
        mesh: &Mesh,
        (state, derived): (&State, &Derived),
        (method, dt): (&Method, f64),
        (sums, touched, active): (&mut Sums, &mut [bool], &mut [bool]),
    ) {
        let kernel = self.kernel.as_ref();
        let view = View { mesh, state, derived, method, kernel, volumes: self.volumes };
        let widest = (method.reach() * self.longest).powi(2);
        let pairs = self.list.pairs();
        self.blocks.resize_with(pairs.len().div_ceil(BLOCK), Vec::new);
        let (position, members, body) = (&self.position, &self.members, &self.body);
        self.blocks.par_iter_mut().zip(pairs.par_chunks(BLOCK)).for_each(|(found, pairs)| {
            found.clear();
            for &[a, b] in pairs {
                let (a, b) = (a as usize, b as usize);
                let r: [f64; 3] = std::array::from_fn(|d| position[d][a] - position[d][b]);
                if r[0] * r[0] + r[1] * r[1] + r[2] * r[2] >= widest {
                    continue;
                }
                let bodies = [body[a] as usize, body[b] as usize];
                if let Some(active) = view.contact([members[a], members[b]], r, bodies) {
                    put(found, active);
                }
            }
        });
        for contact in self.blocks.iter().flatten() {
            let [i, j] = contact.pair.map(|k| k as usize);
            let force = contact.push[0] + contact.push[1] + contact.drag;
            let f = contact.r.map(|r| force * r);
            sums.fx[i] += f[0];
            sums.fy[i] += f[1];
            sums.fz[i] += f[2];
            sums.fx[j] -= f[0];
            sums.fy[j] -= f[1];
            sums.fz[j] -= f[2];
            sums.heat[i] -= contact.flux * dt;
            sums.heat[j] += contact.flux * dt;
            if contact.moves(mesh) {
                active[mesh.piece_of(i)] = true;
                active[mesh.piece_of(j)] = true;
            }
            touched[i] = true;
            touched[j] = true;
        }
    }

    /// Density rates (36), pressure work (59) and viscous heat, the first term of Eq. (60) given half to each,
    /// over the mean velocities of the step.
    pub fn work(
        &self,
        mesh: &Mesh,
        mean: impl Fn(usize) -> [f64; 3],
        dt: f64,
        (rho_rate, heat): (&mut [f64], &mut [f64]),
    ) {
        for active in self.blocks.iter().flatten() {
            let [i, j] = active.pair.map(|k| k as usize);
            let drift = mesh.drift_of(active.bodies[0] as usize, active.bodies[1] as usize);
            let (a, b) = (mean(i), mean(j));
            let v: [f64; 3] = std::array::from_fn(|d| a[d] - b[d] + drift[d]);
            let closing = -(active.r[0] * v[0] + active.r[1] * v[1] + active.r[2] * v[2]);
            rho_rate[i] += active.row[0] * closing;
            rho_rate[j] += active.row[1] * closing;
            let half = 0.5 * active.drag;
            heat[i] += dt * (active.push[0] + half) * closing;
            heat[j] += dt * (active.push[1] + half) * closing;
        }
    }

    /// Pairs that touch in this step.
    pub fn active(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.blocks.iter().flatten().map(|active| active.pair.map(|k| k as usize))
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let blocks: usize = self.blocks.iter().map(Vec::capacity).sum();
        self.members.capacity() * (4 + 24 + 4 + 1 + 2 + 6)
            + 4 * self.index.capacity()
            + self.list.bytes()
            + self.kernel.as_ref().map_or(0, Kernel::bytes)
            + 16 * self.terms.iter().map(Vec::capacity).sum::<usize>()
            + blocks * std::mem::size_of::<Active>()
    }
}

/// Coefficient of the viscous force over impedance, Eq. (53), or that of the limited viscosity: a
/// contact has no neighbours that could explain its jump. `slope` is that of the shock speed.
pub(super) fn steepness(method: &Method, approach: f64, sound: f64, slope: f64) -> f64 {
    // Of cold gas, whose impedance is nothing, the coefficient must still be a number.
    let sound = sound.max(COLDEST * approach);
    match method.viscosity {
        Viscosity::Pairwise => method.visc_linear * (1.0 + method.visc_quad * approach / sound),
        Viscosity::Limited => {
            let steep = method.visc_quad * slope * approach / sound;
            steep + (steep * steep + method.visc_linear * method.visc_linear).sqrt()
        }
    }
}

impl View<'_> {
    /// The contact of particles `pair` at distance `r`, if there is one.
    #[inline]
    fn contact(&self, pair: [u32; 2], r: [f64; 3], bodies: [usize; 2]) -> Option<Active> {
        let [i, j] = pair.map(|k| k as usize);
        if self.volumes && surfaces::meet(self.mesh, [i, j], bodies) {
            return None;
        }
        let square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        let body = bodies.map(|b| &self.mesh.bodies[b]);
        let widest = body[0].length.max(body[1].length) * self.method.reach();
        // Two particles that a corner of walls stops at one point have no direction to part in.
        if square >= widest * widest || square == 0.0 {
            return None;
        }
        let distance = square.sqrt();
        let ratio = [self.derived.rho[i] / body[0].rho_0, self.derived.rho[j] / body[1].rho_0];
        let thin = [0, 1].map(|k| body[k].eos.thinning(ratio[k]));
        // Of the first on the ellipsoid of the second, Eqs. (9), (35), and the other way round.
        let row = match self.kernel {
            None => [
                thin[0] * body[0].rho_0 * self.row(distance, body[1].length, ratio[1]),
                thin[1] * body[1].rho_0 * self.row(distance, body[0].length, ratio[0]),
            ],
            Some(kernel) => {
                let row = |k: usize, i: usize, length: f64| {
                    let slope = kernel.slope(distance / length) / (distance * length);
                    body[k].rho_0 * kernel.scale(i) * slope
                };
                [row(0, i, body[1].length), row(1, j, body[0].length)]
            }
        };
        let near = distance < body[0].length.max(body[1].length);
        if row[0] == 0.0 && row[1] == 0.0 && !near {
            return None;
        }
        let per = |k: usize, i: usize| {
            let rho = self.derived.rho[i];
            row[k] * self.mesh.mass(i) * self.derived.pressure[i] / (rho * rho)
        };
        let mut active = Active {
            pair,
            bodies: bodies.map(|b| b as u16),
            r,
            row,
            push: [per(0, i), per(1, j)],
            drag: 0.0,
            flux: 0.0,
        };
        if near {
            let impedance = [self.impedance(i, bodies[0]), self.impedance(j, bodies[1])];
            let drift = self.mesh.drift_of(bodies[0], bodies[1]);
            let v = [
                self.state.vx[i] - self.state.vx[j] + drift[0],
                self.state.vy[i] - self.state.vy[j] + drift[1],
                self.state.vz[i] - self.state.vz[j] + drift[2],
            ];
            let approach = -(r[0] * v[0] + r[1] * v[1] + r[2] * v[2]) / distance;
            if approach > 0.0 {
                let slope = 0.5 * (body[0].slope + body[1].slope);
                let sound = 0.5 * (self.sound(i, bodies[0]) + self.sound(j, bodies[1]));
                let both = 0.5 * (impedance[0] + impedance[1]);
                active.drag =
                    both * steepness(self.method, approach, sound, slope) * approach / distance;
            }
            let [a, b] = [0, 1].map(|k| impedance[k] * body[k].eos.c_v());
            // The flux of the limited viscosity acts in shocks alone.
            let coefficient = match self.method.viscosity {
                Viscosity::Pairwise => self.method.heat_coeff,
                Viscosity::Limited => 0.0,
            };
            let transfer = 0.5 * coefficient * (a + b);
            active.flux = transfer * (self.derived.theta[i] - self.derived.theta[j]);
        }
        Some(active)
    }

    /// `3/8 W / (zeta^5 L^2)`, Eqs. (35)-(36), at a distance from a particle of contact length `L`.
    #[inline(always)]
    fn row(&self, distance: f64, length: f64, ratio: f64) -> f64 {
        let zeta = distance / length;
        let tolerance = 1.0 + self.method.contact_tolerance;
        let cube = zeta * zeta * zeta * ratio;
        if zeta >= self.method.contact_reach || cube >= tolerance * tolerance * tolerance {
            return 0.0;
        }
        let zeta = if cube < DEEPEST * DEEPEST * DEEPEST { DEEPEST / ratio.cbrt() } else { zeta };
        0.375 / (zeta.powi(5) * length * length)
    }

    /// `rho_o c_s V_o^(2/3)`, Eq. (53).
    #[inline(always)]
    fn impedance(&self, i: usize, body: usize) -> f64 {
        let area = self.mesh.areas[body][self.mesh.share[i] as usize];
        self.mesh.bodies[body].rho_0 * self.sound(i, body) * area
    }

    /// `c_s` of Eqs. (53), (57).
    #[inline(always)]
    fn sound(&self, i: usize, body: usize) -> f64 {
        self.mesh.bodies[body].viscous_sound(self.method.viscosity, self.derived.sound[i])
    }
}
