//! A sphere of aluminium that hits a plate: what the two cases of plates share.

use whipple_solver::space::lattice::cell_size;
use whipple_solver::space::scene::{Body, Shape};

use super::metals::{ALUMINIUM, Ductile};
use super::resting;

/// Diameter of the sphere and thickness of the plate in cm, speed in cm/us: the paper's fourth problem.
pub(in crate::cases) const DIAMETER: f64 = 0.618;
pub(in crate::cases) const THICKNESS: f64 = 0.47;
pub(in crate::cases) const SPEED: f64 = 0.7;
/// End of the runs in us.
pub(in crate::cases) const STOP: f64 = 10.0;
/// First gap between sphere and plate, in cells of the plate.
const GAP: f64 = 0.9;

/// Edge of the finest cells of the sphere: a plate of finer ones has more particles than a scene may, and
/// the cells of a sphere are counted one by one.
const FINEST: f64 = THICKNESS / 100.0;

/// Which body the sphere is, and which the plate.
pub(in crate::cases) const SPHERE: usize = 0;
pub(in crate::cases) const PLATE: usize = 1;

/// The aluminium of Table 6 with the equation of state `al_paper_2_70`. Its spall strength is that of
/// 6061, whose yield it has (`spall_al_6061`).
pub(in crate::cases) const SPHERE_METAL: Ductile = Ductile {
    metal: ALUMINIUM,
    shear_modulus: 0.271,
    hardening: [0.0029, 125.0, 0.10, 0.567, 1220.0],
    strain: 1.0,
    spall: Some(0.0098),
};

/// A square plate that fills 0 < y < [`THICKNESS`] about x = z = 0, and how it is hit.
pub(in crate::cases) struct Impact<'a> {
    /// Edge of the plate in cm.
    pub(in crate::cases) edge: f64,
    /// Cells through it.
    pub(in crate::cases) through: usize,
    /// How many times as long these are in the plane of the plate.
    pub(in crate::cases) aspect: usize,
    /// Angle of the flight from the normal, in degrees.
    pub(in crate::cases) degrees: f64,
    /// Materials of sphere and plate.
    pub(in crate::cases) materials: [&'a str; 2],
}

/// A sphere at rest with so many cells across.
fn sphere(material: &str, across: usize) -> Body {
    let shape = Shape::Sphere { diameter: DIAMETER };
    Body { name: "sphere".into(), ..resting(material, shape, [across; 3], [0.0; 3]) }
}

/// The sphere with the cells that come nearest to this edge: their size follows from its mass.
fn sphere_of(material: &str, edge: f64) -> Body {
    let about = (DIAMETER / edge).round() as usize;
    let off = |body: &Body| (cell_size(body)[0] / edge).ln().abs();
    let spheres = (about.saturating_sub(2).max(1)..=about + 2).map(|n| sphere(material, n));
    let best = spheres.min_by(|a, b| off(a).total_cmp(&off(b)));
    best.unwrap_or_else(|| sphere(material, about))
}

impl Impact<'_> {
    /// Sphere and plate: the sphere flies at the middle of the plate.
    pub(in crate::cases) fn bodies(&self) -> Vec<Body> {
        let cell = THICKNESS / self.through as f64;
        let across = (self.edge / (cell * self.aspect as f64)).round() as usize;
        let [of_sphere, of_plate] = self.materials;
        let middle = 0.5 * THICKNESS;
        let size = Shape::Box { size: [self.edge, THICKNESS, self.edge] };
        let plate = resting(of_plate, size, [across, self.through, across], [0.0, middle, 0.0]);
        let ball = sphere_of(of_sphere, cell.max(FINEST));
        // The lattice of a sphere ends a little before or beyond its surface.
        let reach = 0.5 * cell_size(&ball)[1] * ball.cells[1] as f64;
        let (sine, cosine) = self.degrees.to_radians().sin_cos();
        let ahead = (middle + GAP * cell + reach) / cosine;
        let centre = [-ahead * sine, middle - ahead * cosine, 0.0];
        let velocity = [SPEED * sine, SPEED * cosine, 0.0];
        vec![Body { centre, velocity, ..ball }, Body { name: "plate".into(), ..plate }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells of the sphere are as large as those of the plate, to a few per cent, and it comes from in
    /// front of the plate.
    #[test]
    fn cells_match_and_the_sphere_is_in_front() {
        for (through, across) in [(4, 5), (6, 8), (8, 10)] {
            for degrees in [0.0, 60.0] {
                let materials = ["a", "b"];
                let bodies = Impact { edge: 5.4, through, aspect: 1, degrees, materials }.bodies();
                let [ball, plate] = [&bodies[SPHERE], &bodies[PLATE]];
                let ratio = cell_size(ball)[0] / cell_size(plate)[1];
                assert!((ratio - 1.0).abs() < 0.06, "{through}: {} across, {ratio}", ball.cells[0]);
                assert_eq!(ball.cells[0], across);
                assert!(ball.centre[1] < -0.5 * DIAMETER && ball.velocity[1] > 0.0);
            }
        }
    }
}
