//! States of a run in three dimensions as VTU files with a PVD index.
//!
//! Every frame has two parts. `particles` are all particles as vertices, `elements` all elements as
//! hexahedra over the nodes: a threshold on `live` hides what is no volume any more. Positions and
//! masses are doubles, other fields single precision. Ellipsoids have a tensor besides, `shape`.

use std::path::Path;

use whipple_solver::space::Simulation;
use whipple_solver::space::output::{Element, Particle};
use whipple_solver::space::spin::half_lengths;

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
        self.record_some(simulation, |_| true)
    }

    /// Adds a part of the present state: some particles, and the elements that have all of theirs among them.
    ///
    /// # Errors
    /// As [`Collection::record`].
    pub fn record_some(
        &mut self,
        simulation: &Simulation,
        wanted: impl Fn(&Particle) -> bool,
    ) -> Result<(), VtkError> {
        let particles: Vec<Particle> = simulation.all_particles().filter(wanted).collect();
        let ids = |element: &Element| element.corners.into_iter().chain([element.centre]);
        let known = |id: u32| particles.binary_search_by_key(&id, |p| p.id).is_ok();
        let elements: Vec<Element> =
            simulation.all_elements().filter(|e| ids(e).all(known)).collect();
        self.particles(simulation, &particles)?;
        self.elements(simulation.time(), &elements, &particles)
    }

    fn particles(
        &mut self,
        simulation: &Simulation,
        particles: &[Particle],
    ) -> Result<(), VtkError> {
        let points: Vec<[f64; 3]> = particles.iter().map(|p| p.position).collect();
        let column = |of: fn(&Particle) -> f64| {
            particles.iter().map(|p| single(of(p))).collect::<Vec<f64>>()
        };
        let mass: Vec<f64> = particles.iter().map(|p| p.mass).collect();
        let velocity: Vec<f64> = particles.iter().flat_map(|p| p.velocity).map(single).collect();
        let id: Vec<u32> = particles.iter().map(|p| p.id).collect();
        let body: Vec<u32> = particles.iter().map(|p| p.body as u32).collect();
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
        point_data.extend(fields.iter().map(in_single));
        let shapes: Vec<f64> = if simulation.rotates() {
            particles.iter().flat_map(|p| shape(simulation, p)).collect()
        } else {
            Vec::new()
        };
        if !shapes.is_empty() {
            point_data.push(Field::new("shape", 6, Values::Float32(&shapes)));
        }
        let cells = Cells::particles();
        let grid = Grid { points: &points, cells, point_data, cell_data: Vec::new() };
        self.collection.record(simulation.time(), "particles", &grid)?;
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
        let column =
            |of: fn(&Element) -> f64| elements.iter().map(|e| single(of(e))).collect::<Vec<f64>>();
        let centre = |of: fn(&Particle) -> f64| {
            let centres = elements.iter().map(|e| &particles[at[e.centre as usize] as usize]);
            centres.map(|p| single(of(p))).collect::<Vec<f64>>()
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
        cell_data.extend(fields.iter().map(in_single));
        let cells = Cells::elements(&hexahedra);
        let grid = Grid { points: &points, cells, point_data: Vec::new(), cell_data };
        self.collection.record(time, "elements", &grid)?;
        Ok(())
    }
}

/// `sum_k h_k a_k a_k^T` of a particle with half-lengths `h_k` along its axes: xx, yy, zz, xy, yz, xz. Tensor glyphs draw
/// the ellipsoid by it.
fn shape(simulation: &Simulation, particle: &Particle) -> [f64; 6] {
    let Some(own) = simulation.ellipsoid(particle.id) else {
        let [radius, ..] = half_lengths([simulation.sizes(particle.body).0; 3]);
        return [radius, radius, radius, 0.0, 0.0, 0.0];
    };
    [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]].map(|[a, b]| {
        let axes = own.half_lengths.iter().zip(&own.axes);
        axes.map(|(half, axis)| half * axis[a] * axis[b]).sum()
    })
}

/// What single precision cannot hold, as it may be where a run breaks, is not a number: not defined.
fn single(value: f64) -> f64 {
    if value.abs() > f64::from(f32::MAX) { f64::NAN } else { value }
}

/// A field in single precision.
fn in_single<'a>((name, values): &'a (&'a str, Vec<f64>)) -> Field<'a> {
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
