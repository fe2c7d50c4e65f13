//! Motion that no element resists by its strain: hourglass modes of the corners, and centroids against
//! corners (the checkerboard).

use whipple_solver::space::Simulation;

/// Kinetic energy in such modes. Both are zero in any linear field of velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::cases) struct Modes {
    /// Of the four hourglass modes of each element.
    pub(in crate::cases) hourglass: f64,
    /// Of centroids against the mean of their corners.
    pub(in crate::cases) checkerboard: f64,
}

/// Signs of the four hourglass modes by slot `b1 + 2 b2 + 4 b3`.
fn signs(slot: usize) -> [f64; 4] {
    let [a, b, c] = [0, 1, 2].map(|bit| if slot >> bit & 1 == 1 { 1.0 } else { -1.0 });
    [a * b, b * c, a * c, a * b * c]
}

/// Amplitudes of the hourglass modes and the mean of eight corner values.
fn amplitudes(corners: &[f64; 8]) -> ([f64; 4], f64) {
    let mut modes = [0.0; 4];
    for (slot, value) in corners.iter().enumerate() {
        for (mode, sign) in modes.iter_mut().zip(signs(slot)) {
            *mode += 0.125 * sign * value;
        }
    }
    (modes, 0.125 * corners.iter().sum::<f64>())
}

/// Energy of such modes in all live elements.
pub(in crate::cases) fn energies(simulation: &Simulation) -> Modes {
    let mut out = Modes::default();
    for element in simulation.all_elements().filter(|e| e.live) {
        let centre = simulation.particle(element.centre);
        let velocities = element.corners.map(|i| simulation.particle(i).velocity);
        // The centroid has half of the cell's mass, its corners a sixteenth each.
        let mass = 2.0 * centre.mass;
        for axis in 0..3 {
            let (modes, mean) = amplitudes(&velocities.map(|v| v[axis]));
            out.hourglass += 0.25 * mass * modes.iter().map(|q| q * q).sum::<f64>();
            out.checkerboard += 0.125 * mass * (centre.velocity[axis] - mean).powi(2);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_fields_have_no_hourglass_and_each_mode_has_its_own() {
        let field = |f: fn([f64; 3]) -> f64| {
            let corner = |slot: usize| f([0, 1, 2].map(|bit| (slot >> bit & 1) as f64 - 0.5));
            amplitudes(&std::array::from_fn(corner))
        };
        assert_eq!(field(|x| 1.0 + x[0] - 2.0 * x[1] + x[2]), ([0.0; 4], 1.0));
        assert_eq!(field(|x| 4.0 * x[0] * x[1]), ([1.0, 0.0, 0.0, 0.0], 0.0));
        assert_eq!(field(|x| 8.0 * x[0] * x[1] * x[2]), ([0.0, 0.0, 0.0, 1.0], 0.0));
    }
}
