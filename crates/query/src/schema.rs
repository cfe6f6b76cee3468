//! JSON Schemas of values, by their shapes.

use serde_json::{Value, json};
use strew_encode::Encoding;

use crate::shape::Shape;

pub const NAME: &str = "[A-Za-z0-9_.-]{1,64}";

/// The names of layers ([`is_title`](strew_config::name::is_title)).
pub const TITLE: &str =
    r"^[^\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ufeff]{1,64}$";

/// An integer, with the width that makers of clients read.
pub fn integer(min: Value, max: u64) -> Value {
    let above = [i32::MAX as u64, i64::MAX as u64].map(|most| usize::from(max > most));
    let format = ["int32", "int64", "uint64"][above[0] + above[1]];
    json!({ "type": "integer", "format": format, "minimum": min, "maximum": max })
}

fn integers(count: usize, limit: i64) -> Value {
    let each = integer((-limit).into(), limit as u64);
    json!({ "type": "array", "items": each, "minItems": count, "maxItems": count })
}

fn by_name(each: Value, most: usize) -> Value {
    json!({
        "type": "object",
        "propertyNames": { "pattern": format!("^{NAME}$") },
        "additionalProperties": each,
        "minProperties": 1, "maxProperties": most,
    })
}

pub fn schema(shape: Shape) -> Value {
    match shape {
        Shape::Number { min, max } => json!({ "type": "number", "minimum": min, "maximum": max }),
        // Programs that hold numbers as `f64` write the long ones as text.
        Shape::Integer { min, max } if max >= 1 << 53 => json!({ "anyOf": [
            integer(min.into(), max),
            { "type": "string", "pattern": "^[0-9]+$" },
        ] }),
        Shape::Integer { min, max } => integer(min.into(), max),
        Shape::Signed { limit } => integer((-limit).into(), limit as u64),
        Shape::Switch => json!({ "type": "boolean" }),
        Shape::Strength { max } => json!({ "anyOf": [
            { "type": "string", "enum": ["off", "on"] },
            { "type": "number", "minimum": 0, "maximum": max },
        ] }),
        Shape::Numbers(names) => json!({
            "type": "array", "items": { "type": "number" },
            "minItems": names.len(), "maxItems": names.len(),
        }),
        Shape::Integers { names, limit } => integers(names.len(), limit),
        Shape::Offsets { limit } => json!({
            "type": "array", "minItems": 1, "items": integers(2, limit),
        }),
        Shape::Vertices => json!({ "type": "array", "items": { "type": "number" }, "minItems": 6 }),
        Shape::Names { pattern } => json!({
            "type": "array", "items": { "type": "string", "pattern": pattern },
            "uniqueItems": true,
        }),
        Shape::Weights => by_name(
            json!({ "type": "number", "minimum": 1e-9, "maximum": 1e9 }),
            256,
        ),
        Shape::Ranges => {
            let number = json!({ "type": "number", "minimum": 0, "maximum": 1e9 });
            let pair = json!({ "type": "array", "items": number, "minItems": 2, "maxItems": 2 });
            by_name(pair, 256)
        }
        Shape::Choice(words) => json!({ "type": "string", "enum": words }),
        Shape::Format => {
            let names: Vec<&str> = Encoding::ALL.iter().map(|format| format.name()).collect();
            json!({ "type": "string", "enum": names })
        }
        Shape::Pattern(pattern) => json!({ "type": "string", "pattern": pattern }),
        Shape::Fields => by_name(schema(Shape::Field), 32),
        Shape::Field => json!({ "anyOf": [
            { "type": "string", "pattern": format!("^{}$", NAME) },
            { "$ref": "#/components/schemas/Field" },
        ] }),
        Shape::Quadratic | Shape::Text => json!({ "type": "string" }),
    }
}
