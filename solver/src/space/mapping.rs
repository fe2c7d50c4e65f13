//! Lattices of unequal cells: where the places of a regular lattice lie instead.

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

use crate::error::SceneError;

/// A closed form that moves every place of a body's regular lattice.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Mapping {
    /// Moves along one axis by a sine of the place on it, times the distance from a plane across
    /// another axis: `x_a + slope (zero - x_b) sin(pi x_a / length)`. Planes at whole multiples of the
    /// length stay where they are.
    Skew {
        /// The axis along which places move, `a`: 0, 1 or 2.
        along: usize,
        /// The other axis, `b`.
        across: usize,
        /// Place on it where nothing moves.
        zero: f64,
        /// Half a wave length of the sine.
        length: f64,
        /// Largest way over the distance from `zero`.
        slope: f64,
    },
    /// Bends planes `x` into cylinders about the z axis: `(x cos(y/R), x sin(y/R), z)`. Ways along y
    /// keep their length at the radius R.
    Wrap {
        /// The radius R.
        radius: f64,
    },
}

impl Mapping {
    /// Where a place of the regular lattice lies.
    #[must_use]
    pub fn apply(&self, x: [f64; 3]) -> [f64; 3] {
        match *self {
            Self::Skew { along, across, zero, length, slope } => {
                let mut out = x;
                out[along] += slope * (zero - x[across]) * (PI * x[along] / length).sin();
                out
            }
            Self::Wrap { radius } => {
                let (sin, cos) = (x[1] / radius).sin_cos();
                [x[0] * cos, x[0] * sin, x[2]]
            }
        }
    }

    /// Volume of what becomes of the box with these lowest and highest coordinates.
    #[must_use]
    pub fn volume(&self, [low, high]: [[f64; 3]; 2]) -> f64 {
        let edge = |axis: usize| high[axis] - low[axis];
        match *self {
            Self::Skew { along, across, zero, length, slope } => {
                let wave = |x: f64| (PI * x / length).sin();
                let middle = 0.5 * (low[across] + high[across]);
                let gain = slope * (zero - middle) * (wave(high[along]) - wave(low[along]));
                let face: f64 = (0..3).filter(|&axis| axis != along).map(edge).product();
                (edge(along) + gain) * face
            }
            Self::Wrap { radius } => {
                let middle = 0.5 * (low[0] + high[0]);
                middle / radius * edge(0) * edge(1) * edge(2)
            }
        }
    }

    /// Checks its numbers; whether cells stay cells is seen on the lattice.
    pub(super) fn validate(&self, key: &str) -> Result<(), SceneError> {
        match *self {
            Self::Skew { along, across, zero, length, slope } => {
                let key = |name: &str| format!("{key}.skew.{name}");
                if along > 2 || across > 2 || along == across {
                    let wanted = "`along` and `across` are two of the axes 0, 1 and 2";
                    let given = format!("{along} and {across}");
                    return Err(SceneError::new(key("along"), given, wanted));
                }
                for (name, value) in [("zero", zero), ("slope", slope), ("length", length)] {
                    if !value.is_finite() {
                        return Err(SceneError::new(key(name), value, "it must be finite"));
                    }
                }
                if length <= 0.0 {
                    return Err(SceneError::new(key("length"), length, "it must be positive"));
                }
            }
            Self::Wrap { radius } => {
                if !(radius.is_finite() && radius > 0.0) {
                    let key = format!("{key}.wrap.radius");
                    return Err(SceneError::new(key, radius, "it must be positive"));
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums the Jacobian, taken by differences, over a box.
    fn summed(mapping: &Mapping, [low, high]: [[f64; 3]; 2]) -> f64 {
        let n = 40;
        let size: [f64; 3] = std::array::from_fn(|d| (high[d] - low[d]) / f64::from(n));
        let mut sum = 0.0;
        for k in 0..n * n * n {
            let cell = [k % n, k / n % n, k / n / n].map(f64::from);
            let at = |shift: [f64; 3]| {
                let x = std::array::from_fn(|d| low[d] + (cell[d] + 0.5 + shift[d]) * size[d]);
                mapping.apply(x)
            };
            let side = |d: usize| {
                let mut shift = [0.0; 3];
                shift[d] = 0.5;
                let (a, b) = (at(shift), at(shift.map(|s: f64| -s)));
                [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
            };
            let (a, b) = (side(0), super::super::lattice::cross(side(1), side(2)));
            sum += a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        }
        sum
    }

    #[test]
    fn volumes_are_those_of_the_closed_forms() {
        let ends = [[0.2, 0.1, -0.3], [0.9, 0.7, 0.2]];
        let skew = Mapping::Skew { along: 0, across: 1, zero: 0.7, length: 1.3, slope: 0.4 };
        for mapping in [skew, Mapping::Wrap { radius: 0.8 }] {
            let (sum, exact) = (summed(&mapping, ends), mapping.volume(ends));
            assert!((sum / exact - 1.0).abs() < 1e-3, "{mapping:?}: {sum} {exact}");
        }
    }
}
