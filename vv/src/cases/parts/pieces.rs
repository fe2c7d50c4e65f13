//! What is left of a body: its connected pieces.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use whipple_solver::space::Simulation;

/// The sets of live elements of a body that share nodes and have not failed.
pub(in crate::cases) struct Pieces {
    /// By particle: one nearer to the representative of its set, which is the smallest number in it.
    parent: Vec<u32>,
    member: Vec<bool>,
    /// By particle: the mass of the set that it stands for.
    mass: Vec<f64>,
}

/// A piece as a whole.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::cases) struct Piece {
    /// Extent along its principal axis.
    pub(in crate::cases) length: f64,
    /// Size of the mean velocity of its particles by mass.
    pub(in crate::cases) velocity: f64,
    /// Mass of its particles.
    pub(in crate::cases) mass: f64,
}

/// Representative of a set, with the paths to it halved.
fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

impl Pieces {
    /// Of a body as it is now.
    pub(in crate::cases) fn of(simulation: &Simulation, body: usize) -> Self {
        let sound = || simulation.all_elements().filter(|e| e.body == body && e.live && !e.failed);
        let room = sound().flat_map(|e| e.corners.into_iter().chain([e.centre])).max();
        let room = room.map_or(0, |last| last as usize + 1);
        let mut parent: Vec<u32> = (0..room as u32).collect();
        let mut member = vec![false; room];
        for element in sound() {
            for i in element.corners.into_iter().chain([element.centre]) {
                member[i as usize] = true;
                let (a, b) = (root(&mut parent, element.centre), root(&mut parent, i));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
        let mut mass = vec![0.0; room];
        for i in (0..room as u32).filter(|&i| member[i as usize]) {
            mass[root(&mut parent, i) as usize] += simulation.particle(i).mass;
        }
        Self { parent, member, mass }
    }

    /// Masses of the pieces, the heaviest first.
    pub(in crate::cases) fn masses(&self) -> Vec<f64> {
        let mut masses: Vec<f64> = self.mass.iter().copied().filter(|mass| *mass > 0.0).collect();
        masses.sort_by(|a, b| b.total_cmp(a));
        masses
    }

    /// The heaviest piece; nothing if all elements have failed.
    fn heaviest(mut self, simulation: &Simulation) -> Piece {
        let room = self.mass.len();
        let Some(heaviest) = (0..room).max_by(|&a, &b| self.mass[a].total_cmp(&self.mass[b]))
        else {
            return Piece::default();
        };
        let inside: Vec<_> = (0..room as u32)
            .filter(|&i| self.member[i as usize])
            .filter(|&i| root(&mut self.parent, i) as usize == heaviest)
            .map(|i| simulation.particle(i))
            .collect();
        let total = self.mass[heaviest];
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
        let (low, high) = along
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)));
        Piece { length: high - low, velocity: velocity.norm(), mass: total }
    }
}

/// What is left of a body in one piece; nothing if all its elements have failed.
pub(in crate::cases) fn largest(simulation: &Simulation, body: usize) -> Piece {
    Pieces::of(simulation, body).heaviest(simulation)
}
