//! How two particles meet: spheres along the line between them, ellipsoids across it.

use nalgebra::{Matrix3, Vector3};

use crate::space::lattice::{cross, dot};
use crate::space::mesh::Mesh;
use crate::space::spin::{Spins, Who};

/// A pair of members that may be in contact: the second defines the ellipsoid of the first's coordinate (9).
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) members: [u32; 2],
    pub(super) particles: [u32; 2],
    pub(super) bodies: [u16; 2],
}

impl Pair {
    pub(super) fn who(&self, k: usize) -> Who {
        Who { particle: self.particles[k] as usize, body: self.bodies[k].into() }
    }
}

/// How two particles at some distance meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting<N> {
    /// Coordinate of each on the ellipsoid of the other, Eq. (9).
    pub(super) zeta: [f64; 2],
    /// Length in which `normals` are to be divided twice.
    pub(super) unit: [f64; 2],
    pub(super) normals: N,
}

/// What is particular of spheres, or of ellipsoids.
pub(super) trait Shape: Sync {
    /// What a contact keeps besides.
    type Normals: Normals;
    /// How a pair meets, at `r` from the second to the first.
    fn meet(&self, mesh: &Mesh, pair: &Pair, r: [f64; 3]) -> Meeting<Self::Normals>;
    /// Adds the viscous torque (54) with the coefficient (55), of particles that rotate on their own.
    fn resist(&self, pair: &Pair, coefficient: f64, normals: &mut Self::Normals);
}

/// Directions in which a contact pushes, and rates of its coordinates.
pub(super) trait Normals: Copy + Send + Sync + std::fmt::Debug {
    /// Force on the first: pressure of first and second along `H r` on the other's ellipsoid, Eq. (78), and viscous force
    /// along `r`, Eq. (51).
    fn force(&self, r: [f64; 3], push: [f64; 2], drag: f64) -> [f64; 3];
    /// Torques on both in global axes, Eqs. (79) and (54); nothing of spheres.
    fn torques(&self, r: [f64; 3], push: [f64; 2]) -> Option<[[f64; 3]; 2]>;
    /// `-H r . (v - omega x r)` of each: minus the bracket of Eq. (12), with spins of first and second.
    fn closings(&self, r: [f64; 3], v: [f64; 3], spins: [[f64; 3]; 2]) -> [f64; 2];
    /// Power of the viscous torque on both, with these spins.
    fn torsion_power(&self, spins: [[f64; 3]; 2]) -> f64;
    /// Whether there is a viscous torque.
    fn twists(&self) -> bool;
}

/// Particles that are spheres: nothing rotates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spheres;

impl Shape for Spheres {
    type Normals = ();

    #[inline(always)]
    fn meet(&self, mesh: &Mesh, pair: &Pair, r: [f64; 3]) -> Meeting<()> {
        let distance = dot(r, r).sqrt();
        let unit = [1, 0].map(|other: usize| mesh.bodies[usize::from(pair.bodies[other])].length);
        Meeting { zeta: unit.map(|length| distance / length), unit, normals: () }
    }

    #[inline(always)]
    fn resist(&self, _: &Pair, _: f64, (): &mut ()) {}
}

impl Normals for () {
    #[inline(always)]
    fn force(&self, r: [f64; 3], push: [f64; 2], drag: f64) -> [f64; 3] {
        let force = push[0] + push[1] + drag;
        r.map(|r| force * r)
    }

    #[inline(always)]
    fn torques(&self, _: [f64; 3], _: [f64; 2]) -> Option<[[f64; 3]; 2]> {
        None
    }

    #[inline(always)]
    fn closings(&self, r: [f64; 3], v: [f64; 3], _: [[f64; 3]; 2]) -> [f64; 2] {
        [-dot(r, v); 2]
    }

    #[inline(always)]
    fn torsion_power(&self, _: [[f64; 3]; 2]) -> f64 {
        0.0
    }

    #[inline(always)]
    fn twists(&self) -> bool {
        false
    }
}

/// What a contact of ellipsoids keeps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arms {
    /// `H r` of each on the ellipsoid of the other.
    ways: [[f64; 3]; 2],
    /// Coefficient of the viscous torque, and that on the first.
    pub(super) coefficient: f64,
    torsion: [f64; 3],
}

/// The coordinate (9) of a point at `r` from an ellipsoid with these axes and contact lengths, and `H r` of (10)-(11).
#[inline(always)]
fn coordinate(axes: &[[f64; 3]; 3], lengths: [f64; 3], r: [f64; 3]) -> (f64, [f64; 3]) {
    let (mut square, mut way) = (0.0, [0.0; 3]);
    for (axis, length) in axes.iter().zip(lengths) {
        let along = dot(*axis, r);
        let scaled = along / (length * length);
        square += along * scaled;
        way.iter_mut().zip(axis).for_each(|(way, axis)| *way += scaled * axis);
    }
    (square.sqrt(), way)
}

impl Shape for Spins {
    type Normals = Arms;

    #[inline(always)]
    fn meet(&self, mesh: &Mesh, pair: &Pair, r: [f64; 3]) -> Meeting<Arms> {
        let mut zeta = [0.0; 2];
        let ways = [1, 0].map(|other: usize| {
            let axes = &self.of(pair.members[other]).axes;
            let (own, way) = coordinate(axes, pair.who(other).lengths(mesh), r);
            zeta[1 - other] = own;
            way
        });
        Meeting {
            zeta,
            unit: [1.0; 2],
            normals: Arms { ways, coefficient: 0.0, torsion: [0.0; 3] },
        }
    }

    #[inline(always)]
    fn resist(&self, pair: &Pair, coefficient: f64, arms: &mut Arms) {
        // A held particle has no angular momentum that it could give.
        if !pair.members.into_iter().all(|member| self.rigid(member as usize).is_some()) {
            return;
        }
        let [own, other] = pair.members.map(|member| self.of(member).spin);
        arms.coefficient = coefficient;
        arms.torsion = std::array::from_fn(|d| coefficient * (other[d] - own[d]));
    }
}

impl Arms {
    /// Lessens the viscous torque to what both bear: with the sum `X` of their softnesses, each given by its axes and what
    /// it is along them, times the coefficient it is multiplied by `(1 + X) / (1 + X + X^2)`. That is less than one and
    /// than `1 / X`, and one where `X` is small. Tells whether it is lessened by more than a third.
    pub(super) fn ease(&mut self, softness: &[([[f64; 3]; 3], Vector3<f64>); 2]) -> bool {
        let mut x = Matrix3::zeros();
        for (axes, along) in softness {
            for (axis, along) in axes.iter().zip(along.iter()) {
                let axis = Vector3::from(*axis);
                x += (self.coefficient * along) * axis * axis.transpose();
            }
        }
        let printed = Vector3::from(self.torsion);
        let partly = printed + x * printed;
        let all = Matrix3::identity() + x + x * x;
        // Where nothing is borne, as of a gas without sound, there is none.
        let eased = all.try_inverse().map_or_else(Vector3::zeros, |inverse| inverse * partly);
        let eased = if eased.iter().all(|x| x.is_finite()) { eased } else { Vector3::zeros() };
        self.torsion = eased.into();
        eased.norm() < 2.0 / 3.0 * printed.norm()
    }
}

impl Normals for Arms {
    #[inline(always)]
    fn force(&self, r: [f64; 3], push: [f64; 2], drag: f64) -> [f64; 3] {
        let [a, b] = self.ways;
        std::array::from_fn(|d| push[0] * a[d] + push[1] * b[d] + drag * r[d])
    }

    #[inline(always)]
    fn torques(&self, r: [f64; 3], push: [f64; 2]) -> Option<[[f64; 3]; 2]> {
        let [on_second, on_first] = self.ways.map(|way| cross(way, r));
        Some([
            std::array::from_fn(|d| push[1] * on_first[d] + self.torsion[d]),
            std::array::from_fn(|d| push[0] * on_second[d] - self.torsion[d]),
        ])
    }

    #[inline(always)]
    fn closings(&self, r: [f64; 3], v: [f64; 3], spins: [[f64; 3]; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            let turning = cross(spins[1 - k], r);
            -dot(self.ways[k], std::array::from_fn(|d| v[d] - turning[d]))
        })
    }

    #[inline(always)]
    fn torsion_power(&self, [own, other]: [[f64; 3]; 2]) -> f64 {
        dot(self.torsion, own) - dot(self.torsion, other)
    }

    #[inline(always)]
    fn twists(&self) -> bool {
        self.torsion != [0.0; 3]
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;
    use crate::space::spin::Rigid;

    /// Two ellipsoids that fly and rotate: contact lengths, orientation and spin of each, way and velocity between them.
    struct Two {
        lengths: [[f64; 3]; 2],
        turns: [UnitQuaternion<f64>; 2],
        spins: [[f64; 3]; 2],
        r: [f64; 3],
        v: [f64; 3],
    }

    fn two() -> Two {
        Two {
            lengths: [[0.3, 0.1, 0.2], [1.1, 0.4, 0.15]],
            turns: [[0.3, -1.0, 2.0], [-0.7, 0.2, 1.3]]
                .map(|[a, b, c]| UnitQuaternion::from_euler_angles(a, b, c)),
            spins: [[1.0, -2.0, 0.5], [-0.3, 0.8, 3.0]],
            r: [0.2, -0.15, 0.1],
            v: [-0.4, 0.1, 0.7],
        }
    }

    impl Two {
        /// Coordinates and arms after a time.
        fn after(&self, time: f64) -> ([f64; 2], Arms) {
            let r = std::array::from_fn(|d| self.r[d] + time * self.v[d]);
            let seen = [1, 0].map(|other: usize| {
                let by = UnitQuaternion::new(time * Vector3::from(self.spins[other]));
                let turn = by * self.turns[other];
                let axes = Rigid { turn, momentum: Vector3::zeros() }.axes();
                coordinate(&axes, self.lengths[other], r)
            });
            let arms =
                Arms { ways: seen.map(|own| own.1), coefficient: 0.0, torsion: [0.1, 0.4, -0.2] };
            (seen.map(|own| own.0), arms)
        }
    }

    #[test]
    fn the_rate_of_the_coordinate_is_its_derivative() {
        let two = two();
        let (zeta, arms) = two.after(0.0);
        let closings = arms.closings(two.r, two.v, two.spins);
        let step = 1e-5;
        let (before, after) = (two.after(-step).0, two.after(step).0);
        for k in 0..2 {
            let difference = (after[k] - before[k]) / (2.0 * step);
            let rate = -closings[k] / zeta[k];
            assert!((difference / rate - 1.0).abs() < 1e-8, "{difference} {rate}");
        }
    }

    #[test]
    fn forces_and_torques_of_a_pair_have_no_moment_and_their_power_is_what_closes() {
        let two = two();
        let (_, arms) = two.after(0.0);
        let push = [2.0, 0.7];
        let force = arms.force(two.r, push, 0.3);
        let torques = arms.torques(two.r, push).expect("ellipsoids");
        let orbit = cross(two.r, force);
        let scale: f64 = orbit.iter().chain(&torques[0]).map(|x| x.abs()).sum();
        for d in 0..3 {
            let moment = orbit[d] + torques[0][d] + torques[1][d];
            assert!(moment.abs() < 1e-15 * scale, "{moment}");
        }
        let power =
            dot(force, two.v) + dot(torques[0], two.spins[0]) + dot(torques[1], two.spins[1]);
        let closings = arms.closings(two.r, two.v, two.spins);
        let given = -push[0] * closings[0] - push[1] * closings[1]
            + 0.3 * dot(two.r, two.v)
            + arms.torsion_power(two.spins);
        assert!((power / given - 1.0).abs() < 1e-13, "{power} {given}");
    }

    /// A viscous torque of a slender particle is lessened along the axes that bear less than is printed, and along no other.
    #[test]
    fn torques_are_lessened_along_the_axes_that_cannot_bear_them() {
        let axes = Rigid {
            turn: UnitQuaternion::from_euler_angles(0.4, -1.0, 0.3),
            momentum: Vector3::zeros(),
        }
        .axes();
        let along = |printed: f64| Arms {
            ways: [[0.0; 3]; 2],
            coefficient: 2.0,
            torsion: std::array::from_fn(|d| (0..3).map(|k| printed * axes[k][d]).sum()),
        };
        // The first axis bears a hundredth of what is printed, the others a hundred times as much.
        let softness = (axes, Vector3::new(50.0, 0.005, 0.005));
        let mut arms = along(3.0);
        assert!(!arms.ease(&[softness, (axes, Vector3::zeros())]));
        let given = axes.map(|axis| dot(axis, arms.torsion));
        assert!(given[0] > 0.0 && given[0] < 0.03 && given[0] > 0.029, "{given:?}");
        assert!(given[1..].iter().all(|given| (given / 3.0 - 1.0).abs() < 2e-4), "{given:?}");
        // Two that bear nothing.
        let mut arms = along(3.0);
        assert!(arms.ease(&[(axes, Vector3::repeat(f64::INFINITY)), softness]));
        assert_eq!(arms.torsion, [0.0; 3]);
    }
}
