//! `whipple compare`: two runs side by side.

use std::fmt::Write as _;

use serde::Serialize;
use whipple_solver::units::{Dimension, Units};

use super::show::{energy_unit, read, write_new};
use super::{CompareArgs, Failure, print};
use crate::after::compare::{
    Changed, Difference, EQUAL, figure, findings, histories, reach, scenes,
};
use crate::plots::{render_svg, svg_to_png};
use crate::report::sig;
use crate::scene::AnyScene;

pub(super) const EXAMPLES: &str = "\
Examples:
  whipple compare out/shield out/shield-finer
  whipple compare out/shield out/shield-finer --out out/both
  whipple compare out/shield out/shield-finer --json";

/// Columns of the ledger that the text lists; `--json` has all.
const LISTED: usize = 10;

/// Pixels of the PNG figure over those of the SVG.
const SCALE: f32 = 2.0;

/// What `--json` prints.
#[derive(Serialize)]
struct Summary {
    equal: bool,
    scene: Vec<Changed>,
    findings: Vec<Difference>,
    histories: Vec<Difference>,
}

/// Compares two runs.
pub(super) fn compare(args: &CompareArgs) -> Result<u8, Failure> {
    let [(a, first), (b, second)] = [read(&args.runs[0])?, read(&args.runs[1])?];
    let units = |record: &crate::record::RunRecord| record.scene.as_ref().map(AnyScene::units);
    if units(&a) != units(&b) {
        let message = "the two runs are in different units: their numbers cannot be compared";
        return Err(Failure::usage(message));
    }
    let lever = reach([&a, &b]);
    let ledgers = first.as_ref().zip(second.as_ref());
    let differing = Summary {
        equal: false,
        scene: scenes([&a, &b]),
        findings: findings([&a, &b]),
        histories: ledgers
            .map(|(first, second)| histories([first, second], lever))
            .unwrap_or_default(),
    };
    let moved = differing.findings.iter().chain(&differing.histories).any(Difference::matters);
    let equal = !moved
        && differing.scene.is_empty()
        && a.outcome == b.outcome
        && first.is_some() == second.is_some();
    let summary = Summary { equal, ..differing };
    let mut written = Vec::new();
    if let Some(out) = &args.out {
        let Some((first, second)) = ledgers else {
            let message = "--out draws ledgers: wanted two runs in three dimensions";
            return Err(Failure::usage(message));
        };
        let units = units(&a).unwrap_or(Units::None);
        let momentum = match units {
            Units::None => "",
            Units::InLbfS => "lbf s",
            Units::CmGUsMbar => "g cm/µs",
        };
        let labels = [units.label(Dimension::Time), energy_unit(units), momentum];
        let names = [&args.runs[0], &args.runs[1]].map(|path| path.display().to_string());
        let drawn = figure([first, second], [&names[0], &names[1]], labels);
        let svg = render_svg(&drawn).map_err(Failure::usage)?;
        let png = svg_to_png(&svg, SCALE).map_err(Failure::usage)?;
        let files = [("compare.svg".to_owned(), svg.into_bytes()), ("compare.png".to_owned(), png)];
        written = write_new(out, &files)?;
    }
    let mut text = if args.json {
        serde_json::to_string_pretty(&summary).map_err(Failure::usage)? + "\n"
    } else {
        said(&summary)
    };
    if !args.json {
        written.iter().for_each(|path| text += &format!("{}\n", path.display()));
    }
    print(&text)?;
    Ok(0)
}

fn said(summary: &Summary) -> String {
    if summary.equal {
        let limit = sig(EQUAL, 1);
        return format!(
            "the runs are equal: scenes, findings and ledgers, to {limit} of their scales\n"
        );
    }
    let mut out = String::new();
    if summary.scene.is_empty() {
        out += "the scenes are the same\n";
    }
    let value = |value: &Option<serde_json::Value>| {
        value.as_ref().map_or("none".to_owned(), ToString::to_string)
    };
    for Changed { key, values: [a, b] } in &summary.scene {
        let _ = writeln!(out, "scene {key}: {} | {}", value(a), value(b));
    }
    let number = |x: f64| if x.is_nan() { "none".to_owned() } else { sig(x, 5) };
    let line = |d: &Difference| {
        let [a, b] = d.values.map(number);
        let at = d.time.map_or(String::new(), |time| format!(" at t = {}", sig(time, 4)));
        let by =
            if d.matters() { format!("differs by {}", sig(d.relative, 2)) } else { "equal".into() };
        format!("  {:<30} {a:<14} {b:<14} {by}{at}\n", d.name)
    };
    out += "findings, and differences over their scales:\n";
    summary.findings.iter().for_each(|d| out += &line(d));
    let moved: Vec<&Difference> = summary.histories.iter().filter(|d| d.matters()).collect();
    match moved.len() {
        0 => out += "the ledgers are equal where both have rows\n",
        _ => out += "greatest differences of the ledgers:\n",
    }
    moved.iter().take(LISTED).for_each(|d| out += &line(d));
    out
}
