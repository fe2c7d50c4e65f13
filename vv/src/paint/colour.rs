//! Colour maps, colours of bodies and themes.

/// Appearance of paper and ink.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// For print and light pages.
    #[default]
    Light,
    /// For dark pages and slides.
    Dark,
}

impl Theme {
    /// Background.
    pub(super) fn paper(self) -> [u8; 3] {
        match self {
            Self::Light => [0xFF, 0xFF, 0xFF],
            Self::Dark => [0x17, 0x1A, 0x1F],
        }
    }

    /// How far outlines of dark bodies are light instead of dark, 0 to 1: a dark body cannot be
    /// told from dark paper without a light rim.
    pub(super) fn rim(self) -> f32 {
        match self {
            Self::Light => 0.0,
            Self::Dark => 1.0,
        }
    }

    /// Text and lines.
    pub(super) fn ink(self) -> [u8; 3] {
        match self {
            Self::Light => [0x1A, 0x1C, 0x1F],
            Self::Dark => [0xE8, 0xEA, 0xED],
        }
    }
}

/// A perceptually uniform colour map whose lightness increases with the value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourMap {
    /// Blue, green, yellow (van der Walt, Smith and Firing, matplotlib 2015).
    #[default]
    Viridis,
    /// Blue, grey, yellow: nearly the same with and without a colour vision deficiency (Nuñez,
    /// Anderton and Renslow, PLOS ONE 2018).
    Cividis,
    /// Purple, red, yellow for temperatures: inferno (van der Walt and Smith, matplotlib 2015)
    /// without its darkest part, in which shapes could not be seen.
    Heat,
}

/// Equidistant values of the published maps.
const VIRIDIS: [u32; 16] = [
    0x440154, 0x481A6C, 0x472F7D, 0x414487, 0x39568C, 0x31688E, 0x2A788E, 0x23888E, 0x1F988B,
    0x22A884, 0x35B779, 0x54C568, 0x7AD151, 0xA5DB36, 0xD2E21B, 0xFDE725,
];
const CIVIDIS: [u32; 10] = [
    0x00204D, 0x00336F, 0x39486B, 0x575C6D, 0x707173, 0x8A8779, 0xA69D75, 0xC4B56C, 0xE4CF5B,
    0xFFEA46,
];
const HEAT: [u32; 13] = [
    0x420A68, 0x5D126E, 0x781C6D, 0x932667, 0xAE305C, 0xC73E4C, 0xDD513A, 0xED6925, 0xF8850F,
    0xFCA50A, 0xFAC62D, 0xF2E661, 0xFCFFA4,
];

impl ColourMap {
    fn points(self) -> &'static [u32] {
        match self {
            Self::Viridis => &VIRIDIS,
            Self::Cividis => &CIVIDIS,
            Self::Heat => &HEAT,
        }
    }

    /// Red, green and blue at a part of the range: 0 is its lower, 1 its upper end.
    pub fn at(self, part: f64) -> [u8; 3] {
        let points = self.points();
        let place = part.clamp(0.0, 1.0) * (points.len() - 1) as f64;
        // A part that is not a number takes the first colour.
        let first = (place.floor() as usize).min(points.len() - 2);
        let rest = (place - first as f64).max(0.0);
        let (a, b) = (bytes(points[first]), bytes(points[first + 1]));
        [0, 1, 2].map(|i| {
            let (a, b) = (f64::from(a[i]), f64::from(b[i]));
            (a + rest * (b - a)).round() as u8
        })
    }
}

/// Number of classes that can be told apart.
pub const MAX_CLASSES: usize = 8;

/// The colours of Okabe and Ito (2008) in an order that begins with the lighter ones, whose
/// shades show shape best; grey stands for their black.
const BODIES: [u32; MAX_CLASSES] =
    [0xE69F00, 0x56B4E9, 0x009E73, 0xD55E00, 0xCC79A7, 0x0072B2, 0xF0E442, 0x8A9099];

/// The colour of a class.
pub(super) fn body(class: usize) -> [u8; 3] {
    bytes(BODIES[class % MAX_CLASSES])
}

/// The colour of primitives without a value.
pub(super) const NO_VALUE: [u8; 3] = [0x9A, 0xA1, 0xAB];

/// Relative luminances of a colour that counts as dark, and of one that does not: about twice and
/// four times the contrast of the dark paper to itself.
const DARK: (f64, f64) = (0.07, 0.19);

/// How much dark lines would be lost on a colour, 0 to 1.
pub(super) fn darkness(colour: [u8; 3]) -> f32 {
    ((DARK.1 - luminance(colour)) / (DARK.1 - DARK.0)).clamp(0.0, 1.0) as f32
}

/// Relative luminance (Rec. 709) of an sRGB colour.
pub(super) fn luminance(colour: [u8; 3]) -> f64 {
    let linear = colour.map(|c| {
        let c = f64::from(c) / 255.0;
        if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    });
    0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
}

fn bytes(colour: u32) -> [u8; 3] {
    let [_, r, g, b] = colour.to_be_bytes();
    [r, g, b]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_grows_along_every_map() {
        for map in [ColourMap::Viridis, ColourMap::Cividis, ColourMap::Heat] {
            let values: Vec<f64> =
                (0..=64).map(|i| luminance(map.at(f64::from(i) / 64.0))).collect();
            assert!(values.windows(2).all(|w| w[1] > w[0]), "{map:?}: {values:?}");
        }
    }

    #[test]
    fn colours_of_bodies_differ_in_lightness_or_hue() {
        for i in 0..MAX_CLASSES {
            for j in 0..i {
                let far = body(i).iter().zip(body(j)).map(|(a, b)| a.abs_diff(b)).max();
                assert!(far > Some(60), "{i} {j}");
            }
        }
    }
}
