//! What a picture shows and how.

use super::colour::{ColourMap, MAX_CLASSES, NO_VALUE, Theme, body};
use super::model::{Mark, Model};
use super::{Camera, PaintError, Plane};

/// Entries of a colour map.
const SHADES: u16 = 256;

/// A field that decides colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name, for the colour bar.
    pub name: String,
    /// Its unit, for the colour bar; may be empty.
    pub unit: String,
    /// The values at both ends of the colour bar; without them, those of the model.
    pub range: Option<(f64, f64)>,
    /// Its colours.
    pub map: ColourMap,
}

/// What decides the colours.
#[derive(Clone, Debug, PartialEq)]
pub enum Colouring {
    /// The class; the names go to the legend. At most [`MAX_CLASSES`].
    Classes(Vec<String>),
    /// The value.
    Field(Field),
}

/// The unit of the scale bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Length {
    /// Its name; empty for a picture without scale bar.
    pub unit: String,
    /// How many of it the length unit of the model is.
    pub factor: f64,
}

/// A picture to paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels; without it, the height that the contents need.
    pub height: Option<u32>,
    /// Paper and ink.
    pub theme: Theme,
    /// From where to look.
    pub camera: Camera,
    /// Where to cut.
    pub section: Option<Plane>,
    /// How to colour.
    pub colouring: Colouring,
    /// Whether to draw the edges of elements.
    pub edges: bool,
    /// Tail and head of an arrow over the scene, in the length unit of the model, such as the way that something
    /// flies; it is shown whole unless the camera has a frame.
    pub arrow: Option<[[f64; 3]; 2]>,
    /// Heading; may be empty.
    pub title: String,
    /// Time of the state, such as `t = 40 µs`; may be empty.
    pub time: String,
    /// Unit of the scale bar.
    pub length: Length,
    /// Largest size of the file in bytes.
    pub max_bytes: usize,
}

impl Picture {
    /// A picture 1400 pixels wide of at most 300 kB in the light theme, with element edges and
    /// without texts.
    pub fn new(camera: Camera, colouring: Colouring) -> Self {
        Self {
            width: 1400,
            height: None,
            theme: Theme::Light,
            camera,
            section: None,
            colouring,
            edges: true,
            arrow: None,
            title: String::new(),
            time: String::new(),
            length: Length { unit: String::new(), factor: 1.0 },
            max_bytes: 300_000,
        }
    }

    /// The colours of a model in this picture.
    pub(super) fn tones(&self, model: &Model) -> Result<Tones, PaintError> {
        match &self.colouring {
            Colouring::Classes(names) => {
                let most = names.len().min(MAX_CLASSES);
                let unnamed = model.marks().find(|m| usize::from(m.class) >= most);
                match unnamed {
                    Some(mark) => Err(PaintError::Class(mark.class)),
                    None => Ok(Tones { colours: (0..most).map(body).collect(), range: None }),
                }
            }
            Colouring::Field(field) => {
                let range = field.range.unwrap_or_else(|| extremes(model));
                let (low, high) = range;
                if !(low < high && (high - low).is_finite()) {
                    return Err(PaintError::Range(field.name.clone()));
                }
                let part = |i: u16| f64::from(i) / f64::from(SHADES - 1);
                let mut colours: Vec<[u8; 3]> =
                    (0..SHADES).map(|i| field.map.at(part(i))).collect();
                colours.push(NO_VALUE);
                Ok(Tones { colours, range: Some(range) })
            }
        }
    }
}

/// The least and largest value of a model, apart from each other.
fn extremes(model: &Model) -> (f64, f64) {
    let finite = model.marks().map(|m| f64::from(m.value)).filter(|v| v.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return (0.0, 1.0);
    }
    let margin = if high - low > 1e-6 * low.abs().max(high.abs()) {
        0.0
    } else {
        0.05 * low.abs().max(1e-30)
    };
    (low - margin, high + margin)
}

/// The colours of a picture, and the range of the field that chooses among them.
pub(super) struct Tones {
    pub(super) colours: Vec<[u8; 3]>,
    pub(super) range: Option<(f64, f64)>,
}

impl Tones {
    /// The index of the colour of a mark.
    pub(super) fn of(&self, mark: Mark) -> u16 {
        let last = (self.colours.len() - 1) as u16;
        let Some((low, high)) = self.range else {
            return u16::from(mark.class).min(last);
        };
        let part = (f64::from(mark.value) - low) / (high - low);
        // The last colour is that of no value.
        if part.is_nan() {
            last
        } else {
            (part.clamp(0.0, 1.0) * f64::from(last - 1)).round() as u16
        }
    }
}
