//! Springs between points of a body and the surface of another.

use super::face::{Face, Nearest, POINTS, Part, bilinear, corners_of, dot, face_across, place_of};
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

/// A point of a body in front of a surface, in touch with it or not: a loose particle, or one of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spring {
    /// Its place among those of all members.
    pub(super) slot: usize,
    /// The particles that it is a mean of, and their shares.
    pub(super) own: [(usize, f64); 4],
    pub(super) body: usize,
    /// Body of the surface.
    pub(super) other: usize,
    pub(super) face: Face,
    /// Shares of the corners in the nearest point.
    pub(super) share: [f64; 4],
    /// Unit vector from the surface to the point.
    pub(super) way: [f64; 3],
    pub(super) distance: f64,
    /// Distance at which the spring begins.
    pub(super) stand: f64,
    /// Area that the point acts for.
    pub(super) area: f64,
    /// Its pulls, among those of all springs.
    pub(super) pulls: [u32; 2],
    /// Stiffness, an energy over area.
    pub(super) stiffness: f64,
    pub(super) force: f64,
    /// Viscous force.
    pub(super) drag: f64,
}

/// How the area that a point acts for changes as a node of its surface moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pull {
    pub(super) node: usize,
    /// Gradient of the area.
    pub(super) slope: [f64; 3],
}

impl Spring {
    /// From a place of a body's surface to a face of another one, to be seen yet.
    pub(super) fn new(mesh: &Mesh, slot: usize, from: &Place, to: (Face, usize)) -> Self {
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

    pub(super) fn energy(&self) -> f64 {
        self.area * self.tension()
    }

    /// Energy over area.
    pub(super) fn tension(&self) -> f64 {
        self.stiffness * Law::energy(self.distance / self.stand)
    }

    /// Its own pulls among all.
    pub(super) fn own_pulls<'a>(&self, pulls: &'a [Pull]) -> &'a [Pull] {
        &pulls[self.pulls[0] as usize..self.pulls[1] as usize]
    }

    /// Inverse of the mass that moves with it. With a point of a face all others round a corner push that:
    /// as much area as a node of a flat surface has.
    pub(super) fn inertia(&self, mesh: &Mesh) -> f64 {
        if self.own[1].1 == 0.0 {
            return self.shares().map(|(i, share)| share * share / mesh.mass[i]).sum();
        }
        let per_area = |body: usize| 4.0 / (mesh.bodies[body].rho_0 * mesh.bodies[body].edge());
        let area = mesh.bodies[self.body].edge().powi(2) / POINTS.len() as f64;
        (per_area(self.body) + per_area(self.other)) / area
    }

    /// Velocity of the point towards the surface.
    pub(super) fn approach(&self, mesh: &Mesh, velocity: impl Fn(usize) -> [f64; 3]) -> f64 {
        let mut relative = mesh.drift_of(self.body, self.other);
        for (i, share) in self.shares() {
            relative.iter_mut().zip(velocity(i)).for_each(|(v, u)| *v += share * u);
        }
        -dot(self.way, relative)
    }

    /// Particles that take part, with their shares of the force.
    pub(super) fn shares(&self) -> impl Iterator<Item = (usize, f64)> {
        let own = self.own.into_iter().filter(|own| own.1 > 0.0);
        own.chain(self.face.nodes.into_iter().zip(self.share.map(|share| -share)))
    }
}

impl Spring {
    /// Finds the area that a point of a face acts for and, if it is pressed, how that changes. Returns
    /// whether the point faces the other body.
    pub(super) fn measure(
        &mut self,
        contacts: &Contacts,
        from: &Place,
        pulls: &mut Vec<Pull>,
    ) -> bool {
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

    /// Finds the nearest point of the face. Returns whether the positions are known.
    pub(super) fn see(&mut self, contacts: &Contacts) -> bool {
        let known = corners_of(contacts, &self.face).zip(place_of(contacts, &self.own));
        known.inspect(|&(corners, x)| self.lie(&Nearest::of(x, corners))).is_some()
    }

    /// Takes the nearest point.
    pub(super) fn lie(&mut self, near: &Nearest) {
        self.share = bilinear(near.at);
        self.distance = near.square.sqrt();
        self.way = near.r.map(|r| r / self.distance);
    }
}

/// Where a spring starts: a particle, or a point of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) body: usize,
    /// Corners of the face, or the particle.
    pub(super) nodes: [usize; 4],
    /// Which of the points; none is the particle.
    pub(super) point: Option<usize>,
}

impl Place {
    /// Of a member, by the number among its places.
    pub(super) fn of(mesh: &Mesh, one: &Member, place: usize) -> Self {
        let body = one.body;
        match place.checked_sub(1) {
            None => Self { body, nodes: [one.particle; 4], point: None },
            Some(at) => {
                let face = face_across(&mesh.bodies[body], one.place, at / POINTS.len());
                Self { body, nodes: face.nodes, point: Some(at % POINTS.len()) }
            }
        }
    }

    pub(super) fn own(&self) -> [(usize, f64); 4] {
        let share = self.point.map_or([1.0, 0.0, 0.0, 0.0], |point| bilinear(POINTS[point]));
        std::array::from_fn(|k| (self.nodes[k], share[k]))
    }
}
