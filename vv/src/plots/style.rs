//! Colours, dashes, markers and sizes, and the translation of colours to CSS variables.

use super::model::{Dash, MAX_SERIES, Marker};

/// An opaque colour of the light theme, the only one that is ever drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ink(pub(super) u32);

impl Ink {
    /// Red, green and blue.
    pub(super) fn rgb(self) -> (u8, u8, u8) {
        let [_, r, g, b] = self.0.to_be_bytes();
        (r, g, b)
    }
}

/// Background.
pub(super) const PAPER: Ink = Ink(0xFF_FF_FF);
/// Text and exact solutions.
pub(super) const INK: Ink = Ink(0x1A_1C_1F);
/// Frames, ticks and tick labels.
pub(super) const AXIS: Ink = Ink(0x45_4A_51);
/// Reference lines and remarks.
pub(super) const MUTED: Ink = Ink(0x6A_71_7B);
/// Grid.
pub(super) const GRID: Ink = Ink(0xE4_E7_EB);
/// Neutral bands and strips.
pub(super) const SHADE: Ink = Ink(0x9A_A1_AB);

/// Okabe and Ito's colours; their yellow and purple are darkened and their black (kept for exact
/// solutions) replaced by a grey, so that every one of them reads on white.
const SERIES: [Ink; MAX_SERIES] = [
    Ink(0x00_72_B2),
    Ink(0xD5_5E_00),
    Ink(0x00_9E_73),
    Ink(0xB0_48_82),
    Ink(0xE6_9F_00),
    Ink(0x56_B4_E9),
    Ink(0x8F_7A_00),
    Ink(0x5B_5F_66),
];

const DASHES: [&[f64]; 4] = [&[], &[8.0, 4.0], &[8.0, 3.0, 1.6, 3.0], &[2.6, 2.4]];

const MARKERS: [Marker; MAX_SERIES] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::Ring,
    Marker::Down,
    Marker::Cross,
    Marker::Plus,
];

/// CSS variable, light value (as drawn) and value for dark pages of every colour of a figure.
pub const THEME: [(&str, u32, u32); 14] = [
    ("--fig-paper", PAPER.0, 0x17_1A_1F),
    ("--fig-ink", INK.0, 0xE8_EA_ED),
    ("--fig-axis", AXIS.0, 0xB4_BA_C2),
    ("--fig-muted", MUTED.0, 0x98_A0_AB),
    ("--fig-grid", GRID.0, 0x2B_30_38),
    ("--fig-shade", SHADE.0, 0x6D_75_80),
    ("--fig-s1", SERIES[0].0, 0x4C_A6_EE),
    ("--fig-s2", SERIES[1].0, 0xFF_8A_45),
    ("--fig-s3", SERIES[2].0, 0x2F_CB_9C),
    ("--fig-s4", SERIES[3].0, 0xEB_9F_CB),
    ("--fig-s5", SERIES[4].0, 0xF7_BC_45),
    ("--fig-s6", SERIES[5].0, 0x9C_D9_FF),
    ("--fig-s7", SERIES[6].0, 0xE8_DC_50),
    ("--fig-s8", SERIES[7].0, 0xB9_BE_C6),
];

/// A copy of a rendered figure for an HTML page: colours become CSS variables (see [`THEME`])
/// whose fall-back is the light value.
pub fn themed(svg: &str) -> String {
    THEME.iter().fold(svg.to_owned(), |svg, (name, light, _)| {
        svg.replace(&format!("\"#{light:06X}\""), &format!("\"var({name},#{light:06x})\""))
    })
}

/// Colour of the series in a slot.
pub(super) fn colour(slot: usize) -> Ink {
    SERIES[slot % MAX_SERIES]
}

/// Lengths of strokes and gaps; empty for an unbroken line.
pub(super) fn pattern(dash: Dash, slot: usize) -> &'static [f64] {
    match dash {
        Dash::Auto => DASHES[slot % DASHES.len()],
        Dash::Solid => DASHES[0],
        Dash::Dashed => DASHES[1],
        Dash::DashDot => DASHES[2],
        Dash::Dotted => DASHES[3],
    }
}

/// The marker to draw in a slot.
pub(super) fn marker(marker: Marker, slot: usize) -> Marker {
    match marker {
        Marker::Auto => MARKERS[slot % MAX_SERIES],
        chosen => chosen,
    }
}

/// Half the size of the markers of a series of `count` points: 3.6 for a few, 1.3 for a thousand.
pub(super) fn radius(count: usize) -> f64 {
    let crowd = (count.max(30) as f64 / 30.0).log10();
    (3.6 - 1.55 * crowd).max(1.3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_becomes_a_variable_and_labels_stay() {
        let svg = r##"<path fill="#0072B2"/><text fill="#1A1C1F">#0072B2</text>"##;
        let html = r#"<path fill="var(--fig-s1,#0072b2)"/><text fill="var(--fig-ink,#1a1c1f)">"#;
        assert_eq!(themed(svg), format!("{html}#0072B2</text>"));
    }

    #[test]
    fn markers_shrink_with_their_number() {
        assert!(radius(10) > 3.5 && radius(200) < 2.4 && radius(1000) >= 1.3);
    }
}
