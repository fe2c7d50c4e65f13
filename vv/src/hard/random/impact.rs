//! The random impact of a seed.

use std::fmt;

use whipple_solver::method::{Density, Preset};
use whipple_solver::space::method::{Method, Particles};
use whipple_solver::space::scene::{Body, Hold, Scene, Shape, Side, Wall};

use super::super::measure::{minus, norm};
use super::super::scenes::scene;
use super::body::Piece;
use super::draw::Draw;
use crate::record::Scheme;

/// Speeds in cm/us: 0.01 and 50 km/s.
const SPEEDS: [f64; 2] = [0.001, 5.0];
/// Particles that a scene is planned with; the least leave 20.
const PARTICLES: [f64; 2] = [24.0, 1500.0];
/// Steps.
const STEPS: [f64; 2] = [20.0, 200.0];
/// Edges of cells in cm.
const EDGES: [f64; 2] = [0.01, 0.3];
/// About the length of a step over the time in which sound and motion cross a cell.
const STEP: f64 = 0.3;

/// A scene and how far it is run.
#[derive(Debug, Clone, PartialEq)]
pub struct Impact {
    /// What all of it follows from.
    pub seed: u64,
    /// Preset and density.
    pub scheme: Scheme,
    /// The scene, in cm, g, us and Mbar.
    pub scene: Scene,
    /// Most steps that are taken.
    pub steps: u64,
    /// Shortest time, of all bodies, in which sound and motion cross a cell as they are at the start, in us.
    pub crossing: f64,
}

impl Impact {
    /// That of a seed.
    #[must_use]
    pub fn of(seed: u64) -> Self {
        let mut draw = Draw::new(seed);
        let preset = if draw.chance(0.65) { Preset::Default } else { Preset::Paper };
        let densities = [Density::Hybrid, Density::Nonholonomic, Density::Kernel];
        let density = densities[draw.weighted(&[0.4, 0.35, 0.25])];
        let particles = draw.one_of(&[Particles::Fitting, Particles::Ellipsoids]);
        let method = Method { density, particles, ..preset.space() };
        let steps = draw.log_between(STEPS[0], STEPS[1]).round();
        let speed = draw.log_between(SPEEDS[0], SPEEDS[1]);
        let mut pieces = draw_pieces(&mut draw, speed);
        let walls = draw_walls(&mut draw, &pieces);
        boost(&mut draw, &mut pieces);
        let crossing = crossing(&pieces, !walls.is_empty());
        let mut materials = Vec::new();
        for piece in &pieces {
            if !materials.contains(&piece.material) {
                materials.push(piece.material.clone());
            }
        }
        let bodies = pieces.into_iter().map(|piece| piece.body).collect();
        let scene = scene(method, materials, bodies);
        let stop_time = STEP * steps * crossing;
        let scene = Scene { name: format!("random impact {seed}"), stop_time, walls, ..scene };
        let scheme = Scheme::Particles { preset, density };
        Self { seed, scheme, scene, steps: steps as u64, crossing }
    }
}

/// Two to four bodies that move, each at about this speed relative to one of those before.
fn draw_pieces(draw: &mut Draw, speed: f64) -> Vec<Piece> {
    let count = 2 + draw.weighted(&[0.6, 0.25, 0.15]);
    let particles = draw.log_between(PARTICLES[0], PARTICLES[1]);
    let edge = draw.log_between(EDGES[0], EDGES[1]);
    let shares: Vec<f64> = (0..count).map(|_| draw.log_between(0.1, 1.0)).collect();
    let whole: f64 = shares.iter().sum();
    let mut pieces: Vec<Piece> = Vec::new();
    for (k, share) in shares.iter().enumerate() {
        // Two cells, and one.
        let least = if k == 0 { 14.0 } else { 9.0 };
        let most = (particles * share / whole).max(least) as usize;
        let mut piece = Piece::draw(draw, k + 1, (most, edge), pieces.last());
        let own = match k {
            0 | 1 => speed,
            _ if draw.chance(0.4) => 0.0,
            _ => speed * draw.between(0.0, 1.0),
        };
        // Where there is no room for a third or fourth body, there is none.
        if k == 0 || piece.place(draw, &pieces, own) {
            pieces.push(piece);
        }
    }
    for piece in &mut pieces {
        if draw.chance(0.25) {
            let rate = speed * draw.log_between(0.01, 1.0) / piece.radius();
            piece.body.spin = draw.direction().map(|x| rate * x);
        }
        if draw.chance(0.1) {
            piece.body.noise = 1e-3 * speed;
        }
    }
    pieces
}

/// Walls that no particle starts beyond, and that mostly one touches.
fn draw_walls(draw: &mut Draw, pieces: &[Piece]) -> Vec<Wall> {
    let mut walls: Vec<Wall> = Vec::new();
    for _ in 0..[0, 1, 2, 3][draw.weighted(&[0.7, 0.18, 0.08, 0.04])] {
        let axis = draw.below(3);
        let (material, outward) = draw.one_of(&[(Side::Above, -1.0), (Side::Below, 1.0)]);
        let hold = draw.one_of(&[Hold::Mirror, Hold::Rest]);
        let edge = pieces.iter().map(|piece| piece.edge).fold(f64::INFINITY, f64::min);
        let gap = if draw.chance(0.6) { 0.0 } else { edge * draw.between(0.0, 2.0) };
        let mut way = [0.0; 3];
        way[axis] = outward;
        let end = pieces.iter().map(|piece| piece.end(way)).fold(f64::NEG_INFINITY, f64::max);
        if walls.iter().all(|wall| (wall.axis, wall.material) != (axis, material)) {
            walls.push(Wall { axis, position: outward * (end + gap), material, hold });
        }
    }
    walls
}

/// Watches the scene from a frame that moves, sometimes: what stood still then runs into walls.
fn boost(draw: &mut Draw, pieces: &mut [Piece]) {
    if draw.chance(0.2) {
        let speed = draw.log_between(SPEEDS[0], SPEEDS[1]);
        let velocity = draw.direction().map(|x| speed * x);
        for piece in pieces {
            piece.body.velocity = std::array::from_fn(|d| piece.body.velocity[d] + velocity[d]);
        }
    }
}

/// Shortest time in which sound and motion cross a cell; walls stand still.
fn crossing(pieces: &[Piece], walls: bool) -> f64 {
    let mut fastest = 0.0f64;
    for one in pieces {
        if walls {
            fastest = fastest.max(norm(one.body.velocity) + one.rim());
        }
        for other in pieces {
            let apart = norm(minus(one.body.velocity, other.body.velocity));
            fastest = fastest.max(apart + one.rim() + other.rim());
        }
    }
    let own = |piece: &Piece| piece.edge / (piece.sound() + fastest);
    pieces.iter().map(own).fold(f64::INFINITY, f64::min)
}

/// A vector with four digits.
fn vector(v: [f64; 3]) -> String {
    format!("({:.4e}, {:.4e}, {:.4e})", v[0], v[1], v[2])
}

/// A body in a line.
fn told(body: &Body) -> String {
    let [a, b, c] = body.cells;
    let shape = match body.shape {
        Shape::Box { size } => format!("box {}", vector(size)),
        Shape::Cylinder { diameter, length } => format!("cylinder {diameter:.4e} x {length:.4e}"),
        Shape::Sphere { diameter } => format!("sphere {diameter:.4e}"),
        ref other => format!("{other:?}"),
    };
    let mut text = format!(
        "{}: {}, {shape} cm of {a} x {b} x {c} cells, centre {}, velocity {} cm/us",
        body.name,
        body.material,
        vector(body.centre),
        vector(body.velocity)
    );
    if body.turn.degrees != 0.0 {
        text +=
            &format!(", turned {:.4} degrees about {}", body.turn.degrees, vector(body.turn.axis));
    }
    if body.spin != [0.0; 3] {
        text += &format!(", spin {} /us", vector(body.spin));
    }
    if body.energy > 0.0 {
        text += &format!(", energy {:.4e} Mbar cm3/g", body.energy);
    }
    if body.noise > 0.0 {
        text += &format!(", noise {:.1e} cm/us", body.noise);
    }
    text
}

/// What is set up, a line each: numerical choices, bodies, walls.
impl fmt::Display for Impact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let particles = match self.scene.method.particles {
            Particles::Fitting => "ellipsoids where cells are flat",
            Particles::Ellipsoids => "ellipsoids",
        };
        let (label, seed, steps) = (self.scheme.label(), self.seed, self.steps);
        write!(f, "seed {seed}: {label}, {particles}, {steps} steps or ")?;
        write!(f, "{:.4e} us", self.scene.stop_time)?;
        for body in &self.scene.bodies {
            write!(f, "\n  {}", told(body))?;
        }
        for wall in &self.scene.walls {
            let axis = ["x", "y", "z"].get(wall.axis).copied().unwrap_or_default();
            let kind = if wall.hold == Hold::Mirror { "mirror" } else { "anvil" };
            let side = if wall.material == Side::Above { "above" } else { "below" };
            write!(f, "\n  {kind} at {axis} = {:.4e}, material {side}", wall.position)?;
        }
        Ok(())
    }
}
