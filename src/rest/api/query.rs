//! The JSON Schemas of queries as bodies.

use serde_json::{Map, Value, json};

use super::{document, schemas::reference};
use crate::service::query::{LOOKS_NAMES, Parameter, SET_NAMES, WINDOW_NAMES};

fn members(names: &[&str]) -> Map<String, Value> {
    let member = |name: &&str| {
        let parameter = Parameter::named(name)?;
        let mut schema = document::schema(parameter.shape);
        schema["description"] = parameter.about.into();
        Some((String::from(*name), schema))
    };
    names.iter().filter_map(member).collect()
}

fn set() -> Map<String, Value> {
    // The members of these names that JSON has more to say of replace those of addresses.
    let mut set = members(&SET_NAMES);
    let text = json!({ "type": "string" });
    let about = |name| Parameter::named(name).map_or("", |parameter| parameter.about);
    let others = json!({
        "attributes": { "type": "array", "items": text, "description": about("attributes") },
        "scale_range": {
            "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2,
            "description": about("scale_range"),
        },
        "variants": {
            "type": "object", "additionalProperties": { "type": "number" },
            "description": about("variants"),
        },
    });
    if let Value::Object(others) = others {
        set.extend(others);
    }
    set
}

/// A whole query.
pub(super) fn schema() -> Value {
    let mut properties = set();
    properties.extend(members(&WINDOW_NAMES));
    properties.extend(members(&LOOKS_NAMES));
    properties.insert("region".into(), reference("Region"));
    let layers = json!({
        "type": "array", "minItems": 1, "maxItems": 16, "items": reference("Layer"),
        "description": "Several sets of points at once, instead of one.",
    });
    properties.insert("layers".into(), layers);
    json!({
        "type": "object",
        "description": "Which points are asked for. A region must be given, and how densely points \
                        lie, once or for each layer.",
        "required": ["region"],
        "properties": properties,
        "additionalProperties": false,
    })
}

/// One of several sets of points.
pub(super) fn layer() -> Value {
    let mut properties = set();
    let others = json!({
        "name": { "type": "string", "pattern": "^[A-Za-z0-9_.-]{1,64}$" },
        "region": reference("Region"),
        "clear_of": {
            "type": "object", "additionalProperties": { "type": "number" },
            "description": "Names of earlier layers and the distances kept from their points.",
        },
    });
    if let Value::Object(others) = others {
        properties.extend(others);
    }
    json!({
        "type": "object",
        "required": ["name"],
        "properties": properties,
        "additionalProperties": false,
    })
}

/// A region of any kind.
pub(super) fn region() -> Value {
    let number = || json!({ "type": "number" });
    let numbers =
        |n: u32| json!({ "type": "array", "items": number(), "minItems": n, "maxItems": n });
    let regions = || json!({ "type": "array", "items": reference("Region") });
    let object = |properties: Value, required: &[&str]| {
        json!({
            "type": "object",
            "required": required,
            "properties": properties,
            "additionalProperties": false,
        })
    };
    let circle = object(
        json!({ "center": numbers(2), "radius": number() }),
        &["center", "radius"],
    );
    let chunk = object(
        json!({
            "size": number(),
            "x": { "type": "integer" },
            "y": { "type": "integer" },
        }),
        &["size", "x", "y"],
    );
    // A position may have an elevation, which does not matter.
    let position = json!({ "type": "array", "items": number(), "minItems": 2 });
    let ring = json!({ "type": "array", "items": position, "minItems": 3 });
    let rings = json!({ "type": "array", "items": ring, "minItems": 1 });
    let geometry = |kind: &str, member: &str, schema: Value| {
        json!({
            "type": "object",
            "required": ["type", member],
            "properties": { "type": { "const": kind }, member: schema },
        })
    };
    let several = |kind: &str, member: &str| {
        geometry(
            kind,
            member,
            json!({ "type": "array", "items": { "type": "object" } }),
        )
    };
    let polygon = json!({
        "description": "GeoJSON: a polygon or several, holes included, bare, in features or in \
                        collections.",
        "oneOf": [
            geometry("Polygon", "coordinates", rings.clone()),
            geometry("MultiPolygon", "coordinates", json!({ "type": "array", "items": rings })),
            geometry("Feature", "geometry", json!({ "type": ["object", "null"] })),
            several("FeatureCollection", "features"),
            several("GeometryCollection", "geometries"),
        ],
    });
    let combined = json!({ "include": regions(), "exclude": regions() });
    json!({
        "description": "Where: a half-open box, a circle, polygons, a square of the world grid, or \
                        what lies in any of some regions and in none of others.",
        "oneOf": [
            object(json!({ "bbox": numbers(4) }), &["bbox"]),
            object(json!({ "circle": circle }), &["circle"]),
            object(json!({ "polygon": polygon }), &["polygon"]),
            object(json!({ "chunk": chunk }), &["chunk"]),
            object(combined, &["include"]),
        ],
    })
}
