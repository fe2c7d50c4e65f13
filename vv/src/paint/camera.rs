//! The orthographic camera: from the model to the picture plane.

use super::PaintError;
use super::model::sound;
use super::vector::{Vec3, cross, dot, scaled, sub, unit};

/// A parallel projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The direction of view, from the eye into the scene.
    pub direction: [f64; 3],
    /// A direction that points upwards in the picture.
    pub up: [f64; 3],
    /// Two opposite corners of the box to show; without it, all that is drawn is shown.
    pub frame: Option<[[f64; 3]; 2]>,
}

impl Camera {
    /// A camera that shows everything.
    pub fn new(direction: [f64; 3], up: [f64; 3]) -> Self {
        Self { direction, up, frame: None }
    }

    /// The axes of the picture.
    pub(super) fn axes(&self) -> Result<Axes, PaintError> {
        let forward = unit(self.direction).ok_or(PaintError::Camera)?;
        let up = unit(self.up).ok_or(PaintError::Camera)?;
        let across = cross(forward, up);
        // Nearly parallel directions leave the turn of the picture to rounding.
        let right = unit(across).filter(|_| dot(across, across) > 1e-12);
        let right = right.ok_or(PaintError::Camera)?;
        Ok(Axes { right, down: scaled(cross(right, forward), -1.0), forward })
    }

    /// The box to show, as its eight corners.
    pub(super) fn corners(&self) -> Result<Option<[Vec3; 8]>, PaintError> {
        let Some([a, b]) = self.frame else {
            return Ok(None);
        };
        if !sound(&a) || !sound(&b) {
            return Err(PaintError::Camera);
        }
        let pick = |i: usize, axis: usize| if i >> axis & 1 == 0 { a[axis] } else { b[axis] };
        Ok(Some(std::array::from_fn(|i| [pick(i, 0), pick(i, 1), pick(i, 2)])))
    }
}

/// Orthogonal unit vectors: right and down in the picture, and away from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axes {
    pub(super) right: Vec3,
    pub(super) down: Vec3,
    pub(super) forward: Vec3,
}

impl Axes {
    /// A direction in picture axes.
    pub(super) fn turn(&self, v: Vec3) -> Vec3 {
        [dot(v, self.right), dot(v, self.down), dot(v, self.forward)]
    }
}

/// The extent of what is shown, in picture axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    pub(super) low: Vec3,
    pub(super) high: Vec3,
}

impl Extent {
    /// The smallest extent that holds nothing.
    pub(super) const NONE: Self = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };

    /// Grows to hold a box around a point in picture axes.
    pub(super) fn add(&mut self, p: Vec3, half: Vec3) {
        for (i, (p, half)) in p.into_iter().zip(half).enumerate() {
            self.low[i] = self.low[i].min(p - half);
            self.high[i] = self.high[i].max(p + half);
        }
    }

    /// Width and height.
    pub(super) fn size(&self) -> (f64, f64) {
        (self.high[0] - self.low[0], self.high[1] - self.low[1])
    }
}

/// The mapping from the model to samples of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    pub(super) axes: Axes,
    /// Samples per length of the model.
    pub(super) scale: f64,
    centre: Vec3,
    middle: (f64, f64),
}

impl View {
    /// Fits an extent into a picture of so many samples with a margin on all sides; none if the
    /// extent is empty.
    pub(super) fn fit(axes: Axes, extent: &Extent, size: (u32, u32), margin: f64) -> Option<Self> {
        let (width, height) = extent.size();
        let (w, h) = (f64::from(size.0), f64::from(size.1));
        let scale = ((w - 2.0 * margin) / width).min((h - 2.0 * margin) / height);
        let centre = [0, 1, 2].map(|i| 0.5 * (extent.low[i] + extent.high[i]));
        let usable = scale.is_finite() && scale > 0.0 && centre.iter().all(|x| x.is_finite());
        usable.then_some(Self { axes, scale, centre, middle: (0.5 * w, 0.5 * h) })
    }

    /// Column, row and depth in samples of a point of the model; larger depths are farther away.
    pub(super) fn project(&self, p: Vec3) -> [f32; 3] {
        let [x, y, z] = scaled(sub(self.axes.turn(p), self.centre), self.scale);
        [(x + self.middle.0) as f32, (y + self.middle.1) as f32, z as f32]
    }

    /// A vector of the model in samples.
    pub(super) fn vector(&self, v: Vec3) -> [f32; 3] {
        scaled(self.axes.turn(v), self.scale).map(|x| x as f32)
    }
}
