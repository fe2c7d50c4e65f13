//! The live surfaces that stand in front of each other: where springs may start, and the faces that they
//! may end on. They are found with the list of pairs, for as long as that serves.

use super::face::{Corners, corners_of, each_face};
use super::meet;
use super::spring::Start;
use crate::space::contacts::Contacts;
use crate::space::lattice::NONE;
use crate::space::mesh::Mesh;
use crate::space::near::{put, roomy};

/// Nothing found yet.
const UNKNOWN: u32 = u32::MAX;

/// End of the faces round a node.
const END: Corners = [NONE; 4];

/// A place where springs may start, and what stands in front of each of its corners.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lookout {
    pub(super) start: Start,
    /// Of each corner, its number among those that have something in front of them.
    ahead: Corners,
    /// The same of one that has, for those that have not.
    first: u32,
}

/// Surfaces in front of each other.
#[derive(Debug, Clone, Default)]
pub(super) struct Shell {
    /// Changes of the list of pairs that are known.
    known: Option<u64>,
    /// Members and the nodes of other bodies' live surfaces in front of them, in order.
    ways: Vec<[u32; 2]>,
    /// The nearest of the nodes, member by member.
    nearest: Vec<u32>,
    /// In the order of their places.
    pub(super) lookouts: Vec<Lookout>,
    /// Where the faces round a member begin.
    round: Vec<u32>,
    faces: Vec<Corners>,
}

impl Shell {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        8 * self.ways.capacity()
            + 4 * (self.nearest.capacity() + self.round.capacity())
            + self.lookouts.capacity() * std::mem::size_of::<Lookout>()
            + 16 * self.faces.capacity()
    }

    /// Follows the members to their present positions.
    pub(super) fn follow(&mut self, mesh: &Mesh, contacts: &Contacts) {
        if self.known != Some(contacts.changes()) {
            self.known = Some(contacts.changes());
            self.find_ways(mesh, contacts);
            self.find_lookouts(mesh, contacts);
            self.round.clear();
            roomy(&mut self.round, contacts.members());
            self.round.resize(contacts.members(), UNKNOWN);
            self.faces.clear();
        }
        let Self { ways, nearest, round, faces, .. } = self;
        nearest.clear();
        for ways in ways.chunk_by(|a, b| a[0] == b[0]) {
            let own = contacts.position(ways[0][0]);
            let mut best = (f64::INFINITY, NONE);
            for &[_, node] in ways {
                let other = contacts.position(node);
                let square: f64 = (0..3).map(|d| (own[d] - other[d]).powi(2)).sum();
                if square < best.0 {
                    best = (square, node);
                }
            }
            put(nearest, best.1);
            if let Some(round) = round.get_mut(best.1 as usize).filter(|at| **at == UNKNOWN) {
                *round = faces.len() as u32;
                let node = contacts.member(best.1 as usize);
                each_face(mesh, node.body, node.place, |nodes, _| {
                    if let Some(corners) = corners_of(contacts, &nodes) {
                        put(faces, corners);
                    }
                });
                put(faces, END);
            }
        }
    }

    /// The faces that a point of a lookout may see, and their body.
    #[inline(always)]
    pub(super) fn seen<'a>(
        &'a self,
        contacts: &Contacts,
        lookout: &Lookout,
        point: usize,
    ) -> Option<(impl Iterator<Item = Corners> + Clone + use<'a>, usize)> {
        let ahead = lookout.ahead[point];
        let ahead = if ahead == NONE { lookout.first } else { ahead };
        let node = self.nearest[ahead as usize];
        let round = *self.round.get(node as usize)?;
        let faces = self.faces[round as usize..].iter().copied();
        let body = contacts.member(node as usize).body;
        Some((faces.take_while(|face| *face != END), body))
    }

    /// Finds who stands in front of whom.
    fn find_ways(&mut self, mesh: &Mesh, contacts: &Contacts) {
        self.ways.clear();
        for [a, b] in contacts.exposed_pairs() {
            let particles = [a, b].map(|at| contacts.particle(at));
            if meet(mesh, particles, [a, b].map(|at| contacts.body(at))) {
                let held = particles.map(|i| mesh.held(i));
                for (way, _) in [([a, b], held[1]), ([b, a], held[0])].iter().filter(|way| way.1) {
                    put(&mut self.ways, *way);
                }
            }
        }
        self.ways.sort_unstable();
    }

    /// Finds where springs may start: at loose particles, and at faces with a corner in front of something.
    fn find_lookouts(&mut self, mesh: &Mesh, contacts: &Contacts) {
        let Self { ways, lookouts, nearest, .. } = self;
        // For now the members in front of something themselves.
        nearest.clear();
        ways.chunk_by(|a, b| a[0] == b[0]).for_each(|ways| put(nearest, ways[0][0]));
        lookouts.clear();
        let find = |corner: u32| nearest.binary_search(&corner).map_or(NONE, |at| at as u32);
        for (first, &member) in (0..).zip(&*nearest) {
            let one = contacts.member(member as usize);
            if !mesh.held(one.particle) {
                let start = Start::loose(member as usize, one.body);
                put(lookouts, Lookout { start, ahead: [first; 4], first });
                continue;
            }
            each_face(mesh, one.body, one.place, |nodes, side| {
                let Some(corners) = corners_of(contacts, &nodes) else { return };
                let ahead = corners.map(find);
                // Of the corners in front of something the first looks after the face.
                if ahead.iter().find(|&&at| at != NONE) == Some(&first) {
                    let start = Start::face(corners, side / 2, one.body);
                    put(lookouts, Lookout { start, ahead, first });
                }
            });
        }
        lookouts.sort_unstable_by_key(|lookout| lookout.start.slot);
    }
}
