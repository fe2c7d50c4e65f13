//! Shapes of bodies: their size, and which cells of a lattice belong to them.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::scene::{Turn, positive};
use crate::error::SceneError;

/// Shape of a body before it is turned and moved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// A box, plates included.
    Box {
        /// Edge lengths.
        size: [f64; 3],
    },
    /// A cylinder along its third axis.
    Cylinder {
        /// Diameter.
        diameter: f64,
        /// Length.
        length: f64,
    },
    /// A sphere.
    Sphere {
        /// Diameter.
        diameter: f64,
    },
    /// A ring or tube along its third axis.
    Ring {
        /// Outer diameter.
        outer: f64,
        /// Inner diameter.
        inner: f64,
        /// Length.
        length: f64,
    },
    /// A cone, blunt or not, along its third axis.
    Cone {
        /// Diameter at its lower end.
        lower: f64,
        /// Diameter at its upper end.
        upper: f64,
        /// Length.
        length: f64,
    },
    /// A box whose lattice is turned within it, so that its faces are stairs. Cells are counted along the axes of the
    /// lattice, across the smallest box of that direction round it.
    Skewed {
        /// Edge lengths of the box.
        size: [f64; 3],
        /// Turn of the lattice within the box, before the body is turned.
        lattice: Turn,
    },
    /// Any shape, by the cells of a box that belong to it.
    Filled {
        /// Edge lengths of the box.
        size: [f64; 3],
        /// Volume of the shape, which its cells are given.
        volume: f64,
        /// Cells side by side along the first axis: the first, their number, and their places along the second and the
        /// third axis; in order of the third, the second and the first.
        runs: Vec<[u16; 4]>,
    },
}

impl Shape {
    /// Volume.
    #[must_use]
    pub fn volume(&self) -> f64 {
        match *self {
            Self::Box { size: [a, b, c] } | Self::Skewed { size: [a, b, c], .. } => a * b * c,
            Self::Cylinder { diameter, length } => PI / 4.0 * diameter * diameter * length,
            Self::Sphere { diameter } => PI / 6.0 * diameter.powi(3),
            Self::Ring { outer, inner, length } => {
                PI / 4.0 * (outer - inner) * (outer + inner) * length
            }
            Self::Cone { lower, upper, length } => {
                PI / 12.0 * (lower * lower + lower * upper + upper * upper) * length
            }
            Self::Filled { volume, .. } => volume,
        }
    }

    /// Edge lengths of the smallest box around it along the axes of its lattice.
    #[must_use]
    pub fn extent(&self) -> [f64; 3] {
        match *self {
            Self::Box { size } | Self::Filled { size, .. } => size,
            Self::Cylinder { diameter, length } => [diameter, diameter, length],
            Self::Sphere { diameter } => [diameter; 3],
            Self::Ring { outer, length, .. } => [outer, outer, length],
            Self::Cone { lower, upper, length } => [lower.max(upper), lower.max(upper), length],
            Self::Skewed { size, lattice } => {
                let axes = lattice.axes();
                axes.map(|axis| (0..3).map(|d| axis[d].abs() * size[d]).sum())
            }
        }
    }

    /// The same shape so many times as large.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let long = |x: f64| factor * x;
        match self.clone() {
            Self::Box { size } => Self::Box { size: size.map(long) },
            Self::Cylinder { diameter, length } => {
                Self::Cylinder { diameter: long(diameter), length: long(length) }
            }
            Self::Sphere { diameter } => Self::Sphere { diameter: long(diameter) },
            Self::Ring { outer, inner, length } => {
                Self::Ring { outer: long(outer), inner: long(inner), length: long(length) }
            }
            Self::Cone { lower, upper, length } => {
                Self::Cone { lower: long(lower), upper: long(upper), length: long(length) }
            }
            Self::Skewed { size, lattice } => Self::Skewed { size: size.map(long), lattice },
            Self::Filled { size, volume, runs } => {
                Self::Filled { size: size.map(long), volume: volume * factor.powi(3), runs }
            }
        }
    }

    /// How its lattice is turned within it.
    #[must_use]
    pub fn lattice(&self) -> Option<Turn> {
        match *self {
            Self::Skewed { lattice, .. } => Some(lattice),
            _ => None,
        }
    }

    /// Whether a cell, by its coordinates among so many along the body's own axes, belongs to the shape: by its centre
    /// and the shape inscribed in the box of the cells.
    #[must_use]
    pub fn has(&self, cell: [usize; 3], cells: [usize; 3]) -> bool {
        // From -1 to 1 across the box.
        let from_centre = |axis: usize| {
            let n = cells[axis] as f64;
            (2.0 * cell[axis] as f64 + 1.0 - n) / n
        };
        let square = |axes: usize| (0..axes).map(|axis| from_centre(axis).powi(2)).sum::<f64>();
        match *self {
            Self::Box { .. } => true,
            Self::Cylinder { .. } => square(2) <= 1.0,
            Self::Sphere { .. } => square(3) <= 1.0,
            Self::Ring { outer, inner, .. } => {
                let part = inner / outer;
                (part * part..=1.0).contains(&square(2))
            }
            Self::Cone { lower, upper, .. } => {
                let own = 0.5 * (lower + upper) + 0.5 * (upper - lower) * from_centre(2);
                let part = own / lower.max(upper);
                square(2) <= part * part
            }
            Self::Skewed { size, lattice } => {
                let (extent, axes) = (self.extent(), lattice.axes());
                let along = |d: usize| -> f64 {
                    (0..3).map(|k| from_centre(k) * extent[k] * axes[k][d]).sum()
                };
                (0..3).all(|d| along(d).abs() <= size[d])
            }
            Self::Filled { ref runs, .. } => {
                let [i, j, k] = cell;
                let key = |run: &[u16; 4]| {
                    (usize::from(run[3]), usize::from(run[2]), usize::from(run[0]))
                };
                let next = runs.partition_point(|run| key(run) <= (k, j, i));
                runs[..next].last().is_some_and(|run| {
                    let (layer, row, first) = key(run);
                    (layer, row) == (k, j) && i < first + usize::from(run[1])
                })
            }
        }
    }

    /// Checks its lengths, and what it says of so many cells.
    ///
    /// # Errors
    /// The first value that cannot be used, with its key and the wanted form.
    pub(super) fn validate(&self, cells: [usize; 3], key: &str) -> Result<(), SceneError> {
        for (name, length) in self.lengths() {
            positive(&format!("{key}.{name}"), length)?;
        }
        match self {
            Self::Ring { outer, inner, .. } if inner >= outer => {
                let wanted = format!("it must be less than the outer one, {outer}");
                Err(SceneError::new(format!("{key}.ring.inner"), inner, &wanted))
            }
            Self::Cone { lower, upper, .. } if !(*lower >= 0.0 && *upper >= 0.0) => {
                let given = format!("{lower}, {upper}");
                Err(SceneError::new(format!("{key}.cone"), given, "diameters may not be negative"))
            }
            Self::Skewed { lattice, .. } => lattice.validate(&format!("{key}.skewed.lattice")),
            Self::Filled { runs, .. } => {
                let mut free = [0; 3];
                for (n, &[first, number, row, layer]) in runs.iter().enumerate() {
                    let [first, number, row, layer] = [first, number, row, layer].map(usize::from);
                    let inside = first + number <= cells[0] && row < cells[1] && layer < cells[2];
                    if number == 0 || !inside || [layer, row, first] < free {
                        let given = format!("[{first}, {number}, {row}, {layer}]");
                        let wanted = "runs lie within the cells, in order, and do not overlap";
                        return Err(SceneError::new(
                            format!("{key}.filled.runs.{n}"),
                            given,
                            wanted,
                        ));
                    }
                    free = [layer, row, first + number];
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// What has to be positive, with keys.
    fn lengths(&self) -> Vec<(String, f64)> {
        let edges = |name: &str, size: [f64; 3]| {
            size.into_iter()
                .enumerate()
                .map(|(d, edge)| (format!("{name}.size.{d}"), edge))
                .collect()
        };
        let named = |name: &str, all: &[(&str, f64)]| {
            all.iter().map(|(key, length)| (format!("{name}.{key}"), *length)).collect()
        };
        match *self {
            Self::Box { size } => edges("box", size),
            Self::Skewed { size, .. } => edges("skewed", size),
            Self::Cylinder { diameter, length } => {
                named("cylinder", &[("diameter", diameter), ("length", length)])
            }
            Self::Sphere { diameter } => named("sphere", &[("diameter", diameter)]),
            Self::Ring { outer, inner, length } => {
                named("ring", &[("outer", outer), ("inner", inner), ("length", length)])
            }
            Self::Cone { lower, upper, length } => {
                named("cone", &[("length", length), ("lower + upper", lower + upper)])
            }
            Self::Filled { size, volume, .. } => {
                let mut all: Vec<_> = edges("filled", size);
                all.push(("filled.volume".into(), volume));
                all
            }
        }
    }
}
