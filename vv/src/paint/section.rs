//! The section plane, and what it leaves of an element.

use super::PaintError;
use super::camera::{Axes, View};
use super::model::sound;
use super::vector::{Vec3, dot, mix, scaled, sub, unit};

/// The six tetrahedra around the diagonal from corner 0 to corner 6; they split every face along
/// the diagonal that starts at its first corner in [`FACES`].
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 2, 6], [0, 1, 5, 6], [0, 3, 2, 6], [0, 3, 7, 6], [0, 4, 5, 6], [0, 4, 7, 6]];

/// The corners of the faces of an element.
pub(super) const FACES: [[usize; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [3, 7, 6, 2], [0, 4, 7, 3], [1, 2, 6, 5]];

/// A plane that cuts away all between itself and the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of the plane.
    pub point: [f64; 3],
    /// Its normal; the sign does not matter.
    pub normal: [f64; 3],
}

/// A convex polygon whose edges from each corner to the next may be drawn as lines.
pub(super) type Polygon = Vec<(Vec3, bool)>;

/// A plane whose normal points towards the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    point: Vec3,
    normal: Vec3,
}

impl Cut {
    /// Turns the plane towards the eye.
    pub(super) fn new(plane: &Plane, axes: &Axes) -> Result<Self, PaintError> {
        let normal = unit(plane.normal).filter(|_| sound(&plane.point));
        let normal = normal.ok_or(PaintError::Section)?;
        let away = dot(normal, axes.forward);
        if away.abs() < 1e-3 {
            return Err(PaintError::Section);
        }
        Ok(Self { point: plane.point, normal: scaled(normal, -away.signum()) })
    }

    /// The distance in front of the plane.
    pub(super) fn height(&self, p: Vec3) -> f64 {
        dot(sub(p, self.point), self.normal)
    }

    /// The height of the lowest point of an ellipsoid.
    pub(super) fn lowest(&self, centre: Vec3, half_axes: &[Vec3; 3]) -> f64 {
        let reach = half_axes.iter().map(|a| dot(*a, self.normal).powi(2)).sum::<f64>().sqrt();
        self.height(centre) - reach
    }

    /// The depth of the plane in samples: `d[0] x + d[1] y + d[2]`.
    pub(super) fn depth(&self, view: &View) -> [f64; 3] {
        let n = view.axes.turn(self.normal);
        let p = view.project(self.point).map(f64::from);
        let slope = [-n[0] / n[2], -n[1] / n[2]];
        [slope[0], slope[1], p[2] - slope[0] * p[0] - slope[1] * p[1]]
    }
}

/// The part of a polygon at heights up to zero; the new edge counts as a line.
pub(super) fn clip(polygon: &[(Vec3, f64, bool)]) -> Polygon {
    let mut kept = Polygon::new();
    for (i, &(p, h, line)) in polygon.iter().enumerate() {
        let (q, g, _) = polygon[(i + 1) % polygon.len()];
        if h <= 0.0 {
            kept.push((p, line));
        }
        if (h < 0.0 && g > 0.0) || (h > 0.0 && g < 0.0) {
            kept.push((mix(p, q, h / (h - g)), line || h < 0.0));
        }
    }
    kept
}

/// The polygons where the plane of height zero cuts an element; they cover the cut without gap or
/// overlap, and only edges on its outline are lines.
pub(super) fn cap(corners: &[Vec3; 8], heights: &[f64; 8]) -> Vec<Polygon> {
    TETRAHEDRA.iter().filter_map(|tetrahedron| slice(tetrahedron, corners, heights)).collect()
}

fn slice(tetrahedron: &[usize; 4], corners: &[Vec3; 8], heights: &[f64; 8]) -> Option<Polygon> {
    let (front, back): (Vec<usize>, Vec<usize>) =
        tetrahedron.iter().partition(|c| heights[**c] > 0.0);
    // The order in which one walks around the cut: neighbours share a corner.
    let edges: Vec<[usize; 2]> = match (&front[..], &back[..]) {
        ([a], [p, q, r]) | ([p, q, r], [a]) => vec![[*a, *p], [*a, *q], [*a, *r]],
        ([a, b], [p, q]) => vec![[*a, *p], [*a, *q], [*b, *q], [*b, *p]],
        _ => return None,
    };
    let at = |[a, b]: [usize; 2]| {
        let (h, g) = (heights[a], heights[b]);
        mix(corners[a], corners[b], h / (h - g))
    };
    let outline = |a: [usize; 2], b: [usize; 2]| {
        let touches = |c| a.contains(&c) || b.contains(&c);
        // A face of the tetrahedron with both ends of the diagonal is inside the element.
        !(touches(0) && touches(6))
    };
    let count = edges.len();
    Some((0..count).map(|i| (at(edges[i]), outline(edges[i], edges[(i + 1) % count]))).collect())
}
