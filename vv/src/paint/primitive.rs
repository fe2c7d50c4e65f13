//! Triangles and particles in samples of the picture, and how they fill a row.

use super::camera::View;
use super::raster::{Drawable, Row, Sample};
use super::surface::Facet;
use super::vector::Vec3;

/// Direction to the lamp in picture axes: from the upper left, behind the eye.
const LAMP: [f32; 3] = [-0.42, -0.58, -0.70];

/// Looks that do not depend on the place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) tone: u16,
    pub(super) class: u8,
}

/// A triangle of an element's surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    /// Columns, rows and depths.
    p: [[f32; 3]; 3],
    lines: [bool; 3],
    /// Half the width of an edge line.
    half: f32,
    /// Strength of the edge lines.
    strength: f32,
    /// Nearest depth: the plane of the triangle may be seen edge-on.
    near: f32,
    light: u8,
    style: Style,
    cap: bool,
}

impl Triangle {
    /// Projects a triangle; `line` is the width of edge lines in samples.
    pub(super) fn new(facet: &Facet, view: &View, line: f32, style: Style) -> Self {
        let p = facet.corners.map(|c| view.project(c));
        let (u, v) = (minus(p[1], p[0]), minus(p[2], p[0]));
        let mut normal = direction([
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ]);
        if normal[2] > 0.0 {
            normal = normal.map(|x| -x);
        }
        // Lines of elements that are only a few samples wide would blacken the picture.
        let width = |i: usize| {
            let d = minus(p[(i + 1) % 3], p[i]);
            d[0].hypot(d[1])
        };
        let size = (0..3).map(width).fold(0.0, f32::max);
        let strength = ((size / line - 3.0) / 9.0).clamp(0.0, 1.0);
        Self {
            p,
            lines: facet.lines,
            half: 0.5 * line,
            strength,
            near: p.iter().fold(f32::INFINITY, |m, q| m.min(q[2])),
            light: brightness(normal),
            style,
            cap: facet.cap,
        }
    }
}

impl Drawable for Triangle {
    fn span(&self) -> (f32, f32) {
        let [a, b, c] = self.p.map(|p| p[1]);
        (a.min(b).min(c), a.max(b).max(c))
    }

    fn draw(&self, row: &mut Row, plane: Option<&[f64; 3]>) {
        let at = |i: usize| self.p[i].map(f64::from);
        let [a, b, c] = [at(0), at(1), at(2)];
        let y = row.y as f64 + 0.5;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area.abs() < 1e-9 {
            return;
        }
        let [x0, x1, x2] = self.p.map(|p| p[0]);
        let turn = area.signum();
        let sides = [(a, b), (b, c), (c, a)];
        let length = sides.map(|(p, q)| (q[0] - p[0]).hypot(q[1] - p[1]).max(1e-12));
        for column in row.columns(x0.min(x1).min(x2), x0.max(x1).max(x2)) {
            let x = column as f64 + 0.5;
            // Twice the signed areas opposite to each corner; positive inside.
            let w = sides
                .map(|(p, q)| turn * ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])));
            // Neighbours share their edge: samples on it belong to both, and none is left out.
            if w.iter().any(|w| *w < -1e-6) {
                continue;
            }
            let depth = match plane.filter(|_| self.cap) {
                Some(d) => (d[0] * x + d[1] * y + d[2]) as f32,
                None => {
                    let z = (w[1] * a[2] + w[2] * b[2] + w[0] * c[2]) / area.abs();
                    (z as f32).max(self.near)
                }
            };
            let sample = &mut row.samples[column];
            if depth < sample.depth {
                let lines = (0..3).filter(|i| self.lines[*i]);
                let gap = lines.map(|i| w[i] / length[i]).fold(f64::INFINITY, f64::min) as f32;
                let cover = (self.half + 0.5 - gap).clamp(0.0, 1.0) * self.strength;
                *sample = Sample {
                    depth,
                    tone: self.style.tone,
                    light: self.light,
                    line: (255.0 * cover) as u8,
                    size: 255,
                    class: self.style.class,
                    cap: self.cap,
                };
            }
        }
    }
}

/// An ellipsoid: points whose offset `d` from the centre has `d·m·d ≤ 1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Particle {
    centre: [f32; 3],
    /// The entries xx, yy, zz, xy, xz, yz of `m`.
    m: [f32; 6],
    /// Half of its width and height.
    half: (f32, f32),
    style: Style,
}

impl Particle {
    /// Projects a particle; none is drawn smaller than a radius of `least` samples.
    pub(super) fn new(
        centre: Vec3,
        axes: &[Vec3; 3],
        view: &View,
        least: f32,
        style: Style,
    ) -> Self {
        let mut m = [0.0; 6];
        let mut half = (0.0_f32, 0.0_f32);
        for axis in axes.map(|a| view.vector(a)) {
            let length = axis.iter().map(|x| x * x).sum::<f32>().sqrt().max(1e-30);
            let kept = length.max(least);
            let [x, y, z] = axis.map(|a| a / length);
            for (entry, product) in m.iter_mut().zip([x * x, y * y, z * z, x * y, x * z, y * z]) {
                *entry += product / (kept * kept);
            }
            half = (half.0.hypot(x * kept), half.1.hypot(y * kept));
        }
        Self { centre: view.project(centre), m, half, style }
    }
}

impl Drawable for Particle {
    fn span(&self) -> (f32, f32) {
        (self.centre[1] - self.half.1, self.centre[1] + self.half.1)
    }

    fn draw(&self, row: &mut Row, plane: Option<&[f64; 3]>) {
        let [cx, cy, cz] = self.centre;
        let [xx, yy, zz, xy, xz, yz] = self.m;
        let v = row.y as f32 + 0.5 - cy;
        let size = self.half.0.min(self.half.1).min(255.0) as u8;
        for column in row.columns(cx - self.half.0, cx + self.half.0) {
            let u = column as f32 + 0.5 - cx;
            let b = xz * u + yz * v;
            let c = xx * u * u + 2.0 * xy * u * v + yy * v * v - 1.0;
            let root = b * b - zz * c;
            if root < 0.0 {
                continue;
            }
            let (near, far) = ((-b - root.sqrt()) / zz, (-b + root.sqrt()) / zz);
            let front = plane.map_or(f32::NEG_INFINITY, |d| {
                (d[0] * (column as f64 + 0.5) + d[1] * (row.y as f64 + 0.5) + d[2]) as f32
            });
            if cz + far <= front {
                continue;
            }
            let cap = cz + near < front;
            let depth = if cap { front } else { cz + near };
            let sample = &mut row.samples[column];
            if depth < sample.depth {
                let normal = direction([
                    xx * u + xy * v + xz * near,
                    xy * u + yy * v + yz * near,
                    xz * u + yz * v + zz * near,
                ]);
                *sample = Sample {
                    depth,
                    tone: self.style.tone,
                    light: brightness(normal),
                    line: 0,
                    size,
                    class: self.style.class,
                    cap,
                };
            }
        }
    }
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn direction(v: [f32; 3]) -> [f32; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt().max(1e-30);
    v.map(|x| x / length)
}

/// Light on a surface with a normal towards the eye: soft, so that no side is black.
fn brightness(normal: [f32; 3]) -> u8 {
    let cosine = normal[0] * LAMP[0] + normal[1] * LAMP[1] + normal[2] * LAMP[2];
    (255.0 * ((cosine + 0.35) / 1.35).clamp(0.0, 1.0)) as u8
}
