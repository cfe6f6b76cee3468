//! The JSON Schemas of what several answers have in common.

use serde_json::{Value, json};

use crate::{error_map, service::Kind};

/// A reference to a schema of the document.
pub(in crate::rest) fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/components/schemas/{name}") })
}

/// An object of whose members all are always there.
pub(in crate::rest) fn object(properties: Value) -> Value {
    let required: Vec<&String> = properties
        .as_object()
        .map(|members| members.keys().collect())
        .unwrap_or_default();
    json!({ "type": "object", "required": required, "properties": properties })
}

/// All of them.
pub(super) fn shared() -> Value {
    let text = || json!({ "type": "string" });
    let number = || json!({ "type": "number" });
    let count = || json!({ "type": "integer", "minimum": 0 });
    json!({
        "Problem": {
            "type": "object",
            "description": "Why there is no answer (RFC 9457).",
            "required": ["type", "title", "status", "detail"],
            "properties": {
                "type": { "type": "string", "enum": types() },
                "title": text(),
                "status": { "type": "integer", "minimum": 400, "maximum": 599 },
                "detail": text(),
                "errors": { "type": "array", "items": reference("Fault") },
                "count": count(),
                "limit": count(),
                "pinned": reference("Digest"),
                "loaded": reference("Digest"),
            },
        },
        "Fault": {
            "type": "object",
            "description": "One thing that is wrong with a query.",
            "required": ["field", "value", "detail", "allowed"],
            "properties": {
                "field": { "type": "string", "description": "The parameter or member." },
                "value": {
                    "type": ["string", "null"],
                    "description": "Its value; null if it is missing.",
                },
                "detail": { "type": "string", "description": "What is wrong with it." },
                "allowed": { "type": "string", "description": "What is allowed." },
            },
        },
        "Point": object(json!({
            "id": {
                "type": "string",
                "pattern": "^-?[0-9]+:-?[0-9]+$",
                "description": "The stable id: the point's lattice address.",
            },
            "x": number(),
            "y": number(),
        })),
        "Query": object(json!({
            "bbox": { "type": "array", "items": number(), "minItems": 4, "maxItems": 4 },
            "density": number(),
            "spacing": number(),
            "profile": text(),
            "alpha": text(),
            "map": text(),
            "seed": count(),
            "warp": number(),
            "format": text(),
        })),
        "Table": object(json!({
            "profile": text(),
            "alpha": text(),
            "radius": count(),
            "digest": reference("Digest"),
            "algorithm": count(),
        })),
        "Points": object(json!({
            "query": reference("Query"),
            "table": reference("Table"),
            "count": count(),
            "points": { "type": "array", "items": reference("Point") },
        })),
        "Digest": {
            "type": "string",
            "pattern": "^[0-9a-f]{64}$",
            "description": "The BLAKE3 digest of a table's file.",
        },
    })
}

/// Every problem type that a Strew server knows; and what a library below it may say.
fn types() -> Vec<String> {
    let mut types: Vec<String> = Kind::ALL.map(error_map::urn).into();
    types.push("about:blank".into());
    types
}
