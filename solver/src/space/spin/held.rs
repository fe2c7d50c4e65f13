//! Rotation of particles that live elements hold: they follow those, and hand on to them what torque they bear.
//!
//! A held particle has the rotation of its cells and their spin, half the curl of the velocity. Both depend on the corners
//! alone, and a torque acts on these by the transposed relation: forces without resultant, whose moment and power are
//! those of the torque. So a held particle has no angular momentum of its own. The masses at corners and centroid have
//! more moment of inertia than the cell that they stand for; a spin besides would count it twice (decision 0021).

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::space::columns::State;
use crate::space::lattice::{cross, dot};
use crate::space::mesh::{Body, Mesh};

/// Least volume ratio by which a cell divides; one below is dying.
const LEAST: f64 = 0.05;

/// Rounds and accuracy of the rotation.
const ROUNDS: usize = 200;
const ACCURACY: f64 = 1e-15;

/// A cell that holds a particle.
struct Cell<'a> {
    body: &'a Body,
    corners: [usize; 8],
}

impl<'a> Cell<'a> {
    /// Gradient of a field along the axes of the lattice, at the centre.
    fn gradient(&self, field: impl Fn(usize) -> [f64; 3]) -> [[f64; 3]; 3] {
        let mut out = [[0.0; 3]; 3];
        for (slot, &i) in self.corners.iter().enumerate() {
            let u = field(i);
            for (axis, out) in out.iter_mut().enumerate() {
                let weight = self.weight(slot, axis);
                for (out, u) in out.iter_mut().zip(u) {
                    *out += weight * u;
                }
            }
        }
        out
    }

    /// Weight of a corner in it.
    fn weight(&self, slot: usize, axis: usize) -> f64 {
        let weight = 0.25 / self.body.lattice.size[axis];
        if slot >> axis & 1 == 1 { weight } else { -weight }
    }

    /// What the axes of the lattice have become.
    fn axes(&self, state: &State) -> [[f64; 3]; 3] {
        let mut axes = self.gradient(|i| [state.dx[i], state.dy[i], state.dz[i]]);
        for (own, undeformed) in axes.iter_mut().zip(self.body.lattice.axes) {
            for (own, undeformed) in own.iter_mut().zip(undeformed) {
                *own += undeformed;
            }
        }
        axes
    }

    /// Gradients of the lattice coordinates in space.
    fn slopes(&self, state: &State) -> [[f64; 3]; 3] {
        let [a, b, c] = self.axes(state);
        let across = [cross(b, c), cross(c, a), cross(a, b)];
        let inverse = 1.0 / dot(a, across[0]).max(LEAST);
        across.map(|across| across.map(|x| x * inverse))
    }
}

/// The cells that hold a particle: the live ones, or those that were.
fn cells(mesh: &Mesh, i: usize) -> impl Iterator<Item = Cell<'_>> {
    let (body, at) = mesh.place(i);
    let own = &mesh.bodies[body];
    let held = mesh.held(i);
    let lattice = &own.lattice;
    let around = (at[0] & 1 == 0).then(|| lattice.cells_round(at).map(|(_, cell)| cell));
    let centre = (at[0] & 1 == 1).then(|| lattice.cell(at));
    let all = around.into_iter().flatten().chain(centre);
    let live = move |cell: &u32| !held || mesh.held(own.centroids.start + *cell as usize);
    all.filter(live).map(move |cell| {
        let at = lattice.centroids[cell as usize];
        let corners = std::array::from_fn(|slot| {
            let side = |axis: usize| if slot >> axis & 1 == 1 { 1 } else { -1 };
            let at = [at[0] + side(0), at[1] + side(1), at[2] + side(2)];
            own.nodes.start + lattice.node(at) as usize
        });
        Cell { body: own, corners }
    })
}

/// Rotation of the cells of a particle, from the axes of the lattice: that next to their mean deformation (M. Müller,
/// J. Bender, N. Chentanez and M. Macklin, *A robust method to extract the rotational part of deformations*, 2016).
#[must_use]
pub fn rotation(mesh: &Mesh, state: &State, i: usize) -> Rotation3<f64> {
    let mut sum = Matrix3::zeros();
    let mut start = Rotation3::identity();
    for cell in cells(mesh, i) {
        sum += columns(cell.axes(state));
        start = Rotation3::from_matrix_unchecked(columns(cell.body.lattice.axes));
    }
    Rotation3::from_matrix_eps(&sum, ACCURACY, ROUNDS, start)
}

/// A matrix with these columns.
#[must_use]
pub fn columns(axes: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_columns(&axes.map(Vector3::from))
}

/// Mean spin of the live cells of a particle, with these velocities.
#[must_use]
pub fn spin(
    mesh: &Mesh,
    state: &State,
    velocity: impl Fn(usize) -> [f64; 3],
    i: usize,
) -> Vector3<f64> {
    let (mut sum, mut count) = (Vector3::zeros(), 0.0);
    for cell in cells(mesh, i) {
        for (slope, flow) in cell.slopes(state).into_iter().zip(cell.gradient(&velocity)) {
            sum += Vector3::from(cross(slope, flow));
        }
        count += 2.0;
    }
    sum / count
}

/// Hands a torque on a particle on to the corners of its live cells: tells of each with the force on it.
pub fn couple(
    mesh: &Mesh,
    state: &State,
    (i, torque): (usize, [f64; 3]),
    mut push: impl FnMut(usize, [f64; 3]),
) {
    let share = 0.5 / cells(mesh, i).count() as f64;
    for cell in cells(mesh, i) {
        let ways = cell.slopes(state).map(|slope| cross(torque, slope).map(|x| share * x));
        for (slot, &corner) in cell.corners.iter().enumerate() {
            let part = |d: usize| (0..3).map(|axis| cell.weight(slot, axis) * ways[axis][d]).sum();
            push(corner, std::array::from_fn(part));
        }
    }
}
