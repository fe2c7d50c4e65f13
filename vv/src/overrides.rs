//! `--set KEY=VALUE`: changing one value of a scene by the name that its file gives it.

use serde_json::Value;

use whipple_solver::method::Preset;

use crate::cases;
use crate::nesting::{DEEPEST, too_deep};
use crate::scene::AnyScene;
use crate::suggest::did_you_mean;

/// Why a scene cannot be changed as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OverrideError {
    /// No `=`, or nothing on a side of it.
    #[error(
        "`--set {text}` has no {lacks}: write KEY=VALUE, such as heating=pair or method.cfl=0.1; \
         `whipple list --keys` has the keys"
    )]
    Incomplete {
        /// The override as given.
        text: String,
        /// What is missing.
        lacks: &'static str,
    },
    /// No such key.
    #[error("`--set {key}={value}`: there is no `{part}` in {place}{hint}")]
    NoKey {
        /// The key as given.
        key: String,
        /// The value as given.
        value: String,
        /// The part that is not there.
        part: String,
        /// Where it was looked for.
        place: String,
        /// A similar name, or nothing.
        hint: String,
    },
    /// A key that another override sets already.
    #[error("`--set {key}` is given twice: one value has to do")]
    Twice {
        /// The key as given.
        key: String,
    },
    /// A value of the wrong form.
    #[error("`--set {key}={value}`: {reason}")]
    BadValue {
        /// The key as given.
        key: String,
        /// The value as given.
        value: String,
        /// What is wrong with it.
        reason: String,
    },
}

/// Applies overrides to a scene. A key without a dot is looked for among the method's choices
/// first: `heating` is `method.heating`. Values are TOML; a bare word is a string.
///
/// # Errors
/// The first override that names nothing, has a value of the wrong form or sets a key again. Whether the value makes
/// sense is for [`AnyScene::validate`] to say.
pub fn apply(scene: AnyScene, overrides: &[String]) -> Result<AnyScene, OverrideError> {
    let mut scene = scene;
    for (k, text) in overrides.iter().enumerate() {
        scene = apply_one(&scene, text)?;
        if overrides[..k].iter().any(|other| key(other) == key(text)) {
            return Err(OverrideError::Twice { key: key(text).to_owned() });
        }
    }
    Ok(scene)
}

/// Those of some overrides that give a value which the scene has already, by itself or by one before.
#[must_use]
pub fn redundant<'a>(scene: &AnyScene, overrides: &'a [String]) -> Vec<&'a String> {
    let mut scene = scene.clone();
    let changes_nothing = |text: &&String| match apply_one(&scene, text) {
        Ok(changed) => {
            let same = changed == scene;
            scene = changed;
            same
        }
        Err(_) => false,
    };
    overrides.iter().filter(changes_nothing).collect()
}

/// The key of an override, without `method.` before it.
pub(crate) fn key(text: &str) -> &str {
    let key = text.split('=').next().unwrap_or_default().trim();
    key.strip_prefix("method.").unwrap_or(key)
}

fn apply_one(scene: &AnyScene, text: &str) -> Result<AnyScene, OverrideError> {
    let (key, value) = text.split_once('=').unwrap_or((text, ""));
    let (key, value) = (key.trim(), value.trim());
    for (part, lacks) in [(key, "key"), (value, "value")] {
        if part.is_empty() {
            return Err(OverrideError::Incomplete { text: text.to_owned(), lacks });
        }
    }
    let bad =
        |reason: String| OverrideError::BadValue { key: key.into(), value: value.into(), reason };

    let tree = serde_json::to_value(scene).map_err(|e| bad(e.to_string()))?;
    let in_method = !key.contains('.') && tree["method"].get(key).is_some();
    let path = if in_method { format!("method.{key}") } else { key.to_owned() };
    let with = |new: Value| {
        let mut tree = tree.clone();
        *place(&mut tree, &path, key, value).map_err(|error| elsewhere(scene, error))? = new;
        read(scene, tree).map_err(bad)
    };
    match with(parse(value).map_err(bad)?) {
        // What is not there is listed as `none`, and taken so where it is no choice.
        Err(error) if value == "none" => with(Value::Null).map_err(|_| error),
        done => done,
    }
}

/// Says of a key that is not there if scenes of the other kind have it.
fn elsewhere(scene: &AnyScene, error: OverrideError) -> OverrideError {
    let OverrideError::NoKey { key, value, part, place, hint } = error else { return error };
    let scenes = cases::ALL.iter().map(|c| c.scene(Preset::Default, "", c.default_size()));
    let mut other = scenes.filter(|other| other.space().is_some() != scene.space().is_some());
    let tree = other.next().and_then(|other| serde_json::to_value(other).ok());
    let has = tree.is_some_and(|tree| tree["method"].get(self::key(&key)).is_some());
    let hint = match (has, scene.space()) {
        (false, _) => hint,
        (true, None) => "; it exists in three dimensions alone".into(),
        (true, Some(_)) => "; it exists along a line alone".into(),
    };
    OverrideError::NoKey { key, value, part, place, hint }
}

/// A scene of the kind of another.
fn read(like: &AnyScene, tree: Value) -> Result<AnyScene, String> {
    // The JSON text of the value keeps the path of an error; the scene has no other route in.
    let read = match like {
        AnyScene::Line(_) => serde_path_to_error::deserialize(tree).map(AnyScene::Line),
        AnyScene::Space(_) => serde_path_to_error::deserialize(tree).map(AnyScene::Space),
    };
    read.map_err(|e| {
        let inner = e.inner().to_string();
        let words = [
            ("invalid type: ", "found "),
            ("invalid value: ", "found "),
            ("unknown variant", "unknown choice"),
            ("unit variant", "a word alone"),
            ("newtype variant", "a table with its value, such as { steps = 20 }"),
            ("expected f64", "expected a number"),
            ("expected usize", "expected a whole number"),
            ("expected a sequence", "expected a list, such as [1, 2]"),
            ("expected an array of length 3", "expected a list of three, such as [1, 2, 3]"),
            ("expected string or map", "expected a word, or a table such as { steps = 20 }"),
        ];
        words.iter().fold(inner, |text, (from, to)| text.replace(from, to))
    })
}

/// The value at a dotted path.
fn place<'a>(
    tree: &'a mut Value,
    path: &str,
    key: &str,
    value: &str,
) -> Result<&'a mut Value, OverrideError> {
    let mut at = tree;
    let mut place = String::from("the scene");
    for part in path.split('.') {
        let known: Vec<String> = match at {
            Value::Object(map) => map.keys().cloned().collect(),
            Value::Array(items) => (0..items.len()).map(|k| k.to_string()).collect(),
            _ => Vec::new(),
        };
        if !known.iter().any(|k| k == part) {
            let mut names: Vec<&str> = known.iter().map(String::as_str).collect();
            let method: Vec<String>;
            if place == "the scene" {
                method = at["method"].as_object().map_or(vec![], |m| m.keys().cloned().collect());
                names.extend(method.iter().map(String::as_str));
                return Err(no_key(key, value, part, "the scene or its method", &names));
            }
            return Err(no_key(key, value, part, &place, &names));
        }
        at = match at {
            Value::Array(items) => {
                match part.parse::<usize>().ok().and_then(|k| items.get_mut(k)) {
                    Some(item) => item,
                    None => return Err(no_key(key, value, part, &place, &[])),
                }
            }
            other => &mut other[part],
        };
        place = format!("`{part}`");
    }
    Ok(at)
}

fn no_key(key: &str, value: &str, part: &str, place: &str, known: &[&str]) -> OverrideError {
    // A number has no neighbours in spelling.
    let word = part.parse::<usize>().is_err();
    let hint = match did_you_mean(part, known.iter().copied().filter(|_| word)) {
        hint if hint.is_empty() && !known.is_empty() => format!("; known: {}", known.join(", ")),
        hint => hint,
    };
    OverrideError::NoKey {
        key: key.into(),
        value: value.into(),
        part: part.into(),
        place: place.into(),
        hint,
    }
}

/// A TOML value, or a bare word.
fn parse(text: &str) -> Result<Value, String> {
    if too_deep(text).is_some() {
        return Err(format!("at most {DEEPEST} brackets may be open at once"));
    }
    let value = match toml::from_str::<toml::Table>(&format!("value = {text}")) {
        Ok(mut table) => table.remove("value").unwrap_or(toml::Value::String(text.into())),
        Err(_) => toml::Value::String(text.into()),
    };
    json(value)
}

fn json(value: toml::Value) -> Result<Value, String> {
    match value {
        toml::Value::Float(x) if !x.is_finite() => Err("a finite number is needed".into()),
        other => serde_json::to_value(other).map_err(|e| e.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use whipple_solver::method::Heating;
    use whipple_solver::scene::Scene;

    fn changed(set: &str) -> Result<Scene, OverrideError> {
        let scene = crate::cases::find("noh").expect("a case").scene(Preset::Default, "", 10);
        let changed = apply(scene, &[set.to_owned()])?;
        Ok(changed.line().expect("a scene along a line").clone())
    }

    #[test]
    fn scenes_in_space_are_changed_as_well() {
        let scene =
            || crate::cases::find("long-rod").expect("a case").scene(Preset::Default, "", 5);
        let changed = |set: &str| apply(scene(), &[set.to_owned()]);
        let scene_of =
            |set: &str| changed(set).expect("it applies").space().cloned().expect("in space");
        assert_eq!(scene_of("visc_linear=1.0").method.visc_linear, 1.0);
        assert_eq!(scene_of("bodies.0.velocity.1=0.2").bodies[0].velocity[1], 0.2);
        let melt = |set: &str| scene_of(set).materials[0].failure.melt;
        assert!(melt("cfl=0.5").is_some());
        assert_eq!(melt("materials.0.failure.melt=none"), None);
        let refused = changed("cfl=none").expect_err("a number is needed").to_string();
        assert!(refused.ends_with("found string \"none\", expected a number"), "{refused}");
        let refused = changed("release=steps").expect_err("how many").to_string();
        assert!(refused.ends_with("a table with its value, such as { steps = 20 }"), "{refused}");
        let refused = changed("heat_coef=1").expect_err("must be refused").to_string();
        assert!(refused.contains("heat_coeff"), "{refused}");
    }

    /// Every key of a scene with the value that it has changes nothing; with another it does.
    #[test]
    fn values_that_a_scene_has_are_redundant() {
        for (case, n) in [("noh", 10), ("long-rod", 5)] {
            let scene = crate::cases::find(case).expect("a case").scene(Preset::Default, "", n);
            let keys = crate::keys::of_method([&scene, &scene]);
            let own = keys.iter().map(|key| format!("{}={}", key.name, key.values[0]));
            let own: Vec<String> = own.collect();
            assert!(own.len() > 8, "{own:?}");
            assert_eq!(redundant(&scene, &own).len(), own.len(), "{own:?}");
            let sets = ["cfl=0.123", "stop_time=0.5", "method.cfl=0.123", "nothing=1"];
            let sets = sets.map(str::to_owned);
            assert_eq!(redundant(&scene, &sets), ["method.cfl=0.123"]);
        }
    }

    #[test]
    fn short_and_long_keys_reach_the_method() {
        for key in ["heating=printed", "method.heating=printed"] {
            assert_eq!(changed(key).map(|s| s.method.heating), Ok(Heating::Printed));
        }
        assert_eq!(changed("cfl=1e-1").map(|s| s.method.cfl), Ok(0.1));
        assert_eq!(changed("bodies.0.particles=7").map(|s| s.bodies[0].particles), Ok(7));
        assert_eq!(changed("stop_time=1").map(|s| s.stop_time), Ok(1.0));
    }

    #[test]
    fn messages_say_what_is_wanted() {
        let message = |set: &str| changed(set).expect_err("must be refused");
        insta::assert_snapshot!(message("heating"), @"`--set heating` has no value: write KEY=VALUE, such as heating=pair or method.cfl=0.1; `whipple list --keys` has the keys");
        let lacks = |set: &str| match message(set) {
            OverrideError::Incomplete { lacks, .. } => lacks,
            other => panic!("{other}"),
        };
        assert_eq!(["heating=", "=3", " = ", ""].map(lacks), ["value", "key", "key", "key"]);
        insta::assert_snapshot!(message("heatng=pair"));
        insta::assert_snapshot!(message("heating=sideways"));
        insta::assert_snapshot!(message("cfl=nan"), @"`--set cfl=nan`: a finite number is needed");
        insta::assert_snapshot!(message("cfl=fast"));
        insta::assert_snapshot!(message("bodies.3.particles=7"));
    }
}
