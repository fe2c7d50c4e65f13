//! The neutral form of a state: points, cells over them, fields.

use super::error::GridError;
use super::field::Field;

/// A state to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid<'a> {
    /// Positions; all finite.
    pub points: &'a [[f64; 3]],
    /// Cells over the points.
    pub cells: Cells<'a>,
    /// Fields with one entry a point.
    pub point_data: Vec<Field<'a>>,
    /// Fields with one entry a cell, in the order of the cells: vertices, then hexahedra.
    pub cell_data: Vec<Field<'a>>,
}

/// The cells of a grid: vertices first, then hexahedra.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cells<'a> {
    /// Which points are drawn as particles.
    pub vertices: Vertices<'a>,
    /// Elements by their eight points, in the order (0,0,0), (1,0,0), (1,1,0), (0,1,0), (0,0,1),
    /// (1,0,1), (1,1,1), (0,1,1). Their shape is not judged: a badly distorted element is a result.
    pub hexahedra: &'a [[u32; 8]],
}

/// Which points of a grid have a vertex cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vertices<'a> {
    /// None: only elements are drawn.
    None,
    /// Every point, in order.
    All,
    /// These points.
    Of(&'a [u32]),
}

impl<'a> Cells<'a> {
    /// Every point a particle, no elements.
    #[must_use]
    pub const fn particles() -> Self {
        Self { vertices: Vertices::All, hexahedra: &[] }
    }

    /// Only elements.
    #[must_use]
    pub const fn elements(hexahedra: &'a [[u32; 8]]) -> Self {
        Self { vertices: Vertices::None, hexahedra }
    }

    /// Every point a particle, and elements over the same points.
    #[must_use]
    pub const fn hybrid(hexahedra: &'a [[u32; 8]]) -> Self {
        Self { vertices: Vertices::All, hexahedra }
    }
}

impl Grid<'_> {
    /// Number of vertex cells.
    #[must_use]
    pub const fn vertex_count(&self) -> usize {
        match self.cells.vertices {
            Vertices::None => 0,
            Vertices::All => self.points.len(),
            Vertices::Of(points) => points.len(),
        }
    }

    /// Number of cells of both kinds.
    #[must_use]
    pub const fn cell_count(&self) -> usize {
        self.vertex_count() + self.cells.hexahedra.len()
    }

    /// Refuses what a reader would choke on or silently misread.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place.
    pub fn check(&self) -> Result<(), GridError> {
        for (point, position) in self.points.iter().enumerate() {
            if let Some(k) = position.iter().position(|x| !x.is_finite()) {
                let axis = ['x', 'y', 'z'][k];
                return Err(GridError::Coordinate { point, axis, value: position[k] });
            }
        }
        if let Vertices::Of(chosen) = self.cells.vertices {
            self.check_indices("vertex", chosen.chunks(1))?;
        }
        self.check_indices("hexahedron", self.cells.hexahedra.iter().map(<[u32; 8]>::as_slice))?;
        check_fields("point", &self.point_data, self.points.len())?;
        check_fields("cell", &self.cell_data, self.cell_count())
    }

    /// Refuses cells over points that do not exist.
    fn check_indices<'c>(
        &self,
        kind: &'static str,
        cells: impl Iterator<Item = &'c [u32]>,
    ) -> Result<(), GridError> {
        let points = self.points.len();
        for (cell, nodes) in cells.enumerate() {
            if let Some(&point) = nodes.iter().find(|&&p| p as usize >= points) {
                return Err(GridError::PointIndex { kind, cell, point, points });
            }
        }
        Ok(())
    }
}

/// Refuses a field that does not fit, or a name used twice.
fn check_fields(
    place: &'static str,
    fields: &[Field<'_>],
    entries: usize,
) -> Result<(), GridError> {
    for (k, field) in fields.iter().enumerate() {
        field.check(place, entries)?;
        if fields[..k].iter().any(|earlier| earlier.name == field.name) {
            return Err(GridError::Repeated { place, name: field.name.to_owned() });
        }
    }
    Ok(())
}
