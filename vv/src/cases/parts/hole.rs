//! The hole in a plate across y: what its elements leave open of a plane through it.

use std::f64::consts::PI;

use whipple_solver::space::Simulation;
use whipple_solver::space::output::Element;
use whipple_solver::space::scene::{Scene, Shape};

use super::impact::PLATE;

/// Pixels along the edge of a cell.
const FINE: f64 = 4.0;
/// Cells along the edges of the plate that are left out: what is open there is no hole.
const RIM: f64 = 2.0;

/// Corners of the faces of an element.
const FACES: [[usize; 4]; 6] =
    [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];

/// A square of pixels about x = z = 0.
struct Raster {
    /// Half the edge of the square, and the edge of a pixel.
    half: f64,
    pixel: f64,
    across: usize,
    covered: Vec<bool>,
}

impl Raster {
    fn new(half: f64, pixel: f64) -> Self {
        let across = (2.0 * half / pixel).round() as usize;
        Self {
            half,
            pixel: 2.0 * half / across as f64,
            across,
            covered: vec![false; across * across],
        }
    }

    /// Covers the pixels whose middle lies in a triangle.
    fn cover(&mut self, triangle: [[f64; 2]; 3]) {
        let [a, b, c] = triangle;
        let along = |k: usize| {
            let of = triangle.map(|p| (p[k] + self.half) / self.pixel - 0.5);
            let first = of.iter().copied().fold(f64::INFINITY, f64::min).ceil().max(0.0);
            let last = of.iter().copied().fold(f64::NEG_INFINITY, f64::max).floor();
            first as usize..((last + 1.0).max(0.0) as usize).min(self.across)
        };
        let side = |p: [f64; 2], q: [f64; 2], x: [f64; 2]| {
            (q[0] - p[0]) * (x[1] - p[1]) - (q[1] - p[1]) * (x[0] - p[0])
        };
        let (columns, rows) = (along(0), along(1));
        for row in rows {
            for column in columns.clone() {
                let x = [column, row].map(|i| (i as f64 + 0.5) * self.pixel - self.half);
                let sides = [side(a, b, x), side(b, c, x), side(c, a, x)];
                if sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0) {
                    self.covered[row * self.across + column] = true;
                }
            }
        }
    }

    /// Whether each pixel belongs to the largest connected set of those that are `wanted`.
    fn largest(&self, wanted: &[bool]) -> Vec<bool> {
        let mut seen = vec![false; wanted.len()];
        let mut best: Vec<usize> = Vec::new();
        for start in 0..wanted.len() {
            if seen[start] || !wanted[start] {
                continue;
            }
            seen[start] = true;
            let mut set = vec![start];
            let mut next = 0;
            while let Some(&at) = set.get(next) {
                next += 1;
                let (row, column) = (at / self.across, at % self.across);
                let ways = [
                    (column > 0).then(|| at - 1),
                    (column + 1 < self.across).then(|| at + 1),
                    (row > 0).then(|| at - self.across),
                    (row + 1 < self.across).then(|| at + self.across),
                ];
                for way in ways.into_iter().flatten() {
                    if wanted[way] && !seen[way] {
                        seen[way] = true;
                        set.push(way);
                    }
                }
            }
            if set.len() > best.len() {
                best = set;
            }
        }
        let mut inside = vec![false; wanted.len()];
        best.into_iter().for_each(|at| inside[at] = true);
        inside
    }

    /// Diameter of the disc with the area of the largest opening of what is connected: loose pieces within
    /// it, and single gaps elsewhere, do not count.
    fn opening(&self) -> f64 {
        let open: Vec<bool> = self.largest(&self.covered).into_iter().map(|held| !held).collect();
        let pixels = self.largest(&open).into_iter().filter(|open| *open).count();
        (4.0 / PI * pixels as f64).sqrt() * self.pixel
    }
}

/// Diameter of the hole in the plate of a scene: of the disc with the area that those of its live elements
/// leave open which count and cut the middle plane of the plate, seen along its normal.
pub(in crate::cases) fn diameter(
    simulation: &Simulation,
    scene: &Scene,
    counts: impl Fn(&Element) -> bool,
) -> f64 {
    let plate = &scene.bodies[PLATE];
    let (&Shape::Box { size: [edge, ..] }, [_, middle, _]) = (&plate.shape, plate.centre) else {
        return f64::NAN;
    };
    let cell = edge / plate.cells[0] as f64;
    let mut raster = Raster::new(0.5 * edge - RIM * cell, cell / FINE);
    let elements = simulation.all_elements().filter(|e| e.body == PLATE && e.live);
    for element in elements.filter(|element| counts(element)) {
        let corners = element.corners.map(|i| simulation.particle(i).position);
        let above = corners.iter().any(|x| x[1] >= middle);
        let below = corners.iter().any(|x| x[1] <= middle);
        if above && below {
            for face in FACES {
                let [a, b, c, d] = face.map(|slot| [corners[slot][0], corners[slot][2]]);
                raster.cover([a, b, c]);
                raster.cover([a, c, d]);
            }
        }
    }
    raster.opening()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A square plate with a square opening, a loose piece within it and a gap elsewhere.
    #[test]
    fn openings_are_those_of_the_plate() {
        let mut raster = Raster::new(3.0, 0.05);
        let mut cover = |[x0, x1]: [f64; 2], [z0, z1]: [f64; 2]| {
            raster.cover([[x0, z0], [x1, z0], [x1, z1]]);
            raster.cover([[x0, z0], [x1, z1], [x0, z1]]);
        };
        cover([-3.0, -1.0], [-3.0, 3.0]);
        cover([1.0, 2.0], [-3.0, 3.0]);
        cover([2.5, 3.0], [-3.0, 3.0]);
        cover([2.0, 2.5], [-3.0, 1.0]);
        cover([-1.0, 1.0], [-3.0, -1.0]);
        cover([-1.0, 1.0], [1.0, 3.0]);
        cover([-0.2, 0.3], [-0.1, 0.1]);
        let wanted = (4.0 / PI * 4.0).sqrt();
        assert_relative_eq!(raster.opening(), wanted, max_relative = 1e-9);
        let whole = Raster { covered: vec![true; raster.covered.len()], ..raster };
        assert_eq!(whole.opening(), 0.0);
    }
}
