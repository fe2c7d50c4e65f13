//! The triangles that can be seen of the elements: outer faces, and the cut of a section.

use super::model::{Mark, Model};
use super::section::{Cut, FACES, Polygon, cap, clip};
use super::vector::Vec3;
use rayon::prelude::*;

/// Heights below this part of the largest one of the element count as on the plane.
const ON_PLANE: f64 = 1e-6;

/// A triangle of the surface in model coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    pub(super) corners: [Vec3; 3],
    /// Whether the edge from each corner to the next is one of the element.
    pub(super) lines: [bool; 3],
    pub(super) mark: Mark,
    /// Lies in the section plane.
    pub(super) cap: bool,
}

/// What can be seen of one element after the cut.
struct Solid {
    element: u32,
    corners: [Vec3; 8],
    heights: [f64; 8],
}

/// The triangles of a model that are not hidden inside it.
pub(super) fn facets(model: &Model, cut: Option<&Cut>) -> Vec<Facet> {
    let solids: Vec<Solid> = (0..model.hexahedra.len() as u32)
        .into_par_iter()
        .filter_map(|element| Solid::new(model, element, cut))
        .collect();
    let mut faces: Vec<([u32; 4], u32, u8)> = solids
        .par_iter()
        .enumerate()
        .flat_map_iter(|(at, solid)| {
            let nodes = &model.hexahedra[solid.element as usize].nodes;
            (0..6_u8).map(move |face| {
                let mut key = FACES[usize::from(face)].map(|corner| nodes[corner]);
                key.sort_unstable();
                (key, at as u32, face)
            })
        })
        .collect();
    faces.par_sort_unstable();
    let mut outer: Vec<(u32, u8)> = faces
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|c| c.len() == 1)
        .map(|c| (c[0].1, c[0].2))
        .collect();
    outer.par_sort_unstable();
    let mut facets: Vec<Facet> = Vec::with_capacity(2 * outer.len());
    for (at, face) in outer {
        let solid = &solids[at as usize];
        let mark = model.hexahedra[solid.element as usize].mark;
        solid.face(usize::from(face), mark, &mut facets);
    }
    for solid in solids.iter().filter(|s| s.is_cut()) {
        let mark = model.hexahedra[solid.element as usize].mark;
        for polygon in cap(&solid.corners, &solid.heights) {
            fan(&polygon, mark, true, &mut facets);
        }
    }
    facets
}

impl Solid {
    /// An element, unless nothing is left of it.
    fn new(model: &Model, element: u32, cut: Option<&Cut>) -> Option<Self> {
        let nodes = &model.hexahedra[element as usize].nodes;
        let corners = nodes.map(|n| model.points[n as usize]);
        let mut heights = corners.map(|p| cut.map_or(-1.0, |c| c.height(p)));
        let largest = heights.iter().fold(0.0_f64, |m, h| m.max(h.abs()));
        for h in &mut heights {
            if h.abs() <= ON_PLANE * largest {
                *h = 0.0;
            }
        }
        let kept = heights.iter().any(|h| *h < 0.0);
        kept.then_some(Self { element, corners, heights })
    }

    fn is_cut(&self) -> bool {
        self.heights.iter().any(|h| *h > 0.0)
    }

    /// Adds what is left of a face.
    fn face(&self, face: usize, mark: Mark, facets: &mut Vec<Facet>) {
        let quad = FACES[face];
        // A face in the plane of section shows the inside of the body.
        let cap = quad.iter().all(|c| self.heights[*c] == 0.0);
        for corners in [[0, 1, 2], [2, 3, 0]] {
            let triangle = corners.map(|i| quad[i]);
            // The third edge is the diagonal of the face.
            let corner = |i: usize| (self.corners[triangle[i]], self.heights[triangle[i]], i < 2);
            let polygon = [corner(0), corner(1), corner(2)];
            fan(&clip(&polygon), mark, cap, facets);
        }
    }
}

/// Splits a convex polygon into triangles.
fn fan(polygon: &Polygon, mark: Mark, cap: bool, facets: &mut Vec<Facet>) {
    let last = polygon.len().saturating_sub(1);
    for i in 1..last {
        facets.push(Facet {
            corners: [polygon[0].0, polygon[i].0, polygon[i + 1].0],
            lines: [i == 1 && polygon[0].1, polygon[i].1, i + 1 == last && polygon[last].1],
            mark,
            cap,
        });
    }
}
