//! Rotation of particles that live elements hold: they follow those, and hand on to them what torque they bear.
//!
//! A held particle has the rotation `R` next to the mean deformation `M` of its live cells, and its rate,
//! `omega = R (tr S - S)^-1 R^T sum_k r_k x dM_k/dt` with `S = R^T M` and the columns `r_k` of `R`. Both depend on the
//! corners alone, and a torque acts on these by the transposed relation: forces without resultant, whose moment and power
//! are those of the torque. So a held particle has no angular momentum of its own. The masses at corners and centroid have
//! more moment of inertia than the cell that they stand for; a spin besides would count it twice (decision 0021).

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::space::columns::State;
use crate::space::lattice::cross;
use crate::space::mesh::{Body, Mesh};

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
}

/// The live cells that hold a particle.
fn cells(mesh: &Mesh, i: usize) -> impl Iterator<Item = Cell<'_>> {
    let (body, at) = mesh.place(i);
    let own = &mesh.bodies[body];
    let lattice = &own.lattice;
    let around = (at[0] & 1 == 0).then(|| lattice.cells_round(at).map(|(_, cell)| cell));
    let centre = (at[0] & 1 == 1).then(|| lattice.cell(at));
    let all = around.into_iter().flatten().chain(centre);
    let live = move |cell: &u32| mesh.held(own.centroids.start + *cell as usize);
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

/// A matrix with these columns.
#[must_use]
pub fn columns(axes: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_columns(&axes.map(Vector3::from))
}

/// Whether a particle on these mirrors is on that of an axis.
fn on(mirrors: u8, axis: usize) -> bool {
    mirrors >> axis & 1 == 1
}

/// What a sum over the cells of a particle is with those of its images: `M + Q M Q_o`, with the reflection in space and
/// that of the lattice.
fn with_images(sum: Matrix3<f64>, body: &Body, mirrors: u8) -> Matrix3<f64> {
    let lattice = columns(body.lattice.axes);
    (0..3).filter(|&axis| on(mirrors, axis)).fold(sum, |sum, axis| {
        let mut reflect = Matrix3::identity();
        reflect[(axis, axis)] = -1.0;
        sum + reflect * sum * (lattice.transpose() * reflect * lattice)
    })
}

/// A sum of gradients over the cells of a particle, with its images.
fn over_cells(
    mesh: &Mesh,
    (i, mirrors): (usize, u8),
    gradient: impl Fn(&Cell<'_>) -> [[f64; 3]; 3],
) -> Matrix3<f64> {
    let sum = cells(mesh, i).map(|cell| columns(gradient(&cell))).sum();
    with_images(sum, &mesh.bodies[mesh.place(i).0], mirrors)
}

/// How a held particle lies.
#[derive(Debug, Clone, Copy)]
pub struct Held {
    /// From the axes of the lattice (M. Müller, J. Bender, N. Chentanez and M. Macklin, *A robust method to extract the
    /// rotational part of deformations*, 2016).
    pub rotation: Rotation3<f64>,
    pub lever: Lever,
}

/// `R (tr S - S)^-1 R^T`: from the moment of the rates of the axes to the spin, and from a torque to couples at the axes.
/// The lower half by rows, since it is symmetric.
#[derive(Debug, Clone, Copy, Default)]
pub struct Lever([f64; 6]);

impl Lever {
    fn new(rotation: &Matrix3<f64>, deformation: &Matrix3<f64>) -> Self {
        let stretch = rotation.transpose() * deformation;
        let stiffness =
            Matrix3::from_diagonal_element(stretch.trace()) - 0.5 * (stretch + stretch.transpose());
        // Two stretches that cancel leave a rotation undefined: it is left alone.
        let lever = stiffness.try_inverse().unwrap_or_else(Matrix3::zeros);
        let lever = rotation * lever * rotation.transpose();
        let rows = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];
        Self(rows.map(|at| lever[at]))
    }

    fn times(&self, moment: &Vector3<f64>) -> Vector3<f64> {
        let [xx, xy, yy, xz, yz, zz] = self.0;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * moment
    }

    /// Rate of the rotation with these columns, from that of the deformation.
    fn spin(&self, axes: &[[f64; 3]; 3], rates: &Matrix3<f64>) -> Vector3<f64> {
        let moments = axes.iter().zip(rates.column_iter());
        self.times(&moments.map(|(axis, rate)| Vector3::from(*axis).cross(&rate)).sum())
    }

    /// Forces on the columns of the deformation whose power is that of a torque on the rotation.
    fn couples(&self, axes: &[[f64; 3]; 3], torque: [f64; 3]) -> [[f64; 3]; 3] {
        let couple = self.times(&torque.into()).into();
        axes.map(|axis| cross(couple, axis))
    }
}

/// How the live cells of a particle on these mirrors hold it.
#[must_use]
pub fn hold(mesh: &Mesh, state: &State, (i, mirrors): (usize, u8)) -> Held {
    let deformation = over_cells(mesh, (i, mirrors), |cell| cell.axes(state));
    let start = columns(mesh.bodies[mesh.place(i).0].lattice.axes);
    let start = Rotation3::from_matrix_unchecked(start);
    let rotation = Rotation3::from_matrix_eps(&deformation, ACCURACY, ROUNDS, start);
    Held { rotation, lever: Lever::new(rotation.matrix(), &deformation) }
}

/// Angular velocity of a held particle with these axes, where corners have these velocities.
#[must_use]
pub fn spin(
    mesh: &Mesh,
    velocity: impl Fn(usize) -> [f64; 3],
    (i, mirrors): (usize, u8),
    (axes, lever): (&[[f64; 3]; 3], &Lever),
) -> Vector3<f64> {
    let rates = over_cells(mesh, (i, mirrors), |cell| cell.gradient(&velocity));
    lever.spin(axes, &rates)
}

/// Hands a torque on a particle with these axes on to the corners of its live cells: tells of each with the force on it.
/// Returns the moment of these forces: on a mirror not the torque, but with that of its images.
pub fn couple(
    (mesh, state): (&Mesh, &State),
    (i, mirrors, torque): (usize, u8, [f64; 3]),
    (axes, lever): (&[[f64; 3]; 3], &Lever),
    mut push: impl FnMut(usize, [f64; 3]),
) -> Vector3<f64> {
    // Images bear as much as what is here.
    let sides = f64::from(1_u32 << mirrors.count_ones());
    let ways = lever.couples(axes, torque.map(|x| sides * x));
    let mut moment = Vector3::zeros();
    for cell in cells(mesh, i) {
        for (slot, &corner) in cell.corners.iter().enumerate() {
            let part = |d: usize| (0..3).map(|axis| cell.weight(slot, axis) * ways[axis][d]).sum();
            push(corner, std::array::from_fn(part));
        }
        for (arm, way) in cell.axes(state).into_iter().zip(ways) {
            moment += Vector3::from(cross(arm, way));
        }
    }
    moment
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deformations: much sheared, pressed to a fiftieth of the volume, and turned over.
    fn deformations() -> [Matrix3<f64>; 3] {
        [
            Matrix3::new(1.0, 2.0, 0.1, 0.0, 1.0, -0.3, 0.2, 0.0, 0.9),
            Matrix3::new(1.0, 0.1, 0.0, 0.0, 0.02, 0.1, 0.0, 0.0, 1.1),
            Matrix3::new(-0.9, 0.2, 0.1, 0.1, -1.2, 0.4, 0.3, 0.0, 0.8),
        ]
    }

    fn rotation(deformation: &Matrix3<f64>) -> Rotation3<f64> {
        Rotation3::from_matrix_eps(deformation, ACCURACY, ROUNDS, Rotation3::identity())
    }

    fn held(deformation: &Matrix3<f64>) -> ([[f64; 3]; 3], Lever) {
        let rotation = rotation(deformation);
        let lever = Lever::new(rotation.matrix(), deformation);
        (super::super::axes(&rotation), lever)
    }

    #[test]
    fn the_spin_of_what_is_held_is_the_rate_of_its_rotation() {
        let rates = Matrix3::new(0.3, -1.0, 0.7, 0.2, 0.5, -0.4, 1.1, 0.6, -0.8);
        for deformation in deformations() {
            let (axes, lever) = held(&deformation);
            let spin = lever.spin(&axes, &rates);
            // The rotation is found to about 1e-10.
            let step = 1e-4;
            let [before, after] = [-step, step].map(|time| rotation(&(deformation + time * rates)));
            let difference = (after * before.inverse()).scaled_axis() / (2.0 * step);
            assert!((difference - spin).norm() < 1e-5 * spin.norm(), "{difference} {spin}");
        }
    }

    #[test]
    fn couples_have_the_moment_and_the_power_of_their_torque() {
        let torque = [0.3, -0.8, 0.5];
        let rates = Matrix3::new(0.3, -1.0, 0.7, 0.2, 0.5, -0.4, 1.1, 0.6, -0.8);
        for deformation in deformations() {
            let (axes, lever) = held(&deformation);
            let couples = lever.couples(&axes, torque);
            let columns = couples.iter().zip(deformation.column_iter().zip(rates.column_iter()));
            let (mut moment, mut power) = (Vector3::zeros(), 0.0);
            for (couple, (arm, rate)) in columns {
                moment += arm.cross(&Vector3::from(*couple));
                power += rate.dot(&Vector3::from(*couple));
            }
            let torque = Vector3::from(torque);
            assert!((moment - torque).norm() < 1e-12, "{moment}");
            let wanted = torque.dot(&lever.spin(&axes, &rates));
            assert!((power / wanted - 1.0).abs() < 1e-12, "{power} {wanted}");
        }
    }
}
