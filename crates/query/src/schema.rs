//! JSON Schemas of values, by their shapes.

use serde_json::{Value, json};
use strew_encode::Encoding;

use crate::shape::Shape;

pub const NAME: &str = "[A-Za-z0-9_.-]{1,64}";

/// The names of layers ([`is_title`](strew_config::name::is_title)).
pub const TITLE: &str =
    r"^[^\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ufeff]{1,64}$";

pub fn schema(shape: Shape) -> Value {
    match shape {
        Shape::Number { min, max } => json!({ "type": "number", "minimum": min, "maximum": max }),
        // Programs that hold numbers as `f64` write the long ones as text.
        Shape::Integer { min, max } if max >= 1 << 53 => json!({ "anyOf": [
            { "type": "integer", "minimum": min, "maximum": max },
            { "type": "string", "pattern": "^[0-9]+$" },
        ] }),
        Shape::Integer { min, max } => {
            json!({ "type": "integer", "minimum": min, "maximum": max })
        }
        Shape::Signed { limit } => {
            json!({ "type": "integer", "minimum": -limit, "maximum": limit })
        }
        Shape::Switch => json!({ "type": "boolean" }),
        Shape::Strength { max } => json!({ "anyOf": [
            { "type": "string", "enum": ["off", "on"] },
            { "type": "number", "minimum": 0, "maximum": max },
        ] }),
        Shape::Numbers(names) => json!({
            "type": "array", "items": { "type": "number" },
            "minItems": names.len(), "maxItems": names.len(),
        }),
        Shape::Integers { names, limit } => json!({
            "type": "array", "items": { "type": "integer", "minimum": -limit, "maximum": limit },
            "minItems": names.len(), "maxItems": names.len(),
        }),
        Shape::Offsets { limit } => json!({
            "type": "array", "minItems": 1,
            "items": {
                "type": "array", "items": { "type": "integer", "minimum": -limit, "maximum": limit },
                "minItems": 2, "maxItems": 2,
            },
        }),
        Shape::Vertices => json!({ "type": "array", "items": { "type": "number" }, "minItems": 6 }),
        Shape::Names { pattern } => json!({
            "type": "array", "items": { "type": "string", "pattern": pattern },
            "uniqueItems": true,
        }),
        Shape::Weights => json!({
            "type": "object",
            "propertyNames": { "pattern": format!("^{}$", NAME) },
            "additionalProperties": { "type": "number", "minimum": 1e-9, "maximum": 1e9 },
            "minProperties": 1, "maxProperties": 256,
        }),
        Shape::Ranges => json!({
            "type": "object",
            "propertyNames": { "pattern": format!("^{}$", NAME) },
            "additionalProperties": {
                "type": "array", "items": { "type": "number", "minimum": 0, "maximum": 1e9 },
                "minItems": 2, "maxItems": 2,
            },
            "minProperties": 1, "maxProperties": 256,
        }),
        Shape::Choice(words) => json!({ "type": "string", "enum": words }),
        Shape::Format => {
            let names: Vec<&str> = Encoding::ALL.iter().map(|format| format.name()).collect();
            json!({ "type": "string", "enum": names })
        }
        Shape::Pattern(pattern) => json!({ "type": "string", "pattern": pattern }),
        Shape::Fields => json!({
            "type": "object",
            "propertyNames": { "pattern": format!("^{}$", NAME) },
            "additionalProperties": schema(Shape::Field),
            "minProperties": 1, "maxProperties": 32,
        }),
        Shape::Field => json!({ "anyOf": [
            { "type": "string", "pattern": format!("^{}$", NAME) },
            { "$ref": "#/components/schemas/Field" },
        ] }),
        Shape::Quadratic | Shape::Text => json!({ "type": "string" }),
    }
}
