//! The JSON Schemas of what several answers have in common.

use serde_json::{Value, json};

use super::query;

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
                "points": count(),
                "left": count(),
                "points_per_second": number(),
                "burst_points": number(),
                "retry_after_seconds": number(),
                "request_id": {
                    "type": "string",
                    "description": "What the request is called in the server's log; also the header \
                                    x-request-id of every answer.",
                },
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
        "Query": {
            "type": "object",
            "description": "A query as it was understood: of one set of points, or of layers.",
            "required": ["bbox"],
            "properties": echo(),
        },
        "Set": {
            "type": "object",
            "description": "A set of points as it was understood.",
            "required": SET_REQUIRED,
            "properties": set_echo(),
        },
        "Found": {
            "type": "object",
            "description": "A point, with a member for each attribute asked for.",
            "required": ["id", "x", "y"],
            "properties": {
                "id": { "type": "string", "pattern": "^-?[0-9]+:-?[0-9]+$" },
                "x": number(),
                "y": number(),
                "distance": number(),
                "block": {
                    "type": "array",
                    "description": "The block of the neighborhood map: column and row. Only of a point asked for by its id.",
                    "items": count(),
                    "minItems": 2,
                    "maxItems": 2,
                },
            },
        },
        "PointsQuery": query::schema(),
        "Region": query::region(),
        "Layer": query::layer(),
        "Table": {
            "type": "object",
            "required": ["profile", "alpha", "radius", "digest", "algorithm"],
            "properties": {
                "profile": text(),
                "alpha": text(),
                "radius": count(),
                "digest": reference("Digest"),
                "algorithm": count(),
                "delta_min": number(),
                "delta_avg": number(),
            },
        },
        "Points": {
            "type": "object",
            "required": ["query", "count", "points"],
            "properties": {
                "query": reference("Query"),
                "table": reference("Table"),
                "tables": { "type": "array", "items": reference("Table") },
                "count": count(),
                "next": text(),
                "points": { "type": "array", "items": reference("Point") },
            },
        },
        "Digest": {
            "type": "string",
            "pattern": "^[0-9a-f]{64}$",
            "description": "The BLAKE3 digest of a table's file.",
        },
    })
}

/// What is always there of a set of points.
const SET_REQUIRED: [&str; 8] = [
    "density",
    "spacing",
    "least_distance",
    "profile",
    "alpha",
    "map",
    "seed",
    "warp",
];

fn set_echo() -> Value {
    let text = || json!({ "type": "string" });
    let number = || json!({ "type": "number" });
    json!({
        "name": text(),
        "region": reference("Region"),
        "density": number(),
        "spacing": number(),
        "least_distance": { "type": "number", "description": "No two points are nearer, by their f64 coordinates." },
        "profile": text(),
        "alpha": text(),
        "map": text(),
        "seed": { "type": "integer", "minimum": 0 },
        "warp": number(),
        "keep": number(),
        "attributes": { "type": "array", "items": { "type": "object" } },
        "clear_of": { "type": "object", "additionalProperties": number() },
    })
}

fn echo() -> Value {
    let count = || json!({ "type": "integer", "minimum": 0 });
    let mut members = set_echo();
    let number = json!({ "type": "number" });
    let others = json!({
        "bbox": { "type": "array", "items": number, "minItems": 4, "maxItems": 4 },
        "layers": { "type": "array", "items": reference("Set") },
        "offset": count(),
        "limit": count(),
        "format": { "type": "string" },
        "decimals": count(),
        "relative_to": { "type": "array", "items": number, "minItems": 2, "maxItems": 2 },
    });
    if let (Some(members), Value::Object(others)) = (members.as_object_mut(), others) {
        members.extend(others);
    }
    members
}

/// Every problem type that a Strew server knows; and what a library below it may say.
fn types() -> Vec<String> {
    let mut types: Vec<String> = Kind::ALL.map(error_map::urn).into();
    types.push("about:blank".into());
    types
}
