//! Title, time, scale bar, colour bar and legend as SVG.

use super::PaintError;
use super::camera::View;
use super::layout::{Layout, TEXT};
use super::picture::{Colouring, Field, Length, Picture};
use super::resolve::SAMPLES;
use super::text::{self, Face};
use super::ticks::{number, round_down, ticks};
use std::fmt::Write as _;

/// Length of the head of an arrow.
const HEAD: f64 = 34.0;

/// Stops of the gradient in a colour bar.
const STOPS: u32 = 60;

/// All that stands around the scene, and the arrow over it.
pub(super) fn annotation(
    picture: &Picture,
    layout: &Layout,
    view: &View,
    (range, beyond): ((f64, f64), (bool, bool)),
) -> Result<String, PaintError> {
    let ink = hex(picture.theme.ink());
    let mut svg = format!("<g fill=\"{ink}\">\n");
    heading(&mut svg, picture, layout)?;
    // In pixels per length of the model.
    scale_bar(&mut svg, &picture.length, layout, view.scale / SAMPLES as f64);
    match &picture.colouring {
        Colouring::Field(field) => colour_bar(&mut svg, field, layout, (range, beyond), &ink),
        Colouring::Classes(_) => legend(&mut svg, layout),
    }
    svg.push_str("</g>\n");
    if let Some(ends) = picture.arrow {
        arrow(&mut svg, ends.map(|end| pixel(end, layout, view)), picture, layout.unit);
    }
    Ok(svg)
}

/// Where a point of the model is in the picture.
fn pixel(point: [f64; 3], layout: &Layout, view: &View) -> (f64, f64) {
    let [x, y, _] = view.project(point).map(|samples| f64::from(samples) / SAMPLES as f64);
    (x, y + f64::from(layout.scene.0))
}

/// An arrow from its tail to its head, with a rim of paper against what lies below.
fn arrow(svg: &mut String, [tail, head]: [(f64, f64); 2], picture: &Picture, u: f64) {
    let way = (head.0 - tail.0, head.1 - tail.1);
    let length = way.0.hypot(way.1);
    // One that points at the eye has no direction in the picture.
    if length < 2.0 * HEAD * u {
        return;
    }
    let (along, across) = ((way.0 / length, way.1 / length), (-way.1 / length, way.0 / length));
    let at = |back: f64, aside: f64| {
        let x = head.0 - back * along.0 + aside * across.0;
        let y = head.1 - back * along.1 + aside * across.1;
        format!("{x:.1} {y:.1}")
    };
    let (back, half, shaft) = (HEAD * u, 0.4 * HEAD * u, 0.11 * HEAD * u);
    let corners = [
        at(0.0, 0.0),
        at(back, half),
        at(back, shaft),
        at(length, shaft),
        at(length, -shaft),
        at(back, -shaft),
        at(back, -half),
    ];
    let _ = writeln!(
        svg,
        "<path fill=\"{}\" stroke=\"{}\" stroke-width=\"{:.2}\" stroke-linejoin=\"round\" \
         paint-order=\"stroke\" d=\"M{}z\"/>",
        hex(picture.theme.ink()),
        hex(picture.theme.paper()),
        4.0 * u,
        corners.join("L")
    );
}

/// Title on the left and time on the right; a long title is set smaller.
fn heading(svg: &mut String, picture: &Picture, layout: &Layout) -> Result<(), PaintError> {
    let u = layout.unit;
    let (left, right) = layout.margins();
    let y = 46.0 * u;
    let time = text::width(&picture.time, TEXT * u, false)?;
    let face = Face { size: TEXT * u, bold: false, anchor: "end" };
    svg.push_str(&text::element(&picture.time, (right, y), &face));
    let size = 1.12 * TEXT * u;
    let room = (right - left - time - 30.0 * u).max(1.0);
    let shrink = (room / text::width(&picture.title, size, true)?.max(1.0)).min(1.0);
    let face = Face { size: size * shrink, bold: true, anchor: "start" };
    svg.push_str(&text::element(&picture.title, (left, y), &face));
    Ok(())
}

fn scale_bar(svg: &mut String, length: &Length, layout: &Layout, scale: f64) {
    let most = 0.2 * f64::from(layout.size.0) * length.factor / scale;
    if length.unit.is_empty() || !(most > 0.0 && most.is_finite()) {
        return;
    }
    let u = layout.unit;
    let round = round_down(most);
    let (left, _) = layout.margins();
    let right = left + round / length.factor * scale;
    let middle = layout.foot + 0.5 * layout.strip + 16.0 * u;
    let (thick, high) = (4.0 * u, 18.0 * u);
    for (x, y, w, h) in [
        (left, middle - 0.5 * thick, right - left, thick),
        (left, middle - 0.5 * high, thick, high),
        (right - thick, middle - 0.5 * high, thick, high),
    ] {
        rectangle(svg, (x, y), (w, h));
    }
    let label = format!("{} {}", number(round, round), length.unit);
    let face = Face { size: TEXT * u, bold: false, anchor: "middle" };
    // A short bar has its label beside the margin, not beyond it.
    let half = 0.32 * TEXT * u * label.chars().count() as f64;
    let x = (0.5 * (left + right)).max(left + half);
    svg.push_str(&text::element(&label, (x, middle - 20.0 * u), &face));
}

/// The colour bar with round ticks; pointed ends stand for values beyond the range.
fn colour_bar(
    svg: &mut String,
    field: &Field,
    layout: &Layout,
    ((low, high), beyond): ((f64, f64), (bool, bool)),
    ink: &str,
) {
    let u = layout.unit;
    let end = layout.margins().1 - 44.0 * u;
    let start = end - 0.5 * f64::from(layout.size.0);
    let (top, tall) = (layout.foot + 44.0 * u, 22.0 * u);
    svg.push_str("<linearGradient id=\"map\">");
    for i in 0..=STOPS {
        let part = f64::from(i) / f64::from(STOPS);
        let _ =
            write!(svg, "<stop offset=\"{part:.4}\" stop-color=\"{}\"/>", hex(field.map.at(part)));
    }
    svg.push_str("</linearGradient>\n");
    let _ = writeln!(
        svg,
        "<rect x=\"{start:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{tall:.1}\" \
         fill=\"url(#map)\" stroke=\"{ink}\" stroke-width=\"{:.2}\"/>",
        end - start,
        1.3 * u
    );
    let point = 24.0 * u;
    for (x, tip, part, shown) in [(start, -point, 0.0, beyond.0), (end, point, 1.0, beyond.1)] {
        if shown {
            let _ = writeln!(
                svg,
                "<path fill=\"{}\" stroke=\"{ink}\" stroke-width=\"{:.2}\" \
                 d=\"M{x:.1} {top:.1}v{tall:.1}l{tip:.1} {:.1}z\"/>",
                hex(field.map.at(part)),
                1.3 * u,
                -0.5 * tall
            );
        }
    }
    let face = Face { size: TEXT * u, bold: false, anchor: "middle" };
    for (value, label) in ticks((low, high), 6) {
        let x = start + (value - low) / (high - low) * (end - start);
        rectangle(svg, (x - u, top + tall), (2.0 * u, 8.0 * u));
        svg.push_str(&text::element(&label, (x, top + tall + 32.0 * u), &face));
    }
    let name = match field.unit.as_str() {
        "" => field.name.clone(),
        unit => format!("{} ({unit})", field.name),
    };
    svg.push_str(&text::element(&name, (0.5 * (start + end), top - 14.0 * u), &face));
}

fn legend(svg: &mut String, layout: &Layout) {
    let u = layout.unit;
    let side = 26.0 * u;
    for entry in &layout.legend {
        let (x, y) = entry.place;
        let _ = writeln!(
            svg,
            "<rect x=\"{x:.1}\" y=\"{:.1}\" width=\"{side:.1}\" height=\"{side:.1}\" rx=\"{:.1}\" \
             fill=\"{}\"/>",
            y - 0.5 * side,
            3.0 * u,
            hex(entry.colour)
        );
        let face = Face { size: TEXT * u, bold: false, anchor: "start" };
        svg.push_str(&text::element(&entry.name, (x + 38.0 * u, y + 0.36 * TEXT * u), &face));
    }
}

fn rectangle(svg: &mut String, (x, y): (f64, f64), (width, height): (f64, f64)) {
    let _ = writeln!(
        svg,
        "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>"
    );
}

fn hex(colour: [u8; 3]) -> String {
    let [r, g, b] = colour;
    format!("#{r:02X}{g:02X}{b:02X}")
}
