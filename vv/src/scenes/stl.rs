//! Closed surfaces from STL files, and which cells of a lattice lie within.

use std::collections::BTreeMap;
use std::io::{Read, Seek};
use std::path::Path;

use whipple_solver::space::lattice::{cross, dot};

/// Part of the size of a surface by which rays miss the corners and edges that cells often lie on.
const ASIDE: [f64; 2] = [1.3e-7, 1.7e-7];

/// A closed surface of triangles, in the units of a scene.
#[derive(Debug, Clone)]
pub struct Surface {
    triangles: Vec<[[f64; 3]; 3]>,
    low: [f64; 3],
    high: [f64; 3],
}

impl Surface {
    /// Reads a file whose numbers have this unit of length.
    ///
    /// # Errors
    /// In words, what is wrong with it.
    pub fn read(path: &Path, unit: f64) -> Result<Self, String> {
        let name = path.display().to_string();
        let mut file =
            std::fs::File::open(path).map_err(|error| format!("{name} cannot be read: {error}"))?;
        Self::parse(&name, &mut file, unit)
    }

    /// The same of anything that can be read.
    ///
    /// # Errors
    /// In words, what is wrong with it.
    pub fn parse(name: &str, source: &mut (impl Read + Seek), unit: f64) -> Result<Self, String> {
        let mesh =
            stl_io::read_stl(source).map_err(|error| format!("{name} is no STL file: {error}"))?;
        // Every edge is that of one other triangle, the other way round.
        let mut edges: BTreeMap<[usize; 2], i32> = BTreeMap::new();
        for face in &mesh.faces {
            let [a, b, c] = face.vertices;
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *edges.entry([from.min(to), from.max(to)]).or_default() +=
                    if from < to { 1 } else { -1 };
            }
        }
        if mesh.faces.is_empty() || edges.values().any(|&sum| sum != 0) {
            return Err(format!(
                "{name} is no closed surface: wanted one whose triangles have no free edge"
            ));
        }
        let corner = |k: usize| {
            let x: [f32; 3] = mesh.vertices[k].into();
            x.map(|x| f64::from(x) * unit)
        };
        let triangles: Vec<[[f64; 3]; 3]> =
            mesh.faces.iter().map(|face| face.vertices.map(corner)).collect();
        Self::of(triangles).ok_or_else(|| format!("{name} has no volume, or numbers that are none"))
    }

    fn of(triangles: Vec<[[f64; 3]; 3]>) -> Option<Self> {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for x in triangles.iter().flatten() {
            for d in 0..3 {
                low[d] = low[d].min(x[d]);
                high[d] = high[d].max(x[d]);
            }
        }
        let surface = Self { triangles, low, high };
        let whole: f64 = surface.size().iter().product();
        (whole.is_finite() && surface.volume() > 1e-9 * whole).then_some(surface)
    }

    /// Edges of the box round it.
    #[must_use]
    pub fn size(&self) -> [f64; 3] {
        std::array::from_fn(|d| self.high[d] - self.low[d])
    }

    /// Middle of that box.
    #[must_use]
    pub fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|d| 0.5 * (self.high[d] + self.low[d]))
    }

    /// Volume within, by the divergence theorem.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let middle = self.centre();
        let from = |x: [f64; 3]| -> [f64; 3] { std::array::from_fn(|d| x[d] - middle[d]) };
        let all = self.triangles.iter().map(|&[a, b, c]| dot(from(a), cross(from(b), from(c))));
        (all.sum::<f64>() / 6.0).abs()
    }

    /// Cells of the box round it that have their centres within: first, number, and places along the other axes.
    #[must_use]
    pub fn runs(&self, cells: [usize; 3]) -> Vec<[u16; 4]> {
        let size = self.size();
        let place = |axis: usize, k: f64| self.low[axis] + size[axis] * k / cells[axis] as f64;
        let mut runs = Vec::new();
        for layer in 0..cells[2] {
            for row in 0..cells[1] {
                let y = place(1, row as f64 + 0.5) + ASIDE[0] * size[1];
                let z = place(2, layer as f64 + 0.5) + ASIDE[1] * size[2];
                for [from, to] in self.crossed([y, z]).as_chunks().0 {
                    let cell = |x: f64| (x - self.low[0]) / size[0] * cells[0] as f64 - 0.5;
                    let first = cell(*from).ceil().max(0.0) as usize;
                    let end = ((cell(*to).floor() + 1.0).max(0.0) as usize).min(cells[0]);
                    if first < end {
                        runs.push([first, end - first, row, layer].map(|n| n as u16));
                    }
                }
            }
        }
        runs
    }

    /// Where a line along x meets it.
    fn crossed(&self, [y, z]: [f64; 2]) -> Vec<f64> {
        let mut all: Vec<f64> = self.triangles.iter().filter_map(|t| meet(t, [y, z])).collect();
        all.sort_by(f64::total_cmp);
        all
    }
}

/// Where a line along x meets a triangle.
fn meet(triangle: &[[f64; 3]; 3], [y, z]: [f64; 2]) -> Option<f64> {
    let turn = |k: usize| {
        let [a, b] = [triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
        (a[1] - y) * (b[2] - z) - (a[2] - z) * (b[1] - y)
    };
    let parts = [turn(0), turn(1), turn(2)];
    let inside = parts.iter().all(|&p| p > 0.0) || parts.iter().all(|&p| p < 0.0);
    let sum: f64 = parts.iter().sum();
    inside.then(|| (0..3).map(|k| parts[k] / sum * triangle[k][0]).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A ball of triangles: an octahedron whose faces are split.
    fn ball(splits: usize) -> Surface {
        let mut triangles = Vec::new();
        for octant in 0..8 {
            let s = |d: usize| if octant >> d & 1 == 1 { 1.0 } else { -1.0 };
            let corners = [[s(0), 0.0, 0.0], [0.0, s(1), 0.0], [0.0, 0.0, s(2)]];
            let odd = s(0) * s(1) * s(2) < 0.0;
            triangles.push(if odd { [corners[1], corners[0], corners[2]] } else { corners });
        }
        for _ in 0..splits {
            let middle = |a: [f64; 3], b: [f64; 3]| {
                let m: [f64; 3] = std::array::from_fn(|d| a[d] + b[d]);
                let length = dot(m, m).sqrt();
                m.map(|x| x / length)
            };
            triangles = triangles
                .into_iter()
                .flat_map(|[a, b, c]| {
                    let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                })
                .collect();
        }
        Surface::of(triangles).unwrap()
    }

    #[test]
    fn cells_within_a_ball_are_those_of_a_ball() {
        let ball = ball(5);
        assert!((ball.volume() / (4.0 / 3.0 * PI) - 1.0).abs() < 1e-2);
        let n = 20;
        let runs = ball.runs([n; 3]);
        let found: usize = runs.iter().map(|run| usize::from(run[1])).sum();
        let inside = |c: [usize; 3]| {
            let x = c.map(|k| (2.0 * k as f64 + 1.0 - n as f64) / n as f64);
            dot(x, x) <= 1.0
        };
        let all = (0..n * n * n).map(|k| [k % n, k / n % n, k / n / n]);
        let wanted = all.filter(|&c| inside(c)).count();
        assert!(found.abs_diff(wanted) * 50 < wanted, "{found} {wanted}");
    }
}
