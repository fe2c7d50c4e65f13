//! Contacts between particles that are not neighbours in live material: who can touch, what touching does
//! (`forces.rs`), and what of it outlasts a restart (`memory.rs`).
//!
//! Members are the particles that can take part: with elements that carry the pressure, those on
//! surfaces and of dead elements, and two layers below; without, all. A list of pairs in reach is
//! kept until motion makes it stale; surfaces find those in front of each other by it too. Where they keep
//! two particles apart, no pair does.

mod forces;
mod memory;
mod shape;

pub(super) use self::memory::{Memory, no_order};

use rayon::prelude::*;

use self::forces::{Forces, nested};
use super::columns::State;
use super::kernel::Kernel;
use super::lattice::NONE;
use super::mesh::Mesh;
use super::method::Method;
use super::near::{DEBRIS, EXPOSED, PairList, Points, Reach};
use super::output::Ellipsoid;
use super::spin::{Rigid, Spins, Who, half_lengths};
use crate::method::{Density, Integrator};

/// Pairs that one task evaluates.
const BLOCK: usize = 4096;

/// Margins of the list over the reach of contacts, in contact lengths: of material, and at most of debris that spreads.
const SKIN: [f64; 2] = [0.8, 3.2];

/// By how much the margin grows where a list has served for fewer steps than the first of [`SERVED`], and shrinks where it
/// has served for more than the second.
const GROWTH: f64 = 1.25;
const SERVED: [u64; 2] = [6, 24];

/// Distance in contact lengths within which surfaces seek nodes of each other: that from the middle of a
/// face stretched to 1.5 times its edge, where it is felt, to its corners, and a little more.
pub(super) const SIGHT: f64 = 1.4;

/// Flag of members whose pairs are to be looked for.
const FRESH: u8 = 4;

/// Cells below a surface that take part in contacts, and cells round a dying element that are made able to.
const NEAR: i16 = 2;
const AHEAD: i16 = 4;

/// Half cells between parts of a body that may touch by folding.
const FOLD: i16 = 12;

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
    forces: Forces,
    kernel: Option<Kernel>,
    /// Whether elements carry the pressure of the particles that they hold.
    volumes: bool,
    /// Power of the contacts on each member, where the sweep that finds forces sums it: in a single pass.
    power: Vec<f64>,
    terms: Vec<Vec<[f64; 2]>>,
    /// Margin of the list, in contact lengths; steps since it was made.
    skin: f64,
    served: u64,
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

impl Contacts {
    /// Chooses members: all particles, or where elements carry the pressure, those near surfaces.
    #[must_use]
    pub fn new(mesh: &Mesh, method: &Method) -> Self {
        let volumes = method.density == Density::Hybrid;
        let kernel = method.density == Density::Kernel;
        let kernel = kernel.then(|| Kernel::new(mesh, method.kernel_support));
        let mut contacts = Self {
            kernel,
            volumes,
            index: vec![NONE; mesh.len],
            forces: Forces::new(mesh, volumes),
            skin: SKIN[0],
            longest: mesh.bodies.iter().map(|b| b.longest).fold(0.0, f64::max),
            ..Self::default()
        };
        // In the order of the particles, so that steps go through memory in one direction.
        let exposed = |i: &usize| !volumes || mesh.exposed(*i);
        let mut chosen = vec![!volumes; mesh.len];
        for i in mesh.real().filter(|i| volumes && exposed(i)) {
            let (body, place) = mesh.place(i);
            chosen[i] = true;
            mesh.within(NEAR, body, place).for_each(|near| chosen[near] = true);
        }
        let members = mesh.real().filter(|&i| chosen[i]).count();
        contacts.reserve(mesh.particles.min(members + members / 8));
        for i in mesh.real().filter(|&i| chosen[i]) {
            contacts.admit(mesh, i);
        }
        for i in mesh.real().filter(exposed) {
            contacts.expose(mesh, i);
        }
        if method.integrator == Integrator::SinglePass {
            // By contact densities all are members, and stay the only ones.
            contacts.power = vec![0.0; contacts.members.len()];
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
        if let Some(spins) = self.forces.spins_mut() {
            spins.reserve(n);
        }
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
        // A list must be made anew for new members: those that deaths to come will ask for come along.
        let missing = |near: usize| self.index[near] == NONE;
        if hidden && mesh.within(NEAR, body, place).any(missing) {
            for near in mesh.within(AHEAD, body, place) {
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
        self.length.push(mesh.bodies[body].longest as f32);
        self.flags.push(0);
        self.body.push(body as u16);
        self.place.push(place);
        if let Some(spins) = self.forces.spins_mut() {
            spins.admit(mesh, Who { particle: i, body, place });
        }
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

    /// Whether particles rotate: some are ellipsoids.
    pub(super) fn rotates(&self) -> bool {
        self.forces.spins().is_some()
    }

    /// Rotational energy of a particle, and its angular momentum about itself in global axes, if it rotates on its own.
    pub(super) fn rotation(&self, mesh: &Mesh, i: usize) -> Option<(f64, [f64; 3])> {
        let (spins, member) = (self.forces.spins()?, self.find(i)?);
        let rigid = spins.rigid(member)?;
        let inertia = Who::of(mesh, i).inertia(mesh);
        Some((rigid.energy(&inertia), (rigid.turn * rigid.momentum).into()))
    }

    /// A particle that is an ellipsoid; nothing of a sphere.
    pub(super) fn ellipsoid(&self, (mesh, state): (&Mesh, &State), i: usize) -> Option<Ellipsoid> {
        let spins = self.forces.spins()?;
        let contact_lengths = mesh.bodies[mesh.place(i).0].ellipsoid?;
        let own = self.find(i).and_then(|member| spins.rigid(member));
        let axes = own.map_or_else(|| spins.held_axes(mesh, state, i), Rigid::axes);
        Some(Ellipsoid { axes, half_lengths: half_lengths(contact_lengths), contact_lengths })
    }

    /// Notes how a particle lies before elements round it die; nothing of spheres.
    pub fn part(&mut self, mesh: &Mesh, state: &State, i: usize) {
        if let Some(spins) = self.forces.spins_mut() {
            spins.part(mesh, state, i);
        }
    }

    /// What was noted and no element holds any more begins to rotate on its own.
    pub fn let_go(&mut self, mesh: &Mesh) {
        let index = &self.index;
        if let Some(spins) = self.forces.spins_mut() {
            spins.let_go(mesh, |i| (index[i] != NONE).then_some(index[i] as usize));
        }
    }

    /// Particles lie on a mirror normal to an axis; nothing of spheres.
    pub fn mirror(&mut self, mesh: &Mesh, axis: usize, particles: &[u32]) {
        let index = &self.index;
        if let Some(spins) = self.forces.spins_mut() {
            let find = |i: usize| (index[i] != NONE).then_some(index[i] as usize);
            spins.mirror((mesh, axis), particles, find);
        }
    }

    /// Torque on particles that mirrors took in the present step.
    pub(super) fn barred(&self) -> [f64; 3] {
        self.forces.spins().map_or([0.0; 3], Spins::barred)
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
        self.forces.acting()
    }

    /// What the search for pairs has done so far.
    #[must_use]
    pub fn searches(&self) -> super::near::Counters {
        self.list.counters()
    }

    /// Moves the members to their positions after a step and renews the list if it is stale.
    pub fn refresh(&mut self, mesh: &Mesh, state: &State, method: &Method) {
        self.served += 1;
        self.look_again(mesh, state, method);
    }

    /// Moves the members to their present positions and renews the list if it is stale.
    pub(super) fn look_again(&mut self, mesh: &Mesh, state: &State, method: &Method) {
        self.follow(mesh, state);
        let lattice = self.volumes.then_some(&self.place[..]);
        let points = points(&self.position, &self.length, &self.flags, &self.body, lattice);
        if self.changed || self.list.is_stale(&points) {
            self.adapt();
            self.renew(mesh, method);
        }
    }

    /// Sets the margin of the next list by how long this one has served: where debris flies apart, a wider one is made
    /// less often, and lists little more.
    fn adapt(&mut self) {
        let [least, most] = SKIN;
        let [short, long] = SERVED;
        // Of schemes that look at all pairs of the list a wider one has its price.
        if self.served < short && !self.changed && self.volumes {
            self.skin = (self.skin * GROWTH).min(most);
        } else if self.served > long {
            self.skin = (self.skin / GROWTH).max(least);
        }
        self.served = 0;
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
            self.look_again(mesh, state, method);
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
        let sight = if self.volumes { SIGHT } else { 0.0 };
        let factor = method.reach().max(sight);
        let reach = Reach { factor, skin: self.skin * self.longest };
        self.list.rebuild(&points, reach, may_touch(mesh, (&self.flags, &self.body), lattice));
        self.settle();
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.members.capacity() * (4 + 24 + 4 + 1 + 2 + 6)
            + 4 * self.index.capacity()
            + self.list.bytes()
            + self.kernel.as_ref().map_or(0, Kernel::bytes)
            + 8 * self.power.capacity()
            + nested(&self.terms)
            + self.forces.bytes()
    }
}
