//! The undeformed cells of a body, as its elements see them: all alike, or each with its own shape where
//! a mapping has moved its lattice.
//!
//! Elements are compiled once for either. Of equal cells there is one set of numbers in the body;
//! of others one a cell, in columns, which are empty otherwise.

use super::element::{FACES, corner_volumes, pyramid_volumes};
use super::lanes::{F8, LANES, Lanes};
use super::lattice::{Lattice, cross};
use super::mesh::Body;
use super::scene::Body as BodyData;
use crate::error::SceneError;

/// Longest edge of a mapped cell over its shortest.
const LONGEST_EDGE: f64 = 3.0;

/// Smallest share of a corner in the volume of its cell, over a sixteenth: lighter particles would ask for
/// a much shorter time step than the others.
const LIGHTEST: f64 = 0.64;

/// Columns of a mapped cell: components of the corners from the centroid,
const CORNERS: usize = 0;
/// of the weights of the corners in the mean gradient along the axes of the lattice,
const GRADIENT: usize = 24;
/// volumes of the pyramids, and one over them,
const PYRAMIDS: usize = 48;
const PER_PYRAMID: usize = 54;
/// the volumes that the corners have of the cell,
const SHARES: usize = 60;
/// its volume,
const VOLUME: usize = 68;
/// its volume over its largest face, which is the shortest edge of a box,
const EDGE: usize = 69;
/// and areas of its bonds.
const BOND_AREAS: usize = 70;
const COLUMNS: usize = 72;

/// The shapes of mapped cells.
#[derive(Debug, Clone, Default)]
pub struct Mapped {
    values: Vec<f64>,
    /// Length of a column: the cells, and seven more, so that eight can always be read.
    stride: usize,
    cells: usize,
}

impl Mapped {
    /// The cells of a lattice whose particles have been moved; nothing otherwise. Corners share volumes
    /// with this part of the opposite ones ([`super::method::Method::balance`]).
    #[must_use]
    pub fn new(lattice: &Lattice, balance: f64) -> Self {
        if !lattice.is_mapped() {
            return Self::default();
        }
        let cells = lattice.centroids.len();
        let stride = cells + LANES - 1;
        let mut mapped = Self { values: vec![0.0; COLUMNS * stride], stride, cells };
        for cell in 0..stride {
            let shape = Shape::of(lattice, cell.min(cells - 1));
            for (column, value) in shape.columns(lattice, balance).into_iter().enumerate() {
                mapped.values[column * stride + cell] = value;
            }
        }
        mapped
    }

    /// Number of cells; none if they are all alike.
    #[must_use]
    pub fn len(&self) -> usize {
        self.cells
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cells == 0
    }

    fn column(&self, column: usize) -> &[f64] {
        &self.values[column * self.stride..][..self.cells]
    }

    /// Mean volume of a cell.
    #[must_use]
    pub fn mean_volume(&self) -> f64 {
        self.column(VOLUME).iter().sum::<f64>() / self.cells as f64
    }

    /// Smallest edge of a cell, as [`Cells::edge_as`] has it.
    #[must_use]
    pub fn edge(&self) -> f64 {
        self.column(EDGE).iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Volume of a cell.
    #[must_use]
    pub fn volume(&self, cell: usize) -> f64 {
        self.column(VOLUME)[cell]
    }

    /// Volume that a corner has of a cell.
    #[must_use]
    pub fn share(&self, cell: usize, corner: usize) -> f64 {
        self.column(SHARES + corner)[cell]
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        8 * self.values.capacity()
    }
}

/// Checks that the mapped cells of a body are cells.
///
/// # Errors
/// The first that is not.
pub(super) fn check(body: &BodyData, balance: f64, key: &str) -> Result<(), SceneError> {
    let lattice = Lattice::new(body);
    for cell in 0..lattice.centroids.len() {
        let shape = Shape::of(&lattice, cell);
        let refuse = |what: &str, given: f64, wanted: &str| {
            let at = lattice.position(lattice.centroids[cell]);
            let given = format!("{what} {given:.3e} of the cell at {at:?}");
            Err(SceneError::new(format!("{key}.mapping"), given, wanted))
        };
        let smallest = shape.pyramids.iter().copied().fold(f64::INFINITY, f64::min);
        if smallest.is_nan() || smallest <= 0.0 {
            let wanted = "it must keep the volumes of cells, and of their pyramids, positive";
            return refuse("the smallest pyramid", smallest, wanted);
        }
        let stretch = shape.stretch();
        if stretch > LONGEST_EDGE {
            let wanted =
                format!("edges of a cell may differ by a factor of {LONGEST_EDGE} at most");
            return refuse("the ratio of edges", stretch, &wanted);
        }
        let lightest =
            corner_volumes(&shape.pyramids, balance).into_iter().fold(f64::INFINITY, f64::min);
        let lightest = 16.0 * lightest / shape.volume();
        if lightest < LIGHTEST {
            let wanted = format!("a corner needs {LIGHTEST} of a sixteenth of its cell");
            return refuse("the lightest corner", lightest, &wanted);
        }
    }
    Ok(())
}

/// An undeformed cell.
struct Shape {
    /// Corners from the centroid, slot by slot.
    corners: [[f64; 3]; 8],
    pyramids: [f64; 6],
}

impl Shape {
    fn of(lattice: &Lattice, cell: usize) -> Self {
        let at = lattice.centroids[cell];
        let centre = lattice.position(at);
        let corners = std::array::from_fn(|slot| {
            let side = |axis: usize| if slot >> axis & 1 == 1 { 1 } else { -1 };
            let x = lattice.position([at[0] + side(0), at[1] + side(1), at[2] + side(2)]);
            std::array::from_fn(|d| x[d] - centre[d])
        });
        Self { pyramids: pyramid_volumes(&corners), corners }
    }

    fn volume(&self) -> f64 {
        self.pyramids.iter().sum()
    }

    /// Longest edge over the shortest.
    fn stretch(&self) -> f64 {
        let ways = (0..8).flat_map(|slot| (0..3).map(move |axis| (slot, slot | 1 << axis)));
        let edges = ways.filter(|(slot, other)| slot != other).map(|(slot, other)| {
            let square = |d: usize| (self.corners[slot][d] - self.corners[other][d]).powi(2);
            (square(0) + square(1) + square(2)).sqrt()
        });
        let [short, long] = edges.fold([f64::INFINITY, 0.0_f64], |[a, b], x| [a.min(x), b.max(x)]);
        long / short
    }

    /// Twice the area of a face, outwards.
    fn face(&self, [a, b, c, d]: [usize; 4]) -> [f64; 3] {
        let way = |to: usize, from: usize| {
            std::array::from_fn(|k| self.corners[to][k] - self.corners[from][k])
        };
        cross(way(c, a), way(d, b))
    }

    /// Gradients of the volume by the corners. Over the volume they are the weights of the corners in the
    /// mean gradient of a field over the cell: exact for affine fields, and a uniform stress is in
    /// equilibrium in whatever cells (D. P. Flanagan and T. Belytschko, Int. J. Numer. Meth. Eng. 17
    /// (1981) 679).
    fn slopes(&self) -> [[f64; 3]; 8] {
        let mut slopes = [[0.0; 3]; 8];
        for face in FACES {
            let [a, b, c, d] = face;
            let middle: [f64; 3] = std::array::from_fn(|k| {
                0.25 * face.iter().map(|&slot| self.corners[slot][k]).sum::<f64>()
            });
            let way = |to: usize, from: usize| {
                std::array::from_fn(|k| self.corners[to][k] - self.corners[from][k])
            };
            let area = self.face(face);
            // Of w . (e x g) / 6 with the middle w and the diagonals e, g.
            let (by_e, by_g) = (cross(way(d, b), middle), cross(middle, way(c, a)));
            for k in 0..3 {
                for slot in face {
                    slopes[slot][k] += area[k] / 24.0;
                }
                slopes[c][k] += by_e[k] / 6.0;
                slopes[a][k] -= by_e[k] / 6.0;
                slopes[d][k] += by_g[k] / 6.0;
                slopes[b][k] -= by_g[k] / 6.0;
            }
        }
        slopes
    }

    fn columns(&self, lattice: &Lattice, balance: f64) -> [f64; COLUMNS] {
        let mut out = [0.0; COLUMNS];
        let volume = self.volume();
        for (slot, slope) in self.slopes().iter().enumerate() {
            for d in 0..3 {
                let along = |axis: [f64; 3]| (0..3).map(|k| slope[k] * axis[k]).sum::<f64>();
                out[CORNERS + 3 * slot + d] = self.corners[slot][d];
                out[GRADIENT + 3 * slot + d] = along(lattice.axes[d]) / volume;
            }
        }
        out[PYRAMIDS..PER_PYRAMID].copy_from_slice(&self.pyramids);
        out[PER_PYRAMID..SHARES].copy_from_slice(&self.pyramids.map(|pyramid| 1.0 / pyramid));
        out[SHARES..VOLUME].copy_from_slice(&corner_volumes(&self.pyramids, balance));
        out[VOLUME] = volume;
        let size = |face: [f64; 3]| 0.5 * face.iter().map(|x| x * x).sum::<f64>().sqrt();
        let largest = FACES.map(|face| size(self.face(face))).into_iter().fold(0.0, f64::max);
        out[EDGE] = volume / largest;
        out[BOND_AREAS..].copy_from_slice(&bond_areas(volume, volume.powf(2.0 / 3.0)));
        out
    }
}

/// Area of the bonds of a cell of this volume: for the limited viscosity 3/4 of a face, of unequal ones the largest
/// (decision 0021), and `V_o^(2/3)` of its centroid for the printed one.
#[must_use]
pub fn bond_areas(volume: f64, face: f64) -> [f64; 2] {
    [0.75 * face, 0.5f64.powf(2.0 / 3.0) * volume.powf(2.0 / 3.0)]
}

/// The undeformed cells of up to eight elements, and their body.
#[derive(Debug, Clone, Copy)]
pub struct Cells<'a, const MAPPED: bool> {
    /// Their body.
    pub body: &'a Body,
    /// The first cell, counted in the body.
    at: usize,
}

impl<'a, const MAPPED: bool> Cells<'a, MAPPED> {
    /// The cells from that of this centroid on.
    #[inline(always)]
    #[must_use]
    pub fn new(body: &'a Body, centre: u32) -> Self {
        Self { body, at: centre as usize - body.centroids.start }
    }

    #[inline(always)]
    fn load<F: Lanes>(&self, column: usize) -> F {
        let mapped = &self.body.mapped;
        F::load(&mapped.values, column * mapped.stride + self.at)
    }

    /// A number of equal cells, or a column of others.
    #[inline(always)]
    fn get<F: Lanes>(&self, equal: f64, column: usize) -> F {
        if MAPPED { self.load(column) } else { F::splat(equal) }
    }

    /// What follows from such a number.
    #[inline(always)]
    fn get_as<F: Lanes>(&self, equal: f64, column: usize, f: impl Fn(f64) -> f64) -> F {
        if MAPPED { F::of(F8(self.load::<F>(column).pack().0.map(f))) } else { F::splat(f(equal)) }
    }

    /// A component of a corner from the centroid.
    #[inline(always)]
    #[must_use]
    pub fn corner<F: Lanes>(&self, slot: usize, d: usize) -> F {
        self.get(self.body.corners[slot][d], CORNERS + 3 * slot + d)
    }

    /// Volume of a pyramid.
    #[inline(always)]
    #[must_use]
    pub fn pyramid<F: Lanes>(&self, k: usize) -> F {
        self.get(self.body.pyramids[k], PYRAMIDS + k)
    }

    /// One over it.
    #[inline(always)]
    #[must_use]
    pub fn per_pyramid<F: Lanes>(&self, k: usize) -> F {
        self.get(self.body.per_pyramid[k], PER_PYRAMID + k)
    }

    /// Part of a pyramid in the volume of its cell.
    #[inline(always)]
    #[must_use]
    pub fn part<F: Lanes>(&self, k: usize) -> F {
        if MAPPED {
            self.pyramid::<F>(k) / self.volume()
        } else {
            F::splat(self.body.pyramids[k] / self.body.cell_volume)
        }
    }

    /// The smallest share of a corner in the volume of its cell, over a sixteenth, where cells are unequal.
    #[inline(always)]
    #[must_use]
    pub fn lightest<F: Lanes>(&self) -> Option<F> {
        if !MAPPED {
            return None;
        }
        let shares = (0..8).map(|slot| self.load::<F>(SHARES + slot));
        let least = shares.fold(F::splat(f64::INFINITY), |least, share| least.min(share));
        Some((least * 16.0 / self.volume()).min(F::splat(1.0)))
    }

    /// Volume of a cell.
    #[inline(always)]
    #[must_use]
    pub fn volume<F: Lanes>(&self) -> F {
        self.get(self.body.cell_volume, VOLUME)
    }

    /// What follows from it.
    #[inline(always)]
    #[must_use]
    pub fn volume_as<F: Lanes>(&self, f: impl Fn(f64) -> f64) -> F {
        self.get_as(self.body.cell_volume, VOLUME, f)
    }

    /// What follows from the volume over the largest face, the shortest edge of a box.
    #[inline(always)]
    #[must_use]
    pub fn edge_as<F: Lanes>(&self, f: impl Fn(f64) -> f64) -> F {
        self.get_as(self.body.solid.edge, EDGE, f)
    }

    /// What follows from the area of the bonds, by [`bond_areas`].
    #[inline(always)]
    #[must_use]
    pub fn bond_area_as<F: Lanes>(&self, form: usize, f: impl Fn(f64) -> f64) -> F {
        self.get_as(self.body.bond_areas[form], BOND_AREAS + form, f)
    }

    /// Squared length of the bond of a corner below which the printed viscosity acts.
    #[inline(always)]
    #[must_use]
    pub fn reach_squared<F: Lanes>(&self, slot: usize) -> F {
        if MAPPED {
            let [x, y, z] = [0, 1, 2].map(|d| self.corner::<F>(slot, d));
            x * x + y * y + z * z
        } else {
            F::splat(self.body.diagonal * self.body.diagonal)
        }
    }

    /// Sum of the squares of the weights of the corners in the gradient along an axis of the lattice.
    #[inline(always)]
    #[must_use]
    pub fn gradient_squared<F: Lanes>(&self, axis: usize) -> F {
        if !MAPPED {
            return F::splat(0.5 / self.body.lattice.size[axis].powi(2));
        }
        let mut sum = F::zero();
        for slot in 0..8 {
            let weight: F = self.weight(slot, axis);
            sum += weight * weight;
        }
        sum
    }

    /// Weight of a corner in the mean gradient along an axis of the lattice, of mapped cells.
    #[inline(always)]
    #[must_use]
    pub fn weight<F: Lanes>(&self, slot: usize, axis: usize) -> F {
        self.load(GRADIENT + 3 * slot + axis)
    }
}
