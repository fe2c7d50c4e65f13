//! Surfaces of live elements, which keep the particles of other bodies out (decisions 0014, 0016).
//!
//! A particle that elements hold has its density from their volumes. The printed contact between two
//! such particles would compress both a second time, and a node on a node gives way before it carries
//! the pressure of the bodies. So the Gauss points of live faces, loose particles, and nodes of rims where they meet
//! rims (decision 0024), feel a spring on the nearest point of another body's live surface. Forces are the gradient of an energy of the
//! distance and of the present area, so energy, momentum and angular momentum are kept.

mod face;
mod memory;
mod shell;
mod spring;

pub(super) use self::memory::Memory;

use self::face::{POINTS, Part, dot, each_face, mean_of, minus, places_of};
use self::shell::Shell;
use self::spring::{DEEPEST, Law, Past, Spring, Start};
use super::columns::{Derived, State, Sums};
use super::contacts::{Contacts, SIGHT};
use super::mesh::Mesh;
use super::method::Method;
use super::near::{put, roomy};

/// Distance at which a surface is felt, in edges of cells.
const STAND: f64 = 0.5;

/// Smallest part of it: a particle that a surface appears closer to feels it when it has left it so far.
const CLOSE: f64 = 0.25;

/// Distance over that of the face of the last step below which a spring has jumped, not slid.
const JUMP: f64 = 0.8;

/// The same above which its own face has died and it ends on another, farther away. What is less may be that
/// a warped face has several nearest points.
const SLIP: f64 = 1.001;

/// Approach in a step over the distance, before the safety of the step.
const APPROACH: f64 = 0.4;

/// Rate of damping over that which stops the approach in one step, before the safety of the step: two
/// springs act on a pair of nodes face to face.
const DAMPING: f64 = 2.0;

/// Steps before it meets the surface from which on a point asks for steps as short as its viscosity then
/// will, this one included: the kick in which they meet goes over half of the step before too.
const AHEAD: f64 = 2.0;

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
    pub fn too_close(
        &mut self,
        mesh: &Mesh,
        contacts: &Contacts,
    ) -> Option<([usize; 2], [f64; 2])> {
        let mut first = None;
        self.look((mesh, contacts), |spring| {
            let bodies = spring.bodies.map(usize::from);
            let least = CLOSE * STAND * mesh.bodies[bodies[0]].edge();
            if spring.past.distance < 0.99 * least {
                first.get_or_insert((bodies, [spring.past.distance, least]));
            }
        });
        first
    }

    /// The first body beside others with a mapped cell so wide that a point over the middle of its face has no
    /// corner in reach where it is to feel it: its number, how far they are, and the most.
    #[must_use]
    pub fn too_wide(&self, mesh: &Mesh) -> Option<(usize, [f64; 2])> {
        let solid = |k: &usize| mesh.bodies[*k].solid.sound > 0.0;
        let solids = || (0..mesh.bodies.len()).filter(solid).filter(|_| self.some);
        solids().filter(|&k| mesh.bodies[k].lattice.is_mapped()).find_map(|k| {
            let half = 0.5 * widest_diagonal(mesh, k);
            solids().filter(|&other| other != k).find_map(|other| {
                let pair = [k as u16, other as u16];
                let lengths = pair.map(|body| mesh.bodies[usize::from(body)].longest);
                let (far, most) =
                    (half.hypot(full_stand(mesh, pair)), SIGHT * lengths[0].max(lengths[1]));
                (far > most).then_some((k, [far, most]))
            })
        })
    }

    /// Forces on particles and surfaces, and the marks of touched particles. Returns the inverse of
    /// the longest stable step, and the heat of springs that let go.
    pub fn push(
        &mut self,
        (mesh, contacts): (&Mesh, &Contacts),
        (state, derived): (&State, &Derived),
        (method, dt): (&Method, f64),
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
            let crossing = body.edge() / body.solid.sound;
            let soon = stand + approach * crossing;
            if z >= 1.0 && distance >= soon {
                continue;
            }
            let inertia = spring.inertia((mesh, contacts), start);
            let whole = area * spring.stiffness(mesh);
            if distance < soon {
                let stiffness = whole * Law::stiffness(z.min(1.0));
                rate = rate.max((stiffness * inertia).sqrt() / stand);
            }
            let ahead = if dt > 0.0 { AHEAD * dt } else { crossing };
            let resists = approach > 0.0 && (z < 1.0 || distance < stand + approach * ahead);
            let coefficient = if resists {
                viscosity((derived, contacts), (mesh, method), (spring, start), approach)
            } else {
                0.0
            };
            rate = rate.max(DAMPING * coefficient * inertia);
            if z >= 1.0 {
                continue;
            }
            spring.force = whole * Law::force(z) / stand;
            spring.drag = coefficient * approach;
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
            if !start.is_alone() {
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
    /// is given to its particles and returned. So is what one loses whose face has died, and that ends on
    /// another, farther away.
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
            let mut kept = 0.0;
            if let Some(spring) = same {
                let moved = seen.as_ref().map(|(_, seen)| spring.distance / seen.past.distance);
                match (moved, &seen) {
                    (Some(JUMP..SLIP), _) => continue,
                    (Some(SLIP..), Some((_, seen))) => kept = seen.energy_as(spring, mesh),
                    _ => begin(spring),
                }
            }
            if let Some((start, seen)) = seen.filter(|_| pressed) {
                let energy = (seen.energy(mesh) - kept).max(0.0);
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
        for from in 0..shell.lookouts.len() {
            let lookout = shell.lookouts[from];
            let start = &lookout.start;
            let places = places_of(contacts, &start.corners);
            for (point, at) in POINTS.into_iter().enumerate().take(start.points()) {
                let x = mean_of(&places, &start.shares(point));
                let slot = start.slot + point as u32;
                while before.next_if(|old| old.slot < slot).is_some() {}
                let old = before.peek().filter(|old| old.slot == slot);
                let likely = old.map(|old| old.face);
                let seen = shell.seen((mesh, contacts), (&lookout, point), x, likely);
                let Some((face, near, other)) = seen else { continue };
                let mut spring = Spring::new((start, from), point, (face, other), &near);
                let own = &mut spring.past;
                let stand = old.map_or(0.0, |old| old.stand);
                let full = full_stand(mesh, spring.bodies);
                own.stand = if stand < CLOSE * full {
                    own.distance.min(full)
                } else {
                    stand.max(own.distance).min(full)
                };
                if start.is_alone() {
                    own.area = start.own_area(mesh, contacts);
                    let node = start.corners[0];
                    let pressed = old.is_some_and(|old| old.distance < old.stand);
                    let held = mesh.held(contacts.particle(node));
                    if held && !pressed && !shell.on_rims((mesh, contacts), &spring, node) {
                        continue;
                    }
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

/// Longest diagonal of a face of the surface of a body, undeformed.
fn widest_diagonal(mesh: &Mesh, body: usize) -> f64 {
    let lattice = &mesh.bodies[body].lattice;
    let mut widest = 0.0f64;
    for &at in &lattice.nodes {
        each_face(mesh, body, at, |nodes, _| {
            let [a, b, c, d] = nodes.map(|node| lattice.position(mesh.place(node).1));
            for way in [minus(c, a), minus(d, b)] {
                widest = widest.max(dot(way, way).sqrt());
            }
        });
    }
    widest
}

/// Distance at which the surfaces of two bodies feel each other.
fn full_stand(mesh: &Mesh, bodies: [u16; 2]) -> f64 {
    let edges = bodies.map(|body| mesh.bodies[body as usize].edge());
    0.5 * STAND * (edges[0] + edges[1])
}

/// Coefficient of the viscous force of a spring. Impedance and sound speed are means of the point and the
/// surface; each of the two surfaces stands for half of the area.
fn viscosity(
    (derived, contacts): (&Derived, &Contacts),
    (mesh, method): (&Mesh, &Method),
    (spring, start): (&Spring, &Start),
    approach: f64,
) -> f64 {
    let (mut impedance, mut sound) = (0.0, 0.0);
    for (i, share) in spring.shares(contacts, start) {
        let share = 0.5 * share.abs();
        impedance += share * derived.rho[i] * derived.sound[i];
        sound += share * derived.sound[i];
    }
    let slopes = spring.bodies.map(|body| mesh.bodies[usize::from(body)].slope);
    let slope = 0.5 * (slopes[0] + slopes[1]);
    0.5 * spring.past.area * impedance * method.steepness(approach, sound, slope)
}
