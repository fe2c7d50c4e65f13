//! What pairs in contact do: Eqs. (34)-(36), the force (67) in the form (78), the torque (68) in the form (79), the
//! viscosity (51)-(55) and the conduction (56)-(57), (62).

use rayon::prelude::*;

use super::shape::{Arms, Meeting, Normals, Pair, Shape, Spheres, Torque, Torsion};
use super::{BLOCK, Contacts};
use crate::method::Viscosity;
use crate::space::columns::{Derived, State, Sums};
use crate::space::kernel::Kernel;
use crate::space::lattice::dot;
use crate::space::mesh::Mesh;
use crate::space::method::Method;
use crate::space::near::{PairList, put};
use crate::space::simulation::CROSSING;
use crate::space::spin::{Spins, Who};

/// Overlap beyond which the force of a contact rises no more, as a share of the distance of contact.
const DEEPEST: f64 = 0.8;

/// Most of its velocity that all contacts of a particle take in a kick where volumes carry the pressure: no motion is
/// damped by more than twice that, of which leapfrog bears two.
const BEARABLE: f64 = 0.9;

/// A pair in contact in this step: what takes long to find again. Loops over contacts wait for memory.
#[derive(Debug, Clone, Copy)]
pub struct Active<T> {
    members: [u32; 2],
    /// `3/8 rho_o g` of each: density rate per closing rate of `zeta^2 / 2`, in units of its meeting.
    row: [f64; 2],
    /// Pressure force over separation, and its share of the first particle.
    push: [f64; 2],
    /// Viscous force over separation.
    drag: f64,
    /// Heat flux from the first to the second.
    flux: f64,
    /// Viscous torque, of ellipsoids.
    torque: T,
}

/// Pairs in contact, block by block of the list.
type Blocks<T> = Vec<Vec<Active<T>>>;

/// What contacts of the particles of a scene do: of spheres, or where some are ellipsoids.
#[derive(Debug, Clone)]
pub(super) enum Forces {
    Spheres(Blocks<()>),
    Ellipsoids(Blocks<Torsion>, Box<Spins>),
}

impl Default for Forces {
    fn default() -> Self {
        Self::Spheres(Vec::new())
    }
}

impl Forces {
    /// Of a mesh in which elements carry the pressure, or not.
    pub(super) fn new(mesh: &Mesh, volumes: bool) -> Self {
        Spins::new(mesh, volumes)
            .map_or_else(Self::default, |spins| Self::Ellipsoids(Vec::new(), Box::new(spins)))
    }

    /// The rotation of the members, if they rotate.
    pub(super) fn spins(&self) -> Option<&Spins> {
        match self {
            Self::Spheres(_) => None,
            Self::Ellipsoids(_, spins) => Some(spins),
        }
    }

    /// The same, to be changed.
    pub(super) fn spins_mut(&mut self) -> Option<&mut Spins> {
        match self {
            Self::Spheres(_) => None,
            Self::Ellipsoids(_, spins) => Some(spins),
        }
    }

    /// Pairs that act on each other in this step.
    pub(super) fn acting(&self) -> usize {
        match self {
            Self::Spheres(blocks) => blocks.iter().map(Vec::len).sum(),
            Self::Ellipsoids(blocks, _) => blocks.iter().map(Vec::len).sum(),
        }
    }

    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Spheres(blocks) => nested(blocks),
            Self::Ellipsoids(blocks, spins) => {
                nested(blocks) + std::mem::size_of::<Spins>() + spins.bytes()
            }
        }
    }
}

/// What a contact does over velocities.
struct Work {
    rho_rate: [f64; 2],
    /// Heat and work on the pressure, by time.
    power: [f64; 2],
}

impl<T> Active<T> {
    /// Density rates (36), pressure work (59) and half of the viscous heat of (60) each, where the first is at `r` from the
    /// second and moves against it with velocity `v`, and both have these spins.
    #[inline(always)]
    fn over(
        &self,
        normals: &impl Normals,
        (r, v): ([f64; 3], [f64; 3]),
        spins: [[f64; 3]; 2],
    ) -> Work {
        let [first, second] = normals.closings(r, v, spins);
        let closing = -dot(r, v);
        let half = 0.5 * (self.drag * closing - normals.torsion_power(spins));
        Work {
            rho_rate: [self.row[0] * first, self.row[1] * second],
            power: [self.push[0] * first + half, self.push[1] * second + half],
        }
    }
}

/// Members and the pairs of them that might touch.
struct Crowd<'a> {
    list: &'a PairList,
    position: &'a [Vec<f64>; 3],
    members: &'a [u32],
    body: &'a [u16],
    place: &'a [[i16; 3]],
}

impl Crowd<'_> {
    #[inline(always)]
    fn pair(&self, members: [u32; 2]) -> Pair {
        let [a, b] = members.map(|member| member as usize);
        Pair {
            members,
            particles: [self.members[a], self.members[b]],
            bodies: [self.body[a], self.body[b]],
        }
    }

    fn who(&self, member: usize) -> Who {
        let particle = self.members[member] as usize;
        Who { particle, body: self.body[member].into(), place: self.place[member] }
    }

    /// From the second to the first.
    #[inline(always)]
    fn apart(&self, [a, b]: [u32; 2]) -> [f64; 3] {
        let along = |x: &[f64]| x[a as usize] - x[b as usize];
        let [x, y, z] = self.position;
        [along(x), along(y), along(z)]
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
    /// Sees the members.
    fn parts(&mut self) -> (Crowd<'_>, &mut Forces, Option<&Kernel>, &mut [f64]) {
        let Self { list, position, members, body, place, forces, kernel, power, .. } = self;
        (Crowd { list, position, members, body, place }, forces, kernel.as_ref(), power)
    }

    /// The sweep that the paper's scheme removes: density from the positions, if by a kernel.
    pub fn sum_density(&mut self, mesh: &Mesh, state: &State, rho: &mut [f64]) -> u64 {
        let (mut terms, longest) = (std::mem::take(&mut self.terms), self.longest);
        let (crowd, forces, kernel, _) = self.parts();
        let Some(kernel) = kernel else { return 0 };
        let of = (mesh, kernel, (kernel.support() * longest).powi(2));
        let within = match forces {
            Forces::Spheres(_) => kernel_terms(&crowd, &Spheres, of, &mut terms),
            Forces::Ellipsoids(_, spins) => {
                spins.pose(mesh, state, |member| crowd.who(member));
                kernel_terms(&crowd, &**spins, of, &mut terms)
            }
        };
        for &i in crowd.members {
            rho[i as usize] = kernel.value(0.0);
        }
        let pairs = crowd.list.pairs();
        for (&[a, b], term) in pairs.iter().zip(terms.iter().flatten()) {
            rho[crowd.members[a as usize] as usize] += term[0];
            rho[crowd.members[b as usize] as usize] += term[1];
        }
        for (&i, &body) in crowd.members.iter().zip(crowd.body) {
            rho[i as usize] *= kernel.scale(i as usize) * mesh.bodies[body as usize].rho_0;
        }
        self.terms = terms;
        2 * within
    }

    /// Forces, torques, conduction over the last step, of length `dt`, and the marks of touched particles. Viscosity
    /// damps a pair at the rate `most` at most, and a particle at most at [`BEARABLE`] of it: what stops a pair in a kick
    /// needs to be no more viscous. Returns the largest rate at which a particle is damped, where no such rate is
    /// given, and how often a contact was lessened.
    pub fn push(
        &mut self,
        mesh: &Mesh,
        (state, derived): (&State, &Derived),
        (method, dt, most): (&Method, f64, f64),
        (sums, touched, active): (&mut Sums, &mut [bool], &mut [bool]),
    ) -> (f64, u64) {
        let widest = (method.reach() * self.longest).powi(2);
        let volumes = self.volumes;
        let (crowd, forces, kernel, power) = self.parts();
        let view = View { mesh, state, derived, method, kernel, volumes };
        match forces {
            Forces::Spheres(blocks) => {
                view.find(&Spheres, (&crowd, widest), blocks);
                let damped = view.damp((&crowd, blocks), most, &mut sums.rho_rate, |_| {});
                let each = |contact: &mut Active<()>, (pair, r): (&Pair, _), sums: &mut Sums| {
                    let seen = (pair, r, &Spheres);
                    view.work_at_once(contact, seen, [[0.0; 3]; 2], (sums, power));
                    Spheres.force(r, contact.push, contact.drag)
                };
                view.apply((&crowd, blocks), dt, (sums, touched, active), each);
                damped
            }
            Forces::Ellipsoids(blocks, spins) => {
                if spins.asks() {
                    spins.forget_held();
                    for &[a, b] in crowd.list.pairs() {
                        let (r, pair) = (crowd.apart([a, b]), crowd.pair([a, b]));
                        let near = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] < widest;
                        if near && !view.apart(&pair) {
                            spins.want(a);
                            spins.want(b);
                        }
                    }
                }
                spins.pose(mesh, state, |member| crowd.who(member));
                view.find(&**spins, (&crowd, widest), blocks);
                let count = |contact: &Active<Torsion>| {
                    if contact.torque.coefficient > 0.0 {
                        let [a, b] = contact.members;
                        spins.count(a);
                        spins.count(b);
                    }
                };
                let (rate, mut lessened) =
                    view.damp((&crowd, blocks), most, &mut sums.rho_rate, count);
                let each =
                    |contact: &mut Active<Torsion>, (pair, r): (&Pair, _), sums: &mut Sums| {
                        lessened += u64::from(view.ease(contact, pair, most, spins));
                        let [a, b] = contact.members;
                        let poses = [spins.of(a), spins.of(b)];
                        let arms = Arms::new(poses, r, &contact.torque);
                        let both = poses.map(|pose| pose.spin);
                        view.work_at_once(contact, (pair, r, &arms), both, (sums, power));
                        let [one, other] = arms.torques(r, contact.push);
                        spins.twist(a, one);
                        spins.twist(b, other);
                        spins.act(a);
                        spins.act(b);
                        arms.force(r, contact.push, contact.drag)
                    };
                view.apply((&crowd, blocks), dt, (sums, touched, active), each);
                spins.bar(crowd.members);
                spins.couple((mesh, state), crowd.members, |i, force| {
                    sums.fx[i] += force[0];
                    sums.fy[i] += force[1];
                    sums.fz[i] += force[2];
                    touched[i] = true;
                    active[mesh.piece_of(i)] = true;
                });
                (rate, lessened)
            }
        }
    }

    /// Density rates (36), pressure work (59) and viscous heat, the first two terms of Eq. (60) given half to each,
    /// over the mean velocities of the step, which is of length `dt`. A single pass has summed them before.
    pub fn work(
        &mut self,
        mesh: &Mesh,
        mean: impl Fn(usize) -> [f64; 3] + Sync,
        dt: f64,
        out: (&mut [f64], &mut [f64]),
    ) {
        if !self.power.is_empty() {
            let heat = out.1;
            for (&i, power) in self.members.iter().zip(&mut self.power) {
                heat[i as usize] += dt * std::mem::take(power);
            }
            return;
        }
        let (crowd, forces, ..) = self.parts();
        let crowd = (&crowd, mesh);
        match forces {
            Forces::Spheres(blocks) => {
                work(blocks, crowd, (&mean, dt), |_, _| (Spheres, [[0.0; 3]; 2]), out);
            }
            Forces::Ellipsoids(blocks, spins) => {
                spins.settle(mesh, |member| crowd.0.who(member), &mean, dt);
                let posed = |contact: &Active<Torsion>, r| {
                    let [a, b] = contact.members;
                    let poses = [spins.of(a), spins.of(b)];
                    (Arms::new(poses, r, &contact.torque), poses.map(|pose| pose.spin))
                };
                work(blocks, crowd, (&mean, dt), posed, out);
            }
        }
    }

    /// Rotation over the step: a kick and a drift of these lengths, Eqs. (75), (77).
    pub fn turn(&mut self, mesh: &Mesh, lengths: [f64; 2]) {
        let (crowd, forces, ..) = self.parts();
        if let Some(spins) = forces.spins_mut() {
            spins.advance(mesh, |member| crowd.who(member), lengths);
        }
    }
}

/// The terms of the sum over a kernel, pair by pair; nothing of those out of its reach. Returns how many were in it.
fn kernel_terms<S: Shape>(
    crowd: &Crowd<'_>,
    shape: &S,
    (mesh, kernel, widest): (&Mesh, &Kernel, f64),
    terms: &mut Vec<Vec<[f64; 2]>>,
) -> u64 {
    let pairs = crowd.list.pairs();
    terms.resize_with(pairs.len().div_ceil(BLOCK), Vec::new);
    let each = terms.par_iter_mut().zip(pairs.par_chunks(BLOCK)).map(|(terms, pairs)| {
        terms.clear();
        let mut within = 0;
        for &members in pairs {
            let r = crowd.apart(members);
            let near = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] < widest;
            within += u64::from(near);
            put(
                terms,
                if near {
                    let meeting = shape.meet(mesh, &crowd.pair(members), r);
                    meeting.zeta.map(|zeta| kernel.value(zeta))
                } else {
                    [0.0; 2]
                },
            );
        }
        within
    });
    each.sum()
}

/// What contacts do over the mean velocities of a step; `posed` gives how they push, and the spins.
fn work<T, N: Normals>(
    blocks: &Blocks<T>,
    (crowd, mesh): (&Crowd<'_>, &Mesh),
    (mean, dt): (&impl Fn(usize) -> [f64; 3], f64),
    posed: impl Fn(&Active<T>, [f64; 3]) -> (N, [[f64; 3]; 2]),
    (rho_rate, heat): (&mut [f64], &mut [f64]),
) {
    for active in blocks.iter().flatten() {
        let Pair { particles, bodies, .. } = crowd.pair(active.members);
        let [i, j] = particles.map(|k| k as usize);
        let [one, other] = bodies.map(usize::from);
        let drift = mesh.drift_of(one, other);
        let (a, b) = (mean(i), mean(j));
        let v = [a[0] - b[0] + drift[0], a[1] - b[1] + drift[1], a[2] - b[2] + drift[2]];
        let r = crowd.apart(active.members);
        let (normals, spins) = posed(active, r);
        let work = active.over(&normals, (r, v), spins);
        rho_rate[i] += work.rho_rate[0];
        rho_rate[j] += work.rho_rate[1];
        heat[i] += dt * work.power[0];
        heat[j] += dt * work.power[1];
    }
}

/// Bytes that buffers of a buffer hold, and it.
pub(super) fn nested<T>(buffers: &Vec<Vec<T>>) -> usize {
    let each: usize = buffers.iter().map(Vec::capacity).sum();
    each * std::mem::size_of::<T>() + buffers.capacity() * std::mem::size_of::<Vec<T>>()
}

impl View<'_> {
    /// The contacts of a list, those at distances whose square is below `widest`.
    fn find<S: Shape>(
        &self,
        shape: &S,
        (crowd, widest): (&Crowd<'_>, f64),
        blocks: &mut Blocks<S::Torque>,
    ) {
        let pairs = crowd.list.pairs();
        blocks.resize_with(pairs.len().div_ceil(BLOCK), Vec::new);
        blocks.par_iter_mut().zip(pairs.par_chunks(BLOCK)).for_each(|(found, pairs)| {
            found.clear();
            for &members in pairs {
                let r = crowd.apart(members);
                if r[0] * r[0] + r[1] * r[1] + r[2] * r[2] >= widest {
                    continue;
                }
                if let Some(active) = self.contact(shape, &crowd.pair(members), r) {
                    put(found, active);
                }
            }
        });
    }

    /// Adds what contacts do to sums and marks; `each` gives the force on the first, and does whatever more there is.
    fn apply<T: Torque>(
        &self,
        (crowd, blocks): (&Crowd<'_>, &mut Blocks<T>),
        dt: f64,
        (sums, touched, active): (&mut Sums, &mut [bool], &mut [bool]),
        mut each: impl FnMut(&mut Active<T>, (&Pair, [f64; 3]), &mut Sums) -> [f64; 3],
    ) {
        for contact in blocks.iter_mut().flatten() {
            let pair = crowd.pair(contact.members);
            let [i, j] = pair.particles.map(|k| k as usize);
            let f = each(contact, (&pair, crowd.apart(contact.members)), sums);
            sums.fx[i] += f[0];
            sums.fy[i] += f[1];
            sums.fz[i] += f[2];
            sums.fx[j] -= f[0];
            sums.fy[j] -= f[1];
            sums.fz[j] -= f[2];
            sums.heat[i] -= contact.flux * dt;
            sums.heat[j] += contact.flux * dt;
            if self.moves(contact, &pair) {
                active[self.mesh.piece_of(i)] = true;
                active[self.mesh.piece_of(j)] = true;
            }
            touched[i] = true;
            touched[j] = true;
        }
    }

    /// Whether a contact does anything: particles at rest beside each other do not.
    #[inline(always)]
    fn moves<T: Torque>(&self, contact: &Active<T>, pair: &Pair) -> bool {
        let [a, b] = pair.bodies.map(usize::from);
        contact.push != [0.0; 2]
            || contact.drag != 0.0
            || contact.flux != 0.0
            || contact.torque.twists()
            || a != b && self.mesh.bodies[a].velocity != self.mesh.bodies[b].velocity
    }

    /// The work of a contact over the velocities at hand, in the sweep that finds its force: what a single pass has
    /// instead of [`work`]. Density rates go to sums, powers to members until the length of the kick is known.
    #[inline(always)]
    fn work_at_once<T>(
        &self,
        active: &Active<T>,
        (pair, r, normals): (&Pair, [f64; 3], &impl Normals),
        spins: [[f64; 3]; 2],
        (sums, power): (&mut Sums, &mut [f64]),
    ) {
        if power.is_empty() {
            return;
        }
        let [i, j] = pair.particles.map(|k| k as usize);
        let work = active.over(normals, (r, self.velocity(pair)), spins);
        sums.rho_rate[i] += work.rho_rate[0];
        sums.rho_rate[j] += work.rho_rate[1];
        let [a, b] = pair.members.map(|k| k as usize);
        power[a] += work.power[0];
        power[b] += work.power[1];
    }

    /// Whether surfaces keep a pair apart.
    #[inline(always)]
    fn apart(&self, pair: &Pair) -> bool {
        let [particles, bodies] =
            [pair.particles.map(|i| i as usize), pair.bodies.map(usize::from)];
        self.volumes && self.mesh.keeps_apart(particles, bodies)
    }

    /// The contact of a pair at distance `r`, if there is one.
    #[inline]
    fn contact<S: Shape>(&self, shape: &S, pair: &Pair, r: [f64; 3]) -> Option<Active<S::Torque>> {
        let [i, j] = pair.particles.map(|k| k as usize);
        let bodies = pair.bodies.map(usize::from);
        if self.apart(pair) {
            return None;
        }
        let square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        let body = bodies.map(|b| &self.mesh.bodies[b]);
        let widest = body[0].longest.max(body[1].longest) * self.method.reach();
        // Two particles that a corner of walls stops at one point have no direction to part in.
        if square >= widest * widest || square == 0.0 {
            return None;
        }
        let distance = square.sqrt();
        let ratio = [self.derived.rho[i] / body[0].rho_0, self.derived.rho[j] / body[1].rho_0];
        let thin = [0, 1].map(|k| body[k].eos.thinning(ratio[k]));
        // Of the first on the ellipsoid of the second, Eqs. (9), (35), and the other way round.
        let Meeting { zeta, unit } = shape.meet(self.mesh, pair, r);
        let row = |k: usize| match self.kernel {
            None => thin[k] * body[k].rho_0 * self.row((zeta[k], unit[k]), ratio[1 - k]),
            Some(kernel) => {
                let slope = kernel.slope(zeta[k]) / (zeta[k] * unit[k] * unit[k]);
                body[k].rho_0 * kernel.scale([i, j][k]) * slope
            }
        };
        let row = [row(0), row(1)];
        let near = zeta[0].min(zeta[1]) < 1.0;
        if row[0] == 0.0 && row[1] == 0.0 && !near {
            return None;
        }
        let per = |k: usize, i: usize| {
            let rho = self.derived.rho[i];
            row[k] * self.mesh.mass(i) * self.derived.pressure[i] / (rho * rho)
        };
        let push = [per(0, i), per(1, j)];
        let torque = S::Torque::default();
        let mut active = Active { members: pair.members, row, push, drag: 0.0, flux: 0.0, torque };
        if near {
            let impedance = [self.impedance(i, bodies[0]), self.impedance(j, bodies[1])];
            let approach = self.closing(pair, r) / distance;
            if approach > 0.0 {
                let slope = 0.5 * (body[0].slope + body[1].slope);
                let sound = 0.5 * (self.sound(i, bodies[0]) + self.sound(j, bodies[1]));
                let both = 0.5 * (impedance[0] + impedance[1]);
                active.drag =
                    both * self.method.steepness(approach, sound, slope) * approach / distance;
            }
            let area = |i: usize, body: usize| self.mesh.areas[body][self.mesh.share[i] as usize];
            let torsion = impedance[0] * area(i, bodies[0]) + impedance[1] * area(j, bodies[1]);
            active.torque = shape.resist(pair, 0.5 * self.method.visc_linear * torsion);
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

    /// Lessens a viscous torque as [`View::damp`] does forces: they are so much stiffer than those that the printed ones
    /// would ask for a fiftieth of the step. Along every axis a contact takes of the spin of a particle with `n` of them
    /// at most [`BEARABLE`] / `n` in a kick (decision 0021). Tells whether it was less than two thirds of the torque: where
    /// as much was borne as printed.
    #[inline(always)]
    fn ease(&self, contact: &mut Active<Torsion>, pair: &Pair, most: f64, spins: &Spins) -> bool {
        if contact.torque.coefficient <= 0.0 {
            return false;
        }
        let Pair { members: [a, b], particles, bodies } = *pair;
        let crossing = |k: usize| {
            let body = &self.mesh.bodies[usize::from(bodies[k])];
            let sound = self.derived.sound[particles[k] as usize];
            body.solid.sound.max(sound) / (CROSSING * body.edge())
        };
        // No kick is much longer than the vote of sound, unless that jumps.
        let most = if most.is_finite() { most } else { crossing(0).max(crossing(1)) };
        let both = spins.softness(a) + spins.softness(b);
        contact.torque.ease(both.scaled(1.0 / (BEARABLE * most)))
    }

    /// Lessens viscous forces to what stops a pair in a kick, of which `most` is the inverse, and takes [`BEARABLE`] of
    /// its velocity from a particle. Returns what [`Contacts::push`] does. `sums` is nothing before and after: rates of
    /// density, which are summed there, are not known yet. Meets every contact once, for `each` to see.
    fn damp<T>(
        &self,
        (crowd, blocks): (&Crowd<'_>, &mut Blocks<T>),
        most: f64,
        sums: &mut [f64],
        mut each: impl FnMut(&Active<T>),
    ) -> (f64, u64) {
        let (mut rate, mut lessened) = (0.0f64, 0);
        for contact in blocks.iter_mut().flatten() {
            each(contact);
            let damps = contact.drag > 0.0;
            if !damps {
                continue;
            }
            let (pair, r) = (crowd.pair(contact.members), crowd.apart(contact.members));
            let coefficient = contact.drag * dot(r, r) / self.closing(&pair, r);
            let [i, j] = pair.particles.map(|k| k as usize);
            let own = [coefficient / self.mesh.mass(i), coefficient / self.mesh.mass(j)];
            let part = (most / (own[0] + own[1])).min(1.0);
            contact.drag *= part;
            lessened += u64::from(part < 1.0);
            sums[i] += own[0] * part;
            sums[j] += own[1] * part;
            rate = rate.max(sums[i]).max(sums[j]);
        }
        let bearable = BEARABLE * most;
        if rate > bearable {
            for contact in blocks.iter_mut().flatten().filter(|contact| contact.drag > 0.0) {
                let [i, j] = crowd.pair(contact.members).particles.map(|k| k as usize);
                let part = (bearable / sums[i].max(sums[j])).min(1.0);
                contact.drag *= part;
                lessened += u64::from(part < 1.0);
            }
        }
        if rate > 0.0 {
            crowd.members.iter().for_each(|&i| sums[i as usize] = 0.0);
        }
        (if most.is_finite() { 0.0 } else { rate }, lessened)
    }

    /// Closing rate of `r^2 / 2`.
    #[inline(always)]
    fn closing(&self, pair: &Pair, r: [f64; 3]) -> f64 {
        -dot(r, self.velocity(pair))
    }

    /// Velocity of the first against the second.
    #[inline(always)]
    fn velocity(&self, pair: &Pair) -> [f64; 3] {
        let [i, j] = pair.particles.map(|k| k as usize);
        let drift = self.mesh.drift_of(pair.bodies[0].into(), pair.bodies[1].into());
        [
            self.state.vx[i] - self.state.vx[j] + drift[0],
            self.state.vy[i] - self.state.vy[j] + drift[1],
            self.state.vz[i] - self.state.vz[j] + drift[2],
        ]
    }

    /// `3/8 W / (zeta^5 L^2)`, Eqs. (35)-(36), with the unit `L` of a meeting.
    #[inline(always)]
    fn row(&self, (zeta, length): (f64, f64), ratio: f64) -> f64 {
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
