//! Fragments of a state: what is still joined by elements that have not failed.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use serde::Serialize;
use whipple_solver::space::output::{Element, Particle};
use whipple_solver::units::{Dimension, Units};

/// Particles that live elements which have not failed hold together: failed ones bear no tension. All
/// numbers are in the units of the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fragment {
    /// Index of its body.
    pub body: usize,
    /// Number of its particles.
    pub particles: usize,
    /// Mass.
    pub mass: f64,
    /// Centre of mass.
    pub centre: [f64; 3],
    /// Velocity of the centre of mass.
    pub velocity: [f64; 3],
    /// Angular velocity about it, of the rigid body with the same angular momentum and inertia.
    pub spin: [f64; 3],
    /// Extents of its particles' centres along its principal axes, the longest spread first.
    pub size: [f64; 3],
}

/// All pieces of a state.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Debris {
    /// Fragments, body by body, the heaviest first.
    pub fragments: Vec<Fragment>,
    /// Of every body, the number and the mass of particles in no fragment.
    pub dust: Vec<(usize, f64)>,
}

/// Representative of a set, with the paths to it halved.
fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}

impl Debris {
    /// Of a state: its particles, in the order of their numbers, and its elements.
    #[must_use]
    pub fn of(particles: &[Particle], elements: &[Element], bodies: usize) -> Self {
        let room = particles.last().map_or(0, |p| p.id as usize + 1);
        let mut parent: Vec<usize> = (0..room).collect();
        let mut member = vec![false; room];
        for element in elements.iter().filter(|e| e.live && !e.failed) {
            for id in element.corners.into_iter().chain([element.centre]) {
                member[id as usize] = true;
                let own = root(&mut parent, element.centre as usize);
                let other = root(&mut parent, id as usize);
                parent[own.max(other)] = own.min(other);
            }
        }
        let mut sets: Vec<Vec<&Particle>> = vec![Vec::new(); room];
        let mut dust = vec![(0, 0.0); bodies];
        for p in particles {
            if member[p.id as usize] {
                sets[root(&mut parent, p.id as usize)].push(p);
            } else {
                dust[p.body].0 += 1;
                dust[p.body].1 += p.mass;
            }
        }
        let mut fragments: Vec<Fragment> =
            sets.iter().filter(|set| !set.is_empty()).map(|set| fragment(set)).collect();
        fragments.sort_by(|a, b| a.body.cmp(&b.body).then(b.mass.total_cmp(&a.mass)));
        Self { fragments, dust }
    }

    /// The heaviest fragment of a body: what is left of it.
    #[must_use]
    pub fn residual(&self, body: usize) -> Option<&Fragment> {
        self.fragments.iter().find(|fragment| fragment.body == body)
    }

    /// The fragments as CSV, with bodies by their names and units in the head.
    #[must_use]
    pub fn csv(&self, names: &[String], units: Units) -> String {
        let [length, velocity] = [Dimension::Length, Dimension::Velocity].map(|d| units.label(d));
        let (mass, spin) = match units {
            Units::None => ("", ""),
            Units::InLbfS => ("lbf s²/in", "rad/s"),
            Units::CmGUsMbar => ("g", "rad/µs"),
        };
        let head = |name: &str, unit: &str| {
            if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
        };
        let mut columns = vec!["body".to_owned(), "particles".to_owned(), head("mass", mass)];
        for (name, unit) in [("centre", length), ("velocity", velocity), ("spin", spin)] {
            columns.extend(["x", "y", "z"].map(|axis| head(&format!("{name}_{axis}"), unit)));
        }
        columns.extend([1, 2, 3].map(|k| head(&format!("size_{k}"), length)));
        let mut out = columns.join(",") + "\n";
        for f in &self.fragments {
            let name = names.get(f.body).map_or("", String::as_str);
            let name = name.replace(|c: char| c == ',' || c == '"' || c.is_control(), "_");
            let numbers = [f.mass].into_iter().chain(f.centre).chain(f.velocity);
            let numbers = numbers.chain(f.spin).chain(f.size).map(|x| format!("{x:?}"));
            let cells = [name, f.particles.to_string()].into_iter().chain(numbers);
            out += &(cells.collect::<Vec<_>>().join(",") + "\n");
        }
        out
    }
}

/// What some particles are as one body.
fn fragment(set: &[&Particle]) -> Fragment {
    let mass: f64 = set.iter().map(|p| p.mass).sum();
    let mean = |of: fn(&Particle) -> [f64; 3]| -> Vector3<f64> {
        set.iter().map(|p| p.mass / mass * Vector3::from(of(p))).sum()
    };
    let (centre, velocity) = (mean(|p| p.position), mean(|p| p.velocity));
    let (mut spread, mut angular) = (Matrix3::zeros(), Vector3::zeros());
    for p in set {
        let r = Vector3::from(p.position) - centre;
        spread += p.mass * r * r.transpose();
        angular += p.mass * r.cross(&(Vector3::from(p.velocity) - velocity));
    }
    let inertia = Matrix3::identity() * spread.trace() - spread;
    // An element has three extents, so that its particles have an inertia about every axis.
    let spin = inertia.try_inverse().map_or_else(Vector3::zeros, |inverse| inverse * angular);
    let eigen = SymmetricEigen::new(spread);
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let size = axes.map(|axis| {
        let axis = eigen.eigenvectors.column(axis);
        let along = set.iter().map(|p| axis.dot(&Vector3::from(p.position)));
        let ends = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), s| (a.min(s), b.max(s)));
        ends.1 - ends.0
    });
    let body = set.first().map_or(0, |p| p.body);
    Fragment {
        body,
        particles: set.len(),
        mass,
        centre: centre.into(),
        velocity: velocity.into(),
        spin: spin.into(),
        size,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use approx::assert_relative_eq;
    use whipple_solver::space::Simulation;

    use super::*;
    use crate::scenes::build::Built;

    /// Two blocks apart, one at rest, one that flies and turns.
    const BLOCKS: &str = r#"
stop = "1 us"
resolution = { cell = "1 mm" }

[[body]]
name = "still"
material = "copper"
box = { size = ["3 mm", "4 mm", "6 mm"] }

[[body]]
name = "flying"
material = "copper"
box = { size = ["2 mm", "5 mm", "4 mm"] }
at = ["20 mm", "0 mm", "1 mm"]
velocity = ["100 m/s", "0 m/s", "-200 m/s"]
spin = ["100 rad/s", "2000 rad/s", "-300 rad/s"]
"#;

    fn state() -> (Vec<Particle>, Vec<Element>) {
        let built = Built::of(Path::new("blocks.toml"), BLOCKS, None).expect("a scene");
        let simulation = Simulation::new(&built.scene).expect("a simulation");
        (simulation.all_particles().collect(), simulation.all_elements().collect())
    }

    #[test]
    fn blocks_have_their_masses_motions_and_sizes() {
        let (particles, elements) = state();
        let debris = Debris::of(&particles, &elements, 2);
        let [still, flying] = &debris.fragments[..] else { panic!("{debris:?}") };
        assert_eq!((still.body, flying.body), (0, 1));
        assert_eq!(still.particles, 4 * 5 * 7 + 3 * 4 * 6);
        // The same material: masses are as volumes.
        assert_relative_eq!(still.mass / flying.mass, 72.0 / 40.0, max_relative = 1e-12);
        for d in 0..3 {
            assert_relative_eq!(still.size[d], [0.6, 0.4, 0.3][d], max_relative = 1e-9);
            assert_relative_eq!(flying.size[d], [0.5, 0.4, 0.2][d], max_relative = 1e-9);
            assert_relative_eq!(flying.centre[d], [2.0, 0.0, 0.1][d], epsilon = 1e-12);
            assert_relative_eq!(flying.velocity[d], [0.01, 0.0, -0.02][d], epsilon = 1e-14);
            assert_relative_eq!(flying.spin[d], [1e-4, 2e-3, -3e-4][d], max_relative = 1e-9);
            assert_relative_eq!(still.spin[d], 0.0, epsilon = 1e-15);
        }
        assert_eq!(debris.dust, [(0, 0.0); 2]);
        let csv = debris.csv(&["still".into(), "flying".into()], Units::CmGUsMbar);
        assert!(csv.starts_with("body,particles,mass [g],centre_x [cm],"), "{csv}");
        assert_eq!(csv.lines().count(), 3);
    }

    /// A layer of failed elements across a block parts it; all mass is in fragments or dust.
    #[test]
    fn failed_elements_part_a_block() {
        let (particles, mut elements) = state();
        let height = |e: &Element| {
            particles.iter().find(|p| p.id == e.centre).map_or(f64::NAN, |p| p.position[2])
        };
        for element in elements.iter_mut().filter(|e| e.body == 0) {
            element.failed = (height(element) - 0.05).abs() < 0.01;
        }
        let debris = Debris::of(&particles, &elements, 2);
        assert_eq!(debris.fragments.iter().filter(|f| f.body == 0).count(), 2);
        let residual = debris.residual(0).expect("a fragment");
        assert_relative_eq!(residual.size[0], 0.4, max_relative = 1e-9);
        // The centroids of the layer are loose.
        assert_eq!(debris.dust[0].0, 3 * 4);
        let all: f64 = particles.iter().map(|p| p.mass).sum();
        let found: f64 = debris.fragments.iter().map(|f| f.mass).sum();
        assert_relative_eq!(found + debris.dust[0].1, all, max_relative = 1e-12);
    }
}
