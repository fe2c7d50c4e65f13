//! Rotation of ellipsoidal particles. A scene of spheres has none of it.
//!
//! Where elements carry the pressure, particles that they hold follow their rotation (`held.rs`), and those that none
//! holds rotate on their own (`rigid.rs`). By the contact densities, as in the paper, all rotate on their own.

mod held;
mod mirrors;
mod rigid;

pub use self::rigid::{Rigid, half_lengths, inertia};

use self::held::{Held, Site};
use self::mirrors::{bars, bound, lies_on, mirrors_of};

use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use rayon::prelude::*;

use super::columns::State;
use super::lattice::NONE;
use super::mesh::Mesh;
use super::near::put;
use super::symmetric::Symmetric;

/// Members that one task looks at.
const BLOCK: usize = 1024;

/// How a particle lies and rotates now, as contacts see it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pose {
    /// `H` of Eqs. (10)-(11), with the contact lengths.
    pub metric: Symmetric,
    /// Angular velocity in global axes: that at hand, and once all torques are known that in the middle of the kick. What is
    /// held has the second alone.
    pub spin: [f64; 3],
}

/// The rotation of members of contacts: of those that rotate on their own, and of those that are held as far as the present
/// step needs them. Both stand side by side in places, the free ones first, and a member knows its place.
#[derive(Debug, Clone, Default)]
pub struct Spins {
    /// Whether particles that elements hold rotate on their own too.
    own: bool,
    /// The ellipsoids of the bodies.
    ellipsoids: Vec<PerBody>,
    /// Place of each member, if it has one.
    place: Vec<u32>,
    /// Member in each place.
    members: Vec<u32>,
    /// As contacts see them.
    poses: Vec<Pose>,
    /// Torque in global axes.
    torque: Vec<[f64; 3]>,
    /// What rotates, of the free ones.
    free: Vec<Rigid>,
    /// Inverse of their inertia in global axes.
    softness: Vec<Symmetric>,
    /// Viscous torques that act on each in the present step.
    twisted: Vec<u32>,
    /// How elements hold the others.
    held: Vec<Held>,
    /// Whether a contact of theirs acts.
    acts: Vec<bool>,
    /// Mirrors, by the bits of their axes, on which a particle lies: nothing in a scene without.
    mirrors: Vec<u8>,
    /// Torque that mirrors took in the present step.
    barred: [f64; 3],
    /// Particles that elements let go in the present step, and how they lie.
    leaving: Vec<(u32, UnitQuaternion<f64>)>,
}

/// What all ellipsoids of a body share.
#[derive(Debug, Clone, Copy)]
struct PerBody {
    /// Contact lengths along its axes, as `1 / (2 beta h_k)^2`.
    per_square: [f64; 3],
    /// One over the moments of inertia of a unit of mass.
    per_inertia: [f64; 3],
}

/// A member: its particle, body and place in the lattice.
#[derive(Debug, Clone, Copy)]
pub struct Who {
    /// Particle.
    pub particle: usize,
    /// Body.
    pub body: usize,
    /// Place.
    pub place: [i16; 3],
}

/// Contact lengths of the ellipsoids of a body along their axes.
fn lengths(mesh: &Mesh, body: usize) -> [f64; 3] {
    let body = &mesh.bodies[body];
    body.ellipsoid.unwrap_or([body.length; 3])
}

impl Who {
    /// Of a particle.
    #[must_use]
    pub fn of(mesh: &Mesh, particle: usize) -> Self {
        let (body, place) = mesh.place(particle);
        Self { particle, body, place }
    }

    /// Its moments of inertia.
    #[must_use]
    pub fn inertia(&self, mesh: &Mesh) -> Vector3<f64> {
        inertia(mesh.mass(self.particle), lengths(mesh, self.body))
    }

    /// Where it lies.
    fn site(&self, mirrors: &[u8]) -> Site {
        let mirrors = mirrors_of(mirrors, self.particle);
        Site { body: self.body, place: self.place, mirrors }
    }
}

impl Spins {
    /// Of a mesh in which elements carry the pressure, or not; nothing of one of spheres.
    #[must_use]
    pub fn new(mesh: &Mesh, volumes: bool) -> Option<Self> {
        let some = mesh.bodies.iter().any(|body| body.ellipsoid.is_some());
        let ellipsoids = (0..mesh.bodies.len()).map(|body| {
            let lengths = lengths(mesh, body);
            PerBody {
                per_square: lengths.map(|length| 1.0 / (length * length)),
                per_inertia: inertia(1.0, lengths).map(|j| 1.0 / j).into(),
            }
        });
        some.then(|| Self { own: !volumes, ellipsoids: ellipsoids.collect(), ..Self::default() })
    }

    /// Particles lie on a mirror normal to an axis: images of theirs bear the torques about axes in it, and they have no spin
    /// about such an axis, what lies askew none at all. `find` gives the member that a particle is.
    pub fn mirror(
        &mut self,
        (mesh, axis): (&Mesh, usize),
        particles: &[u32],
        find: impl Fn(usize) -> Option<usize>,
    ) {
        self.mirrors.resize(mesh.len, 0);
        for i in particles.iter().map(|&i| i as usize) {
            self.mirrors[i] |= 1 << axis;
            if let Some(rigid) = find(i).and_then(|at| self.free.get_mut(self.place[at] as usize)) {
                bound(rigid, self.mirrors[i]);
            }
        }
    }

    /// Goes on with the mirrors of another.
    pub fn mirrors_of(&mut self, other: &Self) {
        self.mirrors.clone_from(&other.mirrors);
    }

    /// A new member: where all rotate on their own, it does so with its body.
    pub fn admit(&mut self, mesh: &Mesh, who: Who) {
        let member = self.place.len();
        self.place.push(NONE);
        if self.own {
            let body = &mesh.bodies[who.body];
            let axes = Rotation3::from_matrix_unchecked(held::columns(body.lattice.axes));
            let turn = UnitQuaternion::from_rotation_matrix(&axes);
            self.set_free(member, Rigid::spinning(turn, body.spin.into(), &who.inertia(mesh)));
        }
    }

    /// Makes room for so many more members.
    pub fn reserve(&mut self, n: usize) {
        self.place.reserve_exact(n);
        if self.own {
            self.members.reserve_exact(n);
            self.poses.reserve_exact(n);
            self.torque.reserve_exact(n);
            self.free.reserve_exact(n);
            self.softness.reserve_exact(n);
            self.twisted.reserve_exact(n);
        }
    }

    /// A member rotates on its own from now on. Nothing is known any more of those that are held.
    pub fn set_free(&mut self, member: usize, rigid: Rigid) {
        self.forget_held();
        self.place[member] = self.free.len() as u32;
        put(&mut self.members, member as u32);
        put(&mut self.poses, Pose::default());
        put(&mut self.torque, [0.0; 3]);
        put(&mut self.free, rigid);
        put(&mut self.softness, Symmetric::default());
        put(&mut self.twisted, 0);
    }

    /// Puts in what rotated of a member, if it did so on its own.
    pub fn recall(&mut self, member: usize, rigid: Option<Rigid>) {
        match rigid {
            Some(rigid) if self.own => self.free[member] = rigid,
            Some(rigid) => self.set_free(member, rigid),
            None => {}
        }
    }

    /// A new step: nothing is known of those that are held.
    pub fn forget_held(&mut self) {
        let free = self.free.len();
        for &member in &self.members[free..] {
            self.place[member as usize] = NONE;
        }
        self.members.truncate(free);
        self.poses.truncate(free);
        self.torque.truncate(free);
        self.held.clear();
        self.acts.clear();
    }

    /// Whether poses of held members are to be asked for.
    #[must_use]
    pub fn asks(&self) -> bool {
        !self.own
    }

    /// Asks for the pose of a member in this step.
    #[inline(always)]
    pub fn want(&mut self, member: u32) {
        let place = &mut self.place[member as usize];
        if *place == NONE {
            *place = self.members.len() as u32;
            put(&mut self.members, member);
            put(&mut self.poses, Pose::default());
            put(&mut self.torque, [0.0; 3]);
            put(&mut self.held, Held::default());
            put(&mut self.acts, false);
        }
    }

    /// A contact of a member acts: its spin in the middle of the kick will be asked for.
    #[inline(always)]
    pub fn act(&mut self, member: u32) {
        let place = self.place[member as usize] as usize;
        if place >= self.free.len() {
            self.acts[place - self.free.len()] = true;
        }
    }

    /// Notes how a particle lies before elements round it die.
    pub fn part(&mut self, mesh: &Mesh, state: &State, i: usize) {
        let held = Who::of(mesh, i).site(&self.mirrors).hold(mesh, state);
        let axes = Rotation3::from_matrix_unchecked(held::columns(held.axes));
        self.leaving.push((i as u32, UnitQuaternion::from_rotation_matrix(&axes)));
    }

    /// What was noted and no element holds any more begins to rotate on its own, from rest; `find` gives the member that a
    /// particle is.
    pub fn let_go(&mut self, mesh: &Mesh, find: impl Fn(usize) -> Option<usize>) {
        while let Some((i, turn)) = self.leaving.pop() {
            let i = i as usize;
            let member = find(i).filter(|_| !mesh.held(i));
            if let Some(member) = member.filter(|&member| !self.is_free(member as u32)) {
                self.set_free(member, Rigid { turn, momentum: Vector3::zeros() });
            }
        }
    }

    /// The poses of all that rotate on their own, and of those that were asked for; forgets the viscous torques.
    pub fn pose(&mut self, mesh: &Mesh, state: &State, who: impl Fn(usize) -> Who + Sync) {
        self.twisted.fill(0);
        let Self { members, poses, free, softness, held, ellipsoids, mirrors, .. } = self;
        let (poses, held_poses) = poses.split_at_mut(free.len());
        let (members, held_members) = members.split_at(free.len());
        let who = |member: &u32| who(*member as usize);
        let each = free.par_chunks(BLOCK).zip(members.par_chunks(BLOCK));
        let each = each.zip(poses.par_chunks_mut(BLOCK).zip(softness.par_chunks_mut(BLOCK)));
        each.for_each(|((free, members), (poses, softness))| {
            let each = free.iter().zip(members).zip(poses.iter_mut().zip(softness));
            for ((rigid, member), (pose, softness)) in each {
                let who = who(member);
                let PerBody { per_square, per_inertia } = ellipsoids[who.body];
                let per_mass = 1.0 / mesh.mass(who.particle);
                let axes = rigid.axes();
                pose.metric = Symmetric::along(&axes, per_square);
                *softness = Symmetric::along(&axes, per_inertia).scaled(per_mass);
                pose.spin = softness.times((rigid.turn * rigid.momentum).into());
            }
        });
        let each = held.par_chunks_mut(BLOCK).zip(held_members.par_chunks(BLOCK));
        each.zip(held_poses.par_chunks_mut(BLOCK)).for_each(|((held, members), poses)| {
            for ((held, member), pose) in held.iter_mut().zip(members).zip(poses) {
                let who = who(member);
                let PerBody { per_square, .. } = ellipsoids[who.body];
                *held = who.site(mirrors).hold(mesh, state);
                pose.metric = Symmetric::along(&held.axes, per_square);
            }
        });
    }

    /// Pose of a member in this step: one that rotates on its own or was asked for.
    #[inline(always)]
    #[must_use]
    pub fn of(&self, member: u32) -> &Pose {
        &self.poses[self.place[member as usize] as usize]
    }

    /// Adds a torque in global axes.
    #[inline(always)]
    pub fn twist(&mut self, member: u32, torque: [f64; 3]) {
        let own = &mut self.torque[self.place[member as usize] as usize];
        own[0] += torque[0];
        own[1] += torque[1];
        own[2] += torque[2];
    }

    /// Counts a viscous torque on a member that rotates on its own.
    #[inline(always)]
    pub fn count(&mut self, member: u32) {
        self.twisted[self.place[member as usize] as usize] += 1;
    }

    /// What the viscous torques on such a member meet: the inverse of its inertia in global axes, times their number.
    #[inline(always)]
    #[must_use]
    pub fn softness(&self, member: u32) -> Symmetric {
        let place = self.place[member as usize] as usize;
        self.softness[place].scaled(self.twisted[place].into())
    }

    /// Whether it rotates on its own.
    #[inline(always)]
    #[must_use]
    pub fn is_free(&self, member: u32) -> bool {
        self.own || (self.place[member as usize] as usize) < self.free.len()
    }

    /// Takes from particles on mirrors the torques about axes in these, which those of their images cancel; from what lies
    /// askew all.
    pub fn bar(&mut self, particles: &[u32]) {
        self.barred = [0.0; 3];
        if self.mirrors.is_empty() {
            return;
        }
        // By members, whose order no restart changes.
        let some = self.place.iter().zip(particles).filter(|(place, _)| **place != NONE);
        for (&place, &i) in some {
            let mirrors = mirrors_of(&self.mirrors, i as usize);
            let free = self.free.get(place as usize).filter(|_| mirrors != 0);
            let tilted = free.is_some_and(|rigid| !lies_on(rigid, mirrors));
            for (d, torque) in self.torque[place as usize].iter_mut().enumerate() {
                if tilted || bars(mirrors, d) {
                    self.barred[d] += std::mem::take(torque);
                }
            }
        }
    }

    /// Torque that mirrors took in the present step.
    #[must_use]
    pub fn barred(&self) -> [f64; 3] {
        self.barred
    }

    /// Hands the torques on held members on to the corners of their cells: tells of each with the force on it.
    pub fn couple(
        &mut self,
        (mesh, state): (&Mesh, &State),
        particles: &[u32],
        mut push: impl FnMut(usize, [f64; 3]),
    ) {
        let others = self.free.len()..;
        let each = self.members[others.clone()].iter().zip(&self.torque[others]);
        for ((&member, torque), held) in each.zip(&self.held) {
            if *torque != [0.0; 3] {
                let site = Who::of(mesh, particles[member as usize] as usize).site(&self.mirrors);
                let given = site.couple((mesh, state), (held, *torque), &mut push);
                if site.mirrors != 0 {
                    for (d, barred) in self.barred.iter_mut().enumerate() {
                        *barred += torque[d] - given[d];
                    }
                }
            }
        }
    }

    /// The spins in the middle of a kick of this length, with these mean velocities: of all that rotate on their own, and of
    /// those of which a contact acts.
    pub fn settle(
        &mut self,
        mesh: &Mesh,
        who: impl Fn(usize) -> Who + Sync,
        velocity: impl Fn(usize) -> [f64; 3] + Sync,
        kick: f64,
    ) {
        let Self { members, poses, torque, free, softness, held, acts, mirrors, .. } = self;
        let (poses, held_poses) = poses.split_at_mut(free.len());
        let each = poses.par_chunks_mut(BLOCK).zip(softness.par_chunks(BLOCK));
        each.zip(torque.par_chunks(BLOCK)).for_each(|((poses, softness), torque)| {
            for ((pose, softness), torque) in poses.iter_mut().zip(softness).zip(torque) {
                let change = softness.times(*torque);
                pose.spin[0] += 0.5 * kick * change[0];
                pose.spin[1] += 0.5 * kick * change[1];
                pose.spin[2] += 0.5 * kick * change[2];
            }
        });
        let each = held.par_chunks(BLOCK).zip(members[free.len()..].par_chunks(BLOCK));
        let each = each.zip(held_poses.par_chunks_mut(BLOCK).zip(acts.par_chunks(BLOCK)));
        each.for_each(|((held, members), (poses, acts))| {
            let each = held.iter().zip(members).zip(poses.iter_mut().zip(acts));
            for ((held, member), (pose, _)) in each.filter(|(_, (_, acts))| **acts) {
                let site = who(*member as usize).site(mirrors);
                pose.spin = site.spin(mesh, &velocity, held);
            }
        });
    }

    /// Gives those that rotate on their own the angular impulse of a kick, Eq. (75), and rotates them over a drift,
    /// Eq. (77).
    pub fn advance(
        &mut self,
        mesh: &Mesh,
        who: impl Fn(usize) -> Who + Sync,
        [kick, drift]: [f64; 2],
    ) {
        let Self { members, torque, free, ellipsoids, mirrors, .. } = self;
        let each = free.par_chunks_mut(BLOCK).zip(members.par_chunks(BLOCK));
        each.zip(torque.par_chunks_mut(BLOCK)).for_each(|((free, members), torque)| {
            for ((rigid, member), torque) in free.iter_mut().zip(members).zip(torque) {
                let torque = std::mem::take(torque);
                if torque != [0.0; 3] {
                    rigid.kick(&(kick * Vector3::from(torque)));
                }
                if rigid.momentum != Vector3::zeros() {
                    let who = who(*member as usize);
                    let per_inertia = Vector3::from(ellipsoids[who.body].per_inertia);
                    let softness = per_inertia / mesh.mass(who.particle);
                    match mirrors_of(mirrors, who.particle) {
                        0 => rigid.rotate(&softness, drift),
                        one => rigid.rotate_about(one.trailing_zeros() as usize, &softness, drift),
                    }
                }
            }
        });
    }

    /// What rotates of a member, if it does so on its own.
    #[must_use]
    pub fn rigid(&self, member: usize) -> Option<&Rigid> {
        self.free.get(self.place[member] as usize)
    }

    /// Axes of a particle that may not be a member, which elements hold.
    #[must_use]
    pub fn held_axes(&self, mesh: &Mesh, state: &State, i: usize) -> [[f64; 3]; 3] {
        Who::of(mesh, i).site(&self.mirrors).hold(mesh, state).axes
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        4 * (self.place.capacity() + self.members.capacity() + self.twisted.capacity())
            + self.poses.capacity() * std::mem::size_of::<Pose>()
            + 24 * self.torque.capacity()
            + self.free.capacity() * std::mem::size_of::<Rigid>()
            + self.softness.capacity() * std::mem::size_of::<Symmetric>()
            + self.held.capacity() * std::mem::size_of::<Held>()
            + self.acts.capacity()
            + self.ellipsoids.capacity() * std::mem::size_of::<PerBody>()
            + self.mirrors.capacity()
            + self.leaving.capacity() * std::mem::size_of::<(u32, UnitQuaternion<f64>)>()
    }
}
