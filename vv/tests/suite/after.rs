//! What comes after a run: `whipple show` and `whipple compare`.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::said;

/// A cube of copper that flies past another.
const CUBES: &str = r#"
stop = "0.2 us"
resolution = { cell = "1 mm" }

[[body]]
name = "flyer"
material = "copper"
box = { size = ["3 mm", "3 mm", "3 mm"] }
velocity = ["0 m/s", "0 m/s", "300 m/s"]

[[body]]
name = "other"
material = "copper"
box = { size = ["2 mm", "2 mm", "4 mm"] }
at = ["20 mm", "0 mm", "0 mm"]
"#;

fn json(folder: &Path, args: &[&str]) -> Value {
    let said = said(folder, args);
    assert_eq!(said.code, Some(0), "{}", said.err);
    serde_json::from_str(&said.out).expect("JSON")
}

#[test]
fn runs_are_shown_and_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("cubes.toml"), CUBES).expect("written");
    for (out, velocity) in [("a", "300 m/s"), ("b", "300 m/s"), ("c", "330 m/s")] {
        fs::write(at.join("cubes.toml"), CUBES.replace("300 m/s", velocity)).expect("written");
        let run = said(at, &["run", "cubes.toml", "--out", out]);
        assert_eq!(run.code, Some(0), "{}", run.err);
    }

    let shown = json(at, &["show", "a", "--json"]);
    let fragments = shown["state"]["fragments"].as_array().expect("fragments");
    assert_eq!(fragments.len(), 2, "{shown}");
    let speed = fragments[0]["velocity"][2].as_f64().expect("a number");
    assert!((speed - 0.03).abs() < 1e-9, "{speed}");
    assert_eq!(shown["energies"].as_array().map(Vec::len), Some(3));

    let args = ["show", "a", "--section", "y=0", "--colour", "pressure", "--out", "end"];
    let drawn = said(at, &args);
    assert_eq!(drawn.code, Some(0), "{}", drawn.err);
    for name in ["state-pressure-y0.png", "state-pressure-y0-dark.png", "fragments.csv"] {
        assert!(at.join("end").join(name).exists(), "{name}");
    }
    assert_eq!(said(at, &args).code, Some(0), "the same again");
    fs::write(at.join("end/fragments.csv"), "my own").expect("written");
    let refused = said(at, &args);
    assert_eq!(refused.code, Some(2));
    assert!(refused.err.contains("fragments.csv is there already"), "{}", refused.err);
    assert_eq!(fs::read_to_string(at.join("end/fragments.csv")).expect("kept"), "my own");

    assert_eq!(json(at, &["compare", "a", "b", "--json"])["equal"], true);
    let equal = said(at, &["compare", "a", "b"]);
    assert!(equal.out.starts_with("the runs are equal"), "{}", equal.out);
    let other = json(at, &["compare", "a", "c", "--out", "both", "--json"]);
    assert_eq!(other["equal"], false);
    let keys: Vec<&str> = other["scene"]
        .as_array()
        .expect("keys")
        .iter()
        .filter_map(|changed| changed["key"].as_str())
        .collect();
    assert_eq!(keys, ["bodies.0.velocity.2"]);
    assert!(at.join("both/compare.svg").exists() && at.join("both/compare.png").exists());
}

#[test]
fn what_is_no_run_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |args: &[&str], wanted: &str| {
        let said = said(folder.path(), args);
        assert_eq!(said.code, Some(2), "{args:?}");
        assert!(said.err.contains(wanted), "{args:?}: {}", said.err);
    };
    refused(&["show", "."], "holds no record.json");
    refused(&["compare", ".", "."], "holds no record.json");
    refused(&["show", ".", "--section", "w=0"], "wanted an axis and a place");
}
