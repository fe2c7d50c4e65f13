//! What contacts keep from step to step, for checkpoints.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::Contacts;
use super::forces::Forces;
use crate::space::lattice::NONE;
use crate::space::mesh::Mesh;
use crate::space::method::Method;
use crate::space::spin::Rigid;

/// What contacts keep from step to step, particle by particle.
pub(in crate::space) struct Memory {
    /// Member that a particle is, or [`NONE`].
    pub(in crate::space) index: Vec<u32>,
    /// Flags of the members.
    pub(in crate::space) flags: Vec<u8>,
    /// Where the members were when the list was made.
    pub(in crate::space) places: [Vec<f64>; 3],
    /// Whether the list is to be made anew.
    pub(in crate::space) stale: bool,
    /// Margin of the list, in contact lengths, and the steps that it has served.
    pub(in crate::space) skin: [f64; 2],
    /// Of particles that rotate on their own: one, Euler parameters and angular momentum in own axes, eight numbers in
    /// all; eight zeros of others. Nothing of spheres.
    pub(in crate::space) rigid: Option<Vec<f64>>,
}

/// The first entry of an index of members, by particle, that cannot be: they are numbered without
/// gaps, and only real particles are members.
pub(in crate::space) fn no_order(mesh: &Mesh, index: &[u32]) -> Option<u32> {
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

/// What is kept of what rotates on its own.
fn numbers(rigid: &Rigid) -> [f64; 8] {
    let (e, h) = (rigid.turn.as_ref(), rigid.momentum);
    [1.0, e.w, e.i, e.j, e.k, h.x, h.y, h.z]
}

/// What rotates on its own by these numbers, to the bit.
fn rigid_of([some, e0, e1, e2, e3, h1, h2, h3]: [f64; 8]) -> Option<Rigid> {
    let turn = UnitQuaternion::new_unchecked(Quaternion::new(e0, e1, e2, e3));
    (some > 0.0).then(|| Rigid { turn, momentum: Vector3::new(h1, h2, h3) })
}

impl Contacts {
    /// What must outlast a restart.
    pub(in crate::space) fn memory(&self) -> Memory {
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
        let rigid = self.forces.spins().map(|spins| {
            let of = |at: &u32| by_particle(at).and_then(|at| spins.rigid(at));
            self.index.iter().flat_map(|at| of(at).map_or([0.0; 8], numbers)).collect()
        });
        let skin = [self.skin, self.served as f64];
        Memory { index: self.index.clone(), flags, places, stale: self.changed, skin, rigid }
    }

    /// The members, and the list as it was made.
    pub(in crate::space) fn recall(&mut self, mesh: &Mesh, memory: &Memory, method: &Method) {
        let (longest, kernel, volumes) = (self.longest, self.kernel.take(), self.volumes);
        let mut forces = Forces::new(mesh, volumes);
        if let (Some(own), Some(before)) = (forces.spins_mut(), self.forces.spins()) {
            own.mirrors_of(before);
        }
        let index = vec![NONE; mesh.len];
        let power = std::mem::take(&mut self.power);
        let [skin, served] = memory.skin;
        *self = Self { index, longest, kernel, volumes, forces, power, skin, ..Self::default() };
        self.served = served as u64;
        let order = in_order(&memory.index);
        self.reserve(mesh.particles.min(order.len() + order.len() / 8));
        for i in order {
            let member = self.admit(mesh, i as usize);
            self.flags[member] = memory.flags[i as usize];
            for (position, places) in self.position.iter_mut().zip(&memory.places) {
                position[member] = places[i as usize];
            }
            if let (Some(spins), Some(rigid)) = (self.forces.spins_mut(), &memory.rigid) {
                spins.recall(member, rigid_of(rigid.as_chunks::<8>().0[i as usize]));
            }
        }
        if memory.stale {
            self.changed = true;
        } else {
            self.renew(mesh, method);
        }
    }
}
