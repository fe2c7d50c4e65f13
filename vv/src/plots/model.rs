//! The neutral data model of a figure: what to draw, never how.

use serde::Serialize;

/// A point in data coordinates.
pub type Point = (f64, f64);

/// Number of distinguishable series in one figure.
pub const MAX_SERIES: usize = 8;

/// One to four panels that share a file and a caption.
///
/// A series keeps its colour, dash and marker in all panels: they follow from the order in which
/// series names first appear in the figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// File stem: letters, digits, `-` and `_`.
    pub id: String,
    /// Plain-text caption, also the alternative text of the picture.
    pub caption: String,
    /// One panel, a row of two or three, or a square of four.
    pub panels: Vec<Panel>,
}

impl Figure {
    /// A figure of the given panels.
    pub fn new(id: impl Into<String>, caption: impl Into<String>, panels: Vec<Panel>) -> Self {
        Self { id: id.into(), caption: caption.into(), panels }
    }
}

/// One coordinate system with its layers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Panel {
    /// Heading above the frame; may be empty.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Whether a unit is as long across as upwards: for shapes, on linear axes.
    pub equal: bool,
    /// What is drawn, in legend order.
    pub layers: Vec<Layer>,
}

impl Panel {
    /// An empty panel.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, y, equal: false, layers: Vec::new() }
    }

    /// The panel with equal scales; one of its ranges is widened for it.
    #[must_use]
    pub fn equal(mut self) -> Self {
        self.equal = true;
        self
    }

    /// The panel with one more layer.
    #[must_use]
    pub fn with(mut self, layer: impl Into<Layer>) -> Self {
        self.layers.push(layer.into());
        self
    }
}

/// Label, scale and optional range of an axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// Quantity and unit, such as `density ρ / (kg/m³)`.
    pub label: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// Fixed limits; chosen from the data when absent.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis with automatic range.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None }
    }

    /// A decadic logarithmic axis with automatic range.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log10, range: None }
    }

    /// The axis with fixed limits.
    #[must_use]
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }
}

/// How an axis maps values to lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Scale {
    /// Proportional.
    Linear,
    /// Decadic logarithm; values that are not positive are not drawn.
    Log10,
}

/// One element of a panel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Layer {
    /// A measured or computed series.
    Series(Series),
    /// An exact or reference solution: a dashed line in ink, above the series.
    Exact {
        /// Legend entry.
        name: String,
        /// Vertices, in drawing order.
        points: Vec<Point>,
    },
    /// A straight reference line across the panel, with its label beside it.
    Rule {
        /// Direction of the line.
        along: Along,
        /// The constant coordinate.
        at: f64,
        /// Text beside the line; may be empty.
        label: String,
    },
    /// A shaded strip across the panel, such as a tolerance.
    Span {
        /// Direction of the strip.
        along: Along,
        /// Its limits in the other coordinate.
        limits: (f64, f64),
        /// Legend entry; may be empty.
        name: String,
    },
    /// A shaded band about a curve, in the colour of the series of the same name if there is one.
    Band {
        /// Legend entry, unless a series of that name stands there already.
        name: String,
        /// Abscissa, lower and upper edge.
        edges: Vec<(f64, f64, f64)>,
    },
    /// The slope of a given order of convergence; needs two logarithmic axes.
    Slope {
        /// Exponent: the guide follows `y ∝ x^order`.
        order: f64,
        /// Triangle below the data, or a line across it.
        shape: SlopeShape,
        /// A point the guide passes through (its left end for a triangle); automatic when absent.
        anchor: Option<Point>,
    },
    /// A short remark right of a point.
    Note {
        /// The point.
        at: Point,
        /// The remark.
        text: String,
    },
}

impl Layer {
    /// An exact solution.
    pub fn exact(name: impl Into<String>, points: Vec<Point>) -> Self {
        Self::Exact { name: name.into(), points }
    }

    /// A horizontal reference line.
    pub fn horizontal(at: f64, label: impl Into<String>) -> Self {
        Self::Rule { along: Along::Horizontal, at, label: label.into() }
    }

    /// A vertical reference line.
    pub fn vertical(at: f64, label: impl Into<String>) -> Self {
        Self::Rule { along: Along::Vertical, at, label: label.into() }
    }

    /// A slope triangle, placed below the data.
    pub fn slope(order: f64) -> Self {
        Self::Slope { order, shape: SlopeShape::Triangle, anchor: None }
    }
}

impl From<Series> for Layer {
    fn from(series: Series) -> Self {
        Self::Series(series)
    }
}

/// Direction of a straight layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Along {
    /// Constant ordinate.
    Horizontal,
    /// Constant abscissa.
    Vertical,
}

/// How an order of convergence is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SlopeShape {
    /// A small right triangle with its sides labelled.
    Triangle,
    /// A thin line across the data range.
    Line,
}

/// A named series of points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Series {
    /// Legend entry; the same name has the same looks in every panel of a figure.
    pub name: String,
    /// Points, in drawing order.
    pub points: Vec<Point>,
    /// Lengths of the vertical error bars below and above each point, or empty.
    pub errors: Vec<(f64, f64)>,
    /// The line through the points, if any.
    pub line: Option<Dash>,
    /// The marker at the points, if any.
    pub marker: Option<Marker>,
    /// Place in the palette, if it is not that of its name: for series that belong together.
    pub hue: Option<usize>,
}

impl Series {
    /// Points joined by a line; dashes tell the series apart.
    pub fn line(name: impl Into<String>, points: Vec<Point>) -> Self {
        Self::new(name.into(), points, Some(Dash::Auto), None)
    }

    /// Markers only; they shrink when there are many.
    pub fn scatter(name: impl Into<String>, points: Vec<Point>) -> Self {
        Self::new(name.into(), points, None, Some(Marker::Auto))
    }

    /// Markers joined by a solid line.
    pub fn marked(name: impl Into<String>, points: Vec<Point>) -> Self {
        Self::new(name.into(), points, Some(Dash::Solid), Some(Marker::Auto))
    }

    /// The series with vertical error bars of the given lengths below and above each point.
    #[must_use]
    pub fn errors(mut self, errors: Vec<(f64, f64)>) -> Self {
        self.errors = errors;
        self
    }

    /// The series with a dash and a place in the palette of their own.
    #[must_use]
    pub fn styled(mut self, dash: Dash, hue: usize) -> Self {
        (self.line, self.hue) = (Some(dash), Some(hue));
        self
    }

    fn new(name: String, points: Vec<Point>, line: Option<Dash>, marker: Option<Marker>) -> Self {
        Self { name, points, errors: Vec::new(), line, marker, hue: None }
    }
}

/// Dash pattern of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Dash {
    /// Chosen by the place of the series in the figure.
    Auto,
    /// Unbroken.
    Solid,
    /// Dashes.
    Dashed,
    /// Dashes and dots.
    DashDot,
    /// Dots.
    Dotted,
}

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Marker {
    /// Chosen by the place of the series in the figure.
    Auto,
    /// Filled circle.
    Circle,
    /// Filled square.
    Square,
    /// Filled triangle.
    Triangle,
    /// Filled diamond.
    Diamond,
    /// Open circle.
    Ring,
    /// Open triangle pointing down.
    Down,
    /// Diagonal cross.
    Cross,
    /// Upright cross.
    Plus,
}
