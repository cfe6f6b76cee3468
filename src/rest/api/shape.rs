//! The JSON Schemas of parameters, from their shapes.

use serde_json::{Value, json};
use strew_query::{NAME, Shape, schema};

/// A reference to a schema of the document.
pub(super) fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/components/schemas/{name}") })
}

/// The JSON Schema of a parameter in an address.
pub(super) fn as_text(shape: Shape) -> Value {
    match shape {
        Shape::Numbers(names) => {
            let more = names.len().saturating_sub(1);
            json!({ "type": "string", "pattern": format!("^{NUMBER}(,{NUMBER}){{{more}}}$") })
        }
        Shape::Integers { names, .. } => {
            let pattern = vec![INTEGER; names.len()].join(",");
            json!({ "type": "string", "pattern": format!("^{pattern}$") })
        }
        Shape::Offsets { .. } => {
            let pair = format!("{INTEGER},{INTEGER}");
            json!({ "type": "string", "pattern": format!("^{pair}([ +]{pair})*$") })
        }
        Shape::Vertices => {
            json!({ "type": "string", "pattern": format!("^{NUMBER},{NUMBER}(,{NUMBER},{NUMBER}){{2,}}$") })
        }
        Shape::Names { pattern } => {
            let name = pattern.trim_start_matches('^').trim_end_matches('$');
            json!({ "type": "string", "pattern": format!("^{name}(,{name})*$") })
        }
        Shape::Weights => {
            let pair = format!("{}(:{NUMBER})?", NAME);
            json!({ "type": "string", "pattern": format!("^{pair}(,{pair})*$") })
        }
        Shape::Ranges => {
            let range = format!("{}:{NUMBER}:{NUMBER}", NAME);
            json!({ "type": "string", "pattern": format!("^{range}(,{range})*$") })
        }
        Shape::Switch => json!({ "type": "string", "enum": ["on", "off"] }),
        Shape::Field => json!({ "type": "string", "pattern": format!("^{}$", NAME) }),
        Shape::Fields => {
            let pair = format!("{}:{}", NAME, NAME);
            json!({ "type": "string", "pattern": format!("^{pair}(,{pair})*$") })
        }
        Shape::Integer { min, max } => {
            json!({ "type": "integer", "minimum": min, "maximum": max })
        }
        other => schema(other),
    }
}

/// An integer of up to 15 digits, which is within all bounds.
const INTEGER: &str = r"-?\d{1,15}";

/// A decimal number.
const NUMBER: &str = r"-?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?";

/// An example in the type of its schema.
pub(super) fn sample(shape: Shape, text: &str) -> Value {
    match shape {
        Shape::Number { .. } | Shape::Integer { .. } | Shape::Signed { .. } => {
            serde_json::from_str(text).unwrap_or_else(|_| text.into())
        }
        _ => text.into(),
    }
}
