//! The lattice of one body: which cells fill its shape, and its particles in lattice order.
//!
//! Particles sit at the nodes and centroids of cells, equal ones unless a mapping has moved the nodes
//! (decision 0018). The axes of the lattice are called fast, mid and slow: fast runs along the most
//! cells, so that eight cells side by side are eight numbers in a row; slow is the second longest, so
//! that whole planes of cells can go to different threads. Positions are counted in half cells: nodes
//! have even coordinates, centroids odd ones.

use super::mapping::Mapping;
use super::scene::{Body, Shape, Wall};

/// Sixteenths of a cell's mass at its centroid; each node has one of them.
pub const CENTROID_SHARE: u8 = 8;

/// No particle or cell.
pub const NONE: u32 = u32::MAX;

/// Cells in a row along the fast axis, without a gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Run {
    /// Cell coordinate along the slow axis.
    pub slow: usize,
    /// First cell: its nodes at the lower fast end, for (mid, slow) = (0,0), (1,0), (0,1), (1,1).
    pub rows: [u32; 4],
    /// First cell: its centroid, counted among the centroids.
    pub centre: u32,
    /// Number of cells.
    pub cells: usize,
}

/// Longest edge of a cell over the shortest up to which particles are spheres.
const CUBIC: f64 = 1.1;

/// The lattice of a body.
#[derive(Debug, Clone)]
pub struct Lattice {
    /// Edges of a cell along the fast, mid and slow axes.
    pub size: [f64; 3],
    /// The fast, mid and slow axes as unit vectors, right-handed.
    pub axes: [[f64; 3]; 3],
    /// Corner of the lattice, where all coordinates are zero.
    pub origin: [f64; 3],
    /// Cells along the fast, mid and slow axes.
    pub cells: [usize; 3],
    /// Coordinates of the nodes in half cells, slowest axis first in order.
    pub nodes: Vec<[i16; 3]>,
    /// Coordinates of the centroids in half cells.
    pub centroids: Vec<[i16; 3]>,
    /// Cells round each node, 1 to 8: its mass in sixteenths of a cell.
    pub share: Vec<u8>,
    /// The cells, in order.
    pub runs: Vec<Run>,
    /// First node of every slow plane, and the number of nodes.
    pub node_planes: Vec<usize>,
    /// First centroid of every slow plane of cells, and the number of centroids.
    pub cell_planes: Vec<usize>,
    node_at: Vec<u32>,
    cell_at: Vec<u32>,
    /// Where a mapping has moved the nodes and centroids; empty without one.
    moved: [Vec<[f64; 3]>; 2],
}

/// Edges of the cells of a body along its own axes, without a mapping: the cells have the volume of the
/// shape.
#[must_use]
pub fn cell_size(body: &Body) -> [f64; 3] {
    let extent = body.shape.extent();
    let even = |axis: usize| extent[axis] / body.cells[axis] as f64;
    let nominal = |axes: usize| (0..axes).map(even).product::<f64>();
    match body.shape {
        Shape::Box { .. } => [even(0), even(1), even(2)],
        Shape::Cylinder { .. } | Shape::Ring { .. } => {
            // Stretches both edges alike, so that unequal counts keep their ratio.
            let area = body.shape.volume() / extent[2];
            let scale = (area / (filled(body, 1) as f64 * nominal(2))).sqrt();
            [even(0) * scale, even(1) * scale, even(2)]
        }
        Shape::Sphere { .. } | Shape::Skewed { .. } | Shape::Cone { .. } | Shape::Filled { .. } => {
            let cells = filled(body, body.cells[2]) as f64;
            let scale = (body.shape.volume() / (cells * nominal(3))).cbrt();
            [even(0) * scale, even(1) * scale, even(2) * scale]
        }
    }
}

/// Cells of a body in its first layers.
fn filled(body: &Body, layers: usize) -> usize {
    let [n1, n2, _] = body.cells;
    let rows = (0..layers).flat_map(|k| (0..n2).map(move |j| (j, k)));
    let inside = |at: [usize; 3]| body.shape.has(at, body.cells);
    rows.map(|(j, k)| (0..n1).filter(|&i| inside([i, j, k])).count()).sum()
}

/// Whether a body has a cell at all.
#[must_use]
pub fn fills(body: &Body) -> bool {
    let [n1, n2, n3] = body.cells;
    let mut rows = (0..n3).flat_map(|k| (0..n2).map(move |j| (j, k)));
    rows.any(|(j, k)| (0..n1).any(|i| body.shape.has([i, j, k], body.cells)))
}

/// The axes of the lattice of a body.
fn turned(body: &Body) -> [[f64; 3]; 3] {
    let turn = body.turn.axes();
    let Some(lattice) = body.shape.lattice() else { return turn };
    lattice.axes().map(|axis| std::array::from_fn(|d| (0..3).map(|k| axis[k] * turn[k][d]).sum()))
}

impl Lattice {
    /// The lattice of a body at the start.
    #[must_use]
    pub fn new(body: &Body) -> Self {
        let own = cell_size(body);
        let order = axis_order(body);
        let turned = turned(body);
        let (fast, slow) = (turned[order[0]], turned[order[2]]);
        // Right-handed, whichever way the mid axis then points.
        let axes = [fast, cross(slow, fast), slow];
        let flipped = dot(axes[1], turned[order[1]]) < 0.0;
        let size = order.map(|axis| own[axis]);
        let cells = order.map(|axis| body.cells[axis]);
        let mut origin = body.centre;
        for k in 0..3 {
            for (d, x) in origin.iter_mut().enumerate() {
                *x -= 0.5 * size[k] * cells[k] as f64 * axes[k][d];
            }
        }
        let in_shape = |at: [usize; 3]| {
            let mut cell = [0; 3];
            for (axis, at) in order.into_iter().zip(at) {
                cell[axis] = at;
            }
            if flipped {
                cell[order[1]] = body.cells[order[1]] - 1 - cell[order[1]];
            }
            body.shape.has(cell, body.cells)
        };
        let mut lattice = Self {
            size,
            axes,
            origin,
            cells,
            nodes: Vec::new(),
            centroids: Vec::new(),
            share: Vec::new(),
            runs: Vec::new(),
            node_planes: Vec::new(),
            cell_planes: Vec::new(),
            node_at: Vec::new(),
            cell_at: Vec::new(),
            moved: [Vec::new(), Vec::new()],
        };
        lattice.fill(&in_shape);
        lattice.connect();
        if let Some(mapping) = body.mapping {
            lattice.move_by(&mapping);
        }
        lattice
    }

    /// Numbers cells and nodes.
    fn fill(&mut self, in_shape: &dyn Fn([usize; 3]) -> bool) {
        let [nf, nm, ns] = self.cells;
        self.cell_at = vec![NONE; nf * nm * ns];
        for s in 0..ns {
            self.cell_planes.push(self.centroids.len());
            for m in 0..nm {
                for f in 0..nf {
                    if in_shape([f, m, s]) {
                        self.cell_at[(s * nm + m) * nf + f] = self.centroids.len() as u32;
                        self.centroids.push([f, m, s].map(|c| 2 * c as i16 + 1));
                    }
                }
            }
        }
        self.cell_planes.push(self.centroids.len());
        self.node_at = vec![NONE; (nf + 1) * (nm + 1) * (ns + 1)];
        for s in 0..=ns {
            self.node_planes.push(self.nodes.len());
            for m in 0..=nm {
                for f in 0..=nf {
                    let at = [f, m, s].map(|c| 2 * c as i16);
                    let share = self.cells_round(at).count() as u8;
                    if share > 0 {
                        self.node_at[(s * (nm + 1) + m) * (nf + 1) + f] = self.nodes.len() as u32;
                        self.nodes.push(at);
                        self.share.push(share);
                    }
                }
            }
        }
        self.node_planes.push(self.nodes.len());
    }

    /// Finds the runs.
    fn connect(&mut self) {
        let [nf, nm, ns] = self.cells;
        for s in 0..ns {
            for m in 0..nm {
                let mut f = 0;
                while f < nf {
                    let row = |f: usize| self.cell_at[(s * nm + m) * nf + f];
                    if row(f) == NONE {
                        f += 1;
                        continue;
                    }
                    let cells = (f..nf).take_while(|&f| row(f) != NONE).count();
                    let node = |m: usize, s: usize| self.node_at[(s * (nm + 1) + m) * (nf + 1) + f];
                    let rows = [node(m, s), node(m + 1, s), node(m, s + 1), node(m + 1, s + 1)];
                    self.runs.push(Run { slow: s, rows, centre: row(f), cells });
                    f += cells;
                }
            }
        }
    }

    /// Cells that touch the node at these coordinates, with the number of the octant, 0 to 7.
    pub fn cells_round(&self, at: [i16; 3]) -> impl Iterator<Item = (usize, u32)> + '_ {
        (0..8).filter_map(move |octant| {
            let side = |axis: usize| if octant >> axis & 1 == 1 { 1 } else { -1 };
            let cell = self.cell([at[0] + side(0), at[1] + side(1), at[2] + side(2)]);
            (cell != NONE).then_some((octant, cell))
        })
    }

    /// The cell whose centroid has these coordinates.
    #[must_use]
    pub fn cell(&self, at: [i16; 3]) -> u32 {
        let [nf, nm, ns] = self.cells;
        let inside = |c: i16, n: usize| c >= 1 && (c as usize) < 2 * n;
        if inside(at[0], nf) && inside(at[1], nm) && inside(at[2], ns) {
            let [f, m, s] = at.map(|c| c as usize / 2);
            self.cell_at[(s * nm + m) * nf + f]
        } else {
            NONE
        }
    }

    /// The node at these coordinates.
    #[must_use]
    pub fn node(&self, at: [i16; 3]) -> u32 {
        let [nf, nm, ns] = self.cells;
        let inside = |c: i16, n: usize| c >= 0 && (c as usize) <= 2 * n;
        if inside(at[0], nf) && inside(at[1], nm) && inside(at[2], ns) {
            let [f, m, s] = at.map(|c| c as usize / 2);
            self.node_at[(s * (nm + 1) + m) * (nf + 1) + f]
        } else {
            NONE
        }
    }

    /// Moves the nodes, and the centroids to the middle of their corners.
    fn move_by(&mut self, mapping: &Mapping) {
        let nodes = self.nodes.iter().map(|&at| mapping.apply(self.regular(at))).collect();
        self.moved[0] = nodes;
        let middle = |&at: &[i16; 3]| {
            let corner = |slot: usize| {
                let side = |axis: usize| if slot >> axis & 1 == 1 { 1 } else { -1 };
                self.position([at[0] + side(0), at[1] + side(1), at[2] + side(2)])
            };
            let corners: [[f64; 3]; 8] = std::array::from_fn(corner);
            std::array::from_fn(|d| corners.iter().map(|x| 0.125 * x[d]).sum())
        };
        self.moved[1] = self.centroids.iter().map(middle).collect();
    }

    /// Whether a mapping has moved its particles.
    #[inline(always)]
    #[must_use]
    pub fn is_mapped(&self) -> bool {
        !self.moved[0].is_empty()
    }

    /// Whether all nodes with this coordinate along a lattice axis lie on a wall.
    #[must_use]
    pub fn lies_on(&self, wall: &Wall, (axis, coordinate): (usize, i16)) -> bool {
        let tolerance = 1e-6 * self.cell_volume().cbrt();
        let mut nodes = self.nodes.iter().filter(|at| at[axis] == coordinate);
        nodes.all(|&at| (self.position(at)[wall.axis] - wall.position).abs() < tolerance)
    }

    /// Position of the particle with these coordinates at the start.
    #[must_use]
    pub fn position(&self, at: [i16; 3]) -> [f64; 3] {
        if self.is_mapped() {
            match at[0] & 1 {
                0 => self.moved[0][self.node(at) as usize],
                _ => self.moved[1][self.cell(at) as usize],
            }
        } else {
            self.regular(at)
        }
    }

    /// The same without a mapping.
    fn regular(&self, at: [i16; 3]) -> [f64; 3] {
        let steps = self.steps();
        std::array::from_fn(|d| {
            let along = |k: usize| steps[k][d] * f64::from(at[k]);
            self.origin[d] + along(0) + along(1) + along(2)
        })
    }

    /// Ways of one half cell along the fast, mid and slow axes, without a mapping.
    #[inline(always)]
    #[must_use]
    pub fn steps(&self) -> [[f64; 3]; 3] {
        std::array::from_fn(|k| self.axes[k].map(|x| 0.5 * self.size[k] * x))
    }

    /// Shortest edge of a cell, without a mapping.
    #[must_use]
    pub fn shortest(&self) -> f64 {
        self.size.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Whether edges differ by so little, without a mapping, that spheres pack them.
    #[must_use]
    pub fn nearly_cubic(&self) -> bool {
        self.size.into_iter().fold(0.0, f64::max) <= CUBIC * self.shortest()
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let places = self.nodes.capacity() + self.centroids.capacity();
        let maps = self.node_at.capacity() + self.cell_at.capacity();
        let moved = self.moved[0].capacity() + self.moved[1].capacity();
        6 * places
            + 24 * moved
            + self.share.capacity()
            + 4 * maps
            + self.runs.capacity() * std::mem::size_of::<Run>()
    }

    /// Volume of a cell, without a mapping.
    #[must_use]
    pub fn cell_volume(&self) -> f64 {
        self.size.iter().product()
    }
}

/// Distance at which particles of cells of this volume touch, `2 beta h`: half the diagonal of a cube.
#[must_use]
pub fn contact_length(cell_volume: f64) -> f64 {
    0.5 * 3f64.sqrt() * cell_volume.cbrt()
}

/// Axes of a body in the order fast, mid, slow.
fn axis_order(body: &Body) -> [usize; 3] {
    let cells = body.cells;
    if let Some(Mapping::Wrap { .. }) = body.mapping {
        // A sector ends on mirrors, which elements see across the mid and slow axes alone.
        return [0, 2, 1];
    }
    let mut order = [0, 1, 2];
    order.sort_by_key(|&axis| std::cmp::Reverse(cells[axis]));
    let [longest, second, shortest] = order;
    [longest, shortest, second]
}

/// The coordinate axes turned about `axis` by `angle`.
#[must_use]
pub fn rotation(axis: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
    let n = axis.map(|a| a / length);
    let (sin, cos) = angle.sin_cos();
    let turn = |v: [f64; 3]| {
        let along = (0..3).map(|d| n[d] * v[d]).sum::<f64>() * (1.0 - cos);
        let side = cross(n, v);
        std::array::from_fn(|d| cos * v[d] + sin * side[d] + along * n[d])
    };
    [turn([1.0, 0.0, 0.0]), turn([0.0, 1.0, 0.0]), turn([0.0, 0.0, 1.0])]
}

/// Scalar product.
#[inline(always)]
#[must_use]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
#[inline(always)]
#[must_use]
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
