//! Rotation of ellipsoidal particles. A scene of spheres has none of it.
//!
//! Where elements carry the pressure, particles that they hold follow their rotation (`held.rs`), and those that none
//! holds rotate on their own (`rigid.rs`). By the contact densities, as in the paper, all rotate on their own.

mod held;
mod rigid;

pub use self::rigid::{Rigid, half_lengths, inertia};

use self::held::Lever;
use self::rigid::axes;

use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use rayon::prelude::*;

use super::columns::State;
use super::mesh::Mesh;

/// Members that one task looks at.
const BLOCK: usize = 1024;

/// How a particle lies and rotates now.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pose {
    /// Its axes, in global ones.
    pub axes: [[f64; 3]; 3],
    /// Angular velocity in global axes.
    pub spin: [f64; 3],
}

/// The rotation of the members of contacts, member by member.
#[derive(Debug, Clone, Default)]
pub struct Spins {
    /// Whether particles that elements hold rotate on their own too.
    own: bool,
    /// What turns each.
    turning: Vec<Turning>,
    /// As the present step needs them.
    poses: Vec<Pose>,
    /// Whether the present step needs the pose of a member that is held.
    wanted: Vec<bool>,
    /// Torque in global axes.
    torque: Vec<[f64; 3]>,
    /// Viscous torques that act on it in the present step.
    twisted: Vec<u32>,
    /// Mirrors, by the bits of their axes, on which a particle lies: nothing in a scene without.
    mirrors: Vec<u8>,
    /// Torque that mirrors took in the present step.
    barred: [f64; 3],
    /// Particles that elements let go in the present step, and how they lie.
    leaving: Vec<(u32, UnitQuaternion<f64>)>,
}

/// What turns a member.
#[derive(Debug, Clone, Copy)]
enum Turning {
    /// The live elements round it; the lever is that of the last step that asked for it.
    Held(Lever),
    /// Its own angular momentum.
    Free(Rigid),
}

/// A member: its particle and body.
#[derive(Debug, Clone, Copy)]
pub struct Who {
    /// Particle.
    pub particle: usize,
    /// Body.
    pub body: usize,
}

impl Who {
    /// Contact lengths of its ellipsoid along its axes.
    #[inline(always)]
    #[must_use]
    pub fn lengths(&self, mesh: &Mesh) -> [f64; 3] {
        let body = &mesh.bodies[self.body];
        body.ellipsoid.unwrap_or([body.length; 3])
    }

    /// Its moments of inertia.
    #[must_use]
    pub fn inertia(&self, mesh: &Mesh) -> Vector3<f64> {
        inertia(mesh.mass(self.particle), self.lengths(mesh))
    }
}

impl Spins {
    /// Of a mesh in which elements carry the pressure, or not; nothing of one of spheres.
    #[must_use]
    pub fn new(mesh: &Mesh, volumes: bool) -> Option<Self> {
        let some = mesh.bodies.iter().any(|body| body.ellipsoid.is_some());
        some.then(|| Self { own: !volumes, ..Self::default() })
    }

    /// Particles lie on a mirror normal to an axis: images of theirs bear the torques about axes in it.
    pub fn mirror(&mut self, mesh: &Mesh, axis: usize, particles: &[u32]) {
        self.mirrors.resize(mesh.len, 0);
        particles.iter().for_each(|&i| self.mirrors[i as usize] |= 1 << axis);
    }

    fn mirrors_of(&self, i: usize) -> u8 {
        mirrors_of(&self.mirrors, i)
    }

    /// A new member: it rotates with its body.
    pub fn admit(&mut self, mesh: &Mesh, who: Who) {
        let body = &mesh.bodies[who.body];
        let turning = if self.own {
            let axes = Rotation3::from_matrix_unchecked(held::columns(body.lattice.axes));
            let turn = UnitQuaternion::from_rotation_matrix(&axes);
            Turning::Free(Rigid::spinning(turn, body.spin.into(), &who.inertia(mesh)))
        } else {
            Turning::Held(Lever::default())
        };
        self.turning.push(turning);
        self.poses.push(Pose::default());
        self.wanted.push(false);
        self.torque.push([0.0; 3]);
        self.twisted.push(0);
    }

    /// Makes room for so many more members.
    pub fn reserve(&mut self, n: usize) {
        self.turning.reserve_exact(n);
        self.poses.reserve_exact(n);
        self.wanted.reserve_exact(n);
        self.torque.reserve_exact(n);
        self.twisted.reserve_exact(n);
    }

    /// Whether poses of held members are to be asked for.
    #[must_use]
    pub fn asks(&self) -> bool {
        !self.own
    }

    /// Asks for the pose of a member in this step.
    #[inline(always)]
    pub fn want(&mut self, member: usize) {
        self.wanted[member] = true;
    }

    /// Notes how a particle lies before elements round it die.
    pub fn part(&mut self, mesh: &Mesh, state: &State, i: usize) {
        let held = held::hold(mesh, state, (i, self.mirrors_of(i)));
        self.leaving.push((i as u32, UnitQuaternion::from_rotation_matrix(&held.rotation)));
    }

    /// What was noted and no element holds any more begins to rotate on its own, from rest; `find` gives the member that a
    /// particle is.
    pub fn let_go(&mut self, mesh: &Mesh, find: impl Fn(usize) -> Option<usize>) {
        for (i, turn) in self.leaving.drain(..) {
            let i = i as usize;
            if let Some(member) = find(i).filter(|_| !mesh.held(i)) {
                self.turning[member] = Turning::Free(Rigid { turn, momentum: Vector3::zeros() });
            }
        }
    }

    /// The poses of all that rotate on their own, and of those that were asked for.
    pub fn pose(&mut self, mesh: &Mesh, state: &State, who: impl Fn(usize) -> Who + Sync) {
        let mirrors = &self.mirrors;
        let each = self.turning.par_chunks_mut(BLOCK).zip(self.poses.par_chunks_mut(BLOCK));
        each.zip(self.wanted.par_chunks_mut(BLOCK)).enumerate().for_each(|(block, columns)| {
            let ((turning, poses), wanted) = columns;
            let each = turning.iter_mut().zip(poses).zip(wanted).enumerate();
            for (at, ((turning, pose), wanted)) in each {
                let wanted = std::mem::take(wanted);
                let who = who(block * BLOCK + at);
                match turning {
                    Turning::Free(rigid) => {
                        pose.axes = rigid.axes();
                        pose.spin = rigid.spin(&who.inertia(mesh)).into();
                    }
                    Turning::Held(lever) if wanted => {
                        let own = (who.particle, mirrors_of(mirrors, who.particle));
                        let held = held::hold(mesh, state, own);
                        let velocity = |i: usize| [state.vx[i], state.vy[i], state.vz[i]];
                        pose.axes = axes(&held.rotation);
                        *lever = held.lever;
                        pose.spin = held::spin(mesh, velocity, own, (&pose.axes, lever)).into();
                    }
                    Turning::Held(_) => {}
                }
            }
        });
    }

    /// Pose of a member in this step.
    #[inline(always)]
    #[must_use]
    pub fn of(&self, member: u32) -> &Pose {
        &self.poses[member as usize]
    }

    /// Adds a torque in global axes.
    #[inline(always)]
    pub fn twist(&mut self, member: u32, torque: [f64; 3]) {
        for (own, torque) in self.torque[member as usize].iter_mut().zip(torque) {
            *own += torque;
        }
    }

    /// Counts a viscous torque on a member.
    #[inline(always)]
    pub fn count(&mut self, member: u32) {
        self.twisted[member as usize] += 1;
    }

    /// Number of viscous torques on a member.
    #[inline(always)]
    #[must_use]
    pub fn twisted(&self, member: u32) -> f64 {
        self.twisted[member as usize].into()
    }

    /// Forgets their number.
    #[inline(always)]
    pub fn forget(&mut self, member: u32) {
        self.twisted[member as usize] = 0;
    }

    /// Takes from particles on mirrors the torques about axes in these, which those of their images cancel.
    pub fn bar(&mut self, particles: &[u32]) {
        self.barred = [0.0; 3];
        if self.mirrors.is_empty() {
            return;
        }
        for (torque, &i) in self.torque.iter_mut().zip(particles) {
            let mirrors = mirrors_of(&self.mirrors, i as usize);
            for (d, torque) in torque.iter_mut().enumerate() {
                // A mirror normal to another axis.
                if mirrors & !(1 << d) != 0 {
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
        let each = self.turning.iter().zip(&self.poses).zip(self.torque.iter().zip(particles));
        for ((turning, pose), (torque, &i)) in each {
            if let Turning::Held(lever) = turning
                && *torque != [0.0; 3]
            {
                let mirrors = mirrors_of(&self.mirrors, i as usize);
                let own = (i as usize, mirrors, *torque);
                let given = held::couple((mesh, state), own, (&pose.axes, lever), &mut push);
                if mirrors != 0 {
                    for (d, barred) in self.barred.iter_mut().enumerate() {
                        *barred += torque[d] - given[d];
                    }
                }
            }
        }
    }

    /// Angular velocity of a member over a kick of half this length on either side, with these mean velocities.
    #[must_use]
    pub fn mean(
        &self,
        mesh: &Mesh,
        (member, who): (u32, Who),
        velocity: impl Fn(usize) -> [f64; 3],
        kick: f64,
    ) -> [f64; 3] {
        let at = member as usize;
        match &self.turning[at] {
            Turning::Held(lever) => {
                let own = (who.particle, self.mirrors_of(who.particle));
                held::spin(mesh, velocity, own, (&self.poses[at].axes, lever)).into()
            }
            Turning::Free(rigid) => {
                let mut half = *rigid;
                half.kick(&(0.5 * kick * Vector3::from(self.torque[at])));
                half.spin(&who.inertia(mesh)).into()
            }
        }
    }

    /// Gives members the angular impulse of a kick, Eq. (75), and rotates them over a drift, Eq. (77).
    pub fn advance(
        &mut self,
        mesh: &Mesh,
        who: impl Fn(usize) -> Who + Sync,
        [kick, drift]: [f64; 2],
    ) {
        let each = self.turning.par_chunks_mut(BLOCK).zip(self.torque.par_chunks_mut(BLOCK));
        each.enumerate().for_each(|(block, (turning, torque))| {
            for (at, (turning, torque)) in turning.iter_mut().zip(torque).enumerate() {
                let torque = std::mem::take(torque);
                if let Turning::Free(rigid) = turning {
                    if torque != [0.0; 3] {
                        rigid.kick(&(kick * Vector3::from(torque)));
                    }
                    if rigid.momentum != Vector3::zeros() {
                        rigid.rotate(&who(block * BLOCK + at).inertia(mesh), drift);
                    }
                }
            }
        });
    }

    /// What rotates of a member, if it does so on its own.
    #[must_use]
    pub fn rigid(&self, member: usize) -> Option<&Rigid> {
        match &self.turning[member] {
            Turning::Held(_) => None,
            Turning::Free(rigid) => Some(rigid),
        }
    }

    /// The same, to be set.
    pub fn set(&mut self, member: usize, rigid: Option<Rigid>) {
        self.turning[member] = rigid.map_or(Turning::Held(Lever::default()), Turning::Free);
    }

    /// Axes of a particle that may not be a member, which elements hold.
    #[must_use]
    pub fn held_axes(&self, mesh: &Mesh, state: &State, i: usize) -> [[f64; 3]; 3] {
        axes(&held::hold(mesh, state, (i, self.mirrors_of(i))).rotation)
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.turning.capacity() * std::mem::size_of::<Turning>()
            + self.poses.capacity() * std::mem::size_of::<Pose>()
            + self.wanted.capacity()
            + 24 * self.torque.capacity()
            + 4 * self.twisted.capacity()
            + self.mirrors.capacity()
            + self.leaving.capacity() * std::mem::size_of::<(u32, UnitQuaternion<f64>)>()
    }
}

/// Mirrors that a particle lies on.
fn mirrors_of(mirrors: &[u8], i: usize) -> u8 {
    mirrors.get(i).copied().unwrap_or(0)
}
