//! What a scene will be, before it runs: its particles and masses, its first steps on this machine, what could halve it.

use std::time::{Duration, Instant};

use whipple_solver::error::StepError;
use whipple_solver::space::Simulation;
use whipple_solver::space::scene::{Body, Scene, Shape};

/// Longest time that a calibration takes.
const CALIBRATION: Duration = Duration::from_millis(1500);

/// Most steps of it, and those of its start that are not counted: the first are shorter.
const STEPS: [u64; 2] = [400, 5];

/// Cells through a part below which what happens in it is not resolved: a bending plate has four.
pub const FEW: usize = 3;

/// Time that steps take here, and how long they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Length of the first step.
    pub first: f64,
    /// Mean length of those that were tried.
    pub step: f64,
    /// Seconds on the clock for one of them.
    pub seconds: f64,
}

impl Pace {
    /// Tries steps, with nothing asleep.
    ///
    /// # Errors
    /// A numerical failure.
    pub fn of(mut simulation: Simulation, stop: f64) -> Result<Self, StepError> {
        simulation.keep_awake();
        simulation.step(stop)?;
        let first = simulation.last_step();
        let [most, left_out] = STEPS;
        for _ in 1..left_out {
            simulation.step(stop)?;
        }
        let (from, start) = (simulation.time(), Instant::now());
        let mut steps = 0u64;
        while steps < most && start.elapsed() < CALIBRATION && simulation.time() < stop {
            simulation.step(stop)?;
            steps += 1;
        }
        let steps = steps.max(1) as f64;
        let seconds = start.elapsed().as_secs_f64() / steps;
        let step = ((simulation.time() - from) / steps).max(f64::MIN_POSITIVE);
        Ok(Self { first, step, seconds })
    }

    /// Seconds that a run to this time takes, if its steps stay as they are.
    #[must_use]
    pub fn whole(&self, stop: f64) -> f64 {
        stop / self.step * self.seconds
    }
}

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
