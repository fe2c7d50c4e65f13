//! What flies behind a plate across y that was hit, and what flies back.

use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;

use super::impact::{SPHERE, THICKNESS};

/// What is farther from either face than this is no part of the plate any more: a quarter of its
/// thickness, which its faces do not reach where they only bulge.
const MARGIN: f64 = 0.25 * THICKNESS;

/// Share of the mass behind the plate that is slower than its front.
const FRONT: f64 = 0.99;

/// Share of that mass within the cone.
const CONE: f64 = 0.9;

/// Where the material is, and how it moves.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::cases) struct Cloud {
    /// Masses behind the plate: of the sphere and of the plate.
    pub(in crate::cases) mass: [f64; 2],
    /// Their momenta along the normal.
    pub(in crate::cases) momentum: [f64; 2],
    /// Masses in front of the plate, and between.
    pub(in crate::cases) in_front: f64,
    pub(in crate::cases) in_plate: f64,
    /// Velocity along the normal than which a hundredth of the mass behind is faster; zero where there is
    /// none.
    pub(in crate::cases) front: f64,
    /// Angle of the cone about the mean velocity of the mass behind that holds nine tenths of its
    /// velocities, in degrees; zero where there is none.
    pub(in crate::cases) cone: f64,
}

/// The least of some values than which no more than this share of their weights is less.
fn percentile(mut values: Vec<(f64, f64)>, share: f64) -> f64 {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let wanted = share * values.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut so_far = 0.0;
    let reached = values.iter().find(|(_, weight)| {
        so_far += weight;
        so_far >= wanted
    });
    reached.or(values.last()).map_or(0.0, |(value, _)| *value)
}

impl Cloud {
    /// Of a state.
    pub(in crate::cases) fn of(simulation: &Simulation) -> Self {
        let mut cloud = Self::default();
        let mut behind: Vec<Particle> = Vec::new();
        for p in simulation.all_particles() {
            let place = p.position[1];
            if place > THICKNESS + MARGIN {
                let whose = usize::from(p.body != SPHERE);
                cloud.mass[whose] += p.mass;
                cloud.momentum[whose] += p.mass * p.velocity[1];
                behind.push(p);
            } else if place < -MARGIN {
                cloud.in_front += p.mass;
            } else {
                cloud.in_plate += p.mass;
            }
        }
        let along = behind.iter().map(|p| (p.velocity[1], p.mass)).collect();
        cloud.front = percentile(along, FRONT);
        cloud.cone = 2.0 * percentile(off_the_mean(&behind), CONE).to_degrees();
        cloud
    }

    /// Mass behind the plate.
    pub(in crate::cases) fn mass_behind(&self) -> f64 {
        self.mass.iter().sum()
    }

    /// All mass.
    pub(in crate::cases) fn whole(&self) -> f64 {
        self.mass_behind() + self.in_front + self.in_plate
    }
}

/// Angles between the velocities of particles and their mean by mass, with the masses.
fn off_the_mean(particles: &[Particle]) -> Vec<(f64, f64)> {
    let mut mean = [0.0; 3];
    for p in particles {
        mean.iter_mut().zip(p.velocity).for_each(|(sum, v)| *sum += p.mass * v);
    }
    let size = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    let angle = |p: &Particle| {
        let along: f64 = (0..3).map(|d| mean[d] * p.velocity[d]).sum();
        (along / (size(mean) * size(p.velocity))).clamp(-1.0, 1.0).acos()
    };
    particles.iter().map(|p| (angle(p), p.mass)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_go_by_weight() {
        let values = vec![(3.0, 1.0), (1.0, 97.0), (2.0, 2.0)];
        assert_eq!(percentile(values.clone(), 0.97), 1.0);
        assert_eq!(percentile(values.clone(), 0.98), 2.0);
        assert_eq!(percentile(values, 1.0), 3.0);
        assert_eq!(percentile(Vec::new(), 0.5), 0.0);
    }
}
