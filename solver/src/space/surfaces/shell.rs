//! The live surfaces that stand in front of each other: where springs may start, and the faces that they
//! may end on. What may ever be in reach is found with the list of pairs, for as long as that serves; what
//! is, by the present positions alone, so that nothing depends on when the list was made.

use super::face::{
    Corners, Nearest, Part, corners_of, dot, each_face, is_rim, nearest_face, places_of,
};
use super::spring::{Spring, Start};
use crate::space::contacts::{Contacts, SIGHT};
use crate::space::lattice::NONE;
use crate::space::mesh::Mesh;
use crate::space::near::{put, roomy};

/// Cosine between the way of a spring and the normal of a face above which it leads straight onto it.
const STRAIGHT: f64 = 0.8;

/// Nothing found yet.
const UNKNOWN: u32 = u32::MAX;

/// End of the faces round a node.
const END: Corners = [NONE; 4];

/// A place where springs may start, and what may stand in front of each of its corners.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lookout {
    pub(super) start: Start,
    /// Of each corner, its number among those that may have something in front of them.
    ahead: Corners,
}

/// Surfaces in front of each other.
#[derive(Debug, Clone, Default)]
pub(super) struct Shell {
    /// Changes of the list of pairs that are known.
    known: Option<u64>,
    /// Members and the nodes of other bodies' live surfaces that may be in front of them, in order.
    ways: Vec<[u32; 2]>,
    /// The nearest of the nodes in reach, member by member.
    nearest: Vec<u32>,
    /// In the order of their places.
    pub(super) lookouts: Vec<Lookout>,
    /// The faces round nodes.
    stars: Stars,
}

impl Shell {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        8 * self.ways.capacity()
            + 4 * self.nearest.capacity()
            + self.lookouts.capacity() * std::mem::size_of::<Lookout>()
            + self.stars.bytes()
    }

    /// Follows the members to their present positions.
    pub(super) fn follow(&mut self, mesh: &Mesh, contacts: &Contacts) {
        if self.known != Some(contacts.changes()) {
            self.known = Some(contacts.changes());
            self.find_ways(mesh, contacts);
            self.find_lookouts(mesh, contacts);
            self.stars.forget(contacts.members());
        }
        let Self { ways, nearest, .. } = self;
        nearest.clear();
        for ways in ways.chunk_by(|a, b| a[0] == b[0]) {
            let length = |at: u32| mesh.bodies[contacts.body(at)].longest;
            let (own, least) = (contacts.position(ways[0][0]), length(ways[0][0]));
            let mut best = (f64::INFINITY, NONE);
            for &[_, node] in ways {
                let other = contacts.position(node);
                let square: f64 = (0..3).map(|d| (own[d] - other[d]).powi(2)).sum();
                if square < best.0 && square < (SIGHT * least.max(length(node))).powi(2) {
                    best = (square, node);
                }
            }
            put(nearest, best.1);
        }
    }

    /// The nearest point that point number `point` of a lookout, at `x`, sees of another body's surface, with
    /// its face and that body. It is `likely` on this face.
    #[inline(always)]
    pub(super) fn seen(
        &mut self,
        of: (&Mesh, &Contacts),
        (lookout, point): (&Lookout, usize),
        x: [f64; 3],
        likely: Option<Corners>,
    ) -> Option<(Corners, Nearest, usize)> {
        let ahead = |corner: usize| {
            let node = *self.nearest.get(lookout.ahead[corner] as usize)?;
            (node != NONE).then_some(node)
        };
        // What its own corner has in front of it; or the first that has something.
        let node = std::iter::once(point).chain(0..4).find_map(ahead)?;
        let (face, near) = self.stars.nearest(of, x, node, likely)?;
        Some((face, near, of.1.body(face[0])))
    }

    /// Whether a node of a rim meets a rim of the other surface, where a spring begins: the way between them leads straight
    /// onto no face round either. What comes straight onto a face meets its points.
    pub(super) fn on_rims(&mut self, of: (&Mesh, &Contacts), spring: &Spring, node: u32) -> bool {
        let Some(other) = spring.nearest_corner() else { return false };
        [node, other].into_iter().all(|node| {
            let straight = |face: Corners| {
                let part = Part::of(places_of(of.1, &face), [0.5; 2]);
                dot(part.normal, spring.way).abs() > STRAIGHT
            };
            !self.stars.round(of, node).any(straight)
        })
    }

    /// Finds who may stand in front of whom.
    fn find_ways(&mut self, mesh: &Mesh, contacts: &Contacts) {
        self.ways.clear();
        for [a, b] in contacts.exposed_pairs() {
            let particles = [a, b].map(|at| contacts.particle(at));
            if mesh.keeps_apart(particles, [a, b].map(|at| contacts.body(at))) {
                let held = particles.map(|i| mesh.held(i));
                for (way, _) in [([a, b], held[1]), ([b, a], held[0])].iter().filter(|way| way.1) {
                    put(&mut self.ways, *way);
                }
            }
        }
        self.ways.sort_unstable();
    }

    /// Finds where springs may start: at loose particles, nodes of rims, and faces with a corner that may be in front of
    /// something.
    fn find_lookouts(&mut self, mesh: &Mesh, contacts: &Contacts) {
        let Self { ways, lookouts, nearest, .. } = self;
        // For now the members that may be in front of something themselves.
        nearest.clear();
        ways.chunk_by(|a, b| a[0] == b[0]).for_each(|ways| put(nearest, ways[0][0]));
        lookouts.clear();
        let find = |corner: u32| nearest.binary_search(&corner).map_or(NONE, |at| at as u32);
        for (first, &member) in (0..).zip(&*nearest) {
            let one = contacts.member(member as usize);
            if !mesh.held(one.particle) {
                let start = Start::alone(member as usize, one.body);
                put(lookouts, Lookout { start, ahead: [first; 4] });
                continue;
            }
            if is_rim(mesh, one.body, one.place) {
                let start = Start::alone(member as usize, one.body);
                put(lookouts, Lookout { start, ahead: [first; 4] });
            }
            each_face(mesh, one.body, one.place, |nodes, side| {
                let Some(corners) = corners_of(contacts, &nodes) else { return };
                let ahead = corners.map(find);
                // The first of those corners looks after the face.
                if ahead.iter().find(|&&at| at != NONE) == Some(&first) {
                    let start = Start::face(corners, side / 2, one.body);
                    put(lookouts, Lookout { start, ahead });
                }
            });
        }
        lookouts.sort_unstable_by_key(|lookout| lookout.start.slot);
    }
}

/// The faces of live surfaces round their nodes, node by node as they are asked for.
#[derive(Debug, Clone, Default)]
struct Stars {
    /// Where the faces round a member begin.
    first: Vec<u32>,
    faces: Vec<Corners>,
}

impl Stars {
    fn bytes(&self) -> usize {
        4 * self.first.capacity() + 16 * self.faces.capacity()
    }

    /// Forgets all, of so many members.
    fn forget(&mut self, members: usize) {
        self.first.clear();
        roomy(&mut self.first, members);
        self.first.resize(members, UNKNOWN);
        self.faces.clear();
    }

    /// The faces round a node.
    fn round(
        &mut self,
        (mesh, contacts): (&Mesh, &Contacts),
        node: u32,
    ) -> impl Iterator<Item = Corners> + Clone + use<'_> {
        let Self { first, faces } = self;
        let first = &mut first[node as usize];
        if *first == UNKNOWN {
            *first = faces.len() as u32;
            let node = contacts.member(node as usize);
            each_face(mesh, node.body, node.place, |nodes, _| {
                if let Some(corners) = corners_of(contacts, &nodes) {
                    put(faces, corners);
                }
            });
            put(faces, END);
        }
        let faces = faces[*first as usize..].iter().copied();
        faces.take_while(|face| *face != END)
    }

    /// The point of a surface nearest to `x`, from one of its nodes on: where the nearest of the faces round
    /// it lies on their rim, the surface may come nearer beyond, and those round a corner there are looked at
    /// as well. So faces much smaller than that of `x` are found, however far from its corner.
    fn nearest(
        &mut self,
        of: (&Mesh, &Contacts),
        x: [f64; 3],
        mut node: u32,
        likely: Option<Corners>,
    ) -> Option<(Corners, Nearest)> {
        let mut best = nearest_face(of.1, x, self.round(of, node), likely)?;
        while let Some(next) = best.1.beyond(&best.0, node) {
            let (face, near) = nearest_face(of.1, x, self.round(of, next), likely)?;
            if near.square >= best.1.square {
                break;
            }
            (best, node) = ((face, near), next);
        }
        Some(best)
    }
}
