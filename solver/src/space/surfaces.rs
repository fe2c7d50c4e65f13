//! Surfaces of live elements, which keep the other bodies out (decisions 0014 and 0016).
//!
//! A particle that elements hold has its density from their volumes. The printed contact between two
//! such particles would compress both a second time, and a node on a node gives way before it carries
//! the pressure of the bodies. So each Gauss point of a live face, and each loose particle, in front
//! of a live surface of another body feels a spring on the nearest point of that surface. The force is
//! the gradient of an energy of the distance and of the area that the point acts for, so energy,
//! momentum and angular momentum are kept.

use super::columns::{Derived, State, Sums};
use super::contacts::{Contacts, Member, steepness};
use super::lattice::{NONE, cross};
use super::mesh::{Body, Mesh};
use super::method::Method;

/// Distance at which a surface is felt, in edges of cells.
const STAND: f64 = 0.5;

/// Distance in contact lengths within which the corner of the nearest face is sought: of a face that
/// is stretched to 1.5 times its edge.
pub(super) const REACH: f64 = 1.4;

/// Smallest part of it: a particle that a surface appears closer to feels it when it has left it so far.
const CLOSE: f64 = 0.25;

/// Stiffness of the spring over that of the half cells behind both surfaces in series: two flat surfaces
/// of one material carry its bulk modulus at 0.58 of the distance.
const STIFFNESS: f64 = 0.5;

/// Distance, over that at which a surface is felt, below which the force rises no more: a
/// stiffer spring would dictate the time step.
const DEEPEST: f64 = 0.2;

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

/// Energy, force and stiffness of a spring of unit stiffness and length at a distance below one:
/// `(1 - z)^2 / (2 z)`, whose force rises no more below [`DEEPEST`].
struct Law;

impl Law {
    fn energy(z: f64) -> f64 {
        let deep = z.max(DEEPEST);
        if z < 1.0 {
            0.5 * (1.0 - deep) * (1.0 - deep) / deep + Self::force(z) * (deep - z)
        } else {
            0.0
        }
    }

    fn force(z: f64) -> f64 {
        let z = z.max(DEEPEST);
        if z < 1.0 { 0.5 * (1.0 / (z * z) - 1.0) } else { 0.0 }
    }

    fn stiffness(z: f64) -> f64 {
        1.0 / z.max(DEEPEST).powi(3)
    }
}

/// Places of springs that a member has: its own, and those of the points of the faces across each axis
/// of which it is the first corner.
const PLACES: usize = 13;

/// Points of a face, from 0 to 1 along its sides: those of Gauss, two each way. A pressure then does on
/// every corner the work that it does on the bilinear face, and no point starts on an edge of the
/// face across (decision 0016).
const POINTS: [[f64; 2]; 4] = {
    // (1 - 1/sqrt(3)) / 2
    let (low, high) = (0.211_324_865_405_187_1, 0.788_675_134_594_812_9);
    [[low, low], [high, low], [high, high], [low, high]]
};

/// Least cosine between the way of a spring and the normal of a face from whose middle it starts.
const FACING: f64 = 0.5;

/// Most rounds of the search for the nearest point of a face, and the move along its sides that ends it.
const ROUNDS: usize = 40;
const CLOSEST: f64 = 1e-13;

/// Relative growth of the square of the distance that is round-off.
const LEVEL: f64 = 1e-14;

/// Least curvature of the square of the distance, over that of a flat face, that the search trusts.
const CONVEX: f64 = 0.1;

/// Face of an element.
#[derive(Debug, Clone, Copy)]
struct Face {
    /// Its corners, in order about the axis that it lies across, from the lowest.
    nodes: [usize; 4],
}

/// A point of a body in front of a surface, in touch with it or not: a loose particle, or one of a face.
#[derive(Debug, Clone, Copy)]
struct Spring {
    /// Its place among those of all members.
    slot: usize,
    /// The particles that it is a mean of, and their shares.
    own: [(usize, f64); 4],
    body: usize,
    /// Body of the surface.
    other: usize,
    face: Face,
    /// Shares of the corners in the nearest point.
    share: [f64; 4],
    /// Unit vector from the surface to the point.
    way: [f64; 3],
    distance: f64,
    /// Distance at which the spring begins.
    stand: f64,
    /// Area that the point acts for.
    area: f64,
    /// Its pulls, among those of all springs.
    pulls: [u32; 2],
    /// Stiffness, an energy over area.
    stiffness: f64,
    force: f64,
    /// Viscous force.
    drag: f64,
}

/// How the area that a point acts for changes as a node of its surface moves.
#[derive(Debug, Clone, Copy)]
struct Pull {
    node: usize,
    /// Gradient of the area.
    slope: [f64; 3],
}

impl Spring {
    /// From a place of a body's surface to a face of another one, to be seen yet.
    fn new(mesh: &Mesh, slot: usize, from: &Place, to: (Face, usize)) -> Self {
        let (face, other) = to;
        let first = &mesh.bodies[from.body];
        let soft = |body: &Body| 1.0 / (body.rho_0 * body.solid.sound.powi(2));
        let series = 1.0 / (soft(first) + soft(&mesh.bodies[other]));
        Self {
            slot,
            own: from.own(),
            body: from.body,
            other,
            face,
            share: [0.0; 4],
            way: [0.0; 3],
            distance: f64::INFINITY,
            stand: 0.0,
            // A loose particle acts for what one of its mass has of a flat surface.
            area: 4.0 * mesh.mass[from.nodes[0]] / (first.rho_0 * first.edge()),
            pulls: [0; 2],
            stiffness: STIFFNESS * first.edge() * series,
            force: 0.0,
            drag: 0.0,
        }
    }

    fn energy(&self) -> f64 {
        self.area * self.tension()
    }

    /// Energy over area.
    fn tension(&self) -> f64 {
        self.stiffness * Law::energy(self.distance / self.stand)
    }

    /// Its own pulls among all.
    fn own_pulls<'a>(&self, pulls: &'a [Pull]) -> &'a [Pull] {
        &pulls[self.pulls[0] as usize..self.pulls[1] as usize]
    }

    /// Inverse of the mass that moves with it. With a point of a face all others round a corner push that:
    /// as much area as a node of a flat surface has.
    fn inertia(&self, mesh: &Mesh) -> f64 {
        if self.own[1].1 == 0.0 {
            return self.shares().map(|(i, share)| share * share / mesh.mass[i]).sum();
        }
        let per_area = |body: usize| 4.0 / (mesh.bodies[body].rho_0 * mesh.bodies[body].edge());
        let area = mesh.bodies[self.body].edge().powi(2) / POINTS.len() as f64;
        (per_area(self.body) + per_area(self.other)) / area
    }

    /// Velocity of the point towards the surface.
    fn approach(&self, mesh: &Mesh, velocity: impl Fn(usize) -> [f64; 3]) -> f64 {
        let mut relative = mesh.drift_of(self.body, self.other);
        for (i, share) in self.shares() {
            relative.iter_mut().zip(velocity(i)).for_each(|(v, u)| *v += share * u);
        }
        -dot(self.way, relative)
    }

    /// Particles that take part, with their shares of the force.
    fn shares(&self) -> impl Iterator<Item = (usize, f64)> {
        let own = self.own.into_iter().filter(|own| own.1 > 0.0);
        own.chain(self.face.nodes.into_iter().zip(self.share.map(|share| -share)))
    }
}

/// Lower half of a number.
const HALF: u64 = 0xffff_ffff;

/// Where a spring starts: a particle, or a point of a face.
#[derive(Debug, Clone, Copy)]
struct Place {
    body: usize,
    /// Corners of the face, or the particle.
    nodes: [usize; 4],
    /// Which of the points; none is the particle.
    point: Option<usize>,
}

impl Place {
    /// Of a member, by the number among its places.
    fn of(mesh: &Mesh, one: &Member, place: usize) -> Self {
        let body = one.body;
        match place.checked_sub(1) {
            None => Self { body, nodes: [one.particle; 4], point: None },
            Some(at) => {
                let face = face_across(&mesh.bodies[body], one.place, at / POINTS.len());
                Self { body, nodes: face.nodes, point: Some(at % POINTS.len()) }
            }
        }
    }

    fn own(&self) -> [(usize, f64); 4] {
        let share = self.point.map_or([1.0, 0.0, 0.0, 0.0], |point| bilinear(POINTS[point]));
        std::array::from_fn(|k| (self.nodes[k], share[k]))
    }
}

/// Shares of the corners of a face in a point of it.
fn bilinear([u, v]: [f64; 2]) -> [f64; 4] {
    [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]
}

/// What surfaces keep from step to step, [`Memory::address`] by address; nothing of a scene without them.
pub(super) struct Memory {
    /// Distance at which the point feels a surface.
    pub(super) stand: Vec<f64>,
    /// Distance of the surface when it was last looked at.
    pub(super) distance: Vec<f64>,
    /// Area that the point acted for.
    pub(super) area: Vec<f64>,
    /// Corners of the face, two in a number, two numbers an address; all bits set for none.
    pub(super) face: Vec<u64>,
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
    pub(super) fn no_face(face: &[u64], nodes: usize) -> Option<u64> {
        let none = |pair: u64| pair >> 32 >= nodes as u64 || pair & HALF >= nodes as u64;
        let whole = |pairs: &[u64; 2]| pairs.iter().all(|&pair| pair == u64::MAX);
        let bad = |pairs: &&[u64; 2]| !whole(pairs) && pairs.iter().any(|&pair| none(pair));
        face.as_chunks().0.iter().find(bad).map(|pairs| pairs[0])
    }
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

    /// What must outlast a restart.
    pub(super) fn memory(&self, mesh: &Mesh, contacts: &Contacts) -> Memory {
        let all = mesh.len + (PLACES - 1) * mesh.first_centroid;
        let places = if self.some { all } else { 0 };
        let mut memory = Memory {
            stand: vec![0.0; places],
            distance: vec![0.0; places],
            area: vec![0.0; places],
            face: vec![u64::MAX; 2 * places],
        };
        for spring in &self.springs {
            let first = contacts.member(spring.slot / PLACES).particle;
            let at = Memory::address(mesh, first, spring.slot % PLACES);
            let [a, b, c, d] = spring.face.nodes.map(|node| node as u64);
            memory.stand[at] = spring.stand;
            memory.distance[at] = spring.distance;
            memory.area[at] = spring.area;
            memory.face[2 * at] = a << 32 | b;
            memory.face[2 * at + 1] = c << 32 | d;
        }
        memory
    }

    /// Takes it back.
    pub(super) fn recall(&mut self, mesh: &Mesh, contacts: &Contacts, memory: &Memory) {
        self.springs.clear();
        for (at, &[low, high]) in memory.face.as_chunks().0.iter().enumerate() {
            let (particle, place) = Memory::place(mesh, at);
            let Some(member) = contacts.find(particle).filter(|_| low != u64::MAX) else {
                continue;
            };
            let from = Place::of(mesh, &contacts.member(member), place);
            if place > 0 && from.nodes.iter().any(|&node| node >= mesh.first_centroid) {
                continue;
            }
            let nodes = [low >> 32, low & HALF, high >> 32, high & HALF];
            let face = Face { nodes: nodes.map(|node| node as usize) };
            let to = (face, mesh.place(face.nodes[0]).0);
            let mut spring = Spring::new(mesh, PLACES * member + place, &from, to);
            (spring.stand, spring.distance) = (memory.stand[at], memory.distance[at]);
            spring.area = memory.area[at];
            self.springs.push(spring);
        }
        self.springs.sort_unstable_by_key(|spring| spring.slot);
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
        let heat = self.renew((mesh, contacts), |i, energy| sums.heat[i] += energy);
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
        for &[a, b] in contacts.list() {
            let (one, other) = (contacts.member(a as usize), contacts.member(b as usize));
            let bodies = [one.body, other.body];
            if one.exposed && other.exposed && meet(mesh, [one.particle, other.particle], bodies) {
                let square = (0..3).map(|d| (one.position[d] - other.position[d]).powi(2)).sum();
                for (member, node, held) in [(a, b, other.particle), (b, a, one.particle)] {
                    let nearest = &mut self.nearest[member as usize];
                    if mesh.held(held) && square < nearest.0 {
                        *nearest = (square, node);
                    }
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
    let mut best: Option<Spring> = None;
    each_face(mesh, node.body, node.place, |face, _| {
        let mut spring = Spring::new(mesh, slot, from, (face, node.body));
        if spring.see(contacts) && best.as_ref().is_none_or(|best| spring.distance < best.distance)
        {
            best = Some(spring);
        }
    });
    best.filter(|spring| spring.distance > 0.0)
}

/// Calls for every face of the live surface of a body round a node, with the side of its element: twice
/// the axis that it lies across, and one more if it is the upper one.
fn each_face(mesh: &Mesh, body: usize, at: [i16; 3], mut f: impl FnMut(Face, usize)) {
    let own = &mesh.bodies[body];
    let live = |at: [i16; 3]| {
        let cell = own.lattice.cell(at);
        cell != NONE && mesh.held(own.centroids.start + cell as usize)
    };
    for corner in 0..8 {
        let side: [i16; 3] = std::array::from_fn(|d| if corner >> d & 1 == 1 { 1 } else { -1 });
        let centre: [i16; 3] = std::array::from_fn(|d| at[d] + side[d]);
        if !live(centre) {
            continue;
        }
        for axis in 0..3 {
            let mut beyond = centre;
            beyond[axis] -= 2 * side[axis];
            if live(beyond) {
                continue;
            }
            let mut lowest = centre.map(|c| c - 1);
            lowest[axis] = at[axis];
            f(face_across(own, lowest, axis), 2 * axis + usize::from(side[axis] < 0));
        }
    }
}

/// The face across an axis with this node as its lowest corner.
fn face_across(body: &Body, lowest: [i16; 3], axis: usize) -> Face {
    let nodes = [[0, 0], [2, 0], [2, 2], [0, 2]].map(|step: [i16; 2]| {
        let mut node = lowest;
        node[(axis + 1) % 3] += step[0];
        node[(axis + 2) % 3] += step[1];
        body.nodes.start + body.lattice.node(node) as usize
    });
    Face { nodes }
}

impl Spring {
    /// Finds the area that a point of a face acts for and, if it is pressed, how that changes. Returns
    /// whether the point faces the other body.
    fn measure(&mut self, contacts: &Contacts, from: &Place, pulls: &mut Vec<Pull>) -> bool {
        self.pulls = [pulls.len() as u32; 2];
        let Some(point) = from.point else { return true };
        let Some(corners) = corners_of(contacts, &Face { nodes: from.nodes }) else {
            return false;
        };
        let part = Part::of(corners, POINTS[point]);
        self.area = part.area;
        if self.distance < self.stand {
            let slopes = from.nodes.into_iter().zip(part.slopes());
            pulls.extend(slopes.map(|(node, slope)| Pull { node, slope }));
            self.pulls[1] = pulls.len() as u32;
        }
        dot(part.normal, self.way).abs() > FACING
    }

    /// Finds the nearest point of the face, which is bilinear as the pyramid under it. Returns whether
    /// the positions are known.
    fn see(&mut self, contacts: &Contacts) -> bool {
        let Some(corners) = corners_of(contacts, &self.face) else { return false };
        let mut x = [0.0; 3];
        for (i, share) in self.own.into_iter().filter(|own| own.1 > 0.0) {
            let Some(member) = contacts.find(i) else { return false };
            let position = contacts.member(member).position;
            x.iter_mut().zip(position).for_each(|(x, own)| *x += share * own);
        }
        let (at, r) = nearest_point(x, corners);
        self.share = bilinear(at);
        self.distance = dot(r, r).sqrt();
        self.way = r.map(|r| r / self.distance);
        true
    }
}

/// The part of a face that one of its points acts for.
struct Part {
    /// Where the point is, from 0 to 1 along both sides.
    at: [f64; 2],
    /// Derivatives of the place along both.
    along: [[f64; 3]; 2],
    area: f64,
    normal: [f64; 3],
}

impl Part {
    fn of([a, b, c, d]: [[f64; 3]; 4], at: [f64; 2]) -> Self {
        let between = |x: [f64; 3], y: [f64; 3], t: f64| plus(x, t, minus(y, x));
        let along =
            [between(minus(b, a), minus(c, d), at[1]), between(minus(d, a), minus(c, b), at[0])];
        let area = cross(along[0], along[1]);
        let size = dot(area, area).sqrt();
        let normal = area.map(|x| x / size.max(f64::MIN_POSITIVE));
        Self { at, along, area: size / POINTS.len() as f64, normal }
    }

    /// Gradients of the area, by corner.
    fn slopes(&self) -> [[f64; 3]; 4] {
        let [u, v] = self.at;
        let turned = [cross(self.along[1], self.normal), cross(self.normal, self.along[0])];
        let [p, q] = turned.map(|way| way.map(|x| x / POINTS.len() as f64));
        // Derivatives of the shares of the corners along both sides.
        [[v - 1.0, u - 1.0], [1.0 - v, -u], [v, u], [-v, 1.0 - u]]
            .map(|[by, other]| plus(p.map(|x| by * x), other, q))
    }
}

/// Where the corners of a face are, if that is known: those of live surfaces are.
fn corners_of(contacts: &Contacts, face: &Face) -> Option<[[f64; 3]; 4]> {
    let mut corners = [[0.0; 3]; 4];
    for (corner, &node) in corners.iter_mut().zip(&face.nodes) {
        *corner = contacts.member(contacts.find(node)?).position;
    }
    Some(corners)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + t b`.
fn plus(a: [f64; 3], t: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Where, from 0 to 1 along both sides, a bilinear face has its point nearest to `x`, and the way from
/// there to `x`: Newton's iteration on the square of the distance, within the face.
fn nearest_point(x: [f64; 3], [a, b, c, d]: [[f64; 3]; 4]) -> ([f64; 2], [f64; 3]) {
    let (from, sides) = (minus(x, a), [minus(b, a), minus(d, a)]);
    let twist = minus(minus(c, d), sides[0]);
    let away =
        |at: [f64; 2]| plus(plus(from, -at[0], sides[0]), -at[1], plus(sides[1], at[0], twist));
    let mut at = [0.5; 2];
    let mut r = away(at);
    let mut rounds = 0..ROUNDS;
    while rounds.next().is_some() {
        let along = [plus(sides[0], at[1], twist), plus(sides[1], at[0], twist)];
        let slope = [dot(r, along[0]), dot(r, along[1])];
        let steep = [dot(along[0], along[0]), dot(along[1], along[1])];
        let mixed = dot(along[0], along[1]) - dot(r, twist);
        let both = steep[0] * steep[1] - mixed * mixed;
        // What would leave the face stays on its edge.
        let stays = |i: usize| at[i] <= 0.0 && slope[i] <= 0.0 || at[i] >= 1.0 && slope[i] >= 0.0;
        let held = [stays(0), stays(1)];
        let mut step = if held == [false; 2] && both > CONVEX * steep[0] * steep[1] {
            [0, 1].map(|i| (slope[i] * steep[1 - i] - slope[1 - i] * mixed) / both)
        } else {
            let alone = |i: usize| slope[i] / steep[i].max(f64::MIN_POSITIVE);
            [0, 1].map(|i| if held[i] { 0.0 } else { alone(i) })
        };
        // A step that leads farther away is too long.
        loop {
            let next = [0, 1].map(|i| (at[i] + step[i]).clamp(0.0, 1.0));
            let way = away(next);
            let moved = (next[0] - at[0]).abs() + (next[1] - at[1]).abs();
            if moved < CLOSEST {
                return (next, way);
            }
            if dot(way, way) <= dot(r, r) * (1.0 + LEVEL) {
                (at, r) = (next, way);
                break;
            }
            if rounds.next().is_none() {
                break;
            }
            step = step.map(|step| 0.5 * step);
        }
    }
    (at, r)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A face that is neither flat nor square.
    const CORNERS: [[f64; 3]; 4] =
        [[0.1, 0.0, -0.1], [1.2, 0.1, 0.2], [0.9, 1.1, -0.1], [-0.1, 0.8, 0.3]];

    fn on_face(at: [f64; 2]) -> [f64; 3] {
        let shares = bilinear(at);
        (0..4).fold([0.0; 3], |x, k| plus(x, shares[k], CORNERS[k]))
    }

    #[test]
    fn the_nearest_point_is_nearer_than_any_of_a_grid() {
        for x in [[0.4, 0.5, 0.3], [0.9, 0.2, -0.4], [-0.3, 0.4, 0.1], [1.4, 1.5, 0.2]] {
            let (at, r) = nearest_point(x, CORNERS);
            let found = dot(r, r);
            let away = minus(x, on_face(at));
            assert!((dot(away, away) - found).abs() < 1e-14);
            for k in 0..=40 {
                for j in 0..=40 {
                    let other = minus(x, on_face([f64::from(k) / 40.0, f64::from(j) / 40.0]));
                    assert!(dot(other, other) >= found - 1e-14, "{x:?} {at:?} {k} {j}");
                }
            }
        }
    }

    #[test]
    fn parts_fill_a_flat_face_and_their_slopes_are_gradients() {
        let flat = [[0.0; 3], [1.2, 0.1, 0.0], [1.0, 1.0, 0.0], [0.1, 0.8, 0.0]];
        let whole = 0.5 * cross(minus(flat[2], flat[0]), minus(flat[3], flat[1]))[2];
        let sum: f64 = POINTS.iter().map(|&at| Part::of(flat, at).area).sum();
        assert!((sum / whole - 1.0).abs() < 1e-14);
        for at in POINTS {
            let slopes = Part::of(CORNERS, at).slopes();
            for corner in 0..4 {
                for d in 0..3 {
                    let moved = |by: f64| {
                        let mut corners = CORNERS;
                        corners[corner][d] += by;
                        Part::of(corners, at).area
                    };
                    let slope = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                    assert!((slopes[corner][d] - slope).abs() < 1e-9, "{at:?} {corner} {d}");
                }
            }
        }
    }

    /// The work of a pressure at the points, on each corner of a square, is that on its bilinear face.
    #[test]
    fn points_integrate_what_a_bulge_and_a_slide_do_together() {
        let exact = [1.0 / 9.0, 1.0 / 18.0, 1.0 / 36.0, 1.0 / 18.0];
        for (corner, exact) in exact.into_iter().enumerate() {
            let products = POINTS.map(|at| bilinear(at)[0] * bilinear(at)[corner]);
            let sum: f64 = products.iter().sum::<f64>() / POINTS.len() as f64;
            assert!((sum - exact).abs() < 1e-15, "{corner}");
        }
    }
}
