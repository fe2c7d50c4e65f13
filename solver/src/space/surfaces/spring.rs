//! Springs between points of a body and the surface of another.

use super::face::{
    Corners, Nearest, POINTS, Part, bilinear, corners_of, dot, face_across, mean_of, places_of,
};
use crate::space::contacts::{Contacts, Member};
use crate::space::mesh::{Body, Mesh};

/// Stiffness of the spring over that of the half cells behind both surfaces in series: two flat surfaces
/// of one material carry its bulk modulus at 0.58 of the distance.
const STIFFNESS: f64 = 0.5;

/// Distance, over that at which a surface is felt, below which the force rises no more: a
/// stiffer spring would dictate the time step.
pub(super) const DEEPEST: f64 = 0.2;

/// Places of springs that a member has: its own, and those of the points of the faces across each axis
/// of which it is the first corner.
pub(super) const PLACES: usize = 13;

/// Least cosine between the way of a spring and the normal of a face from whose middle it starts.
const FACING: f64 = 0.5;

/// No gradient of an area.
const FIXED: u32 = u32::MAX;

/// Energy, force and stiffness of a spring of unit stiffness and length at a distance below one:
/// `(1 - z)^2 / (2 z)`, whose force rises no more below [`DEEPEST`].
pub(super) struct Law;

impl Law {
    pub(super) fn energy(z: f64) -> f64 {
        let deep = z.max(DEEPEST);
        if z < 1.0 {
            0.5 * (1.0 - deep) * (1.0 - deep) / deep + Self::force(z) * (deep - z)
        } else {
            0.0
        }
    }

    pub(super) fn force(z: f64) -> f64 {
        let z = z.max(DEEPEST);
        if z < 1.0 { 0.5 * (1.0 / (z * z) - 1.0) } else { 0.0 }
    }

    pub(super) fn stiffness(z: f64) -> f64 {
        1.0 / z.max(DEEPEST).powi(3)
    }
}

/// Where springs start: a particle that is loose or lies on a rim, or the points of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Start {
    /// First of their places among those of all members.
    pub(super) slot: u32,
    /// Corners of the face, or the particle.
    pub(super) corners: Corners,
    pub(super) body: u16,
}

impl Start {
    /// Of a member, the springs at one of its places; none if that is on no face of members.
    pub(super) fn at(mesh: &Mesh, contacts: &Contacts, slot: u32) -> Option<Self> {
        let (member, place) = (slot as usize / PLACES, slot as usize % PLACES);
        let Member { body, place: lowest, .. } = contacts.member(member);
        let Some(place) = place.checked_sub(1) else { return Some(Self::alone(member, body)) };
        let axis = place / POINTS.len();
        let nodes = face_across(&mesh.bodies[body], lowest, axis);
        if nodes.iter().any(|&node| node >= mesh.first_centroid) {
            return None;
        }
        let corners = corners_of(contacts, &nodes)?;
        Some(Self::face(corners, axis, body))
    }

    /// Of a particle alone.
    pub(super) fn alone(member: usize, body: usize) -> Self {
        Self { slot: (PLACES * member) as u32, corners: [member as u32; 4], body: body as u16 }
    }

    /// Of a face across an axis.
    pub(super) fn face(corners: Corners, axis: usize, body: usize) -> Self {
        let slot = PLACES * corners[0] as usize + 1 + POINTS.len() * axis;
        Self { slot: slot as u32, corners, body: body as u16 }
    }

    #[inline(always)]
    pub(super) fn is_alone(&self) -> bool {
        self.slot.is_multiple_of(PLACES as u32)
    }

    /// How many points it has.
    pub(super) fn points(&self) -> usize {
        if self.is_alone() { 1 } else { POINTS.len() }
    }

    /// Shares of the corners in a point.
    #[inline(always)]
    pub(super) fn shares(&self, point: usize) -> [f64; 4] {
        if self.is_alone() { [1.0, 0.0, 0.0, 0.0] } else { bilinear(POINTS[point]) }
    }

    /// Area that a particle alone acts for: what one of its mass has of a flat surface.
    pub(super) fn own_area(&self, mesh: &Mesh, contacts: &Contacts) -> f64 {
        let body = &mesh.bodies[self.body as usize];
        4.0 * mesh.mass(contacts.particle(self.corners[0])) / (body.rho_0 * body.edge())
    }
}

/// What is kept of a spring from step to step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Past {
    /// Its place among those of all members.
    pub(super) slot: u32,
    /// Corners of the face that it ends on.
    pub(super) face: Corners,
    pub(super) distance: f64,
    /// Distance at which it begins.
    pub(super) stand: f64,
    /// Area that the point acts for.
    pub(super) area: f64,
}

/// A point of a body in front of a surface, in touch with it or not: a particle alone, or one of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spring {
    pub(super) past: Past,
    /// Where it starts, among all such places.
    pub(super) from: u32,
    /// Gradient of its area, among those of all pressed faces.
    pub(super) slopes: u32,
    /// The own body, and that of the surface.
    pub(super) bodies: [u16; 2],
    /// The nearest point of the face, from 0 to 1 along both sides.
    at: [f64; 2],
    /// Unit vector from the surface to the point.
    pub(super) way: [f64; 3],
    pub(super) force: f64,
    /// Viscous force.
    pub(super) drag: f64,
}

impl Spring {
    /// From one of the points of a start, number `from` of all, to the nearest point of a face of a body.
    pub(super) fn new(
        (start, from): (&Start, usize),
        point: usize,
        (face, other): (Corners, usize),
        near: &Nearest,
    ) -> Self {
        let distance = near.square.sqrt();
        let slot = start.slot + point as u32;
        Self {
            past: Past { slot, face, distance, stand: 0.0, area: 0.0 },
            from: from as u32,
            slopes: FIXED,
            bodies: [start.body, other as u16],
            at: near.at,
            way: near.r.map(|r| r / distance),
            force: 0.0,
            drag: 0.0,
        }
    }

    /// The corner of its face that is nearest to its end; none where it ends amid the face.
    pub(super) fn nearest_corner(&self) -> Option<u32> {
        let inner = |t: f64| t > 0.0 && t < 1.0;
        if self.at.into_iter().all(inner) {
            return None;
        }
        let shares = bilinear(self.at).into_iter().zip(self.past.face);
        shares.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, corner)| corner)
    }

    /// A spring of the past as it is now, and where it starts.
    pub(super) fn again(past: &Past, mesh: &Mesh, contacts: &Contacts) -> Option<(Start, Self)> {
        let start = Start::at(mesh, contacts, past.slot)?;
        let point = (past.slot - start.slot) as usize;
        let x = mean_of(&places_of(contacts, &start.corners), &start.shares(point));
        let near = Nearest::of(x, places_of(contacts, &past.face));
        let other = contacts.member(past.face[0] as usize).body;
        let mut spring = Self::new((&start, 0), point, (past.face, other), &near);
        (spring.past.stand, spring.past.area) = (past.stand, past.area);
        Some((start, spring))
    }

    pub(super) fn energy(&self, mesh: &Mesh) -> f64 {
        self.past.area * self.tension(mesh)
    }

    /// What its area would hold at the distance of another, beginning where that does.
    pub(super) fn energy_as(&self, other: &Past, mesh: &Mesh) -> f64 {
        self.past.area * self.stiffness(mesh) * Law::energy(other.distance / other.stand)
    }

    /// Energy over area.
    pub(super) fn tension(&self, mesh: &Mesh) -> f64 {
        self.stiffness(mesh) * Law::energy(self.past.distance / self.past.stand)
    }

    /// Stiffness, an energy over area.
    pub(super) fn stiffness(&self, mesh: &Mesh) -> f64 {
        let [first, other] = self.bodies.map(|body| &mesh.bodies[body as usize]);
        let soft = |body: &Body| 1.0 / (body.rho_0 * body.solid.sound.powi(2));
        let series = 1.0 / (soft(first) + soft(other));
        STIFFNESS * first.edge() * series
    }

    /// Inverse of the mass that moves with it. With a point of a face all others round a corner push that:
    /// as much area as a node of a flat surface has. A point that acts for more than a node of the other surface has pushes
    /// that alone.
    pub(super) fn inertia(&self, (mesh, contacts): (&Mesh, &Contacts), start: &Start) -> f64 {
        if start.is_alone() {
            let shares = self.shares(contacts, start);
            return shares.map(|(i, share)| share * share / mesh.mass(i)).sum();
        }
        let bodies = self.bodies.map(|body| &mesh.bodies[body as usize]);
        let per_area = bodies.map(|body| 4.0 / (body.rho_0 * body.edge()));
        let area = bodies.map(|body| body.edge().powi(2) / POINTS.len() as f64);
        if area[1] < area[0] {
            per_area[0] / area[0] + per_area[1] / area[1]
        } else {
            (per_area[0] + per_area[1]) / area[0]
        }
    }

    /// Velocity of the point towards the surface.
    #[inline(always)]
    pub(super) fn approach(
        &self,
        (mesh, contacts): (&Mesh, &Contacts),
        start: &Start,
        velocity: impl Fn(usize) -> [f64; 3],
    ) -> f64 {
        let [body, other] = self.bodies.map(usize::from);
        let mut relative = mesh.drift_of(body, other);
        for (i, share) in self.shares(contacts, start) {
            relative.iter_mut().zip(velocity(i)).for_each(|(v, u)| *v += share * u);
        }
        -dot(self.way, relative)
    }

    /// Particles that take part, with their shares of the force.
    #[inline(always)]
    pub(super) fn shares(
        &self,
        contacts: &Contacts,
        start: &Start,
    ) -> impl Iterator<Item = (usize, f64)> {
        let own = start.shares((self.past.slot - start.slot) as usize);
        let own = start.corners.into_iter().zip(own).filter(|own| own.1 > 0.0);
        let face = self.past.face.into_iter().zip(bilinear(self.at).map(|share| -share));
        own.chain(face).map(|(member, share)| (contacts.particle(member), share))
    }

    /// Whether a part of a face, from whose point it starts, faces the other body.
    pub(super) fn faces(&self, part: &Part) -> bool {
        dot(part.normal, self.way).abs() > FACING
    }

    /// Its gradient of the area among those of all, of the corners of its face.
    pub(super) fn own_slopes<'a>(&self, all: &'a [[[f64; 3]; 4]]) -> Option<&'a [[f64; 3]; 4]> {
        all.get(self.slopes as usize)
    }
}
