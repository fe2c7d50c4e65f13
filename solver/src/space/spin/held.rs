//! Rotation of particles that live elements hold: they follow those, and hand on to them what torque they bear.
//!
//! A held particle has the rotation `R` next to the mean deformation `M` of its live cells, and its rate,
//! `omega = R (tr S - S)^-1 R^T sum_k r_k x dM_k/dt` with `S = R^T M` and the columns `r_k` of `R`. Both depend on the
//! corners alone, and a torque acts on these by the transposed relation: forces without resultant, whose moment and power
//! are those of the torque. So a held particle has no angular momentum of its own. The masses at corners and centroid have
//! more moment of inertia than the cell that they stand for; a spin besides would count it twice (decision 0021).

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::space::columns::State;
use crate::space::lattice::{cross, dot};
use crate::space::mesh::{Body, Mesh};
use crate::space::symmetric::Symmetric;

/// Rounds of the rotation by averages, and where they end: what is left is the square of it.
const AVERAGES: usize = 20;
const NEARLY: f64 = 1e-9;

/// Least volume, over that of a cube of edges as long, of a deformation whose rotation averages find.
const FLAT: f64 = 1e-6;

/// Rounds and accuracy of the rotation by turns.
const ROUNDS: usize = 200;
const ACCURACY: f64 = 1e-15;

/// A particle, and where it lies.
#[derive(Debug, Clone, Copy)]
pub struct Site {
    /// Its body.
    pub body: usize,
    /// Place in the lattice.
    pub place: [i16; 3],
    /// Mirrors that it lies on, by the bits of their axes.
    pub mirrors: u8,
}

impl Site {
    /// The live cells that hold it.
    fn cells<'a>(&self, mesh: &'a Mesh) -> impl Iterator<Item = Cell<'a>> {
        let own = &mesh.bodies[self.body];
        let (lattice, at) = (&own.lattice, self.place);
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

    /// What a sum over its cells is with those of its images: `M + Q M Q_o`, with the reflection in space and that of the
    /// lattice.
    fn with_images(&self, sum: [[f64; 3]; 3], mesh: &Mesh) -> [[f64; 3]; 3] {
        if self.mirrors == 0 {
            return sum;
        }
        let lattice = columns(mesh.bodies[self.body].lattice.axes);
        let on = |axis: &usize| self.mirrors >> axis & 1 == 1;
        let all = (0..3).filter(on).fold(columns(sum), |sum, axis| {
            let mut reflect = Matrix3::identity();
            reflect[(axis, axis)] = -1.0;
            sum + reflect * sum * (lattice.transpose() * reflect * lattice)
        });
        of_columns(&all)
    }

    /// What the axes of the lattice have become over its live cells, with its images.
    fn deformation(&self, mesh: &Mesh, state: &State) -> [[f64; 3]; 3] {
        let mut sum = [[0.0; 3]; 3];
        self.cells(mesh).for_each(|cell| add(&mut sum, &cell.axes(state)));
        self.with_images(sum, mesh)
    }

    /// How its live cells hold it.
    #[must_use]
    pub fn hold(&self, mesh: &Mesh, state: &State) -> Held {
        let deformation = self.deformation(mesh, state);
        Held::of(&deformation, &mesh.bodies[self.body].lattice.axes)
    }

    /// Angular velocity where it is held so and corners have these velocities.
    #[must_use]
    pub fn spin(&self, mesh: &Mesh, velocity: impl Fn(usize) -> [f64; 3], held: &Held) -> [f64; 3] {
        let mut rates = [[0.0; 3]; 3];
        self.cells(mesh).for_each(|cell| add(&mut rates, &cell.gradient(&velocity)));
        held.spin(&self.with_images(rates, mesh))
    }

    /// Hands a torque on it, where it is held so, on to the corners of its live cells: tells of each with the force on it.
    /// Returns the moment of these forces: on a mirror not the torque, but with that of its images.
    pub fn couple(
        &self,
        (mesh, state): (&Mesh, &State),
        (held, torque): (&Held, [f64; 3]),
        mut push: impl FnMut(usize, [f64; 3]),
    ) -> [f64; 3] {
        // Images bear as much as what is here.
        let sides = f64::from(1_u32 << self.mirrors.count_ones());
        let ways = held.couples(torque.map(|x| sides * x));
        let mut moment = [0.0; 3];
        for cell in self.cells(mesh) {
            for (slot, &corner) in cell.corners.iter().enumerate() {
                let part =
                    |d: usize| (0..3).map(|axis| cell.weight(slot, axis) * ways[axis][d]).sum();
                push(corner, std::array::from_fn(part));
            }
            for (arm, way) in cell.axes(state).into_iter().zip(ways) {
                let own = cross(arm, way);
                moment.iter_mut().zip(own).for_each(|(all, own)| *all += own);
            }
        }
        moment
    }
}

/// A cell that holds a particle.
struct Cell<'a> {
    body: &'a Body,
    corners: [usize; 8],
}

impl<'a> Cell<'a> {
    /// Gradient of a field along the axes of the lattice, at the centre.
    #[inline(always)]
    fn gradient(&self, field: impl Fn(usize) -> [f64; 3]) -> [[f64; 3]; 3] {
        let u = self.corners.map(field);
        let size = self.body.lattice.size;
        let weight = [0.25 / size[0], 0.25 / size[1], 0.25 / size[2]];
        let mut out = [[0.0; 3]; 3];
        for d in 0..3 {
            let [a, b, c, e, f, g, h, i] = [0, 1, 2, 3, 4, 5, 6, 7].map(|slot: usize| u[slot][d]);
            out[0][d] = weight[0] * ((b - a) + (e - c) + ((g - f) + (i - h)));
            out[1][d] = weight[1] * ((c - a) + (e - b) + ((h - f) + (i - g)));
            out[2][d] = weight[2] * ((f - a) + (g - b) + ((h - c) + (i - e)));
        }
        out
    }

    /// Weight of a corner in it.
    fn weight(&self, slot: usize, axis: usize) -> f64 {
        let weight = 0.25 / self.body.lattice.size[axis];
        if slot >> axis & 1 == 1 { weight } else { -weight }
    }

    /// What the axes of the lattice have become.
    #[inline(always)]
    fn axes(&self, state: &State) -> [[f64; 3]; 3] {
        let mut axes = self.gradient(|i| [state.dx[i], state.dy[i], state.dz[i]]);
        add(&mut axes, &self.body.lattice.axes);
        axes
    }
}

/// Adds to vectors.
#[inline(always)]
fn add(to: &mut [[f64; 3]; 3], more: &[[f64; 3]; 3]) {
    for (to, more) in to.iter_mut().zip(more) {
        to.iter_mut().zip(more).for_each(|(to, more)| *to += more);
    }
}

/// A matrix with these columns.
#[must_use]
pub fn columns(axes: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_columns(&axes.map(Vector3::from))
}

/// Columns of a matrix.
#[must_use]
pub fn of_columns(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    matrix.data.0
}

/// How a held particle lies.
#[derive(Debug, Clone, Copy, Default)]
pub struct Held {
    /// Its axes: those of the lattice, rotated.
    pub axes: [[f64; 3]; 3],
    /// `R (tr S - S)^-1 R^T`: from the moment of the rates of the axes to the spin, and from a torque to couples at the
    /// axes.
    lever: Symmetric,
}

impl Held {
    /// Of what the axes of a lattice have become.
    fn of(deformation: &[[f64; 3]; 3], lattice: &[[f64; 3]; 3]) -> Self {
        let axes = rotation(deformation, lattice);
        // `R S R^T` is the symmetric half of `M R^T`.
        let [a, b, c] = deformation;
        let row = |d: usize| {
            let along = |e: usize| a[d] * axes[0][e] + b[d] * axes[1][e] + c[d] * axes[2][e];
            [along(0), along(1), along(2)]
        };
        let stretch = Symmetric::half([row(0), row(1), row(2)]);
        let stiffness = Symmetric::identity(stretch.trace()) + stretch.scaled(-1.0);
        // Two stretches that cancel leave a rotation undefined: it is left alone.
        Self { axes, lever: stiffness.inverse().unwrap_or_default() }
    }

    /// Angular velocity, from the rates of the deformation.
    fn spin(&self, rates: &[[f64; 3]; 3]) -> [f64; 3] {
        let [a, b, c] = [0, 1, 2].map(|k: usize| cross(self.axes[k], rates[k]));
        self.lever.times([a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]])
    }

    /// Forces on the columns of the deformation whose power is that of a torque on the rotation.
    fn couples(&self, torque: [f64; 3]) -> [[f64; 3]; 3] {
        let couple = self.lever.times(torque);
        self.axes.map(|axis| cross(couple, axis))
    }
}

/// Columns of the rotation next to a deformation. Where that is no inversion, the limit of the averages of a matrix and
/// its inverse transposed (N. J. Higham, *Computing the polar decomposition*, SIAM J. Sci. Stat. Comput. 7 (1986) 1160);
/// else, and where it is nearly flat, by turns from the axes of the lattice (M. Müller, J. Bender, N. Chentanez and
/// M. Macklin, *A robust method to extract the rotational part of deformations*, 2016).
fn rotation(deformation: &[[f64; 3]; 3], lattice: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    by_averages(*deformation).unwrap_or_else(|| {
        let start = Rotation3::from_matrix_unchecked(columns(*lattice));
        let by_turns = Rotation3::from_matrix_eps(&columns(*deformation), ACCURACY, ROUNDS, start);
        of_columns(by_turns.matrix())
    })
}

/// The first way of [`rotation`]; nothing where it is not for it.
#[inline]
fn by_averages(mut a: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let squares = |a: &[[f64; 3]; 3]| dot(a[0], a[0]) + dot(a[1], a[1]) + dot(a[2], a[2]);
    let mut size = squares(&a);
    if !size.is_finite() || dot(a[0], cross(a[1], a[2])) < FLAT * (size / 3.0).powf(1.5) {
        return None;
    }
    for _ in 0..AVERAGES {
        // Cofactors: the inverse transposed, times the determinant.
        let b = [cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])];
        let per = 1.0 / dot(a[0], b[0]);
        // Both of one size: the fewest rounds.
        let scale = ((squares(&b) * (per * per)) / size).sqrt().sqrt();
        let [own, other] = [0.5 * scale, 0.5 * per / scale];
        let mut next = [[0.0; 3]; 3];
        for k in 0..3 {
            for d in 0..3 {
                next[k][d] = own * a[k][d] + other * b[k][d];
            }
        }
        let mut change = 0.0f64;
        for k in 0..3 {
            for d in 0..3 {
                change = change.max((next[k][d] - a[k][d]).abs());
            }
        }
        a = next;
        size = squares(&a);
        if change <= NEARLY {
            return Some(a);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deformations, by columns: much sheared, pressed to a fiftieth of the volume, and turned over.
    const DEFORMATIONS: [[[f64; 3]; 3]; 3] = [
        [[1.0, 0.0, 0.2], [2.0, 1.0, 0.0], [0.1, -0.3, 0.9]],
        [[1.0, 0.0, 0.0], [0.1, 0.02, 0.0], [0.0, 0.1, 1.1]],
        [[-0.9, 0.1, 0.3], [0.2, -1.2, 0.0], [0.1, 0.4, 0.8]],
    ];
    const RATES: [[f64; 3]; 3] = [[0.3, 0.2, 1.1], [-1.0, 0.5, 0.6], [0.7, -0.4, -0.8]];
    const STRAIGHT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// Some time on.
    fn after(deformation: &[[f64; 3]; 3], time: f64) -> [[f64; 3]; 3] {
        std::array::from_fn(|k| std::array::from_fn(|d| deformation[k][d] + time * RATES[k][d]))
    }

    #[test]
    fn averages_and_turns_find_one_rotation() {
        let start = Rotation3::identity();
        for deformation in DEFORMATIONS {
            let found = columns(by_averages(deformation).expect("no inversion"));
            assert!((found.transpose() * found - Matrix3::identity()).norm() < 2e-15);
            assert!((found.determinant() - 1.0).abs() < 1e-15);
            let stretch = found.transpose() * columns(deformation);
            assert!((stretch - stretch.transpose()).norm() < 1e-15 * stretch.norm());
            assert!(stretch.symmetric_eigenvalues().min() > 0.0);
            let turned = Rotation3::from_matrix_eps(&columns(deformation), ACCURACY, ROUNDS, start);
            assert!((found - turned.matrix()).norm() < 1e-7);
        }
        // Inverted, flat, and no numbers.
        assert!(by_averages(DEFORMATIONS[0].map(|axis| axis.map(|x| -x))).is_none());
        assert!(by_averages([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]).is_none());
        assert!(by_averages([[f64::NAN; 3]; 3]).is_none());
    }

    #[test]
    fn the_spin_of_what_is_held_is_the_rate_of_its_rotation() {
        for deformation in DEFORMATIONS {
            let held = Held::of(&deformation, &STRAIGHT);
            let spin = Vector3::from(held.spin(&RATES));
            let step = 1e-6;
            let [before, after] =
                [-step, step].map(|time| columns(rotation(&after(&deformation, time), &STRAIGHT)));
            // Of so small an angle the sine is the angle, and the cosine tells nothing.
            let turned = after * before.transpose();
            let sines = [(2, 1), (0, 2), (1, 0)].map(|(a, b)| turned[(a, b)] - turned[(b, a)]);
            let difference = Vector3::from(sines) / (4.0 * step);
            assert!((difference - spin).norm() < 1e-8 * spin.norm(), "{difference} {spin}");
        }
    }

    #[test]
    fn couples_have_the_moment_and_the_power_of_their_torque() {
        let torque = [0.3, -0.8, 0.5];
        for deformation in DEFORMATIONS {
            let held = Held::of(&deformation, &STRAIGHT);
            let (mut moment, mut power) = (Vector3::zeros(), 0.0);
            for (couple, (arm, rate)) in
                held.couples(torque).into_iter().zip(deformation.into_iter().zip(RATES))
            {
                moment += Vector3::from(cross(arm, couple));
                power += dot(rate, couple);
            }
            assert!((moment - Vector3::from(torque)).norm() < 1e-12, "{moment}");
            let wanted = dot(torque, held.spin(&RATES));
            assert!((power / wanted - 1.0).abs() < 1e-12, "{power} {wanted}");
        }
    }
}
