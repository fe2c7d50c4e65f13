//! One ellipsoid that rotates on its own: Eqs. (2)-(8), (19)-(20), (64), (75), (77).

use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};

/// `(2 beta)^2` of Eq. (11), `(pi sqrt 3)^(2/3)`: particles have the volume that they stand for (gap G15).
const FILL_SQUARED: f64 = 3.0936677262801355;

/// Largest angle of a step of the rotation.
const ANGLE: f64 = 0.25;

/// Most such steps in one of a run; what spins faster is not followed any closer.
const MOST: f64 = 1000.0;

/// Most rounds until the momentum in the middle of a step is found.
const ROUNDS: usize = 60;

/// Moments of inertia `J` of an ellipsoid of this mass about its axes, from contact lengths `2 beta h_k`: Eq. (19).
#[must_use]
pub fn inertia(mass: f64, lengths: [f64; 3]) -> Vector3<f64> {
    let [a, b, c] = lengths.map(|length| length * length / FILL_SQUARED);
    Vector3::new(b + c, a + c, a + b) * (0.2 * mass)
}

/// Half-lengths `h_k` of an ellipsoid with contact lengths `2 beta h_k`.
#[must_use]
pub fn half_lengths(lengths: [f64; 3]) -> [f64; 3] {
    lengths.map(|length| length / FILL_SQUARED.sqrt())
}

/// What rotates: orientation, the Euler parameters `e` of Eq. (1), and angular momentum `h` of Eq. (20) in its own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigid {
    /// From own axes to global ones.
    pub turn: UnitQuaternion<f64>,
    /// Angular momentum in own axes.
    pub momentum: Vector3<f64>,
}

impl Rigid {
    /// With the angular velocity `spin` in global axes.
    #[must_use]
    pub fn spinning(turn: UnitQuaternion<f64>, spin: Vector3<f64>, inertia: &Vector3<f64>) -> Self {
        Self { turn, momentum: turn.inverse_transform_vector(&spin).component_mul(inertia) }
    }

    /// Its axes, in global ones: columns of `R`, Eq. (2).
    #[must_use]
    pub fn axes(&self) -> [[f64; 3]; 3] {
        axes(&self.turn.to_rotation_matrix())
    }

    /// Angular velocity in global axes, Eq. (37).
    #[must_use]
    pub fn spin(&self, inertia: &Vector3<f64>) -> Vector3<f64> {
        self.turn * self.momentum.component_div(inertia)
    }

    /// Rotational part of the kinetic co-energy (19).
    #[must_use]
    pub fn energy(&self, inertia: &Vector3<f64>) -> f64 {
        0.5 * self.momentum.dot(&self.momentum.component_div(inertia))
    }

    /// Takes an angular impulse in global axes.
    pub fn kick(&mut self, impulse: &Vector3<f64>) {
        self.momentum += self.turn.inverse_transform_vector(impulse);
    }

    /// Rotates freely for a time `dt`: Eq. (64) without torque, and (77). The implicit midpoint rule keeps energy and
    /// angular momentum to round-off, whatever the step (D. Lewis and J. C. Simo, J. Nonlinear Sci. 4 (1994) 253), and
    /// is of second order.
    /// `softness` is one over the moments of inertia.
    pub fn rotate(&mut self, softness: &Vector3<f64>, dt: f64) {
        let angle = self.momentum.component_mul(softness).norm() * dt;
        if angle == 0.0 {
            return;
        }
        if angle <= ANGLE {
            self.midpoint(softness, dt);
            return;
        }
        let steps = (angle / ANGLE).ceil().min(MOST);
        for _ in 0..steps as usize {
            self.midpoint(softness, dt / steps);
        }
    }

    /// The same about one global axis alone, next to which one of its own lies: a middle one too, about which round-off would
    /// grow.
    pub fn rotate_about(&mut self, axis: usize, softness: &Vector3<f64>, dt: f64) {
        let normal = Vector3::ith_axis(axis);
        let own = self.turn.inverse_transform_vector(&normal);
        let spin = self.momentum.component_mul(softness).dot(&own);
        self.turn = UnitQuaternion::from_axis_angle(&normal, spin * dt) * self.turn;
        self.turn.renormalize_fast();
        self.momentum = self.momentum.dot(&own) * own;
    }

    fn midpoint(&mut self, softness: &Vector3<f64>, dt: f64) {
        let start = self.momentum;
        let small = (4.0 * f64::EPSILON).powi(2) * start.norm_squared();
        let mut end = start;
        let mut spin = Vector3::zeros();
        for _ in 0..ROUNDS {
            let mean = 0.5 * (start + end);
            spin = mean.component_mul(softness);
            let next = start - dt * spin.cross(&mean);
            let change = (next - end).norm_squared();
            end = next;
            if change <= small {
                break;
            }
        }
        let half = 0.5 * dt * spin;
        let part = UnitQuaternion::new_normalize(Quaternion::new(1.0, half.x, half.y, half.z));
        self.turn *= part;
        self.turn.renormalize_fast();
        self.momentum = part.inverse_transform_vector(&start);
    }
}

/// Columns of a rotation.
#[must_use]
pub fn axes(rotation: &Rotation3<f64>) -> [[f64; 3]; 3] {
    let matrix = rotation.matrix();
    std::array::from_fn(|k| matrix.column(k).into_owned().into())
}
