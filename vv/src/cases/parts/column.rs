//! Columns of cells along x, between mirrors on their four sides.

use whipple_solver::space::Simulation;
use whipple_solver::space::scene::{Body, Shape, Side, Wall};

use super::{mirror, moments, resting, sleeve};

/// A column of cubic cells, a few across.
#[derive(Clone, Copy)]
pub(in crate::cases) struct Column {
    pub(in crate::cases) length: f64,
    /// Cells along it.
    pub(in crate::cases) cells: usize,
    pub(in crate::cases) across: usize,
}

impl Column {
    /// Edge of a cell.
    pub(in crate::cases) fn edge(&self) -> f64 {
        self.length / self.cells as f64
    }

    /// Edge of the section.
    pub(in crate::cases) fn width(&self) -> f64 {
        self.across as f64 * self.edge()
    }

    /// Mirrors along its sides.
    pub(in crate::cases) fn sides(&self) -> Vec<Wall> {
        sleeve(self.width())
    }

    /// Mirrors along its sides, and one at x = 0 that it stands on.
    pub(in crate::cases) fn walls(&self) -> Vec<Wall> {
        let mut walls = self.sides();
        walls.push(mirror(0, 0.0, Side::Above));
        walls
    }

    /// The column of a material, its middle at a place, with a velocity along x.
    pub(in crate::cases) fn body(&self, material: &str, centre: f64, velocity: f64) -> Body {
        let width = self.width();
        let shape = Shape::Box { size: [self.length, width, width] };
        let cells = [self.cells, self.across, self.across];
        Body {
            velocity: [velocity, 0.0, 0.0],
            ..resting(material, shape, cells, [centre, 0.0, 0.0])
        }
    }
}

/// The nodes of a face across x.
pub(in crate::cases) struct Face(Vec<u32>);

impl Face {
    /// Of the particles at a place of the undeformed lattice, to 1e-6 of it.
    pub(in crate::cases) fn at(simulation: &Simulation, place: f64) -> Self {
        let on = |x: f64| (x - place).abs() < 1e-6 * place;
        Self(simulation.all_particles().filter(|p| on(p.position[0])).map(|p| p.id).collect())
    }

    /// Mean velocity along x in a frame that moves at `-frame`.
    pub(in crate::cases) fn velocity(&self, simulation: &Simulation, frame: f64) -> f64 {
        let of = |&i: &u32| simulation.particle(i).velocity[0] + frame;
        moments(&self.0.iter().map(of).collect::<Vec<f64>>()).0
    }
}
