//! What a scene will be, before it runs: gaps between its bodies, what is too coarse, what could halve it.

use whipple_solver::space::Simulation;
use whipple_solver::space::scene::{Body, Scene, Shape};

/// Cells through a part below which what happens in it is not resolved: a bending plate has four.
pub const FEW: usize = 3;

/// Axes across which a scene is its own mirror image, in the plane through the origin.
#[must_use]
pub fn symmetric(scene: &Scene) -> Vec<usize> {
    (0..3).filter(|&axis| scene.bodies.iter().all(|body| own_image(body, axis))).collect()
}

/// Whether a body is its own image: its middle lies on the plane, nothing of its motion leads across, and its cells are as many on
/// either side.
fn own_image(body: &Body, axis: usize) -> bool {
    let shape = match &body.shape {
        Shape::Filled { .. } | Shape::Skewed { .. } => false,
        _ => body.turn.degrees == 0.0,
    };
    // Spin about the axis is its own image, about the others it is not.
    let spins = (0..3).any(|d| d != axis && body.spin[d] != 0.0);
    shape
        && body.centre[axis] == 0.0
        && body.velocity[axis] == 0.0
        && !spins
        && body.cells[axis].is_multiple_of(2)
}

/// Pairs of bodies whose boxes are nearest, with the gap along the axis that parts them; below zero they overlap.
#[must_use]
pub fn gaps(simulation: &Simulation, bodies: usize) -> Vec<([usize; 2], usize, f64)> {
    let mut boxes = vec![([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]); bodies];
    for p in simulation.all_particles() {
        let (low, high) = &mut boxes[p.body];
        for d in 0..3 {
            low[d] = low[d].min(p.position[d]);
            high[d] = high[d].max(p.position[d]);
        }
    }
    let mut all = Vec::new();
    for a in 0..bodies {
        for b in a + 1..bodies {
            let apart = |d: usize| {
                let ((low, high), (other_low, other_high)) = (boxes[a], boxes[b]);
                (other_low[d] - high[d]).max(low[d] - other_high[d])
            };
            let widest = (0..3).max_by(|&c, &d| apart(c).total_cmp(&apart(d))).unwrap_or(0);
            // Others lie before each other along no axis.
            if (0..3).all(|d| d == widest || apart(d) < 0.0) {
                all.push(([a, b], widest, apart(widest)));
            }
        }
    }
    all
}

/// Cells through the thinnest part of a body.
#[must_use]
pub fn through(body: &Body) -> usize {
    match body.shape {
        Shape::Ring { outer, inner, .. } => {
            let wall = 0.5 * (outer - inner) / outer * body.cells[0] as f64;
            (wall.round() as usize).min(body.cells[2])
        }
        _ => body.cells.into_iter().min().unwrap_or(0),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::build::Built;
    use super::*;

    fn scene(more: &str) -> Scene {
        let text = format!(
            "stop = \"1 us\"\nresolution = {{ cell = \"1 mm\" }}\n[[body]]\nname = \"a\"\nmaterial = \"copper\"\n\
             box = {{ size = [\"4 mm\", \"6 mm\", \"2 mm\"] }}\n{more}"
        );
        Built::of(Path::new("a.toml"), &text, None).unwrap_or_else(|e| panic!("{e}")).scene
    }

    #[test]
    fn what_is_its_own_image_is_seen() {
        assert_eq!(symmetric(&scene("")), [0, 1, 2]);
        let flying = "velocity = [\"0 m/s\", \"0 m/s\", \"1 m/s\"]";
        assert_eq!(symmetric(&scene(flying)), [0, 1]);
        assert_eq!(symmetric(&scene("spin = [\"1 rad/s\", \"0 rad/s\", \"0 rad/s\"]")), [0]);
        assert_eq!(symmetric(&scene("at = [\"1 mm\", \"0 mm\", \"0 mm\"]")), [1, 2]);
        assert_eq!(symmetric(&scene("cells = [3, 6, 2]")), [1, 2]);
    }

    #[test]
    fn gaps_are_those_between_faces() {
        let other = "[[body]]\nname = \"b\"\nmaterial = \"copper\"\nbox = { size = [\"4 mm\", \"6 mm\", \"2 mm\"] }\n\
                     at = [\"1 mm\", \"0 mm\", \"2.7 mm\"]\n";
        let scene = scene(other);
        let simulation = Simulation::new(&scene).unwrap();
        let found = gaps(&simulation, 2);
        let [([0, 1], 2, gap)] = found[..] else { panic!("{found:?}") };
        assert!((gap - 0.07).abs() < 1e-12, "{gap}");
    }
}
