//! The JSON schema of scene files, for editors: made from the types that read them, so that it cannot know other keys.

use std::borrow::Cow;
use std::ops::Deref;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use whipple_solver::units::Units;

use super::file::{SceneFile, Text};

/// A value and where it stands in its file: that of the TOML reader, of which a schema can be made.
#[derive(Debug, Clone, Deserialize)]
#[serde(transparent)]
pub struct Spanned<T>(toml::Spanned<T>);

impl<T> Deref for Spanned<T> {
    type Target = toml::Spanned<T>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<T: JsonSchema> JsonSchema for Spanned<T> {
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

impl JsonSchema for Text {
    fn schema_name() -> Cow<'static, str> {
        "Quantity".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number with its unit, such as \"7 km/s\"; a bare one where nothing has a unit.",
            "anyOf": [
                { "type": "number" },
                { "type": "string", "pattern": r"^\s*[-+]?(\d|\.\d)" },
            ],
        })
    }
}

/// The names of the unit systems.
pub(super) fn units(_: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "type": "string",
        "enum": [Units::None, Units::InLbfS, Units::CmGUsMbar],
    })
}

/// The shapes of a body, by their keys.
const SHAPES: [&str; 6] = ["sphere", "box", "cylinder", "ring", "cone", "stl"];

/// A body has exactly one shape.
pub(super) fn one_shape(schema: &mut Schema) {
    let shapes = SHAPES.map(|shape| serde_json::json!({ "required": [shape] }));
    schema.insert("oneOf".to_owned(), shapes.to_vec().into());
}

/// The schema of scene files as JSON text (draft 2020-12), with a line end.
#[must_use]
pub fn text() -> String {
    format!("{:#}\n", schemars::schema_for!(SceneFile).as_value())
}
