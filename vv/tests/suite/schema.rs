//! The JSON schema of scene files: as committed, and true of what the program reads.

use std::fs;
use std::path::{Path, PathBuf};

use jsonschema::Validator;
use serde_json::Value;

/// The folder of reference data.
fn references() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../references")
}

/// What checks scenes against the schema.
fn validator() -> Validator {
    let schema: Value = serde_json::from_str(&whipple_vv::scenes::schema::text()).expect("JSON");
    jsonschema::validator_for(&schema).expect("a schema")
}

/// A scene file as JSON.
fn json(text: &str) -> Value {
    let table: toml::Table = text.parse().expect("TOML");
    serde_json::to_value(table).expect("JSON")
}

/// What the schema says of a scene file.
fn refusals(text: &str) -> Vec<String> {
    validator().iter_errors(&json(text)).map(|e| format!("{}: {e}", e.instance_path())).collect()
}

/// The committed schema is the one that the program prints: `whipple schema > references/scene.schema.json`.
#[test]
fn the_committed_schema_is_that_of_the_program() {
    let committed = fs::read_to_string(references().join("scene.schema.json")).expect("a schema");
    assert!(committed == whipple_vv::scenes::schema::text(), "write it again");
}

/// Examples and the scene that `whipple new` writes agree with the schema.
#[test]
fn examples_agree_with_the_schema() {
    let mut files = vec![PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src/cli/template.toml")];
    for entry in fs::read_dir(references().join("scenes")).expect("the examples") {
        let path = entry.expect("a file").path();
        if path.extension().is_some_and(|e| e == "toml") {
            files.push(path);
        }
    }
    assert!(files.len() > 8, "{files:?}");
    for path in files {
        let text = fs::read_to_string(&path).expect("a scene");
        assert_eq!(refusals(&text), Vec::<String>::new(), "{}", path.display());
    }
}

/// What the program refuses for its form, the schema refuses too.
#[test]
fn bad_forms_are_refused() {
    let good = r#"
stop = "4 us"
resolution = { cell = "1 mm" }
[[body]]
name = "flyer"
material = "copper"
sphere = { diameter = "4 mm" }
[[wall]]
kind = "mirror"
axis = "z"
at = "0 mm"
bodies = "above"
"#;
    assert_eq!(refusals(good), Vec::<String>::new());
    for (right, wrong) in [
        ("stop =", "stopp ="),
        ("stop = \"4 us\"", "stop = \"soon\""),
        ("cell = \"1 mm\"", "cell = \"1 mm\", through = 4"),
        ("{ cell = \"1 mm\" }", "{}"),
        ("diameter", "radius"),
        ("sphere = { diameter = \"4 mm\" }", ""),
        ("sphere =", "box = { size = [1, 1, 1] }\nsphere ="),
        ("axis = \"z\"", "axis = \"w\""),
        ("\"above\"", "\"left\""),
        ("name = \"flyer\"", "name = 3"),
    ] {
        assert!(good.contains(right), "{right}");
        assert!(!refusals(&good.replace(right, wrong)).is_empty(), "{wrong}");
    }
}

/// A system of units is one that the program knows, by the same name.
#[test]
fn unit_systems_are_those_of_the_program() {
    let schema: Value = serde_json::from_str(&whipple_vv::scenes::schema::text()).expect("JSON");
    let names = schema["properties"]["units"]["enum"].as_array().expect("names").clone();
    assert_eq!(names.len(), 3);
    for name in names {
        let read: Result<whipple_solver::units::Units, _> = serde_json::from_value(name.clone());
        assert!(read.is_ok(), "{name}");
    }
}
