//! What is painted: particles and hexahedra, each with a value and a class.

use super::PaintError;
use super::vector::Vec3;

/// Coordinates beyond this cannot be squared safely.
const HUGE: f64 = 1e100;

/// What decides the colour of a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// The field that is shown, in its own unit; NaN is painted grey.
    pub value: f32,
    /// The body or material, an index into the classes of the picture.
    pub class: u8,
}

/// A spherical particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre, in the length unit of the model.
    pub centre: [f64; 3],
    /// Its radius, in the length unit of the model.
    pub radius: f64,
    /// Its colour.
    pub mark: Mark,
}

/// An ellipsoidal particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Its centre, in the length unit of the model.
    pub centre: [f64; 3],
    /// Its half-axes, in the length unit of the model.
    pub half_axes: [f64; 3],
    /// The directions of the half-axes: three orthogonal unit vectors.
    pub directions: [[f64; 3]; 3],
    /// Its colour.
    pub mark: Mark,
}

/// An eight-node element with its corners in the order (0,0,0), (1,0,0), (1,1,0), (0,1,0),
/// (0,0,1), (1,0,1), (1,1,1), (0,1,1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hexahedron {
    /// Indices into the points of the model; elements that share a face share its nodes.
    pub nodes: [u32; 8],
    /// Its colour.
    pub mark: Mark,
}

/// A state of particles and elements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The nodes of the hexahedra, in the length unit of the model.
    pub points: Vec<[f64; 3]>,
    /// Spherical particles.
    pub spheres: Vec<Sphere>,
    /// Ellipsoidal particles.
    pub ellipsoids: Vec<Ellipsoid>,
    /// Elements.
    pub hexahedra: Vec<Hexahedron>,
}

impl Model {
    /// The marks of all primitives.
    pub(super) fn marks(&self) -> impl Iterator<Item = Mark> {
        let spheres = self.spheres.iter().map(|s| s.mark);
        let ellipsoids = self.ellipsoids.iter().map(|e| e.mark);
        spheres.chain(ellipsoids).chain(self.hexahedra.iter().map(|h| h.mark))
    }

    /// Centre, vectors of the half-axes and mark of all particles.
    pub(super) fn particles(&self) -> impl Iterator<Item = (Vec3, [Vec3; 3], Mark)> {
        let spheres = self.spheres.iter().map(|s| {
            let r = s.radius;
            (s.centre, [[r, 0.0, 0.0], [0.0, r, 0.0], [0.0, 0.0, r]], s.mark)
        });
        spheres.chain(self.ellipsoids.iter().map(|e| {
            let axis = |i: usize| e.directions[i].map(|x| x * e.half_axes[i]);
            (e.centre, [axis(0), axis(1), axis(2)], e.mark)
        }))
    }

    /// Refuses what cannot be painted.
    pub(super) fn check(&self) -> Result<(), PaintError> {
        if self.spheres.is_empty() && self.ellipsoids.is_empty() && self.hexahedra.is_empty() {
            return Err(PaintError::EmptyModel);
        }
        let wrong = |what, index| Err(PaintError::Primitive { what, index });
        if let Some(i) = self.points.iter().position(|p| !sound(p)) {
            return wrong("node", i);
        }
        let bad = |r: &f64| !(*r > 0.0 && *r < HUGE);
        if let Some(i) = self.spheres.iter().position(|s| !sound(&s.centre) || bad(&s.radius)) {
            return wrong("sphere", i);
        }
        if let Some(i) = self.ellipsoids.iter().position(|e| {
            !sound(&e.centre) || e.half_axes.iter().any(bad) || !orthonormal(&e.directions)
        }) {
            return wrong("ellipsoid", i);
        }
        let count = self.points.len();
        let outside = |h: &Hexahedron| h.nodes.iter().any(|n| *n as usize >= count);
        self.hexahedra.iter().position(outside).map_or(Ok(()), |i| wrong("hexahedron", i))
    }
}

/// Whether a point has usable coordinates.
pub(super) fn sound(p: &[f64; 3]) -> bool {
    p.iter().all(|x| x.abs() < HUGE)
}

fn orthonormal(axes: &[Vec3; 3]) -> bool {
    (0..3).all(|i| {
        (0..=i).all(|j| {
            let target = if i == j { 1.0 } else { 0.0 };
            (super::vector::dot(axes[i], axes[j]) - target).abs() < 1e-3
        })
    })
}
