//! Bodies of random impacts: what they are made of, and where they stand.

use whipple_solver::space::lattice::{Lattice, cell_size, cross, dot};
use whipple_solver::space::scene::{Body, EosData, Material, Shape, Turn};

use super::super::measure::{minus, norm};
use super::super::scenes::body;
use super::draw::Draw;
use super::material::draw_material;

/// Tries to put a body where it touches none but its partner.
const TRIES: usize = 24;
/// Particles of a ball of eight cells.
const BALL: usize = 35;
/// Gap to bodies other than the partner, in edges, beyond which a place is taken.
const CLEAR: f64 = 0.6;

/// A body with its material and its particles.
#[derive(Debug)]
pub(super) struct Piece {
    pub(super) body: Body,
    pub(super) material: Material,
    /// Places of its nodes from its centre.
    nodes: Vec<[f64; 3]>,
    /// Shortest edge of its cells.
    pub(super) edge: f64,
}

/// Sum of a vector and so many times another.
fn along(a: [f64; 3], by: f64, way: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|d| a[d] + by * way[d])
}

/// A unit vector across another.
fn across(draw: &mut Draw, way: [f64; 3]) -> [f64; 3] {
    // Two directions in a row are never so nearly parallel that nothing is left.
    let side = cross(way, draw.direction());
    let size = norm(side);
    if size > 0.0 { side.map(|x| x / size) } else { across(draw, way) }
}

/// Particles of a box of cells.
fn particles(cells: [usize; 3]) -> usize {
    cells.iter().map(|n| n + 1).product::<usize>() + cells.iter().product::<usize>()
}

/// As many cells as so many particles allow, in a box that grows with these weights along its axes, up to so many along
/// each; not all are limited.
fn fill(draw: &mut Draw, most: usize, weights: [f64; 3], limits: [usize; 3]) -> [usize; 3] {
    let mut cells = [1; 3];
    loop {
        let axis = draw.weighted(&weights);
        let mut next = cells;
        next[axis] += 1;
        if particles(next) > most {
            return cells;
        }
        if next[axis] <= limits[axis] {
            cells = next;
        }
    }
}

/// A shape with its cells, of about this edge and of at most so many particles.
fn form(draw: &mut Draw, most: usize, edge: f64) -> (Shape, [usize; 3]) {
    const ANY: usize = usize::MAX;
    let round = |[a, b, c]: [usize; 3]| [a.min(b), a.min(b), c.max(2)];
    let thin = 1 + draw.below(2);
    // The smallest ball that is no box has eight cells.
    let kind = draw.weighted(&[0.35, 0.2, 0.15, 0.1, if most < BALL { 0.0 } else { 0.2 }]);
    let cells = match kind {
        0 => fill(draw, most, [1.0; 3], [ANY; 3]),
        1 => fill(draw, most, [1.0, 1.0, 0.2], [ANY, ANY, thin]),
        2 => fill(draw, most, [1.0, 1.0, 12.0], [ANY; 3]),
        3 => round(fill(draw, most, [1.0, 1.0, 4.0], [ANY; 3])),
        _ => {
            // A ball fills half of its box.
            [(2..).take_while(|&n| particles([n; 3]) <= most).last().unwrap_or(2); 3]
        }
    };
    let bricks = match draw.weighted(&[0.5, 0.4, 0.1]) {
        0 => [1.0; 3],
        1 => std::array::from_fn(|_| draw.log_between(1.0, 4.0)),
        _ => [1.0, 1.0, draw.log_between(4.0, 14.0)],
    };
    let size: [f64; 3] = std::array::from_fn(|k| cells[k] as f64 * edge * bricks[k]);
    let shape = match kind {
        0..=2 => Shape::Box { size },
        3 => Shape::Cylinder { diameter: size[0], length: size[2] },
        _ => Shape::Sphere { diameter: size[0] },
    };
    // Unequal edges of a ball: fewer cells along one axis.
    let flat = kind == 4 && bricks != [1.0; 3] && cells[0] > 2;
    (shape, if flat { [cells[0], cells[0], 1 + draw.below(cells[0])] } else { cells })
}

/// How the lattice of a body lies.
fn turn(draw: &mut Draw) -> Turn {
    match draw.weighted(&[0.6, 0.1, 0.3]) {
        0 => Turn::default(),
        1 => {
            let axis = draw.one_of(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
            Turn { axis, degrees: 90.0 * draw.one_of(&[1.0, 2.0, 3.0]) }
        }
        _ => Turn { axis: draw.direction(), degrees: draw.between(0.0, 180.0) },
    }
}

impl Piece {
    /// The body of this number, in the middle and at rest, with at most about so many particles of about this size;
    /// like another in its material or not.
    pub(super) fn draw(
        draw: &mut Draw,
        number: usize,
        (most, edge): (usize, f64),
        like: Option<&Self>,
    ) -> Self {
        let like = like.filter(|_| draw.chance(0.35));
        let (material, energy) = match like {
            Some(piece) => (piece.material.clone(), piece.body.energy),
            None => draw_material(draw, number),
        };
        let edge = if draw.chance(0.4) { edge } else { edge * draw.log_between(0.5, 2.0) };
        let (shape, cells) = form(draw, most, edge);
        let turn = turn(draw);
        let body = Body { turn, energy, ..body(&material.name, shape, cells) };
        let body = Body { name: format!("body {number}"), ..body };
        let lattice = Lattice::new(&body);
        let nodes = lattice.nodes.iter().map(|&at| lattice.position(at)).collect();
        let edge = cell_size(&body).into_iter().fold(f64::INFINITY, f64::min);
        Self { body, material, nodes, edge }
    }

    /// How far it extends from its centre in a direction.
    fn extent(&self, way: [f64; 3]) -> f64 {
        self.nodes.iter().map(|x| dot(*x, way)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The farthest place of its nodes along a direction.
    pub(super) fn end(&self, way: [f64; 3]) -> f64 {
        dot(self.body.centre, way) + self.extent(way)
    }

    /// Distance of its farthest node from its centre.
    pub(super) fn radius(&self) -> f64 {
        self.nodes.iter().map(|x| norm(*x)).fold(0.0, f64::max)
    }

    /// Largest speed of its nodes in the frame of its centre.
    pub(super) fn rim(&self) -> f64 {
        norm(self.body.spin) * self.radius()
    }

    /// About the speed of sound in it.
    pub(super) fn sound(&self) -> f64 {
        let (u, Material { density, eos, strength, .. }) = (self.body.energy, &self.material);
        let shear = strength.map_or(0.0, |s| 4.0 / 3.0 * s.shear_modulus / density);
        match *eos {
            EosData::MieGruneisen { c0, gamma_0, .. } => {
                (c0 * c0 + gamma_0 * (gamma_0 + 1.0) * u + shear).sqrt()
            }
            EosData::IdealGas { adiabatic_index: g, .. } => (g * (g - 1.0) * u).sqrt(),
        }
    }

    /// Whether a plane across the line of centres parts it from others by at least [`CLEAR`] edges.
    fn is_clear_of(&self, others: &[Self], partner: usize) -> bool {
        others.iter().enumerate().filter(|(k, _)| *k != partner).all(|(_, other)| {
            let way = minus(self.body.centre, other.body.centre);
            let distance = norm(way);
            let (way, back) = (way.map(|x| x / distance), way.map(|x| -x / distance));
            let gap = distance - other.extent(way) - self.extent(back);
            distance > 0.0 && gap > CLEAR * self.edge.max(other.edge)
        })
    }

    /// Puts it beside one of others, with this speed relative to it; whether there is room.
    pub(super) fn place(&mut self, draw: &mut Draw, others: &[Self], speed: f64) -> bool {
        for _ in 0..TRIES {
            let partner = draw.below(others.len());
            let way = self.put(draw, &others[partner]);
            if self.is_clear_of(others, partner) {
                self.body.velocity = along(others[partner].body.velocity, speed, course(draw, way));
                return true;
            }
        }
        false
    }

    /// Puts it beside another; the direction in which it then stands of that.
    fn put(&mut self, draw: &mut Draw, partner: &Self) -> [f64; 3] {
        let straight = [self, partner].iter().all(|piece| piece.body.turn.degrees == 0.0);
        let faces = straight && draw.chance(0.75);
        let way = if faces {
            let mut way = [0.0; 3];
            way[draw.below(3)] = draw.one_of(&[-1.0, 1.0]);
            way
        } else {
            draw.direction()
        };
        let edge = self.edge.min(partner.edge);
        let gap = gap(draw) * edge;
        let back = way.map(|x| -x);
        let distance = partner.extent(way) + self.extent(back) + gap;
        let side = across(draw, way);
        let aside = match draw.weighted(&[0.3, 0.1, 0.6]) {
            0 => 0.0,
            1 => 0.5 * edge,
            _ => draw.between(0.0, 0.9) * (partner.extent(side) + self.extent(side.map(|x| -x))),
        };
        let beside = along(partner.body.centre, distance, way);
        self.body.centre = along(beside, aside, side);
        way
    }
}

/// A gap between two bodies in edges of cells: of exactly nothing, tiny, at the distances at which surfaces are first
/// felt and below which they are refused, of any size, or an overlap.
fn gap(draw: &mut Draw) -> f64 {
    match draw.weighted(&[0.1, 0.07, 0.12, 0.05, 0.45, 0.12, 0.09]) {
        0 => 0.0,
        1 => draw.log_between(1e-12, 1e-2),
        2 => 0.5,
        3 => 0.125,
        4 => draw.between(0.125, 1.2),
        5 => draw.between(1.2, 4.0),
        _ => -draw.log_between(1e-6, 0.3),
    }
}

/// The direction in which a body flies that stands in this direction of another: head on, oblique, grazing or away.
fn course(draw: &mut Draw, way: [f64; 3]) -> [f64; 3] {
    let degrees = match draw.weighted(&[0.3, 0.45, 0.2, 0.05]) {
        0 => 0.0,
        1 => draw.between(0.0, 75.0),
        2 => draw.between(75.0, 90.0),
        _ => draw.between(90.0, 180.0),
    };
    let (sine, cosine) = f64::to_radians(degrees).sin_cos();
    let side = across(draw, way);
    std::array::from_fn(|d| sine * side[d] - cosine * way[d])
}
