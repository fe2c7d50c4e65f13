//! Cross-sections of a rod along z: what is left of each layer of its lattice.

use std::f64::consts::PI;

use whipple_solver::space::Simulation;

/// A section through the nodes of one plane of the undeformed lattice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::cases) struct Section {
    /// Mean height above the lowest node of a live element.
    pub(in crate::cases) height: f64,
    /// Radius of the disc of the same area, of faces of live elements alone.
    pub(in crate::cases) left: f64,
    /// The same with the faces of dead elements as large as when they were last seen live.
    pub(in crate::cases) radius: f64,
}

/// Sections of a rod along z.
pub(in crate::cases) struct Discs {
    /// By element: its layer, and the corners of its lower and upper face in order round them.
    faces: Vec<(usize, [[u32; 4]; 2])>,
    /// By element: the areas of its faces when it was last seen live.
    areas: Vec<[f64; 2]>,
    layers: usize,
}

/// A rod as it is now.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::cases) struct Rod {
    /// From the lowest to the highest node of a live element.
    pub(in crate::cases) length: f64,
    /// Farthest node of a live element from the axis.
    pub(in crate::cases) reach: f64,
    /// Sections from the lowest plane up.
    pub(in crate::cases) sections: Vec<Section>,
}

impl Rod {
    /// The lowest section; not a number where there is none.
    pub(in crate::cases) fn foot(&self) -> Section {
        let none = Section { height: f64::NAN, left: f64::NAN, radius: f64::NAN };
        self.sections.first().copied().unwrap_or(none)
    }

    /// Radius at a height, between the sections; NaN above and below them.
    pub(in crate::cases) fn radius_at(&self, height: f64) -> f64 {
        let pair = self.sections.windows(2).find(|w| w[0].height <= height && height < w[1].height);
        pair.map_or(f64::NAN, |w| {
            let share = (height - w[0].height) / (w[1].height - w[0].height);
            w[0].radius + share * (w[1].radius - w[0].radius)
        })
    }
}

impl Discs {
    /// Sections of the only body of a new simulation, its axis along z.
    pub(in crate::cases) fn new(simulation: &Simulation) -> Self {
        let place = |i: u32| simulation.particle(i).position;
        let lowest =
            simulation.all_particles().map(|p| p.position[2]).fold(f64::INFINITY, f64::min);
        let mut faces = Vec::new();
        let mut layers = 0;
        for element in simulation.all_elements() {
            let centre = place(element.centre);
            let halves = [-1.0, 1.0].map(|side| {
                let mut face: Vec<u32> = element.corners.into();
                face.retain(|&i| (place(i)[2] - centre[2]) * side > 0.0);
                face.sort_by(|&a, &b| {
                    let angle = |i: u32| {
                        let x = place(i);
                        (x[1] - centre[1]).atan2(x[0] - centre[0])
                    };
                    angle(a).total_cmp(&angle(b))
                });
                std::array::from_fn(|k| face.get(k).copied().unwrap_or(element.centre))
            });
            let height = place(halves[1][0])[2] - place(halves[0][0])[2];
            let layer = ((centre[2] - lowest) / height) as usize;
            layers = layers.max(layer + 1);
            faces.push((layer, halves));
        }
        let areas = vec![[0.0; 2]; faces.len()];
        Self { faces, areas, layers }
    }

    /// The areas that the sections are made of: of lower faces, and of upper ones at the top.
    fn used(&mut self) -> impl Iterator<Item = &mut f64> {
        let top = self.layers;
        let faces = self.faces.iter().zip(&mut self.areas);
        faces.flat_map(move |(&(layer, _), areas)| {
            areas.iter_mut().take(if layer + 1 == top { 2 } else { 1 })
        })
    }

    /// What has been seen of elements that may be dead by the next look.
    pub(in crate::cases) fn memory(&mut self) -> Vec<f64> {
        self.used().map(|area| *area).collect()
    }

    /// Takes back what [`Discs::memory`] gave.
    pub(in crate::cases) fn recall(&mut self, memory: &[f64]) {
        self.used().zip(memory).for_each(|(area, seen)| *area = *seen);
    }

    /// What is left of the rod.
    pub(in crate::cases) fn look(&mut self, simulation: &Simulation) -> Rod {
        let place = |i: u32| simulation.particle(i).position;
        let mut sums = vec![Sum::default(); self.layers + 1];
        let (mut low, mut high, mut reach) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        let all = simulation.all_elements().zip(&self.faces).zip(&mut self.areas);
        for ((element, &(layer, faces)), areas) in all {
            let corners = faces.map(|face| face.map(place));
            if element.live {
                *areas = [area(&corners[0]), area(&corners[1])];
                for x in corners.as_flattened() {
                    (low, high) = (low.min(x[2]), high.max(x[2]));
                    reach = reach.max(x[0].hypot(x[1]));
                }
            }
            sums[layer].add(element.live, areas[0], &corners[0]);
            if layer + 1 == self.layers {
                sums[layer + 1].add(element.live, areas[1], &corners[1]);
            }
        }
        let sections = sums.into_iter().map(|sum| sum.section(low)).collect();
        Rod { length: high - low, reach, sections }
    }
}

/// Sums over the faces of a section.
#[derive(Clone, Copy, Default)]
struct Sum {
    area: f64,
    left: f64,
    height: f64,
    count: f64,
}

impl Sum {
    fn add(&mut self, live: bool, area: f64, corners: &[[f64; 3]; 4]) {
        self.area += area;
        if live {
            self.left += area;
            self.height += corners.iter().map(|x| 0.25 * x[2]).sum::<f64>();
            self.count += 1.0;
        }
    }

    fn section(self, low: f64) -> Section {
        let radius = |area: f64| (area / PI).sqrt();
        Section {
            height: self.height / self.count - low,
            left: radius(self.left),
            radius: radius(self.area),
        }
    }
}

/// Area of a quadrilateral seen along z.
fn area(corners: &[[f64; 3]; 4]) -> f64 {
    let cross = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % 4]);
        a[0] * b[1] - a[1] * b[0]
    };
    0.5 * (0..4).map(cross).sum::<f64>().abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn areas_and_radii_are_those_of_the_figure() {
        let square = [[1.0, 1.0, 5.0], [3.0, 1.0, 5.0], [3.0, 4.0, 6.0], [1.0, 4.0, 6.0]];
        assert_relative_eq!(area(&square), 6.0);
        let at = |height, radius| Section { height, radius, left: radius };
        let sections = vec![at(0.0, 2.0), at(1.0, 1.0)];
        let rod = Rod { length: 1.0, reach: 2.0, sections };
        assert_relative_eq!(rod.radius_at(0.25), 1.75);
        assert!(rod.radius_at(2.0).is_nan());
    }
}
