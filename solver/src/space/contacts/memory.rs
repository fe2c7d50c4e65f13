//! What contacts keep from step to step, for checkpoints.

use super::Contacts;
use crate::space::lattice::NONE;
use crate::space::mesh::Mesh;
use crate::space::method::Method;

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
        Memory { index: self.index.clone(), flags, places, stale: self.changed }
    }

    /// The members, and the list as it was made.
    pub(in crate::space) fn recall(&mut self, mesh: &Mesh, memory: &Memory, method: &Method) {
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
}
