//! How two particles meet: spheres along the line between them, ellipsoids across it.

use crate::space::lattice::{cross, dot};
use crate::space::mesh::Mesh;
use crate::space::spin::{Pose, Spins};
use crate::space::symmetric::Symmetric;

/// A pair of members that may be in contact: the second defines the ellipsoid of the first's coordinate (9).
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) members: [u32; 2],
    pub(super) particles: [u32; 2],
    pub(super) bodies: [u16; 2],
}

/// How two particles at some distance meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    /// Coordinate of each on the ellipsoid of the other, Eq. (9).
    pub(super) zeta: [f64; 2],
    /// Length in which directions of the contact are to be divided twice.
    pub(super) unit: [f64; 2],
}

/// What is particular of spheres, or of ellipsoids.
pub(super) trait Shape: Sync {
    /// What a contact keeps of its viscous torque.
    type Torque: Torque;
    /// How a pair meets, at `r` from the second to the first.
    fn meet(&self, mesh: &Mesh, pair: &Pair, r: [f64; 3]) -> Meeting;
    /// The viscous torque (54) with the coefficient (55), of particles that rotate on their own.
    fn resist(&self, pair: &Pair, coefficient: f64) -> Self::Torque;
}

/// A viscous torque.
pub(super) trait Torque: Copy + Send + Sync + Default + std::fmt::Debug {
    /// Whether there is one.
    fn twists(&self) -> bool;
}

/// Directions in which a contact pushes, and rates of its coordinates.
pub(super) trait Normals: Copy {
    /// Force on the first: pressure of first and second along `H r` on the other's ellipsoid, Eq. (78), and viscous force
    /// along `r`, Eq. (51).
    fn force(&self, r: [f64; 3], push: [f64; 2], drag: f64) -> [f64; 3];
    /// `-H r . (v - omega x r)` of each: minus the bracket of Eq. (12), with spins of first and second.
    fn closings(&self, r: [f64; 3], v: [f64; 3], spins: [[f64; 3]; 2]) -> [f64; 2];
    /// Power of the viscous torque on both, with these spins.
    fn torsion_power(&self, spins: [[f64; 3]; 2]) -> f64;
}

/// Particles that are spheres: nothing rotates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spheres;

impl Shape for Spheres {
    type Torque = ();

    #[inline(always)]
    fn meet(&self, mesh: &Mesh, pair: &Pair, r: [f64; 3]) -> Meeting {
        let distance = dot(r, r).sqrt();
        let length = |k: usize| mesh.bodies[usize::from(pair.bodies[k])].length;
        let unit = [length(1), length(0)];
        Meeting { zeta: [distance / unit[0], distance / unit[1]], unit }
    }

    #[inline(always)]
    fn resist(&self, _: &Pair, _: f64) {}
}

impl Torque for () {
    #[inline(always)]
    fn twists(&self) -> bool {
        false
    }
}

impl Normals for Spheres {
    #[inline(always)]
    fn force(&self, r: [f64; 3], push: [f64; 2], drag: f64) -> [f64; 3] {
        let force = push[0] + push[1] + drag;
        [force * r[0], force * r[1], force * r[2]]
    }

    #[inline(always)]
    fn closings(&self, r: [f64; 3], v: [f64; 3], _: [[f64; 3]; 2]) -> [f64; 2] {
        [-dot(r, v); 2]
    }

    #[inline(always)]
    fn torsion_power(&self, _: [[f64; 3]; 2]) -> f64 {
        0.0
    }
}

/// The viscous torque of a contact of ellipsoids.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Torsion {
    /// Its coefficient.
    pub(super) coefficient: f64,
    /// What acts on the first.
    on_first: [f64; 3],
}

/// How a contact of ellipsoids pushes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arms {
    /// `H r` of each on the ellipsoid of the other.
    ways: [[f64; 3]; 2],
    /// Viscous torque on the first.
    torsion: [f64; 3],
}

/// The coordinate (9) of a point at `r` from an ellipsoid with this `H`, and `H r` of (10)-(11).
#[inline(always)]
fn coordinate(metric: &Symmetric, r: [f64; 3]) -> (f64, [f64; 3]) {
    let way = metric.times(r);
    (dot(way, r).sqrt(), way)
}

impl Shape for Spins {
    type Torque = Torsion;

    #[inline(always)]
    fn meet(&self, _: &Mesh, pair: &Pair, r: [f64; 3]) -> Meeting {
        let on = |k: usize| coordinate(&self.of(pair.members[k]).metric, r).0;
        Meeting { zeta: [on(1), on(0)], unit: [1.0; 2] }
    }

    #[inline(always)]
    fn resist(&self, pair: &Pair, coefficient: f64) -> Torsion {
        let [a, b] = pair.members;
        // A held particle has no angular momentum that it could give.
        if !self.is_free(a) || !self.is_free(b) {
            return Torsion::default();
        }
        let (own, other) = (self.of(a).spin, self.of(b).spin);
        let along = |d: usize| coefficient * (other[d] - own[d]);
        Torsion { coefficient, on_first: [along(0), along(1), along(2)] }
    }
}

impl Torque for Torsion {
    #[inline(always)]
    fn twists(&self) -> bool {
        self.on_first != [0.0; 3]
    }
}

impl Torsion {
    /// Lessens the viscous torque to what both bear: with the sum `X` of their softnesses times the coefficient it is
    /// multiplied by `(1 + X) / (1 + X + X^2)`. That is less than one and than `1 / X`, and one where `X` is small. Tells
    /// whether it is lessened by more than a third.
    #[inline(always)]
    pub(super) fn ease(&mut self, softness: Symmetric) -> bool {
        let x = softness.scaled(self.coefficient);
        let printed = self.on_first;
        let more = x.times(printed);
        let partly = [printed[0] + more[0], printed[1] + more[1], printed[2] + more[2]];
        let all = Symmetric::identity(1.0) + x + x.squared();
        let eased = all.inverse().map_or([0.0; 3], |inverse| inverse.times(partly));
        // Where nothing is borne there is none.
        let some = eased[0].is_finite() && eased[1].is_finite() && eased[2].is_finite();
        self.on_first = if some { eased } else { [0.0; 3] };
        9.0 * dot(self.on_first, self.on_first) < 4.0 * dot(printed, printed)
    }
}

impl Arms {
    /// Of two that are so posed, at `r` from the second to the first, with this viscous torque.
    #[inline(always)]
    pub(super) fn new([first, second]: [&Pose; 2], r: [f64; 3], torsion: &Torsion) -> Self {
        let ways = [second.metric.times(r), first.metric.times(r)];
        Self { ways, torsion: torsion.on_first }
    }

    /// Torques on both in global axes, Eqs. (79) and (54).
    #[inline(always)]
    pub(super) fn torques(&self, r: [f64; 3], push: [f64; 2]) -> [[f64; 3]; 2] {
        let [by_first, by_second] = self.ways;
        let (on_second, on_first) = (cross(by_first, r), cross(by_second, r));
        let t = self.torsion;
        let first = |d: usize| push[1] * on_first[d] + t[d];
        let second = |d: usize| push[0] * on_second[d] - t[d];
        [[first(0), first(1), first(2)], [second(0), second(1), second(2)]]
    }
}

impl Normals for Arms {
    #[inline(always)]
    fn force(&self, r: [f64; 3], push: [f64; 2], drag: f64) -> [f64; 3] {
        let [a, b] = self.ways;
        let along = |d: usize| push[0] * a[d] + push[1] * b[d] + drag * r[d];
        [along(0), along(1), along(2)]
    }

    #[inline(always)]
    fn closings(&self, r: [f64; 3], v: [f64; 3], spins: [[f64; 3]; 2]) -> [f64; 2] {
        let [first, second] = spins;
        let against = |spin: [f64; 3], way: [f64; 3]| {
            let turning = cross(spin, r);
            -dot(way, [v[0] - turning[0], v[1] - turning[1], v[2] - turning[2]])
        };
        [against(second, self.ways[0]), against(first, self.ways[1])]
    }

    #[inline(always)]
    fn torsion_power(&self, [own, other]: [[f64; 3]; 2]) -> f64 {
        dot(self.torsion, own) - dot(self.torsion, other)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

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
                let per_square = self.lengths[other].map(|length| 1.0 / (length * length));
                coordinate(&Symmetric::along(&axes, per_square), r)
            });
            let arms = Arms { ways: seen.map(|own| own.1), torsion: [0.1, 0.4, -0.2] };
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
        let torques = arms.torques(two.r, push);
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
        let along = |printed: f64| Torsion {
            coefficient: 2.0,
            on_first: std::array::from_fn(|d| (0..3).map(|k| printed * axes[k][d]).sum()),
        };
        // The first axis bears a hundredth of what is printed, the others a hundred times as much.
        let softness = Symmetric::along(&axes, [50.0, 0.005, 0.005]);
        let mut torque = along(3.0);
        assert!(!torque.ease(softness));
        let given = axes.map(|axis| dot(axis, torque.on_first));
        assert!(given[0] > 0.0 && given[0] < 0.03 && given[0] > 0.029, "{given:?}");
        assert!(given[1..].iter().all(|given| (given / 3.0 - 1.0).abs() < 2e-4), "{given:?}");
        // Two that bear nothing.
        let mut torque = along(3.0);
        assert!(torque.ease(Symmetric::along(&axes, [f64::INFINITY; 3]) + softness));
        assert_eq!(torque.on_first, [0.0; 3]);
    }
}
