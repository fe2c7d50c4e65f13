//! Rotation of ellipsoidal particles. A scene of spheres has none of it.
//!
//! Where elements carry the pressure, particles that they hold follow their rotation (`held.rs`), and those that none
//! holds rotate on their own (`rigid.rs`). By the contact densities, as in the paper, all rotate on their own.

mod held;
mod rigid;

pub use self::rigid::{Rigid, half_lengths, inertia};

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
    /// Of those that rotate on their own.
    rigid: Vec<Option<Rigid>>,
    /// As the present step needs them.
    poses: Vec<Pose>,
    /// Whether the present step needs the pose of a member that is held.
    wanted: Vec<bool>,
    /// Torque in global axes.
    torque: Vec<[f64; 3]>,
    /// Sum of the rates at which contacts damp the spin.
    damping: Vec<f64>,
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

    /// A new member: it rotates with its body.
    pub fn admit(&mut self, mesh: &Mesh, who: Who) {
        let body = &mesh.bodies[who.body];
        let rigid = self.own.then(|| {
            let axes = Rotation3::from_matrix_unchecked(held::columns(body.lattice.axes));
            let turn = UnitQuaternion::from_rotation_matrix(&axes);
            Rigid::spinning(turn, body.spin.into(), &who.inertia(mesh))
        });
        self.rigid.push(rigid);
        self.poses.push(Pose::default());
        self.wanted.push(false);
        self.torque.push([0.0; 3]);
        self.damping.push(0.0);
    }

    /// Makes room for so many more members.
    pub fn reserve(&mut self, n: usize) {
        self.rigid.reserve_exact(n);
        self.poses.reserve_exact(n);
        self.wanted.reserve_exact(n);
        self.torque.reserve_exact(n);
        self.damping.reserve_exact(n);
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

    /// The poses of all that rotate on their own, and of those that were asked for. Particles that elements have let go
    /// begin to rotate on their own, from rest.
    pub fn pose(&mut self, mesh: &Mesh, state: &State, who: impl Fn(usize) -> Who + Sync) {
        let each = self.rigid.par_chunks_mut(BLOCK).zip(self.poses.par_chunks_mut(BLOCK));
        each.zip(self.wanted.par_chunks_mut(BLOCK)).enumerate().for_each(|(block, columns)| {
            let ((rigid, poses), wanted) = columns;
            let each = rigid.iter_mut().zip(poses).zip(wanted).enumerate();
            for (at, ((rigid, pose), wanted)) in each {
                let member = block * BLOCK + at;
                if rigid.is_none() && !std::mem::take(wanted) {
                    continue;
                }
                let who = who(member);
                if rigid.is_none() && !mesh.held(who.particle) {
                    let rotation = held::rotation(mesh, state, who.particle);
                    let turn = UnitQuaternion::from_rotation_matrix(&rotation);
                    *rigid = Some(Rigid { turn, momentum: Vector3::zeros() });
                }
                let (rotation, spin) = match rigid {
                    Some(rigid) => (rigid.turn.into(), rigid.spin(&who.inertia(mesh))),
                    None => {
                        let velocity = |i: usize| [state.vx[i], state.vy[i], state.vz[i]];
                        let spin = held::spin(mesh, state, velocity, who.particle);
                        (held::rotation(mesh, state, who.particle), spin)
                    }
                };
                *pose = Pose { axes: axes(&rotation), spin: spin.into() };
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

    /// Sum of the rates at which contacts damp the spin of a member.
    #[inline(always)]
    pub fn damping(&mut self, member: u32) -> &mut f64 {
        &mut self.damping[member as usize]
    }

    /// Hands the torques on held members on to the corners of their cells: tells of each with the force on it.
    pub fn couple(
        &self,
        mesh: &Mesh,
        state: &State,
        particles: &[u32],
        mut push: impl FnMut(usize, [f64; 3]),
    ) {
        for ((rigid, torque), &i) in self.rigid.iter().zip(&self.torque).zip(particles) {
            if rigid.is_none() && *torque != [0.0; 3] {
                held::couple(mesh, state, (i as usize, *torque), &mut push);
            }
        }
    }

    /// Angular velocity of a member over a kick of half this length on either side, with these mean velocities.
    #[must_use]
    pub fn mean(
        &self,
        (mesh, state): (&Mesh, &State),
        (member, who): (u32, Who),
        velocity: impl Fn(usize) -> [f64; 3],
        kick: f64,
    ) -> [f64; 3] {
        let at = member as usize;
        match &self.rigid[at] {
            None => held::spin(mesh, state, velocity, who.particle).into(),
            Some(rigid) => {
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
        let each = self.rigid.par_chunks_mut(BLOCK).zip(self.torque.par_chunks_mut(BLOCK));
        each.enumerate().for_each(|(block, (rigid, torque))| {
            for (at, (rigid, torque)) in rigid.iter_mut().zip(torque).enumerate() {
                let torque = std::mem::take(torque);
                if let Some(rigid) = rigid {
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
        self.rigid[member].as_ref()
    }

    /// The same, to be set.
    pub fn set(&mut self, member: usize, rigid: Option<Rigid>) {
        self.rigid[member] = rigid;
    }

    /// Axes of a particle that may not be a member, which elements hold.
    #[must_use]
    pub fn held_axes(mesh: &Mesh, state: &State, i: usize) -> [[f64; 3]; 3] {
        axes(&held::rotation(mesh, state, i))
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.rigid.capacity() * std::mem::size_of::<Option<Rigid>>()
            + self.poses.capacity() * std::mem::size_of::<Pose>()
            + self.wanted.capacity()
            + 24 * self.torque.capacity()
            + 8 * self.damping.capacity()
    }
}
