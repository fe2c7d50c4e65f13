//! Surfaces of live elements, which keep the particles of other bodies out (decision 0014).
//!
//! A particle that elements hold has its density from their volumes. The printed contact between two
//! such particles would compress both a second time, and a node on a node gives way before it carries
//! the pressure of the bodies. So a particle in front of a live surface of another body feels a
//! spring on the nearest point of that surface: the force is the gradient of an energy of the
//! distance alone, along the line between the two points, so energy, momentum and angular momentum
//! are kept.

use super::columns::{Derived, State, Sums};
use super::contacts::{Contacts, Member, steepness};
use super::lattice::NONE;
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

/// Face of an element.
#[derive(Debug, Clone, Copy)]
struct Face {
    /// Its corners, in order round it.
    nodes: [usize; 4],
}

/// A particle in front of a surface, in touch with it or not.
#[derive(Debug, Clone, Copy)]
struct Spring {
    member: usize,
    particle: usize,
    body: usize,
    /// Body of the surface.
    other: usize,
    face: Face,
    /// Shares of the corners in the nearest point.
    share: [f64; 4],
    /// Unit vector from the surface to the particle.
    way: [f64; 3],
    distance: f64,
    /// Distance at which the spring begins.
    stand: f64,
    /// Area that the particle acts for.
    area: f64,
    /// Stiffness, an energy over area.
    stiffness: f64,
    force: f64,
    /// Viscous force.
    drag: f64,
}

impl Spring {
    /// Of a member on a face of another body, to be seen yet.
    fn new(mesh: &Mesh, (member, one): (usize, &Member), other: usize, face: Face) -> Self {
        let own = &mesh.bodies[one.body];
        let soft = |body: &Body| 1.0 / (body.rho_0 * body.solid.sound.powi(2));
        let series = 1.0 / (soft(own) + soft(&mesh.bodies[other]));
        Self {
            member,
            particle: one.particle,
            body: one.body,
            other,
            face,
            share: [0.0; 4],
            way: [0.0; 3],
            distance: f64::INFINITY,
            stand: 0.0,
            // A node of a flat surface has a quarter of a cell.
            area: 4.0 * mesh.mass[one.particle] / (own.rho_0 * own.edge()),
            stiffness: STIFFNESS * own.edge() * series,
            force: 0.0,
            drag: 0.0,
        }
    }

    fn energy(&self) -> f64 {
        self.area * self.stiffness * Law::energy(self.distance / self.stand)
    }

    /// Velocity of the particle towards the surface.
    fn approach(&self, mesh: &Mesh, velocity: impl Fn(usize) -> [f64; 3]) -> f64 {
        let mut relative = velocity(self.particle);
        let drift = mesh.drift_of(self.body, self.other);
        relative.iter_mut().zip(drift).for_each(|(v, drift)| *v += drift);
        for (&j, share) in self.face.nodes.iter().zip(self.share) {
            relative.iter_mut().zip(velocity(j)).for_each(|(v, u)| *v -= share * u);
        }
        -dot(self.way, relative)
    }

    /// Particles that take part, with their shares of the force.
    fn shares(&self) -> impl Iterator<Item = (usize, f64)> {
        let corners = self.face.nodes.into_iter().zip(self.share.map(|share| -share));
        std::iter::once((self.particle, 1.0)).chain(corners)
    }
}

/// Lower half of a number.
const HALF: u64 = 0xffff_ffff;

/// What surfaces keep from step to step, particle by particle.
pub(super) struct Memory {
    /// Distance at which the particle feels a surface.
    pub(super) stand: Vec<f64>,
    /// Distance of the surface when it was last looked at.
    pub(super) distance: Vec<f64>,
    /// Corners of the face, two in a number, two numbers a particle; all bits set for none.
    pub(super) face: Vec<u64>,
}

impl Memory {
    /// The first face of particles that are none.
    pub(super) fn no_face(face: &[u64], nodes: usize) -> Option<u64> {
        let none = |pair: u64| pair >> 32 >= nodes as u64 || pair & HALF >= nodes as u64;
        let whole = |pairs: &[u64; 2]| pairs.iter().all(|&pair| pair == u64::MAX);
        let bad = |pairs: &&[u64; 2]| !whole(pairs) && pairs.iter().any(|&pair| none(pair));
        face.as_chunks().0.iter().find(bad).map(|pairs| pairs[0])
    }
}

/// The particles in front of surfaces.
#[derive(Debug, Clone, Default)]
pub struct Surfaces {
    /// Whether there can be any.
    some: bool,
    /// Distance at which each member feels a surface: that at which it was first seen, at most the
    /// full one, and growing with the distance.
    stand: Vec<f64>,
    /// Nearest node of another body's surface and the square of its distance, by member.
    nearest: Vec<(f64, u32)>,
    /// By member, in order.
    springs: Vec<Spring>,
    /// Those of the last step.
    before: Vec<Spring>,
    /// Whether nothing has moved since they were found.
    found: bool,
}

impl Surfaces {
    /// Of a mesh whose elements carry the pressure, or not.
    #[must_use]
    pub fn new(mesh: &Mesh, volumes: bool) -> Self {
        Self { some: volumes && mesh.bodies.len() > 1, ..Self::default() }
    }

    /// The first member that stands too close to a surface to feel it: distance, and what it must be.
    pub fn too_close(&mut self, mesh: &Mesh, contacts: &Contacts) -> Option<(usize, [f64; 2])> {
        self.look(mesh, contacts);
        (0..self.stand.len()).find_map(|member| {
            let one = contacts.member(member);
            let least = CLOSE * STAND * mesh.bodies[one.body].edge();
            let near = self.nearest[member].1 != NONE && self.stand[member] < 0.99 * least;
            near.then_some((one.body, [self.stand[member], least]))
        })
    }

    /// What must outlast a restart.
    pub(super) fn memory(&self, contacts: &Contacts, particles: usize) -> Memory {
        let mut memory = Memory {
            stand: vec![0.0; particles],
            distance: vec![0.0; particles],
            face: vec![u64::MAX; 2 * particles],
        };
        for (member, &stand) in self.stand.iter().enumerate() {
            memory.stand[contacts.member(member).particle] = stand;
        }
        for spring in &self.springs {
            let [a, b, c, d] = spring.face.nodes.map(|node| node as u64);
            memory.distance[spring.particle] = spring.distance;
            memory.face[2 * spring.particle] = a << 32 | b;
            memory.face[2 * spring.particle + 1] = c << 32 | d;
        }
        memory
    }

    /// Takes it back.
    pub(super) fn recall(&mut self, mesh: &Mesh, contacts: &Contacts, memory: &Memory) {
        self.found = false;
        self.stand.clear();
        self.springs.clear();
        for member in 0..contacts.members() {
            let one = contacts.member(member);
            let (i, stand) = (one.particle, memory.stand[one.particle]);
            self.stand.push(stand);
            let [low, high] = [memory.face[2 * i], memory.face[2 * i + 1]];
            if low != u64::MAX {
                let nodes = [low >> 32, low & HALF, high >> 32, high & HALF];
                let nodes = nodes.map(|node| node as usize);
                let other = mesh.place(nodes[0]).0;
                let mut spring = Spring::new(mesh, (member, &one), other, Face { nodes });
                (spring.stand, spring.distance) = (stand, memory.distance[i]);
                self.springs.push(spring);
            }
        }
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
            let inertia: f64 = spring.shares().map(|(i, w)| w * w / mesh.mass[i]).sum();
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
                let (impedance, sound) = resistance(mesh, derived, spring);
                let bodies = [spring.body, spring.other].map(|b| &mesh.bodies[b]);
                let slope = 0.5 * (bodies[0].slope + bodies[1].slope);
                let coefficient = impedance * steepness(method, approach, sound, slope);
                spring.drag = coefficient * approach;
                rate = rate.max(DAMPING * coefficient * inertia);
            }
            let force = spring.force + spring.drag;
            for (i, share) in spring.shares() {
                sums.fx[i] += share * force * spring.way[0];
                sums.fy[i] += share * force * spring.way[1];
                sums.fz[i] += share * force * spring.way[2];
                touched[i] = true;
                active[mesh.piece_of(i)] = true;
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
        self.look(mesh, contacts);
        let mut heat = 0.0;
        let mut new = self.springs.iter_mut().peekable();
        let mut begin = |spring: &mut Spring| {
            spring.stand = spring.stand.min(spring.distance);
            self.stand[spring.member] = spring.stand;
        };
        for old in &mut self.before {
            while let Some(spring) = new.next_if(|spring| spring.member < old.member) {
                begin(spring);
            }
            let same = new.next_if(|spring| spring.member == old.member);
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
        self.stand.capacity() * 8
            + self.nearest.capacity() * 16
            + springs * std::mem::size_of::<Spring>()
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
        now.look(mesh, contacts);
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

    /// Finds the springs at the present positions.
    fn look(&mut self, mesh: &Mesh, contacts: &Contacts) {
        self.springs.clear();
        if !self.some {
            return;
        }
        self.stand.resize(contacts.members(), 0.0);
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
        for member in 0..self.nearest.len() {
            let node = self.nearest[member].1;
            if node == NONE {
                self.stand[member] = 0.0;
                continue;
            }
            let (one, node) = (contacts.member(member), contacts.member(node as usize));
            let Some(mut spring) = nearest_face((mesh, contacts), member, &one, &node) else {
                continue;
            };
            let full = full_stand(mesh, [one.body, node.body]);
            let stand = &mut self.stand[member];
            *stand = if *stand < CLOSE * full {
                spring.distance.min(full)
            } else {
                stand.max(spring.distance).min(full)
            };
            if *stand >= CLOSE * full {
                spring.stand = *stand;
                self.springs.push(spring);
            }
        }
    }
}

/// Distance at which the surfaces of two bodies feel each other.
fn full_stand(mesh: &Mesh, bodies: [usize; 2]) -> f64 {
    0.5 * STAND * (mesh.bodies[bodies[0]].edge() + mesh.bodies[bodies[1]].edge())
}

/// Impedance times area, and sound speed: means of the particle and the surface. A particle stands for
/// as much of a flat surface as its volume over half a cell's edge.
fn resistance(mesh: &Mesh, derived: &Derived, spring: &Spring) -> (f64, f64) {
    let of = |i: usize, body: usize| {
        let area = mesh.mass[i] / (0.5 * mesh.bodies[body].edge());
        (area * derived.sound[i], derived.sound[i])
    };
    let (mut impedance, mut sound) = of(spring.particle, spring.body);
    for (&j, share) in spring.face.nodes.iter().zip(spring.share) {
        let (z, c) = of(j, spring.other);
        impedance += share * z;
        sound += share * c;
    }
    (0.5 * impedance, 0.5 * sound)
}

/// The spring on the nearest of the faces round a node.
fn nearest_face(
    (mesh, contacts): (&Mesh, &Contacts),
    member: usize,
    one: &Member,
    node: &Member,
) -> Option<Spring> {
    let mut best: Option<(Nearest, Face)> = None;
    each_face(mesh, node.body, node.place, |face| {
        let Some(near) = Nearest::of(contacts, one.position, &face) else { return };
        if best.as_ref().is_none_or(|(best, _)| near.square < best.square) {
            best = Some((near, face));
        }
    });
    let (near, face) = best.filter(|(near, _)| near.square > 0.0)?;
    let mut spring = Spring::new(mesh, (member, one), node.body, face);
    spring.lie(&near);
    Some(spring)
}

/// Calls for every face of the live surface of a body round a node.
fn each_face(mesh: &Mesh, body: usize, at: [i16; 3], mut f: impl FnMut(Face)) {
    let own = &mesh.bodies[body];
    let side = |octant: usize, d: usize| if octant >> d & 1 == 1 { 1 } else { -1 };
    let mut live = 0u8;
    for (octant, cell) in own.lattice.cells_round(at) {
        live |= u8::from(mesh.held(own.centroids.start + cell as usize)) << octant;
    }
    for octant in (0..8).filter(|octant| live >> octant & 1 == 1) {
        // The cell beyond the face is another one round the node.
        for axis in (0..3).filter(|axis| live >> (octant ^ 1 << axis) & 1 == 0) {
            let nodes = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(|step: [i16; 2]| {
                let mut node = at;
                for (d, step) in [(axis + 1) % 3, (axis + 2) % 3].into_iter().zip(step) {
                    node[d] += side(octant, d) + step;
                }
                own.nodes.start + own.lattice.node(node) as usize
            });
            f(Face { nodes });
        }
    }
}

impl Spring {
    /// Finds the nearest point of the face. Returns whether the positions are known.
    fn see(&mut self, contacts: &Contacts) -> bool {
        let at = contacts.position(self.member as u32);
        let near = Nearest::of(contacts, at, &self.face);
        near.iter().for_each(|near| self.lie(near));
        near.is_some()
    }

    /// Takes the nearest point.
    fn lie(&mut self, near: &Nearest) {
        self.share = near.share;
        self.distance = near.square.sqrt();
        self.way = near.r.map(|r| r / self.distance);
    }
}

/// The point of a face that is nearest to a particle.
#[derive(Debug, Clone, Copy)]
struct Nearest {
    /// Shares of the corners.
    share: [f64; 4],
    /// From there to the particle.
    r: [f64; 3],
    /// Square of its length.
    square: f64,
}

impl Nearest {
    /// Of a face, four triangles about its middle, if it is known where its corners are: those of live
    /// surfaces are.
    fn of(contacts: &Contacts, x: [f64; 3], face: &Face) -> Option<Self> {
        let mut corners = [[0.0; 3]; 4];
        for (corner, &node) in corners.iter_mut().zip(&face.nodes) {
            *corner = contacts.position(contacts.find(node)? as u32);
        }
        let middle = std::array::from_fn(|d| 0.25 * corners.iter().map(|c| c[d]).sum::<f64>());
        let (r, e) = (minus(x, middle), corners.map(|corner| minus(corner, middle)));
        let (rr, ee, re) = (dot(r, r), e.map(|e| dot(e, e)), e.map(|e| dot(r, e)));
        let (mut best, mut at) = ([f64::INFINITY, 0.0, 0.0], 0);
        for k in 0..4 {
            let next = (k + 1) % 4;
            let triangle = Triangle {
                rr,
                ee: [ee[k], ee[next]],
                ef: dot(e[k], e[next]),
                re: [re[k], re[next]],
            };
            let nearest = triangle.nearest();
            if nearest[0] < best[0] {
                (best, at) = (nearest, k);
            }
        }
        let [_, v, w] = best;
        let mut share = [0.25 * (1.0 - v - w); 4];
        share[at] += v;
        share[(at + 1) % 4] += w;
        let r =
            std::array::from_fn(|d| x[d] - (0..4).map(|k| share[k] * corners[k][d]).sum::<f64>());
        Some(Self { share, r, square: dot(r, r) })
    }
}

/// A triangle with a corner at the origin, and a point, by their products: of the point `r` with itself,
/// of the sides `e` and `f` from the origin with themselves and each other, of the point with both.
struct Triangle {
    rr: f64,
    ee: [f64; 2],
    ef: f64,
    re: [f64; 2],
}

impl Triangle {
    /// Square of the distance, and the shares of both sides in the nearest point.
    fn nearest(&self) -> [f64; 3] {
        let Self { rr, ee: [ee, ff], ef, re: [re, rf] } = *self;
        let area = ee * ff - ef * ef;
        let (v, w) = (ff * re - ef * rf, ee * rf - ef * re);
        if area > 0.0 && v >= 0.0 && w >= 0.0 && v + w <= area {
            let (v, w) = (v / area, w / area);
            return [rr - v * re - w * rf, v, w];
        }
        // On an edge that begins at square `rr`, of square length `ll`, with the product `rl`.
        let edge = |rr: f64, rl: f64, ll: f64| {
            let t = (rl / ll.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (rr - t * (2.0 * rl - t * ll), t)
        };
        let (first, v) = edge(rr, re, ee);
        let (second, w) = edge(rr, rf, ff);
        let (third, t) = edge(rr - 2.0 * re + ee, rf - re - ef + ee, ee + ff - 2.0 * ef);
        let mut best = [first, v, 0.0];
        if second < best[0] {
            best = [second, 0.0, w];
        }
        if third < best[0] {
            best = [third, 1.0 - t, t];
        }
        best
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|d| a[d] - b[d])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
