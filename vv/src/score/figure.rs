//! Profiles beside the exact solution.

use super::answer::Fields;
use super::judge::Profile;
use crate::plots::{Axis, Figure, Layer, Panel, Point, Series};

fn points(x: &[f64], y: &[f64]) -> Vec<Point> {
    x.iter().copied().zip(y.iter().copied()).collect()
}

/// A panel a field of the first profile: the exact solution as a line, theirs as points, ours as lines.
#[must_use]
pub fn figure(
    title: &str,
    theirs: &[Profile],
    ours: &[Profile],
    exact: (&[f64], &Fields),
) -> Figure {
    let fields = theirs.first().map(|profile| profile.fields.keys()).into_iter().flatten();
    let panel = |field: &String| {
        let mut panel = Panel::new("", Axis::linear("x"), Axis::linear(field.clone()));
        if let Some(line) = exact.1.get(field) {
            panel = panel.with(Layer::exact("exact", points(exact.0, line)));
        }
        for profile in theirs {
            if let Some(values) = profile.fields.get(field) {
                panel = panel.with(Series::scatter(&profile.name, points(&profile.x, values)));
            }
        }
        for profile in ours {
            if let Some(values) = profile.fields.get(field) {
                panel = panel.with(Series::line(&profile.name, points(&profile.x, values)));
            }
        }
        panel
    };
    Figure::new("score", title, fields.map(panel).collect())
}
