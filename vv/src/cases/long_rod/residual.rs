//! What is left of a body: its largest connected piece.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use whipple_solver::space::Simulation;

/// The largest set of live elements of a body that share nodes and have not failed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Residual {
    /// Extent along its principal axis.
    pub(super) length: f64,
    /// Size of the mean velocity of its particles by mass.
    pub(super) velocity: f64,
    /// Mass of its particles.
    pub(super) mass: f64,
}

/// Representative of a set, with the paths to it halved.
fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

/// What is left of a body; nothing if all its elements have failed.
pub(super) fn largest(simulation: &Simulation, body: usize) -> Residual {
    let sound = || simulation.all_elements().filter(|e| e.body == body && e.live && !e.failed);
    let room = sound().flat_map(|e| e.corners.into_iter().chain([e.centre])).max();
    let room = room.map_or(0, |last| last as usize + 1);
    let mut parent: Vec<u32> = (0..room as u32).collect();
    let mut member = vec![false; room];
    for element in sound() {
        for i in element.corners.into_iter().chain([element.centre]) {
            member[i as usize] = true;
            let (a, b) = (root(&mut parent, element.centre), root(&mut parent, i));
            // The smaller number stands for the set.
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut mass = vec![0.0; room];
    for i in (0..room as u32).filter(|&i| member[i as usize]) {
        mass[root(&mut parent, i) as usize] += simulation.particle(i).mass;
    }
    let Some(heaviest) = (0..room).max_by(|&a, &b| mass[a].total_cmp(&mass[b])) else {
        return Residual::default();
    };
    let inside: Vec<_> = (0..room as u32)
        .filter(|&i| member[i as usize])
        .filter(|&i| root(&mut parent, i) as usize == heaviest)
        .map(|i| simulation.particle(i))
        .collect();
    let total = mass[heaviest];
    let (mut centre, mut velocity) = (Vector3::zeros(), Vector3::zeros());
    for p in &inside {
        centre += p.mass / total * Vector3::from(p.position);
        velocity += p.mass / total * Vector3::from(p.velocity);
    }
    let mut spread = Matrix3::zeros();
    for p in &inside {
        let r = Vector3::from(p.position) - centre;
        spread += p.mass / total * r * r.transpose();
    }
    let eigen = SymmetricEigen::new(spread);
    let axis = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned();
    let along = inside.iter().map(|p| axis.dot(&(Vector3::from(p.position) - centre)));
    let (low, high) =
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)));
    Residual { length: high - low, velocity: velocity.norm(), mass: total }
}
