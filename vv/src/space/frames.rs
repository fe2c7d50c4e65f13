//! States of a run in three dimensions as VTU files with a PVD index.
//!
//! Every frame has two parts. `particles` are all particles as vertices, `elements` all elements as
//! hexahedra over the nodes: a threshold on `live` hides what is no volume any more. Positions and
//! masses are doubles, other fields single precision.

use std::path::Path;

use whipple_solver::space::Simulation;
use whipple_solver::space::output::{Element, Particle};

use crate::vtk::{Cells, Collection, CollectionError, Field, Grid, Values, VtkError};

/// The frames of a run.
#[derive(Debug)]
pub struct Frames {
    collection: Collection,
}

impl Frames {
    /// Frames of a new run, with their index at `path`.
    ///
    /// # Errors
    /// [`CollectionError::Path`] if `path` has no usable file name.
    pub fn new(path: &Path) -> Result<Self, CollectionError> {
        Ok(Self { collection: Collection::new(path)? })
    }

    /// Frames of a run that goes on from a checkpoint of `time`: those of this time and later ones
    /// are written anew.
    ///
    /// # Errors
    /// As [`Collection::resume`].
    pub fn resume(path: &Path, time: f64) -> Result<Self, CollectionError> {
        Ok(Self { collection: Collection::resume(path, time)? })
    }

    /// Adds the present state.
    ///
    /// # Errors
    /// As [`Collection::record`].
    pub fn record(&mut self, simulation: &Simulation) -> Result<(), VtkError> {
        let particles: Vec<Particle> = simulation.all_particles().collect();
        let elements: Vec<Element> = simulation.all_elements().collect();
        self.particles(simulation.time(), &particles)?;
        self.elements(simulation.time(), &elements, &particles)
    }

    fn particles(&mut self, time: f64, particles: &[Particle]) -> Result<(), VtkError> {
        let points: Vec<[f64; 3]> = particles.iter().map(|p| p.position).collect();
        let column = |of: fn(&Particle) -> f64| particles.iter().map(of).collect::<Vec<f64>>();
        let velocity: Vec<f64> = particles.iter().flat_map(|p| p.velocity).collect();
        let id: Vec<u32> = particles.iter().map(|p| p.id).collect();
        let body: Vec<u32> = particles.iter().map(|p| p.body as u32).collect();
        let mass = column(|p| p.mass);
        let fields = [
            ("density", column(|p| p.rho)),
            ("pressure", column(|p| p.pressure)),
            ("temperature", column(|p| p.theta)),
            ("internal energy", column(|p| p.u)),
            ("held", column(|p| p.held)),
        ];
        let mut point_data = vec![
            Field::scalar("id", Values::UInt32(&id)),
            Field::scalar("body", Values::UInt32(&body)),
            Field::scalar("mass", Values::Float64(&mass)),
            Field::new("velocity", 3, Values::Float32(&velocity)),
        ];
        point_data.extend(fields.iter().map(single));
        let cells = Cells::particles();
        let grid = Grid { points: &points, cells, point_data, cell_data: Vec::new() };
        self.collection.record(time, "particles", &grid)?;
        Ok(())
    }

    fn elements(
        &mut self,
        time: f64,
        elements: &[Element],
        particles: &[Particle],
    ) -> Result<(), VtkError> {
        let at = places(particles);
        // Nodes come first: what follows the last of them are centroids, which no corner names.
        let corners = elements.iter().flat_map(|e| e.corners);
        let nodes = corners.map(|id| at[id as usize] as usize + 1).max().unwrap_or(0);
        let points: Vec<[f64; 3]> = particles[..nodes].iter().map(|p| p.position).collect();
        let ring = |e: &Element| e.ring().map(|id| at[id as usize]);
        let hexahedra: Vec<[u32; 8]> = elements.iter().map(ring).collect();
        let column = |of: fn(&Element) -> f64| elements.iter().map(of).collect::<Vec<f64>>();
        let centre = |of: fn(&Particle) -> f64| {
            let centres = elements.iter().map(|e| &particles[at[e.centre as usize] as usize]);
            centres.map(of).collect::<Vec<f64>>()
        };
        let body: Vec<u32> = elements.iter().map(|e| e.body as u32).collect();
        let live: Vec<u8> = elements.iter().map(|e| u8::from(e.live)).collect();
        let failed: Vec<u8> = elements.iter().map(|e| u8::from(e.failed)).collect();
        let fields = [
            ("plastic strain", column(|e| e.strain)),
            ("damage", column(|e| e.damage)),
            ("equivalent stress", column(|e| e.equivalent_stress)),
            ("density", centre(|p| p.rho)),
            ("pressure", centre(|p| p.pressure)),
            ("temperature", centre(|p| p.theta)),
        ];
        let mut cell_data = vec![
            Field::scalar("body", Values::UInt32(&body)),
            Field::scalar("live", Values::UInt8(&live)),
            Field::scalar("failed", Values::UInt8(&failed)),
        ];
        cell_data.extend(fields.iter().map(single));
        let cells = Cells::elements(&hexahedra);
        let grid = Grid { points: &points, cells, point_data: Vec::new(), cell_data };
        self.collection.record(time, "elements", &grid)?;
        Ok(())
    }
}

/// A field in single precision.
fn single<'a>((name, values): &'a (&'a str, Vec<f64>)) -> Field<'a> {
    Field::scalar(name, Values::Float32(values))
}

/// Where each particle stands among all, by its number.
pub(super) fn places(particles: &[Particle]) -> Vec<u32> {
    let numbers = particles.iter().map(|p| p.id as usize + 1).max().unwrap_or(0);
    let mut at = vec![0; numbers];
    for (k, particle) in particles.iter().enumerate() {
        at[particle.id as usize] = k as u32;
    }
    at
}
