//! Averages over shells about the origin, the axis z or the plane x = 0.

use whipple_solver::space::Simulation;
use whipple_solver::space::output::Particle;

use crate::exact::Geometry;

/// Distance from the plane, axis or centre.
pub(in crate::cases) fn radius(geometry: Geometry, x: [f64; 3]) -> f64 {
    let k = geometry.dimension() as usize;
    x[..k].iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Velocity away from the plane, axis or centre; zero there.
pub(in crate::cases) fn outward(geometry: Geometry, p: &Particle) -> f64 {
    let k = geometry.dimension() as usize;
    let along: f64 = (0..k).map(|d| p.position[d] * p.velocity[d]).sum();
    let r = radius(geometry, p.position);
    if r > 0.0 { along / r } else { 0.0 }
}

/// Means over a shell by mass.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::cases) struct Shell {
    pub(in crate::cases) radius: f64,
    pub(in crate::cases) velocity: f64,
    pub(in crate::cases) density: f64,
    pub(in crate::cases) pressure: f64,
    /// Root mean square of the pressure about its mean.
    pub(in crate::cases) pressure_scatter: f64,
    mass: f64,
}

/// Means over the shells of a width that hold particles, the innermost first.
pub(in crate::cases) fn shells(
    simulation: &Simulation,
    geometry: Geometry,
    [width, end]: [f64; 2],
) -> Vec<Shell> {
    let mut shells = vec![Shell::default(); (end / width).ceil() as usize];
    for p in simulation.all_particles() {
        let r = radius(geometry, p.position);
        let Some(shell) = shells.get_mut((r / width) as usize) else { continue };
        shell.mass += p.mass;
        shell.radius += p.mass * r;
        shell.velocity += p.mass * outward(geometry, &p);
        shell.density += p.mass * p.rho;
        shell.pressure += p.mass * p.pressure;
        shell.pressure_scatter += p.mass * p.pressure * p.pressure;
    }
    shells.retain(|shell| shell.mass > 0.0);
    for shell in &mut shells {
        let Shell { radius, velocity, density, pressure, pressure_scatter, mass } = shell;
        for sum in [radius, velocity, density, &mut *pressure, &mut *pressure_scatter] {
            *sum /= *mass;
        }
        // Round-off may take the variance of a uniform shell below zero.
        *pressure_scatter = (*pressure_scatter - *pressure * *pressure).max(0.0).sqrt();
    }
    shells
}

/// Where the mean of a quantity falls below a level, the farthest out.
pub(in crate::cases) fn edge(
    shells: &[Shell],
    quantity: impl Fn(&Shell) -> f64,
    level: f64,
) -> Option<f64> {
    super::last_fall(shells.iter().map(|s| (s.radius, quantity(s))), level)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn radii_are_those_of_the_geometry() {
        let x = [3.0, 4.0, 12.0];
        for (geometry, wanted) in Geometry::ALL.into_iter().zip([3.0, 5.0, 13.0]) {
            assert_relative_eq!(radius(geometry, x), wanted);
        }
        let at = |radius: f64, density: f64| Shell { radius, density, ..Shell::default() };
        let shells = [at(0.1, 3.0), at(0.2, 4.0), at(0.3, 1.0)];
        assert_relative_eq!(
            edge(&shells, |s| s.density, 2.0).unwrap_or(0.0),
            0.2 + 0.1 * 2.0 / 3.0
        );
        assert!(edge(&shells, |s| s.density, 9.0).is_none());
    }
}
