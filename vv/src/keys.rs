//! What `--set` can change: keys and values from scenes as they are written down, meanings and choices
//! from the documentation of the solver's own data. Nothing is said twice.

mod idle;

use std::collections::BTreeMap;

use serde_json::Value;
use whipple_solver::method::Preset;
use whipple_solver::units::{Dimension, Units};

use crate::scene::AnyScene;

pub use idle::idle;

/// Sources of the data of a scene along a line.
const LINE: [&str; 2] =
    [include_str!("../../solver/src/scene.rs"), include_str!("../../solver/src/method.rs")];

/// Sources of the data of a scene in space, the nearest first; choices are shared.
const SPACE: [&str; 5] = [
    include_str!("../../solver/src/space/scene.rs"),
    include_str!("../../solver/src/space/shape.rs"),
    include_str!("../../solver/src/space/mapping.rs"),
    include_str!("../../solver/src/space/method.rs"),
    include_str!("../../solver/src/method.rs"),
];

/// A value that `--set` can change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Key {
    /// Its name, as `--set` takes it.
    pub name: String,
    /// Its values under the presets `paper` and `default`; empty where a scene does not have it.
    pub values: [String; 2],
    /// Unit; empty for pure numbers and for what is no number.
    pub unit: String,
    /// What it is, in a sentence or two, with equations of the paper.
    pub meaning: String,
    /// What may be chosen; empty where a number is wanted.
    pub choices: Vec<String>,
}

/// The keys of the method of a scene, which need no `method.` before them.
#[must_use]
pub fn of_method(scenes: [&AnyScene; 2]) -> Vec<Key> {
    let docs = docs_of(scenes[0]);
    let trees = scenes.map(|scene| tree(scene)["method"].take());
    let names = trees[1].as_object().map(|map| map.keys().cloned().collect::<Vec<String>>());
    let key = |name: String| {
        let values = [0, 1].map(|k| text(&trees[k][&name]));
        let (meaning, choices) = docs.meaning(&["method", &name]);
        Key { name, values, unit: String::new(), meaning, choices }
    };
    names.unwrap_or_default().into_iter().map(key).collect()
}

/// The keys of what a scene simulates: everything but its method and its name.
#[must_use]
pub fn of_problem(scenes: [&AnyScene; 2]) -> Vec<Key> {
    let docs = docs_of(scenes[0]);
    let mut leaves: BTreeMap<String, [String; 2]> = BTreeMap::new();
    let mut order = Vec::new();
    for (k, scene) in scenes.into_iter().enumerate() {
        let mut tree = tree(scene);
        if let Some(map) = tree.as_object_mut() {
            ["method", "name", "units"].into_iter().for_each(|name| drop(map.remove(name)));
        }
        collect("", &tree, &mut |name, value| {
            if !leaves.contains_key(name) {
                order.push(name.to_owned());
            }
            leaves.entry(name.to_owned()).or_default()[k] = text(value);
        });
    }
    let key = |name: String| {
        let path: Vec<&str> = name.split('.').collect();
        let (meaning, choices) = docs.meaning(&path);
        let values = leaves.get(&name).cloned().unwrap_or_default();
        Key { unit: unit(&path, scenes[0].units()), values, meaning, choices, name }
    };
    order.into_iter().map(key).collect()
}

/// The scenes of both presets, the paper's first.
pub fn of_presets(scene: impl Fn(Preset) -> AnyScene) -> [AnyScene; 2] {
    [Preset::Paper, Preset::Default].map(scene)
}

fn tree(scene: &AnyScene) -> Value {
    // A scene is plain data: JSON can carry all of it.
    serde_json::to_value(scene).unwrap_or_default()
}

/// Calls `found` with every value that has no parts with names of their own.
fn collect(path: &str, value: &Value, found: &mut impl FnMut(&str, &Value)) {
    let below = |name: &str| if path.is_empty() { name.into() } else { format!("{path}.{name}") };
    match value {
        Value::Object(map) => map.iter().for_each(|(name, v)| collect(&below(name), v, found)),
        Value::Array(items) if items.iter().any(Value::is_object) => {
            items.iter().enumerate().for_each(|(k, v)| collect(&below(&k.to_string()), v, found));
        }
        leaf => found(path, leaf),
    }
}

/// A value as `--set` would take it.
fn text(value: &Value) -> String {
    match value {
        Value::Null => "none".into(),
        Value::String(text) => text.clone(),
        Value::Number(number) => number.to_string().trim_end_matches(".0").to_owned(),
        Value::Array(items) => {
            format!("[{}]", items.iter().map(text).collect::<Vec<String>>().join(", "))
        }
        Value::Object(map) => {
            let parts: Vec<String> =
                map.iter().map(|(k, v)| format!("{k} = {}", text(v))).collect();
            format!("{{ {} }}", parts.join(", "))
        }
        Value::Bool(choice) => choice.to_string(),
    }
}

/// Unit of a value of a scene, by the last part of its name that says what it measures.
fn unit(path: &[&str], units: Units) -> String {
    use Dimension as D;
    let label = |dimension| units.label(dimension).to_owned();
    let per = |above: String, dimension| match units {
        Units::None => String::new(),
        _ if above.is_empty() => format!("1/{}", label(dimension)),
        _ => format!("{above}/{}", label(dimension)),
    };
    let Some((last, above)) = path.split_last() else { return String::new() };
    match *last {
        "stop_time" => label(D::Time),
        "from" | "to" | "size" | "diameter" | "length" | "centre" | "position" | "mirror" => {
            label(D::Length)
        }
        "velocity" | "noise" | "c0" => label(D::Velocity),
        "density" => label(D::Density),
        "pressure" | "bulk" | "shear_modulus" | "y_0" | "a" | "b" | "spall" => label(D::Pressure),
        "energy" | "u_0" => label(D::SpecificEnergy),
        "theta_0" | "melt" | "reference" if units != Units::None => label(D::Temperature),
        "c_v" => per(label(D::SpecificEnergy), D::Temperature),
        "spin" | "rate_0" => per(String::new(), D::Time),
        "radius" | "zero" => label(D::Length),
        // Of a skewed lattice it is a way over a distance.
        "slope" if above.last() == Some(&"skew") => String::new(),
        "slope" => per(unit(above, units), D::Length),
        "degrees" => "degrees".into(),
        // How a field is spread says nothing of what it is.
        "uniform" | "linear" | "cosine" | "at_origin" | "mean" | "amplitude" => unit(above, units),
        _ => String::new(),
    }
}

/// A field of a struct or variant, or a variant that holds a value.
#[derive(Debug, PartialEq, Eq)]
struct Entry {
    /// The struct, the enum, or `Enum::variant`.
    owner: String,
    /// Name as it is written down.
    name: String,
    /// Type, containers taken off; empty for variants without a value, or with named ones.
    kind: String,
    /// Its documentation.
    doc: String,
    /// Whether it is a variant.
    variant: bool,
}

/// Documentation of the data of a scene.
struct Docs(Vec<Entry>);

fn docs_of(scene: &AnyScene) -> Docs {
    match scene {
        AnyScene::Line(_) => Docs::read(&LINE),
        AnyScene::Space(_) => Docs::read(&SPACE),
    }
}

impl Docs {
    /// Reads the declarations of structs and enums, which rustfmt lays out a field or variant a line.
    fn read(sources: &[&str]) -> Self {
        let mut entries = Vec::new();
        for source in sources {
            // What encloses a line: its name, and whether its parts are variants.
            let mut owners: Vec<(String, bool)> = Vec::new();
            let mut doc = Vec::new();
            for line in source.lines().map(str::trim) {
                if let Some(text) = line.strip_prefix("///") {
                    doc.push(text.trim());
                    continue;
                }
                if line.starts_with("#[") {
                    continue;
                }
                let doc = std::mem::take(&mut doc).join(" ");
                let head = line.strip_suffix(" {").unwrap_or_default();
                if let Some(name) = head.strip_prefix("pub struct ") {
                    owners = vec![(name.to_owned(), false)];
                } else if let Some(name) = head.strip_prefix("pub enum ") {
                    owners = vec![(name.to_owned(), true)];
                } else if line.starts_with('}') {
                    owners.pop();
                } else if let Some((owner, variant)) = owners.last().cloned() {
                    let (name, kind) = declaration(line);
                    if line.ends_with('{') {
                        owners.push((format!("{owner}::{name}"), false));
                    }
                    entries.push(Entry { owner, name, kind, doc, variant });
                }
            }
        }
        Self(entries)
    }

    fn entry(&self, owner: &str, name: &str) -> Option<&Entry> {
        self.0.iter().find(|entry| entry.owner == owner && entry.name == name)
    }

    /// What is said of a value, and what may be chosen for it.
    fn meaning(&self, path: &[&str]) -> (String, Vec<String>) {
        let (mut owner, mut doc) = ("Scene".to_owned(), String::new());
        for part in path.iter().filter(|part| part.parse::<usize>().is_err()) {
            let Some(entry) = self.entry(&owner, part) else { return Default::default() };
            // A variant says how, and what it is of says what.
            doc = if entry.variant { format!("{doc} {}", entry.doc) } else { entry.doc.clone() };
            owner = match entry.kind.as_str() {
                "" => format!("{owner}::{part}"),
                kind => kind.to_owned(),
            };
        }
        let choices = self.0.iter().filter(|entry| entry.owner == owner && entry.variant);
        (doc, choices.map(|entry| entry.name.clone()).collect())
    }
}

/// Name and type of a field or variant, as serde writes the name.
fn declaration(line: &str) -> (String, String) {
    let bare = line.trim_start_matches("pub ").trim_end_matches([',', '{', ' ']);
    if let Some((name, kind)) = bare.split_once(": ") {
        return (name.to_owned(), within(kind));
    }
    match bare.split_once('(') {
        Some((variant, kind)) => (snake(variant), within(kind.trim_end_matches(')'))),
        None => (snake(bare), String::new()),
    }
}

/// The type within lists, arrays and options.
fn within(kind: &str) -> String {
    let inner = ["Vec<", "Option<"].iter().find_map(|k| kind.strip_prefix(k)?.strip_suffix('>'));
    let inner = inner.or_else(|| kind.strip_prefix('[')?.split(';').next());
    inner.map_or_else(|| kind.to_owned(), within)
}

/// `MieGruneisen` as `mie_gruneisen`.
fn snake(name: &str) -> String {
    let mut out = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !out.is_empty() {
            out.push('_');
        }
        out.extend(letter.to_lowercase());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::{ALL, find};

    fn scenes(case: &str) -> [AnyScene; 2] {
        let case = find(case).expect("a case");
        of_presets(|preset| case.scene(preset, "", case.default_size()))
    }

    fn key(case: &str, name: &str) -> Key {
        let [paper, default] = scenes(case);
        let all = [of_method([&paper, &default]), of_problem([&paper, &default])].concat();
        all.into_iter().find(|key| key.name == name).expect("a key")
    }

    /// Whatever a scene of a case has, `--set` can address, and the solver's documentation explains.
    #[test]
    fn every_key_of_every_case_is_explained_and_can_be_set() {
        for case in ALL {
            let [paper, default] = scenes(case.id());
            let keys = [of_method([&paper, &default]), of_problem([&paper, &default])].concat();
            assert!(keys.len() > 20, "{}", case.id());
            for key in keys {
                assert!(!key.meaning.is_empty(), "{}: {}", case.id(), key.name);
                let [_, value] = &key.values;
                if value.is_empty() || value == "none" {
                    continue;
                }
                let set = format!("{}={value}", key.name);
                let same = crate::overrides::apply(default.clone(), std::slice::from_ref(&set));
                assert_eq!(same.as_ref(), Ok(&default), "{}: {set}", case.id());
                let chosen = value.trim_start_matches("{ ").split(' ').next().unwrap_or_default();
                let known = key.choices.is_empty() || key.choices.iter().any(|c| c == chosen);
                assert!(known, "{}: {set}: {:?}", case.id(), key.choices);
            }
        }
    }

    #[test]
    fn keys_have_values_units_meanings_and_choices() {
        let linear = key("noh", "visc_linear");
        assert_eq!(linear.values, ["1", "0.25"]);
        assert_eq!(linear.meaning, "Linear viscosity coefficient, `c_o` of Eq. (53).");
        assert_eq!((linear.unit.as_str(), linear.choices.len()), ("", 0));
        assert_eq!(key("noh", "heating").choices, ["printed", "pair"]);
        assert_eq!(key("noh", "heating").values, ["printed", "pair"]);
        let release = key("long-rod", "release");
        assert_eq!(release.values, ["{ steps = 20 }", "{ crossings = 5 }"]);
        assert_eq!(release.choices, ["steps", "crossings"]);
        let speed = key("kolsky", "bodies.0.velocity.uniform");
        assert_eq!(speed.meaning, "Initial velocity. The same value everywhere.");
        for (case, name, unit) in [
            ("long-rod", "materials.0.density", "g/cm³"),
            ("long-rod", "materials.0.eos.mie_gruneisen.c_v", "Mbar cm³/g/K"),
            ("long-rod", "bodies.0.spin", "1/µs"),
            ("long-rod", "bodies.0.cells", ""),
            ("long-rod", "stop_time", "µs"),
            ("kolsky", "bodies.0.velocity.uniform", "in/s"),
            ("noh", "bodies.0.to", ""),
        ] {
            assert_eq!(key(case, name).unit, unit, "{case}: {name}");
        }
    }
}
