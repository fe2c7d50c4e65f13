//! Faces of live surfaces, and points of them.

use crate::space::contacts::Contacts;
use crate::space::lattice::cross;
use crate::space::mesh::{Body, Mesh};

/// Points of a face, from 0 to 1 along its sides: those of Gauss, two each way. A pressure then does on
/// every corner the work that it does on the bilinear face, and no point starts on an edge of the
/// face across (decision 0016).
pub(super) const POINTS: [[f64; 2]; 4] = {
    // (1 - 1/sqrt(3)) / 2
    let (low, high) = (0.211_324_865_405_187_1, 0.788_675_134_594_812_9);
    [[low, low], [high, low], [high, high], [low, high]]
};

/// Most rounds of the search for the nearest point of a face, and the move along its sides that ends it.
const ROUNDS: usize = 40;
const CLOSEST: f64 = 1e-13;

/// A move so short that the square of the distance does not tell whether it leads away.
const SHORT: f64 = 1e-6;

/// Square of the warp of a face over that of its sides from which on it may have several nearest points.
const WARPED: f64 = 0.01;

/// Part by which the square of a distance must be larger to be so beyond rounding.
const SURE: f64 = 1e-9;

/// Least determinant of the curvatures of the square of the distance, over that of a rectangle's, that the
/// search trusts.
const CONVEX: f64 = 1e-6;

/// Corners of the face of an element, in order about the axis that it lies across, from the lowest.
pub(super) type Nodes = [usize; 4];

/// The same as members.
pub(super) type Corners = [u32; 4];

/// Calls for every face of the live surface of a body round a node, with the side of its element: twice
/// the axis that it lies across, and one more if it is the upper one.
pub(super) fn each_face(mesh: &Mesh, body: usize, at: [i16; 3], mut f: impl FnMut(Nodes, usize)) {
    let own = &mesh.bodies[body];
    let mut live = 0u8;
    for (octant, cell) in own.lattice.cells_round(at) {
        live |= u8::from(mesh.held(own.centroids.start + cell as usize)) << octant;
    }
    for octant in (0..8).filter(|octant| live >> octant & 1 == 1) {
        let upper = |d: usize| octant >> d & 1 == 1;
        let corner: [i16; 3] = std::array::from_fn(|d| if upper(d) { at[d] } else { at[d] - 2 });
        // The cell beyond the face is another one round the node.
        for axis in (0..3).filter(|axis| live >> (octant ^ 1 << axis) & 1 == 0) {
            let mut lowest = corner;
            lowest[axis] = at[axis];
            f(face_across(own, lowest, axis), 2 * axis + usize::from(!upper(axis)));
        }
    }
}

/// Whether a node lies where faces of the live surface of a body meet at an edge or a corner that stands out: two of its cells
/// are live at most.
pub(super) fn is_rim(mesh: &Mesh, body: usize, at: [i16; 3]) -> bool {
    let own = &mesh.bodies[body];
    let live = |&(_, cell): &(usize, u32)| mesh.held(own.centroids.start + cell as usize);
    own.lattice.cells_round(at).filter(live).count() <= 2
}

/// The face across an axis with this node as its lowest corner.
pub(super) fn face_across(body: &Body, lowest: [i16; 3], axis: usize) -> Nodes {
    [[0, 0], [2, 0], [2, 2], [0, 2]].map(|step: [i16; 2]| {
        let mut node = lowest;
        node[(axis + 1) % 3] += step[0];
        node[(axis + 2) % 3] += step[1];
        body.nodes.start + body.lattice.node(node) as usize
    })
}

/// Shares of the corners of a face in a point of it.
pub(super) fn bilinear([u, v]: [f64; 2]) -> [f64; 4] {
    [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]
}

/// The members that the corners of a face are, if they are: those of live surfaces are.
pub(super) fn corners_of(contacts: &Contacts, nodes: &Nodes) -> Option<Corners> {
    let mut corners = [0; 4];
    for (corner, &node) in corners.iter_mut().zip(nodes) {
        *corner = contacts.find(node)? as u32;
    }
    Some(corners)
}

/// Where they are.
#[inline(always)]
pub(super) fn places_of(contacts: &Contacts, corners: &Corners) -> [[f64; 3]; 4] {
    corners.map(|corner| contacts.position(corner))
}

/// The mean of places with these shares.
#[inline(always)]
pub(super) fn mean_of(places: &[[f64; 3]; 4], shares: &[f64; 4]) -> [f64; 3] {
    let shares = shares.iter().zip(places).filter(|(share, _)| **share > 0.0);
    shares.fold([0.0; 3], |x, (&share, &place)| plus(x, share, place))
}

/// The part of a face that one of its points acts for.
pub(super) struct Part {
    /// Where the point is, from 0 to 1 along both sides.
    pub(super) at: [f64; 2],
    /// Derivatives of the place along both.
    pub(super) along: [[f64; 3]; 2],
    pub(super) area: f64,
    pub(super) normal: [f64; 3],
}

impl Part {
    pub(super) fn of([a, b, c, d]: [[f64; 3]; 4], at: [f64; 2]) -> Self {
        let between = |x: [f64; 3], y: [f64; 3], t: f64| plus(x, t, minus(y, x));
        let along =
            [between(minus(b, a), minus(c, d), at[1]), between(minus(d, a), minus(c, b), at[0])];
        let area = cross(along[0], along[1]);
        let size = dot(area, area).sqrt();
        let normal = area.map(|x| x / size.max(f64::MIN_POSITIVE));
        Self { at, along, area: size / POINTS.len() as f64, normal }
    }

    /// Gradients of the area, by corner.
    pub(super) fn slopes(&self) -> [[f64; 3]; 4] {
        let [u, v] = self.at;
        let turned = [cross(self.along[1], self.normal), cross(self.normal, self.along[0])];
        let [p, q] = turned.map(|way| way.map(|x| x / POINTS.len() as f64));
        // Derivatives of the shares of the corners along both sides.
        [[v - 1.0, u - 1.0], [1.0 - v, -u], [v, u], [-v, 1.0 - u]]
            .map(|[by, other]| plus(p.map(|x| by * x), other, q))
    }
}

/// The point of a face that is nearest to another point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    /// Where it is, from 0 to 1 along both sides.
    pub(super) at: [f64; 2],
    /// From there to the other.
    pub(super) r: [f64; 3],
    /// Square of its length.
    pub(super) square: f64,
}

impl Nearest {
    /// Of a bilinear face with these corners, to `x`. Where the face is warped the search starts from its
    /// edges too: a fold of it may be nearer than what is seen from the middle.
    pub(super) fn of(x: [f64; 3], corners: [[f64; 3]; 4]) -> Self {
        let face = Bilinear::new(x, corners);
        face.nearest(face.start())
    }

    /// The same, unless the face is seen to be farther away than the square root of `limit`.
    pub(super) fn within(x: [f64; 3], corners: [[f64; 3]; 4], limit: f64) -> Option<Self> {
        let face = Bilinear::new(x, corners);
        let away = corners.map(|corner| minus(x, corner));
        // No point of a face is nearer, along any way, than the nearest of its corners.
        let beyond = |way: [f64; 3]| {
            let least = away.iter().fold(f64::INFINITY, |least, &r| least.min(dot(r, way)));
            least > 0.0 && least * least > limit * (1.0 + SURE) * dot(way, way)
        };
        let start = face.start();
        if limit.is_finite() && (beyond(start.r) || beyond(face.step(&start).1.r)) {
            return None;
        }
        Some(face.nearest(start))
    }

    /// The corner of its face next to it, if it lies on a side that does not meet `node`.
    pub(super) fn beyond(&self, face: &Corners, node: u32) -> Option<u32> {
        let shares = bilinear(self.at);
        let corners = || face.iter().zip(&shares);
        corners().find(|&(&corner, &share)| corner == node && share == 0.0)?;
        corners().max_by(|a, b| a.1.total_cmp(b.1)).map(|(&corner, _)| corner)
    }
}

/// The nearest point of some faces, the first of equals. It is sought first on a face where it is likely.
pub(super) fn nearest_face(
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

/// A bilinear face, and a point seen from its first corner.
struct Bilinear {
    from: [f64; 3],
    /// From the first corner to those beside it.
    sides: [[f64; 3]; 2],
    /// What the opposite corner lacks of a parallelogram's.
    twist: [f64; 3],
}

impl Bilinear {
    fn new(x: [f64; 3], [a, b, c, d]: [[f64; 3]; 4]) -> Self {
        let sides = [minus(b, a), minus(d, a)];
        Self { from: minus(x, a), sides, twist: minus(minus(c, d), sides[0]) }
    }

    /// Derivatives of the place along both sides.
    fn along(&self, at: [f64; 2]) -> [[f64; 3]; 2] {
        [plus(self.sides[0], at[1], self.twist), plus(self.sides[1], at[0], self.twist)]
    }

    /// From a place on the face to the point.
    fn away(&self, at: [f64; 2]) -> [f64; 3] {
        plus(plus(self.from, -at[0], self.sides[0]), -at[1], self.along(at)[1])
    }

    /// A place on the face, as if it were the nearest.
    fn seen(&self, at: [f64; 2]) -> Nearest {
        let r = self.away(at);
        Nearest { at, r, square: dot(r, r) }
    }

    /// The middle, where the search begins.
    fn start(&self) -> Nearest {
        self.seen([0.5; 2])
    }

    /// The nearest place, seen from the middle.
    fn nearest(&self, start: Nearest) -> Nearest {
        let mut best = self.descend(start);
        let size = dot(self.sides[0], self.sides[0]) + dot(self.sides[1], self.sides[1]);
        if dot(self.twist, self.twist) > WARPED * size {
            for (start, way) in [([0.0; 2], 0), ([0.0; 2], 1), ([0.0, 1.0], 0), ([1.0, 0.0], 1)] {
                let near = self.seen(self.slide(start, way));
                if near.square < best.square {
                    best = self.descend(near);
                }
            }
        }
        best
    }

    /// The place nearest to the point along one side through `start`.
    fn slide(&self, start: [f64; 2], way: usize) -> [f64; 2] {
        let along = self.along(start)[way];
        let t = dot(self.away(start), along) / dot(along, along).max(f64::MIN_POSITIVE);
        let mut at = start;
        at[way] = (start[way] + t).clamp(0.0, 1.0);
        at
    }

    /// Newton's step on the square of the distance, within the face, and where it leads.
    fn step(&self, Nearest { at, r, .. }: &Nearest) -> ([f64; 2], Nearest) {
        let along = self.along(*at);
        let slope = along.map(|along| dot(*r, along));
        let steep = along.map(|along| dot(along, along));
        let mixed = dot(along[0], along[1]) - dot(*r, self.twist);
        let both = steep[0] * steep[1] - mixed * mixed;
        let (own, other) = if both > CONVEX * steep[0] * steep[1] {
            (steep, mixed)
        } else {
            // With the size of the smaller curvature: no step leads up then.
            let scale = (steep[0] * steep[1]).sqrt().max(f64::MIN_POSITIVE);
            let bent = mixed.abs() / scale;
            let (more, less) = (0.5 * (1.0 + bent), 0.5 * (1.0 - bent).abs().max(CONVEX));
            (steep.map(|x| (more + less) * x), ((more - less) * scale).copysign(mixed))
        };
        let whole = (own[0] * own[1] - other * other).max(f64::MIN_POSITIVE);
        let step = [0, 1].map(|i| (slope[i] * own[1 - i] - slope[1 - i] * other) / whole);
        // What would leave the face stays on its edge.
        let leaves = |i: usize, way: f64| at[i] <= 0.0 && way <= 0.0 || at[i] >= 1.0 && way >= 0.0;
        let held = match [0, 1].map(|i| leaves(i, slope[i])) {
            [false, false] => [0, 1].map(|i| leaves(i, step[i])),
            held => held,
        };
        let alone = |i: usize| slope[i] / steep[i].max(f64::MIN_POSITIVE);
        let step = match held {
            [false, false] => step,
            _ => [0, 1].map(|i| if held[i] { 0.0 } else { alone(i) }),
        };
        (step, self.by(at, &step))
    }

    /// What a step leads to.
    fn by(&self, at: &[f64; 2], step: &[f64; 2]) -> Nearest {
        self.seen([0, 1].map(|i| (at[i] + step[i]).clamp(0.0, 1.0)))
    }

    /// Newton's iteration from a place on; a step never leads away.
    fn descend(&self, mut near: Nearest) -> Nearest {
        let mut rounds = 0..ROUNDS;
        while rounds.next().is_some() {
            let (mut step, mut next) = self.step(&near);
            // A step that leads away is too long, unless the distance cannot tell.
            loop {
                let moved = (next.at[0] - near.at[0]).abs() + (next.at[1] - near.at[1]).abs();
                let nearer = moved < SHORT || next.square < near.square;
                if nearer {
                    near = next;
                }
                if moved < CLOSEST {
                    return near;
                }
                if nearer || rounds.next().is_none() {
                    break;
                }
                step = step.map(|step| 0.5 * step);
                next = self.by(&near.at, &step);
            }
        }
        near
    }
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + t b`.
pub(super) fn plus(a: [f64; 3], t: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]]
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
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
            let Nearest { at, square: found, .. } = Nearest::of(x, CORNERS);
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

    /// However warped a face is and wherever the point, the search ends where no way along the face leads
    /// nearer. One that alternates between the sides where the distance is not convex does not get there.
    #[test]
    fn the_search_ends_at_a_stationary_point_of_any_face() {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for case in 0..20_000 {
            let mut place = |at: [f64; 2]| [at[0] + random(), at[1] + random(), random()];
            let corners = [[0.0; 2], [1.0, 0.0], [1.0; 2], [0.0, 1.0]].map(&mut place);
            let x = place([0.5; 2]);
            let Nearest { at, r, .. } = Nearest::of(x, corners);
            for (t, along) in at.into_iter().zip(Part::of(corners, at).along) {
                let slope = dot(r, along) / dot(along, along);
                let leaves = t == 0.0 && slope <= 0.0 || t == 1.0 && slope >= 0.0;
                assert!(
                    leaves || slope.abs() < 1e-12,
                    "{case}: {x:?} {corners:?} {at:?} {slope:e}"
                );
            }
        }
    }

    /// Seen from the middle of a face as the rod has them, the nearest point of its fold is missed.
    #[test]
    fn the_nearest_point_of_a_fold_is_found() {
        let corners = [
            [0.023_1, -0.020_0, 0.193_9],
            [0.159_4, -0.054_5, 0.256_8],
            [0.257_9, -0.061_8, 0.294_4],
            [0.116_0, -0.118_3, 0.264_3],
        ];
        let x = [0.099_4, -0.003_5, 0.407_2];
        let near = Nearest::of(x, corners);
        let corner = minus(x, corners[1]);
        assert!(near.square <= dot(corner, corner) + 1e-15, "{near:?}");
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
