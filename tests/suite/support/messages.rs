//! Messages from JSON: the contract's own, and bodies of REST.

use std::sync::LazyLock;

use prost::Message;
use prost_reflect::{DescriptorPool, DynamicMessage};
use serde_json::{Map, Value, json};
use strew::grpc::proto::{DESCRIPTORS, StreamPointsRequest};

/// A message of the contract from its JSON.
pub fn message<M: Message + Default>(json: &Value) -> M {
    static POOL: LazyLock<DescriptorPool> =
        LazyLock::new(|| DescriptorPool::decode(DESCRIPTORS).expect("the contract"));
    let path = std::any::type_name::<M>();
    let name = path.rsplit("::").next().unwrap_or(path);
    let descriptor = POOL.get_message_by_name(&format!("strew.v1.{name}"));
    let descriptor = descriptor.expect("a message of the contract");
    let message = DynamicMessage::deserialize(descriptor, json);
    let message = message.unwrap_or_else(|error| panic!("{error}: {json}"));
    message.transcode_to().expect("the same message")
}

/// The query of a body of REST, whose fields are named ones. `encoding` is the number of an encoding.
pub fn query(body: &Value, encoding: i32) -> StreamPointsRequest {
    let mut query = json!({ "encoding": encoding });
    for name in ["offset", "limit", "cursor", "world", "world_digest"] {
        query[name] = body[name].clone();
    }
    query["region"] = region(&body["region"]);
    match body["layers"].as_array() {
        Some(layers) => query["layers"] = layers.iter().map(layer).collect(),
        None => query["set"] = set(body),
    }
    message(&query)
}

fn layer(body: &Value) -> Value {
    let [name, clear_of] = ["name", "clear_of"].map(|member| &body[member]);
    json!({ "name": name, "clear_of": clear_of, "region": region(&body["region"]), "set": set(body) })
}

/// The set of a body, or of one of its layers.
pub fn set(body: &Value) -> Value {
    let own = body.as_object().expect("an object").iter();
    let beside = [
        "region",
        "layers",
        "name",
        "clear_of",
        "offset",
        "limit",
        "cursor",
        "world",
        "world_digest",
        "format",
    ];
    let own = own.filter(|(name, _)| !beside.contains(&name.as_str()));
    own.map(|(name, value)| (name.clone(), member(name, value)))
        .collect()
}

/// A member of a set: what REST reads from a text, a message has as a list or a map.
fn member(name: &str, value: &Value) -> Value {
    let items = || value.as_str().into_iter().flat_map(|text| text.split(','));
    match (name, value) {
        ("warp", Value::String(text)) => json!(if text == "on" { 1 } else { 0 }),
        ("normals", Value::String(text)) => json!(text == "on"),
        ("attributes" | "except", Value::String(_)) => items().collect(),
        ("variants", Value::String(_)) => {
            let weight = |item: &str| {
                let (name, weight) = item.split_once(':').unwrap_or((item, "1"));
                (
                    name.to_owned(),
                    json!(weight.parse::<f64>().expect("a weight")),
                )
            };
            items().map(weight).collect::<Map<_, _>>().into()
        }
        ("variant_fields", Value::Object(fields)) => {
            let fields = fields
                .iter()
                .map(|(kind, name)| (kind.clone(), json!({ "name": name })));
            fields.collect::<Map<_, _>>().into()
        }
        ("field" | "terrain", Value::String(_)) => json!({ "name": value }),
        ("scale_range", Value::Array(_)) => named(&["min", "max"], value),
        ("heights", Value::Array(_)) => named(&["low", "high"], value),
        _ => value.clone(),
    }
}

/// A region of a body.
pub fn region(region: &Value) -> Value {
    let Some((name, shape)) = region.as_object().and_then(|region| region.iter().next()) else {
        return Value::Null;
    };
    match name.as_str() {
        "bbox" if shape[4].is_null() => {
            json!({ "bbox": named(&["min_x", "min_y", "max_x", "max_y"], shape) })
        }
        "bbox" => {
            json!({ "cuboid": named(&["min_x", "min_y", "min_z", "max_x", "max_y", "max_z"], shape) })
        }
        "circle" | "ball" => {
            let center = position(&shape["center"]);
            json!({ name: { "center": center, "radius": shape["radius"] } })
        }
        "polygon" => json!({ "polygons": polygons(shape) }),
        "prism" => {
            let [bottom, top] = ["bottom", "top"].map(|end| &shape[end]);
            json!({ "prism": { "base": polygons(&shape["polygon"]), "bottom": bottom, "top": top } })
        }
        "chunk" if shape["z"].is_null() => region.clone(),
        "chunk" => json!({ "cube": shape }),
        _ => {
            let [include, exclude] =
                ["include", "exclude"].map(|list| list_of(&region[list], self::region));
            json!({ "combined": { "include": include, "exclude": exclude } })
        }
    }
}

/// The polygons of a GeoJSON geometry.
fn polygons(geometry: &Value) -> Value {
    let ring = |ring: &Value| json!({ "positions": list_of(ring, position) });
    let polygon = |rings: &Value| json!({ "rings": list_of(rings, ring) });
    let coordinates = &geometry["coordinates"];
    match geometry["type"] == "Polygon" {
        true => json!({ "polygons": [polygon(coordinates)] }),
        false => json!({ "polygons": list_of(coordinates, polygon) }),
    }
}

fn position(place: &Value) -> Value {
    named(&["x", "y", "z"], place)
}

fn list_of(list: &Value, item: impl Fn(&Value) -> Value) -> Value {
    list.as_array().into_iter().flatten().map(item).collect()
}

/// A list as an object whose members have these names.
fn named(names: &[&str], list: &Value) -> Value {
    let items = list.as_array().into_iter().flatten();
    let members = names.iter().zip(items);
    members
        .map(|(name, value)| ((*name).to_owned(), value.clone()))
        .collect::<Map<_, _>>()
        .into()
}
