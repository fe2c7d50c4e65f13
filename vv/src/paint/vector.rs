//! The few operations on vectors in space that the painter needs.

/// A point or direction.
pub(super) type Vec3 = [f64; 3];

pub(super) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn scaled(a: Vec3, by: f64) -> Vec3 {
    a.map(|x| x * by)
}

/// The point at `t` on the way from `a` (0) to `b` (1).
pub(super) fn mix(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])]
}

/// The direction of a vector, unless it has none.
pub(super) fn unit(a: Vec3) -> Option<Vec3> {
    // Scaling first keeps the square of a huge or tiny vector in range.
    let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let a = scaled(a, largest.recip());
    let length = dot(a, a).sqrt();
    (largest > 0.0 && length.is_finite()).then(|| scaled(a, length.recip()))
}
