//! The last touch on plotters' SVG text: true size, accessible name, and runs of equal elements
//! joined into one path each, which makes files several times smaller.

use super::canvas::UNITS;
use super::model::Point;
use crate::xml::escape;
use std::fmt::Write as _;

/// Finishes a drawing of the given size in pixels; `caption` becomes its accessible name.
pub(super) fn finish(drawing: &str, (width, height): Point, caption: &str) -> String {
    let (w, h) = (width * UNITS, height * UNITS);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {w} {h}\" role=\"img\" aria-label=\"{}\">\n",
        escape(caption)
    );
    let mut run: Option<(String, String)> = None;
    for line in drawing.lines().skip_while(|l| !l.starts_with("<svg")).skip(1) {
        let element = Element::read(line);
        match (&mut run, element) {
            (Some((style, data)), Some(e)) if *style == e.style => data.push_str(&e.data),
            (_, element) => {
                close(&mut out, run.take());
                match element {
                    Some(e) => run = Some((e.style, e.data)),
                    None => out.extend([line, "\n"]),
                }
            }
        }
    }
    out
}

fn close(out: &mut String, run: Option<(String, String)>) {
    if let Some((style, data)) = run {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "<path {style} d=\"{data}\"/>");
    }
}

/// A drawing element that can share a path with others of its style.
struct Element {
    style: String,
    data: String,
}

impl Element {
    /// Reads what plotters wrote; anything unknown is left alone by the caller.
    fn read(line: &str) -> Option<Self> {
        let get = |name: &str| {
            let (_, rest) = line.split_once(&format!(" {name}=\""))?;
            rest.split_once('"').map(|(value, _)| value)
        };
        let opacity = match get("opacity")? {
            "1" => String::new(),
            other => format!(" opacity=\"{other}\""),
        };
        if line.starts_with("<polyline ") {
            let (ink, width) = (get("stroke")?, get("stroke-width")?);
            Some(Self {
                style: format!(
                    "fill=\"none\" stroke=\"{ink}\" stroke-width=\"{width}\" \
                     stroke-linejoin=\"round\"{opacity}"
                ),
                data: path(get("points")?, "")?,
            })
        } else if line.starts_with("<polygon ") {
            let style = format!("fill=\"{}\"{opacity}", get("fill")?);
            Some(Self { style, data: path(get("points")?, "z")? })
        } else if line.starts_with("<circle ") && get("stroke") == Some("none") {
            // A dot is a line of no length with round ends.
            let (ink, width) = (get("fill")?, 2 * get("r")?.parse::<u32>().ok()?);
            Some(Self {
                style: format!(
                    "fill=\"none\" stroke=\"{ink}\" stroke-width=\"{width}\" \
                     stroke-linecap=\"round\"{opacity}"
                ),
                data: format!("M{} {}h0", get("cx")?, get("cy")?),
            })
        } else {
            None
        }
    }
}

/// Path data of a list of points, relative after the first.
fn path(points: &str, end: &str) -> Option<String> {
    let mut data = String::new();
    let mut last: Option<(i32, i32)> = None;
    for point in points.split_whitespace() {
        let (x, y) = point.split_once(',')?;
        let (x, y): (i32, i32) = (x.parse().ok()?, y.parse().ok()?);
        let _ = match last {
            None => write!(data, "M{x} {y}"),
            Some((a, b)) => write!(data, "l{} {}", x - a, y - b),
        };
        last = Some((x, y));
    }
    data.push_str(end);
    Some(data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_neighbours_share_a_path() {
        let dot = |x| {
            format!(
                "<circle cx=\"{x}\" cy=\"2\" r=\"3\" opacity=\"1\" fill=\"#000000\" stroke=\"none\" \
             stroke-width=\"1\"/>\n"
            )
        };
        let line = "<polyline fill=\"none\" opacity=\"1\" stroke=\"#123456\" stroke-width=\"4\" \
                    points=\"1,2 3,5 \"/>\n";
        let drawing = format!("<svg>\n{}{}{line}<text>x</text>\n</svg>\n", dot(1), dot(9));
        insta::assert_snapshot!(finish(&drawing, (10.0, 5.0), "a < b"), @r##"
    <svg xmlns="http://www.w3.org/2000/svg" width="10" height="5" viewBox="0 0 40 20" role="img" aria-label="a &lt; b">
    <path fill="none" stroke="#000000" stroke-width="6" stroke-linecap="round" d="M1 2h0M9 2h0"/>
    <path fill="none" stroke="#123456" stroke-width="4" stroke-linejoin="round" d="M1 2l2 3"/>
    <text>x</text>
    </svg>
    "##);
    }
}
