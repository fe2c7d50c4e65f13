//! Surfaces of live elements, which keep the particles of other bodies out (decisions 0014, 0016).
//!
//! A particle that elements hold has its density from their volumes. The printed contact between two
//! such particles would compress both a second time, and a node on a node gives way before it carries
//! the pressure of the bodies. So the Gauss points of live faces, and loose particles, feel a spring on
//! the nearest point of another body's live surface. Forces are the gradient of an energy of the
//! distance and of the present area, so energy, momentum and angular momentum are kept.

mod face;
mod memory;
mod shell;
mod spring;

pub(super) use self::memory::Memory;

use self::face::{Corners, Nearest, POINTS, Part, dot, mean_of, places_of};
use self::shell::{Lookout, Shell};
use self::spring::{DEEPEST, Law, Past, Spring, Start};
use super::columns::{Derived, State, Sums};
use super::contacts::{Contacts, steepness};
use super::mesh::Mesh;
use super::method::Method;
use super::near::{put, roomy};

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
    /// Surfaces in front of each other.
    shell: Shell,
    /// By slot, in order.
    springs: Vec<Spring>,
    /// What is left of those before, while the present ones are not known.
    past: Vec<Past>,
    /// Whether nothing has moved since they were found.
    found: bool,
    /// Gradients of the areas of pressed faces by their corners.
    slopes: Vec<[[f64; 3]; 4]>,
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
        self.look((mesh, contacts), |spring| {
            let body = usize::from(spring.bodies[0]);
            let least = CLOSE * STAND * mesh.bodies[body].edge();
            if spring.past.distance < 0.99 * least {
                first.get_or_insert((body, [spring.past.distance, least]));
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
        self.slopes.clear();
        let velocity = |i: usize| [state.vx[i], state.vy[i], state.vz[i]];
        let mut rate = 0.0f64;
        for spring in &mut self.springs {
            let Past { stand, distance, area, .. } = spring.past;
            if stand < CLOSE * full_stand(mesh, spring.bodies) {
                continue;
            }
            let start = &self.shell.lookouts[spring.from as usize].start;
            let approach = spring.approach((mesh, contacts), start, velocity);
            rate = rate.max(approach / (APPROACH * distance.max(DEEPEST * stand)));
            let z = distance / stand;
            let body = &mesh.bodies[spring.bodies[0] as usize];
            let soon = stand + approach * body.edge() / body.solid.sound;
            if z >= 1.0 && distance >= soon {
                continue;
            }
            let inertia = spring.inertia((mesh, contacts), start);
            let whole = area * spring.stiffness(mesh);
            if distance < soon {
                let stiffness = whole * Law::stiffness(z.min(1.0));
                rate = rate.max((stiffness * inertia).sqrt() / stand);
            }
            if z >= 1.0 {
                continue;
            }
            spring.force = whole * Law::force(z) / stand;
            if approach > 0.0 {
                let (impedance, sound) = resistance((derived, contacts), spring, start);
                let bodies = spring.bodies.map(|b| &mesh.bodies[b as usize]);
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
            let shares = spring.shares(contacts, start);
            shares.for_each(|(i, share)| add(i, share * force, spring.way));
            if !start.is_loose() {
                let point = (spring.past.slot - start.slot) as usize;
                let part = Part::of(places_of(contacts, &start.corners), POINTS[point]);
                let (tension, slopes) = (spring.tension(mesh), part.slopes());
                for (corner, slope) in start.corners.into_iter().zip(slopes) {
                    add(contacts.particle(corner), -tension, slope);
                }
                spring.slopes = self.slopes.len() as u32;
                put(&mut self.slopes, slopes);
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
        self.look((mesh, contacts), |_| {});
        let mut heat = 0.0;
        let mut new = self.springs.iter_mut().map(|spring| &mut spring.past).peekable();
        let begin = |spring: &mut Past| spring.stand = spring.stand.min(spring.distance);
        for old in self.past.drain(..) {
            while let Some(spring) = new.next_if(|spring| spring.slot < old.slot) {
                begin(spring);
            }
            let same = new.next_if(|spring| spring.slot == old.slot);
            if same.as_ref().is_some_and(|spring| spring.face == old.face) {
                continue;
            }
            let pressed = old.distance < old.stand;
            let seen = Spring::again(&old, mesh, contacts);
            if let Some(spring) = same {
                let distance = seen.as_ref().map(|(_, seen)| seen.past.distance);
                if distance.is_some_and(|distance| spring.distance >= JUMP * distance) {
                    continue;
                }
                begin(spring);
            }
            if let Some((start, seen)) = seen.filter(|_| pressed) {
                let energy = seen.energy(mesh);
                let shares = seen.shares(contacts, &start);
                shares.for_each(|(i, share)| give(i, 0.5 * share.abs() * energy));
                heat += energy;
            }
        }
        new.for_each(begin);
        heat
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.shell.bytes()
            + self.springs.capacity() * std::mem::size_of::<Spring>()
            + self.past.capacity() * std::mem::size_of::<Past>()
            + self.slopes.capacity() * std::mem::size_of::<[[f64; 3]; 4]>()
    }

    /// Viscous heat over the mean velocity of the step. Returns the work on the springs.
    pub fn work(
        &self,
        (mesh, contacts): (&Mesh, &Contacts),
        mean: impl Fn(usize) -> [f64; 3],
        dt: f64,
        heat: &mut [f64],
    ) -> f64 {
        let mut work = 0.0;
        for spring in self.springs.iter().filter(|spring| spring.force > 0.0) {
            let start = &self.shell.lookouts[spring.from as usize].start;
            let way = dt * spring.approach((mesh, contacts), start, &mean);
            work += way * spring.force;
            let slopes = spring.own_slopes(&self.slopes).into_iter().flatten();
            let corners = start.corners.map(|corner| contacts.particle(corner));
            let growth: f64 = slopes.zip(corners).map(|(slope, i)| dot(*slope, mean(i))).sum();
            work += dt * growth * spring.tension(mesh);
            for (i, share) in spring.shares(contacts, start) {
                heat[i] += 0.5 * share.abs() * spring.drag * way;
            }
        }
        work
    }

    /// Energy of the springs, half to each body.
    pub fn stored(&self, mesh: &Mesh, contacts: &Contacts) -> Vec<f64> {
        let mut all = vec![0.0; mesh.bodies.len()];
        let mut now = self.clone();
        now.look((mesh, contacts), |_| {});
        for spring in &now.springs {
            for body in spring.bodies {
                all[body as usize] += 0.5 * spring.energy(mesh);
            }
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
        self.renew((mesh, contacts), |i, energy| u[i] += energy / mesh.mass(i))
    }

    /// Finds the springs at the present positions, and tells of those that are too short to be one. The
    /// present ones become the past.
    fn look(&mut self, (mesh, contacts): (&Mesh, &Contacts), mut short: impl FnMut(&Spring)) {
        if !self.some {
            return;
        }
        let Self { shell, springs, past, .. } = self;
        roomy(past, springs.len());
        past.extend(springs.drain(..).map(|spring| spring.past));
        shell.follow(mesh, contacts);
        let mut before = past.iter().peekable();
        for (from, lookout) in shell.lookouts.iter().enumerate() {
            let Lookout { start, .. } = lookout;
            let places = places_of(contacts, &start.corners);
            for (point, at) in POINTS.into_iter().enumerate().take(start.points()) {
                let Some((faces, other)) = shell.seen(contacts, lookout, point) else { continue };
                let x = mean_of(&places, &start.shares(point));
                let slot = start.slot + point as u32;
                while before.next_if(|old| old.slot < slot).is_some() {}
                let old = before.peek().filter(|old| old.slot == slot);
                let likely = old.map(|old| old.face);
                let Some((face, near)) = nearest_face(contacts, x, faces, likely) else {
                    continue;
                };
                let mut spring = Spring::new((start, from), point, (face, other), &near);
                let own = &mut spring.past;
                let stand = old.map_or(0.0, |old| old.stand);
                let full = full_stand(mesh, spring.bodies);
                own.stand = if stand < CLOSE * full {
                    own.distance.min(full)
                } else {
                    stand.max(own.distance).min(full)
                };
                if start.is_loose() {
                    own.area = start.loose_area(mesh, contacts);
                } else {
                    let part = Part::of(places, at);
                    own.area = part.area;
                    if !spring.faces(&part) {
                        continue;
                    }
                }
                if spring.past.stand < CLOSE * full {
                    short(&spring);
                } else {
                    put(springs, spring);
                }
            }
        }
    }
}

/// Distance at which the surfaces of two bodies feel each other.
fn full_stand(mesh: &Mesh, bodies: [u16; 2]) -> f64 {
    let edges = bodies.map(|body| mesh.bodies[body as usize].edge());
    0.5 * STAND * (edges[0] + edges[1])
}

/// Impedance times area, and sound speed: means of the point and the surface. Each of the two surfaces
/// stands for half of the area.
fn resistance(
    (derived, contacts): (&Derived, &Contacts),
    spring: &Spring,
    start: &Start,
) -> (f64, f64) {
    let (mut impedance, mut sound) = (0.0, 0.0);
    for (i, share) in spring.shares(contacts, start) {
        let share = 0.5 * share.abs();
        impedance += share * derived.rho[i] * derived.sound[i];
        sound += share * derived.sound[i];
    }
    (0.5 * spring.past.area * impedance, sound)
}

/// The nearest point of some faces, the first of equals. It is sought first on a face where it is likely.
fn nearest_face(
    contacts: &Contacts,
    x: [f64; 3],
    faces: impl Iterator<Item = Corners> + Clone,
    likely: Option<Corners>,
) -> Option<(Corners, Nearest)> {
    let faces = faces.enumerate();
    let mut best = faces.clone().find(|&(_, face)| Some(face) == likely).map(|(place, face)| {
        let near = Nearest::of(x, places_of(contacts, &face));
        (near, place, face)
    });
    for (place, face) in faces {
        let (limit, known) = best.map_or((f64::INFINITY, None), |(n, at, _)| (n.square, Some(at)));
        if known == Some(place) {
            continue;
        }
        let near = Nearest::within(x, places_of(contacts, &face), limit);
        let earlier = known.is_some_and(|known| place < known);
        best = near
            .filter(|near| near.square < limit || near.square == limit && earlier)
            .map(|near| (near, place, face))
            .or(best);
    }
    best.filter(|(near, ..)| near.square > 0.0).map(|(near, _, face)| (face, near))
}
