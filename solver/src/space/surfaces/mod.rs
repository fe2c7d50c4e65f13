//! Surfaces of live elements, which keep the particles of other bodies out (decisions 0014, 0016).
//!
//! A particle that elements hold has its density from their volumes. The printed contact between two
//! such particles would compress both a second time, and a node on a node gives way before it carries
//! the pressure of the bodies. So the Gauss points of live faces, and loose particles, feel a spring on
//! the nearest point of another body's live surface. Forces are the gradient of an energy of the
//! distance and of the present area, so energy, momentum and angular momentum are kept.

mod face;
mod memory;
mod spring;

pub(super) use self::memory::Memory;

use self::face::{Face, Nearest, POINTS, corners_of, dot, each_face, place_of};
use self::spring::{DEEPEST, Law, PLACES, Place, Pull, Spring};
use super::columns::{Derived, State, Sums};
use super::contacts::{Contacts, Member, steepness};
use super::lattice::NONE;
use super::mesh::Mesh;
use super::method::Method;

/// Distance at which a surface is felt, in edges of cells.
const STAND: f64 = 0.5;

/// Distance in contact lengths within which the corner of the nearest face is sought: of a face that
/// is stretched to 1.5 times its edge.
pub(in crate::space) const REACH: f64 = 1.4;

/// Smallest part of it: a particle that a surface appears closer to feels it when it has left it so far.
const CLOSE: f64 = 0.25;

/// Distance over that of the face of the last step below which a spring has jumped, not slid.
const JUMP: f64 = 0.8;

/// Approach in a step over the distance, before the safety of the step.
const APPROACH: f64 = 0.4;

/// Rate of damping over that which stops the approach in one step, before the safety of the step: two
/// springs act on a pair of nodes face to face.
const DAMPING: f64 = 2.0;

/// Whether a surface keeps two particles apart: of two solid bodies, and one of them held.
#[inline(always)]
pub fn meet(mesh: &Mesh, pair: [usize; 2], bodies: [usize; 2]) -> bool {
    bodies[0] != bodies[1]
        && pair.iter().any(|&i| mesh.held(i))
        && bodies.iter().all(|&b| mesh.bodies[b].solid.sound > 0.0)
}

/// The points in front of surfaces.
#[derive(Debug, Clone, Default)]
pub struct Surfaces {
    /// Whether there can be any.
    some: bool,
    /// Nearest node of another body's surface and the square of its distance, by member.
    nearest: Vec<(f64, u32)>,
    /// By slot, in order.
    springs: Vec<Spring>,
    /// Those of the last step.
    before: Vec<Spring>,
    /// Whether nothing has moved since they were found.
    found: bool,
    /// Changes of the areas of pressed springs.
    pulls: Vec<Pull>,
}

impl Surfaces {
    /// Of a mesh whose elements carry the pressure, or not.
    #[must_use]
    pub fn new(mesh: &Mesh, volumes: bool) -> Self {
        Self { some: volumes && mesh.bodies.len() > 1, ..Self::default() }
    }

    /// The first point that stands too close to a surface to feel it: its body, distance, and what
    /// that must be.
    pub fn too_close(&mut self, mesh: &Mesh, contacts: &Contacts) -> Option<(usize, [f64; 2])> {
        let mut first = None;
        self.look(mesh, contacts, |spring| {
            let least = CLOSE * STAND * mesh.bodies[spring.body].edge();
            if spring.distance < 0.99 * least {
                first.get_or_insert((spring.body, [spring.distance, least]));
            }
        });
        first
    }

    /// Forces on particles and surfaces, and the marks of touched particles. Returns the inverse of
    /// the longest stable step, and the heat of springs that let go.
    pub fn push(
        &mut self,
        (mesh, contacts): (&Mesh, &Contacts),
        (state, derived): (&State, &Derived),
        method: &Method,
        (sums, touched, active): (&mut Sums, &mut [bool], &mut [bool]),
    ) -> [f64; 2] {
        if !self.some {
            return [0.0; 2];
        }
        let heat = if std::mem::take(&mut self.found) {
            0.0
        } else {
            self.renew((mesh, contacts), |i, energy| sums.heat[i] += energy)
        };
        let velocity = |i: usize| [state.vx[i], state.vy[i], state.vz[i]];
        let mut rate = 0.0f64;
        for spring in &mut self.springs {
            if spring.stand < CLOSE * full_stand(mesh, [spring.body, spring.other]) {
                continue;
            }
            let approach = spring.approach(mesh, velocity);
            rate = rate.max(approach / (APPROACH * spring.distance.max(DEEPEST * spring.stand)));
            let z = spring.distance / spring.stand;
            let inertia = spring.inertia(mesh);
            let body = &mesh.bodies[spring.body];
            let soon = spring.stand + approach * body.edge() / body.solid.sound;
            if spring.distance < soon {
                let stiffness = spring.area * spring.stiffness * Law::stiffness(z.min(1.0));
                rate = rate.max((stiffness * inertia).sqrt() / spring.stand);
            }
            if z >= 1.0 {
                continue;
            }
            spring.force = spring.area * spring.stiffness * Law::force(z) / spring.stand;
            if approach > 0.0 {
                let (impedance, sound) = resistance(derived, spring);
                let bodies = [spring.body, spring.other].map(|b| &mesh.bodies[b]);
                let slope = 0.5 * (bodies[0].slope + bodies[1].slope);
                let coefficient = impedance * steepness(method, approach, sound, slope);
                spring.drag = coefficient * approach;
                rate = rate.max(DAMPING * coefficient * inertia);
            }
            let force = spring.force + spring.drag;
            let mut add = |i: usize, scale: f64, way: [f64; 3]| {
                sums.fx[i] += scale * way[0];
                sums.fy[i] += scale * way[1];
                sums.fz[i] += scale * way[2];
                touched[i] = true;
                active[mesh.piece_of(i)] = true;
            };
            spring.shares().for_each(|(i, share)| add(i, share * force, spring.way));
            let tension = spring.tension();
            for pull in spring.own_pulls(&self.pulls) {
                add(pull.node, -tension, pull.slope);
            }
        }
        [rate, heat]
    }

    /// Finds the springs anew. One that has jumped to a much nearer face, or appears, begins where it
    /// is, so that no energy comes from nothing; the energy of one that jumped or went is heat, which
    /// is given to its particles and returned.
    fn renew(
        &mut self,
        (mesh, contacts): (&Mesh, &Contacts),
        mut give: impl FnMut(usize, f64),
    ) -> f64 {
        std::mem::swap(&mut self.springs, &mut self.before);
        self.look(mesh, contacts, |_| {});
        let mut heat = 0.0;
        let mut new = self.springs.iter_mut().peekable();
        let begin = |spring: &mut Spring| spring.stand = spring.stand.min(spring.distance);
        for old in &mut self.before {
            while let Some(spring) = new.next_if(|spring| spring.slot < old.slot) {
                begin(spring);
            }
            let same = new.next_if(|spring| spring.slot == old.slot);
            if same.as_ref().is_some_and(|spring| spring.face == old.face) {
                continue;
            }
            let pressed = old.distance < old.stand;
            let known = old.see(contacts);
            if let Some(spring) = same {
                if known && spring.distance >= JUMP * old.distance {
                    continue;
                }
                begin(spring);
            }
            if known && pressed {
                let energy = old.energy();
                old.shares().for_each(|(i, share)| give(i, 0.5 * share.abs() * energy));
                heat += energy;
            }
        }
        new.for_each(begin);
        heat
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let springs = self.springs.capacity() + self.before.capacity();
        self.nearest.capacity() * 16
            + springs * std::mem::size_of::<Spring>()
            + self.pulls.capacity() * std::mem::size_of::<Pull>()
    }

    /// Viscous heat over the mean velocity of the step. Returns the work on the springs.
    pub fn work(
        &self,
        mesh: &Mesh,
        mean: impl Fn(usize) -> [f64; 3],
        dt: f64,
        heat: &mut [f64],
    ) -> f64 {
        let mut work = 0.0;
        for spring in self.springs.iter().filter(|spring| spring.force > 0.0) {
            let way = dt * spring.approach(mesh, &mean);
            work += way * spring.force;
            let pulls = spring.own_pulls(&self.pulls).iter();
            let growth: f64 = pulls.map(|pull| dot(pull.slope, mean(pull.node))).sum();
            work += dt * growth * spring.tension();
            for (i, share) in spring.shares() {
                heat[i] += 0.5 * share.abs() * spring.drag * way;
            }
        }
        work
    }

    /// Energy of the springs, half to each body.
    pub fn stored(&self, mesh: &Mesh, contacts: &Contacts) -> Vec<f64> {
        let mut all = vec![0.0; mesh.bodies.len()];
        let mut now = self.clone();
        now.before.clone_from(&self.springs);
        now.look(mesh, contacts, |_| {});
        for spring in &now.springs {
            all[spring.body] += 0.5 * spring.energy();
            all[spring.other] += 0.5 * spring.energy();
        }
        all
    }

    /// After elements died: other surfaces are in front of particles. Returns the heat of springs that
    /// let go.
    pub fn release(&mut self, mesh: &Mesh, contacts: &Contacts, u: &mut [f64]) -> f64 {
        if !self.some {
            return 0.0;
        }
        self.found = true;
        self.renew((mesh, contacts), |i, energy| u[i] += energy / mesh.mass[i])
    }

    /// Finds the springs at the present positions, and tells of those that are too short to be one.
    fn look(&mut self, mesh: &Mesh, contacts: &Contacts, mut short: impl FnMut(&Spring)) {
        self.springs.clear();
        self.pulls.clear();
        if !self.some {
            return;
        }
        self.find_nearest(mesh, contacts);
        let Self { nearest, springs, before, pulls, .. } = self;
        let mut look = |slot: usize, from: &Place, node: u32| {
            let node = contacts.member(node as usize);
            let Some(mut spring) = nearest_face((mesh, contacts), (slot, from), &node) else {
                return;
            };
            let full = full_stand(mesh, [from.body, node.body]);
            let old = before.binary_search_by_key(&slot, |old| old.slot);
            let stand = old.map_or(0.0, |at| before[at].stand);
            spring.stand = if stand < CLOSE * full {
                spring.distance.min(full)
            } else {
                stand.max(spring.distance).min(full)
            };
            if !spring.measure(contacts, from, pulls) {
                return;
            }
            if spring.stand < CLOSE * full {
                short(&spring);
            } else {
                springs.push(spring);
            }
        };
        for (member, &(_, node)) in nearest.iter().enumerate().filter(|(_, near)| near.1 != NONE) {
            let one = contacts.member(member);
            if !mesh.held(one.particle) {
                look(PLACES * member, &Place::of(mesh, &one, 0), node);
                continue;
            }
            each_face(mesh, one.body, one.place, |face, side| {
                let corners = face.nodes.map(|node| contacts.find(node));
                // Of the corners in front of something the first looks after the face.
                let ahead = |corner: Option<usize>| corner.filter(|&c| nearest[c].1 != NONE);
                if corners.iter().find_map(|&corner| ahead(corner)) != Some(member) {
                    return;
                }
                let Some(first) = corners[0] else { return };
                for (point, &corner) in corners.iter().enumerate() {
                    let from = Place { body: one.body, nodes: face.nodes, point: Some(point) };
                    let slot = PLACES * first + 1 + POINTS.len() * (side / 2) + point;
                    look(slot, &from, ahead(corner).map_or(node, |corner| nearest[corner].1));
                }
            });
        }
        springs.sort_unstable_by_key(|spring| spring.slot);
    }

    /// Finds the nearest node of another body's live surface to every member.
    fn find_nearest(&mut self, mesh: &Mesh, contacts: &Contacts) {
        self.nearest.clear();
        self.nearest.resize(contacts.members(), (f64::INFINITY, NONE));
        for &[a, b] in contacts.facing() {
            let (one, other) = (contacts.position(a), contacts.position(b));
            let square = (0..3).map(|d| (one[d] - other[d]).powi(2)).sum();
            for (member, node) in [(a, b), (b, a)] {
                let nearest = &mut self.nearest[member as usize];
                if square < nearest.0 && mesh.held(contacts.particle(node)) {
                    *nearest = (square, node);
                }
            }
        }
    }
}

/// Distance at which the surfaces of two bodies feel each other.
fn full_stand(mesh: &Mesh, bodies: [usize; 2]) -> f64 {
    0.5 * STAND * (mesh.bodies[bodies[0]].edge() + mesh.bodies[bodies[1]].edge())
}

/// Impedance times area, and sound speed: means of the point and the surface. Each of the two surfaces
/// stands for half of the area.
fn resistance(derived: &Derived, spring: &Spring) -> (f64, f64) {
    let (mut impedance, mut sound) = (0.0, 0.0);
    for (i, share) in spring.shares() {
        let share = 0.5 * share.abs();
        impedance += share * derived.rho[i] * derived.sound[i];
        sound += share * derived.sound[i];
    }
    (0.5 * spring.area * impedance, sound)
}

/// The spring on the nearest of the faces round a node.
fn nearest_face(
    (mesh, contacts): (&Mesh, &Contacts),
    (slot, from): (usize, &Place),
    node: &Member,
) -> Option<Spring> {
    let x = place_of(contacts, &from.own())?;
    let mut best: Option<(Nearest, Face)> = None;
    each_face(mesh, node.body, node.place, |face, _| {
        let Some(corners) = corners_of(contacts, &face) else { return };
        let near = Nearest::of(x, corners);
        if best.as_ref().is_none_or(|(best, _)| near.square < best.square) {
            best = Some((near, face));
        }
    });
    let (near, face) = best.filter(|(near, _)| near.square > 0.0)?;
    let mut spring = Spring::new(mesh, slot, from, (face, node.body));
    spring.lie(&near);
    Some(spring)
}
