//! Averages over the planes of a column along x.

use whipple_solver::space::Simulation;

/// Means over the particles of one plane of the undeformed lattice.
#[derive(Clone, Copy, Default)]
pub(in crate::cases) struct Plane {
    /// Distance from the face before the run.
    pub(in crate::cases) place: f64,
    /// Position along the column.
    pub(in crate::cases) position: f64,
    /// Velocity along the column.
    pub(in crate::cases) velocity: f64,
    pub(in crate::cases) pressure: f64,
    pub(in crate::cases) density: f64,
    count: f64,
}

/// Planes of a body, the nearest to a face first.
pub(in crate::cases) struct Planes {
    pub(in crate::cases) spacing: f64,
    /// Plane of every particle of the body.
    of: Vec<(u32, usize)>,
    count: usize,
}

impl Planes {
    /// Planes of a body along x whose face of interest is at x = `face`.
    pub(in crate::cases) fn new(simulation: &Simulation, body: usize, face: f64) -> Self {
        // Nodes and centroids alternate.
        let spacing = 0.5 * simulation.sizes(body).1[0];
        let of: Vec<(u32, usize)> = simulation
            .all_particles()
            .filter(|p| p.body == body)
            .map(|p| (p.id, ((p.position[0] - face).abs() / spacing).round() as usize))
            .collect();
        let count = of.iter().map(|(_, k)| k + 1).max().unwrap_or(0);
        Self { spacing, of, count }
    }

    /// Means over every plane.
    pub(in crate::cases) fn look(&self, simulation: &Simulation) -> Vec<Plane> {
        let mut layers = vec![Plane::default(); self.count];
        for (k, layer) in layers.iter_mut().enumerate() {
            layer.place = k as f64 * self.spacing;
        }
        for &(id, k) in &self.of {
            let p = simulation.particle(id);
            let layer = &mut layers[k];
            layer.count += 1.0;
            layer.position += p.position[0];
            layer.velocity += p.velocity[0];
            layer.pressure += p.pressure;
            layer.density += p.rho;
        }
        for layer in &mut layers {
            let Plane { position, velocity, pressure, density, .. } = layer;
            for sum in [position, velocity, pressure, density] {
                *sum /= layer.count;
            }
        }
        layers
    }

    /// Pressures of the particles of planes between two distances from the face.
    pub(in crate::cases) fn pressures(
        &self,
        simulation: &Simulation,
        [from, to]: [f64; 2],
    ) -> Vec<f64> {
        let inside = |k: usize| {
            let place = k as f64 * self.spacing;
            place > from && place < to
        };
        let of = self.of.iter().filter(|(_, k)| inside(*k));
        of.map(|(id, _)| simulation.pressure(*id as usize)).collect()
    }
}

/// Where a quantity of the planes falls below a level, the farthest from the face.
pub(in crate::cases) fn front(
    layers: &[Plane],
    quantity: impl Fn(&Plane) -> f64,
    level: f64,
) -> Option<f64> {
    super::last_fall(layers.iter().map(|l| (l.place, quantity(l))), level)
}

/// Mean of a quantity over the planes between two distances from the face; NaN if there is none.
pub(in crate::cases) fn mean(
    layers: &[Plane],
    quantity: impl Fn(&Plane) -> f64,
    [from, to]: [f64; 2],
) -> f64 {
    let inside: Vec<f64> =
        layers.iter().filter(|l| l.place > from && l.place < to).map(quantity).collect();
    super::moments(&inside).0
}

/// How the pressure swings behind a front, as parts of the pressure that it should have there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::cases) struct Ringing {
    /// Highest plane over the level, less one.
    pub(in crate::cases) over: f64,
    /// One less the lowest plane behind the first crest over the level.
    pub(in crate::cases) under: f64,
    /// From the front back to the farthest plane that is off the level by more than a share; zero
    /// where there is none.
    pub(in crate::cases) settling: f64,
}

impl Ringing {
    /// Of the planes between a place and the front behind which their pressure should be `level`,
    /// settled where it stays within `share` of it.
    pub(in crate::cases) fn behind(
        layers: &[Plane],
        [from, front]: [f64; 2],
        level: f64,
        share: f64,
    ) -> Self {
        let back: Vec<&Plane> =
            layers.iter().rev().filter(|l| l.place > from && l.place < front).collect();
        let rise = back.windows(2).take_while(|w| w[1].pressure > w[0].pressure).count();
        let ratios = |from: usize| back.iter().skip(from).map(|l| l.pressure / level);
        let off = |l: &&&Plane| (l.pressure / level - 1.0).abs() > share;
        Self {
            over: ratios(0).fold(f64::NAN, f64::max) - 1.0,
            under: 1.0 - ratios(rise).fold(f64::NAN, f64::min),
            settling: back.iter().rfind(off).map_or(0.0, |l| front - l.place),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn ringing_is_what_a_front_leaves_behind_it() {
        let pressures = [9.0, 2.0, 2.0, 1.9, 2.4, 1.5, 3.0, 1.4, 0.0];
        let at = |(k, &pressure)| Plane { place: k as f64, pressure, ..Plane::default() };
        let layers: Vec<Plane> = pressures.iter().enumerate().map(at).collect();
        let ringing = Ringing::behind(&layers, [0.5, 7.5], 2.0, 0.1);
        assert_relative_eq!(ringing.over, 0.5);
        // Not the plane on the rise, at 1.4.
        assert_relative_eq!(ringing.under, 0.25);
        assert_relative_eq!(ringing.settling, 3.5);
        assert_relative_eq!(Ringing::behind(&layers, [0.5, 3.5], 2.0, 0.1).settling, 0.0);
        assert!(Ringing::behind(&layers, [3.5, 3.7], 2.0, 0.1).over.is_nan());
    }

    #[test]
    fn a_front_is_the_last_fall_through_its_level() {
        let at = |place: f64, pressure: f64| Plane { place, pressure, ..Plane::default() };
        let layers = [at(0.0, 2.0), at(1.0, 0.5), at(2.0, 2.0), at(3.0, 1.0), at(4.0, 0.0)];
        assert_relative_eq!(front(&layers, |l| l.pressure, 1.5).unwrap_or(0.0), 2.5);
        assert!(front(&layers, |l| l.pressure, 3.0).is_none());
        assert_relative_eq!(mean(&layers, |l| l.pressure, [0.5, 3.5]), 3.5 / 3.0);
        assert!(mean(&layers, |l| l.pressure, [5.0, 6.0]).is_nan());
    }
}
