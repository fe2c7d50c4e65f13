//! What surfaces keep from step to step, for checkpoints.

use super::Surfaces;
use super::face::corners_of;
use super::spring::{PLACES, Past, Start};
use crate::space::contacts::Contacts;
use crate::space::mesh::Mesh;

/// Lower half of a number.
const HALF: u64 = 0xffff_ffff;

/// What surfaces keep from step to step, [`Memory::address`] by address; nothing of a scene without them.
pub(in crate::space) struct Memory {
    /// Distance at which the point feels a surface.
    pub(in crate::space) stand: Vec<f64>,
    /// Distance of the surface when it was last looked at.
    pub(in crate::space) distance: Vec<f64>,
    /// Area that the point acted for.
    pub(in crate::space) area: Vec<f64>,
    /// Corners of the face, two in a number, two numbers an address; all bits set for none.
    pub(in crate::space) face: Vec<u64>,
}

impl Memory {
    /// Where a place of a particle stands: first all particles themselves, then the faces of nodes.
    fn address(mesh: &Mesh, particle: usize, place: usize) -> usize {
        if place == 0 { particle } else { mesh.len + (PLACES - 1) * particle + place - 1 }
    }

    /// Particle and place at an address.
    fn place(mesh: &Mesh, at: usize) -> (usize, usize) {
        match at.checked_sub(mesh.len) {
            None => (at, 0),
            Some(rest) => (rest / (PLACES - 1), rest % (PLACES - 1) + 1),
        }
    }

    /// The first face of particles that are none.
    pub(in crate::space) fn no_face(face: &[u64], nodes: usize) -> Option<u64> {
        let none = |pair: u64| pair >> 32 >= nodes as u64 || pair & HALF >= nodes as u64;
        let whole = |pairs: &[u64; 2]| pairs.iter().all(|&pair| pair == u64::MAX);
        let bad = |pairs: &&[u64; 2]| !whole(pairs) && pairs.iter().any(|&pair| none(pair));
        face.as_chunks().0.iter().find(bad).map(|pairs| pairs[0])
    }
}

impl Surfaces {
    /// What must outlast a restart.
    pub(in crate::space) fn memory(&self, mesh: &Mesh, contacts: &Contacts) -> Memory {
        let all = mesh.len + (PLACES - 1) * mesh.first_centroid;
        let places = if self.some { all } else { 0 };
        let mut memory = Memory {
            stand: vec![0.0; places],
            distance: vec![0.0; places],
            area: vec![0.0; places],
            face: vec![u64::MAX; 2 * places],
        };
        let now = self.springs.iter().map(|spring| &spring.past);
        for spring in self.past.iter().chain(now) {
            let slot = spring.slot as usize;
            let first = contacts.member(slot / PLACES).particle;
            let at = Memory::address(mesh, first, slot % PLACES);
            let [a, b, c, d] = spring.face.map(|corner| contacts.particle(corner) as u64);
            memory.stand[at] = spring.stand;
            memory.distance[at] = spring.distance;
            memory.area[at] = spring.area;
            memory.face[2 * at] = a << 32 | b;
            memory.face[2 * at + 1] = c << 32 | d;
        }
        memory
    }

    /// Takes it back.
    pub(in crate::space) fn recall(&mut self, mesh: &Mesh, contacts: &Contacts, memory: &Memory) {
        *self = Self { some: self.some, ..Self::default() };
        for (at, &[low, high]) in memory.face.as_chunks().0.iter().enumerate() {
            let (particle, place) = Memory::place(mesh, at);
            let Some(member) = contacts.find(particle).filter(|_| low != u64::MAX) else {
                continue;
            };
            let slot = (PLACES * member + place) as u32;
            let nodes = [low >> 32, low & HALF, high >> 32, high & HALF].map(|node| node as usize);
            let Some(face) = corners_of(contacts, &nodes) else { continue };
            if Start::at(mesh, contacts, slot).is_some() {
                let (stand, distance) = (memory.stand[at], memory.distance[at]);
                self.past.push(Past { slot, face, distance, stand, area: memory.area[at] });
            }
        }
        self.past.sort_unstable_by_key(|past| past.slot);
    }
}
