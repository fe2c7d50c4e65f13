//! A scene file with other values: what sweeps and the search for a limit change.

use toml::Value;

use crate::nesting::{DEEPEST, too_deep};
use crate::suggest::did_you_mean;

/// A key of a scene file, such as `body.sphere.velocity.2`: parts of a list are named by number from 0, or by `name`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Key(Vec<String>);

/// A key and the values that it takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// What is varied.
    pub key: Key,
    /// Values, as they are written.
    pub values: Vec<String>,
}

impl std::fmt::Display for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0.join("."))
    }
}

impl std::str::FromStr for Key {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<String> =
            text.trim().split('.').map(|part| part.trim().to_owned()).collect();
        if parts.iter().any(String::is_empty) {
            return Err(format!("`{text}` is no key: wanted one such as `body.sphere.velocity.2`"));
        }
        Ok(Self(parts))
    }
}

impl std::str::FromStr for Variation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = "wanted KEY=VALUE,VALUE,..., such as `body.sphere.velocity.2=5 km/s, 6 km/s`";
        let (key, values) = text.split_once('=').ok_or_else(|| format!("`{text}`: {wanted}"))?;
        let values: Vec<String> = values.split(',').map(|value| value.trim().to_owned()).collect();
        if values.iter().any(String::is_empty) {
            return Err(format!("`{text}`: {wanted}"));
        }
        Ok(Self { key: key.parse()?, values })
    }
}

/// A scene file with other values.
///
/// # Errors
/// In words, a key that is not there.
pub fn vary(text: &str, changes: &[(&Key, &str)]) -> Result<String, String> {
    if too_deep(text).is_some() {
        return Err(format!("more than {DEEPEST} brackets are open at once"));
    }
    let mut whole: Value = toml::from_str(text).map_err(|error| error.message().to_owned())?;
    for (key, value) in changes {
        let place = find(&mut whole, key)?;
        // A number stays one; what has a unit is text.
        *place = match value.parse::<toml::Value>() {
            Ok(value @ (Value::Integer(_) | Value::Float(_) | Value::Boolean(_))) => value,
            _ => Value::String((*value).to_owned()),
        };
    }
    toml::to_string(&whole).map_err(|error| error.to_string())
}

/// The place of a key.
fn find<'a>(whole: &'a mut Value, key: &Key) -> Result<&'a mut Value, String> {
    let mut place = whole;
    for (depth, part) in key.0.iter().enumerate() {
        let known = names(place);
        let missing = || {
            let hint = did_you_mean(part, known.iter().map(String::as_str));
            let before = key.0[..depth].join(".");
            let of = if before.is_empty() { "the scene".to_owned() } else { format!("`{before}`") };
            format!("`{key}`: there is no `{part}` in {of}{hint} (there is: {})", known.join(", "))
        };
        place = match place {
            Value::Table(table) => table.get_mut(part).ok_or_else(missing)?,
            Value::Array(all) => {
                let named = all.iter().position(|one| name(one) == Some(part));
                let at = named.or_else(|| part.parse().ok()).filter(|&k: &usize| k < all.len());
                &mut all[at.ok_or_else(missing)?]
            }
            _ => return Err(missing()),
        };
    }
    Ok(place)
}

/// The name that a part of a list has.
fn name(value: &Value) -> Option<&str> {
    value.get("name")?.as_str()
}

/// What can follow a place in a key.
fn names(place: &Value) -> Vec<String> {
    match place {
        Value::Table(table) => table.keys().cloned().collect(),
        Value::Array(all) => {
            let named = all.iter().enumerate();
            named.map(|(k, one)| name(one).map_or_else(|| k.to_string(), str::to_owned)).collect()
        }
        _ => Vec::new(),
    }
}

/// All combinations of the values of some keys, the last changing first.
#[must_use]
pub fn combinations(all: &[Variation]) -> Vec<Vec<(&Key, &str)>> {
    let mut out: Vec<Vec<(&Key, &str)>> = vec![Vec::new()];
    for one in all {
        let mut next = Vec::new();
        for row in &out {
            for value in &one.values {
                let mut row = row.clone();
                row.push((&one.key, value.as_str()));
                next.push(row);
            }
        }
        out = next;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "stop = \"1 us\"\n[[body]]\nname = \"ball\"\nvelocity = [\"0 m/s\", \"1 km/s\"]\ncells = [1, 2]\n";

    fn key(text: &str) -> Key {
        text.parse().unwrap()
    }

    #[test]
    fn values_change_where_keys_lead() {
        let [stop, speed, cells] = ["stop", "body.ball.velocity.1", "body.0.cells.0"].map(key);
        let changed = vary(SCENE, &[(&stop, "2 us"), (&speed, "7 km/s"), (&cells, "4")]).unwrap();
        let read: Value = toml::from_str(&changed).unwrap();
        assert_eq!(read["stop"].as_str(), Some("2 us"));
        assert_eq!(read["body"][0]["velocity"][1].as_str(), Some("7 km/s"));
        assert_eq!(read["body"][0]["cells"][0].as_integer(), Some(4));
    }

    #[test]
    fn keys_that_lead_nowhere_are_named() {
        let said = |text: &str| vary(SCENE, &[(&key(text), "1")]).unwrap_err();
        assert_eq!(
            said("body.bal.velocity.1"),
            "`body.bal.velocity.1`: there is no `bal` in `body`; did you mean `ball`? (there is: ball)"
        );
        assert!(said("stop.x").contains("there is no `x` in `stop`"));
        assert!(said("body.ball.velocity.2").contains("there is: 0, 1"));
        assert!("a..b".parse::<Key>().is_err() && "a=1,,2".parse::<Variation>().is_err());
    }

    #[test]
    fn all_combinations_are_made() {
        let all: Vec<Variation> =
            ["a=1,2,3", "b=x, y"].map(|text| text.parse().unwrap()).into_iter().collect();
        let rows = combinations(&all);
        assert_eq!(rows.len(), 6);
        let values: Vec<Vec<&str>> =
            rows.iter().map(|row| row.iter().map(|(_, value)| *value).collect()).collect();
        assert_eq!(values[0], ["1", "x"]);
        assert_eq!(values[1], ["1", "y"]);
        assert_eq!(values[5], ["3", "y"]);
    }
}
