//! JSON Schemas: of types, derived from them, and of queries, from the table of parameters.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, generate::SchemaSettings, json_schema};
use serde_json::{Map, Value, json};
use strew_catalog::field::Document;
use strew_query::{
    Group, MOST_FEATURES, NAME, Parameter, RegionSchema, Shape, TITLE, VolumeSchema, groups,
    integer, of as parameters_of,
    parameters::{COUNT, EXCEPT, LOD, ONLY, PERIODIC, SEED, WORLD},
    schema,
};

use super::rules;

/// Makes the schema of a content, with what it refers to among the generator's definitions.
pub type Content = fn(&mut SchemaGenerator) -> Schema;

/// A generator whose definitions are components of the document.
pub(super) fn generator() -> SchemaGenerator {
    let settings = SchemaSettings::draft2020_12().with(|settings| {
        settings.definitions_path = "/components/schemas".into();
        settings.meta_schema = None;
    });
    settings.into_generator()
}

pub(in crate::rest) fn of<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    generator.subschema_for::<T>()
}

pub fn text(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string" })
}

pub fn any(_: &mut SchemaGenerator) -> Schema {
    json_schema!({})
}

pub fn object(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "object" })
}

pub(in crate::rest) struct PointsQuery;

pub(in crate::rest) struct CountQuery;

pub(in crate::rest) struct SpaceQuery;

/// A body of one kind or the other.
pub(in crate::rest) struct AnyQuery;

pub(in crate::rest) struct ArrangementQuery;

struct Layer;

struct SpaceLayer;

/// Schemas that are made of the table of parameters.
macro_rules! from_table {
    ($($kind:ty = $name:literal, $schema:expr;)+) => {$(
        impl JsonSchema for $kind {
            fn schema_name() -> Cow<'static, str> {
                $name.into()
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                let schema: fn(&mut SchemaGenerator) -> Value = $schema;
                Schema::try_from(schema(generator)).unwrap_or_default()
            }
        }
    )+};
}

from_table! {
    PointsQuery = "PointsQuery", |generator| {
        refer(generator);
        let about = "Which points, which part of them, and in which format: a region with one set of \
                     points, or with layers.";
        query(groups::QUERY, groups::SET, PLANE, about)
    };
    CountQuery = "CountQuery", |generator| {
        refer(generator);
        let about = "Which points: a region with one set of points, or with layers.";
        query(groups::COUNTED, groups::SET, PLANE, about)
    };
    AnyQuery = "AnyQuery", |generator| json!({
        "description": "A query for points of the plane or in space.",
        "anyOf": [of::<PointsQuery>(generator), of::<SpaceQuery>(generator)],
    });
    ArrangementQuery = "ArrangementQuery", |_| {
        body(groups::ARRANGEMENT, "An arrangement, and where its occurrences are wanted.")
    };
    SpaceQuery = "SpaceQuery", |generator| {
        of::<VolumeSchema>(generator);
        of::<SpaceLayer>(generator);
        let about = "Which points in space: a region with one set of points, or with layers.";
        query(groups::SPACE_QUERY, groups::SPACE_SET, ("Volume", "SpaceLayer"), about)
    };
    Layer = "Layer", |_| layer_of(groups::SET, "Region");
    SpaceLayer = "SpaceLayer", |_| layer_of(groups::SPACE_SET, "Volume");
}

/// Defines what queries refer to.
fn refer(generator: &mut SchemaGenerator) {
    of::<RegionSchema>(generator);
    of::<Document>(generator);
    of::<Layer>(generator);
}

pub(super) fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/components/schemas/{name}") })
}

/// The JSON Schema of a parameter in an address.
pub(super) fn as_text(shape: Shape) -> Value {
    let list = |item: &str| format!("{item}(,{item})*");
    let pattern = match shape {
        Shape::Numbers(names) => {
            let more = names.len().saturating_sub(1);
            format!("{NUMBER}(,{NUMBER}){{{more}}}")
        }
        Shape::Integers { names, .. } => vec![INTEGER; names.len()].join(","),
        Shape::Offsets { .. } => {
            let pair = format!("{INTEGER},{INTEGER}");
            format!("{pair}([ +]{pair})*")
        }
        Shape::Vertices => format!("{NUMBER},{NUMBER}(,{NUMBER},{NUMBER}){{2,}}"),
        Shape::Names { pattern } => list(pattern.trim_start_matches('^').trim_end_matches('$')),
        Shape::Weights => list(&format!("{NAME}(:{NUMBER})?")),
        Shape::Ranges => list(&format!("{NAME}:{NUMBER}:{NUMBER}")),
        Shape::Field => NAME.into(),
        Shape::Fields => list(&format!("{NAME}:{NAME}")),
        Shape::Switch => return json!({ "type": "string", "enum": ["on", "off"] }),
        Shape::Integer { min, max } => return integer(min.into(), max),
        other => return schema(other),
    };
    json!({ "type": "string", "pattern": format!("^{pattern}$") })
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

/// A body whose members are all parameters.
pub(super) fn body(groups: &'static [Group], about: &str) -> Value {
    let required = parameters_of(groups).filter(|parameter| parameter.is_required);
    let required: Vec<&str> = required.map(|parameter| parameter.name).collect();
    json!({
        "type": "object",
        "description": about,
        "required": required,
        "properties": members(groups),
        "additionalProperties": false,
        "x-rules": rules::of(groups),
    })
}

fn members(groups: &'static [Group]) -> Map<String, Value> {
    let member = |parameter: &Parameter| {
        let mut schema = schema(parameter.shape);
        schema["description"] = parameter.about.into();
        (parameter.name.to_owned(), schema)
    };
    parameters_of(groups).map(member).collect()
}

/// A schema that no value fulfills. Not every generator of clients reads `false`.
fn nothing() -> Value {
    json!({ "not": {} })
}

/// The conditions on the members of a set, with a schema that may stand for the amount.
fn rules_of_set(set: &'static [Group], instead: Option<Value>) -> Vec<Value> {
    let is_amount = |group: Group| [Group::Amount, Group::Count].contains(&group);
    let amounts = parameters_of(set).filter(|parameter| is_amount(parameter.group));
    let one: Vec<Value> = amounts
        .map(|amount| json!({ "required": [amount.name] }))
        .collect();
    let amount = match instead {
        None => json!({ "oneOf": one }),
        Some(instead) => json!({ "anyOf": [{ "oneOf": one }, instead] }),
    };
    let with = |name: &str| {
        json!({
            "required": ["attributes"],
            "properties": { "attributes": { "contains": { "const": name } } },
        })
    };
    let only_with =
        |member: &str, name: &str| json!({ "if": { "required": [member] }, "then": with(name) });
    vec![
        amount,
        only_with("scale_range", "scale"),
        json!({ "if": with("variant"), "then": { "required": ["variants"] } }),
    ]
}

/// The schema of a query. The conditions of region, periodic, spread, only, scale_ranges, decimals, size, summary and
/// crs are in `x-rules` only: schema-based test generators cannot satisfy that many.
fn query(
    groups: &'static [Group],
    set: &'static [Group],
    (region, layer): (&str, &str),
    about: &str,
) -> Value {
    let mut properties = members(groups);
    properties.insert("region".into(), reference(region));
    let layers = json!({
        "type": "array", "minItems": 1, "maxItems": MOST_FEATURES, "items": reference(layer),
        "description": "Several sets of points, one after another, instead of one: up to 16, or 1000 that differ in name, region, amount, seed and field alone.",
    });
    properties.insert("layers".into(), layers);
    let has_features = region == PLANE.0;
    if has_features {
        properties.insert("features".into(), features());
    }
    // The common seed and share, and the one layer that is wanted.
    let is_common = |parameter: &Parameter| [&SEED, &ONLY, &EXCEPT, &LOD].contains(&parameter);
    let of_set = parameters_of(set).filter(|parameter| !is_common(parameter));
    let of_set = of_set.map(|parameter| (parameter.name.to_owned(), nothing()));
    let mut of_set: Map<String, Value> = of_set.collect();
    let takes = |wanted: &Parameter| parameters_of(groups).any(|parameter| parameter == wanted);
    if takes(&PERIODIC) {
        of_set.insert(PERIODIC.name.into(), nothing());
    }
    if has_features {
        of_set.insert("features".into(), nothing());
    }
    let world = takes(&WORLD).then(|| json!({ "required": [WORLD.name] }));
    let rules_of_all = vec![json!({ "oneOf": [
        { "required": ["layers"], "properties": of_set },
        {
            "properties": { "layers": nothing(), "features": nothing() },
            "allOf": rules_of_set(set, world),
        },
        { "required": ["features"], "properties": { "layers": nothing(), "region": nothing() } },
    ] })];
    let published = rules::of(groups);
    json!({
        "type": "object",
        "description": format!("{about} Parameters may also be text, written as in an address."),
        "properties": properties,
        "additionalProperties": false,
        "allOf": rules_of_all,
        "x-rules": published,
    })
}

fn features() -> Value {
    let property = |about: &str| json!({ "type": "string", "description": about });
    json!({
        "type": "object",
        "description": "Each feature of a collection by itself, as a layer of its name: instead of a region and layers.",
        "properties": {
            "of": reference("FeatureCollection"),
            "id": property("The property with the name of a feature; by default its place: 0, 1, 2, …"),
            "count": property("The property with the number of points of a feature."),
        },
        "required": ["of"],
        "additionalProperties": false,
    })
}

/// The schemas of regions and layers of the plane.
const PLANE: (&str, &str) = ("Region", "Layer");

fn layer_of(set: &'static [Group], region: &str) -> Value {
    let mut properties = members(set);
    let others = json!({
        "name": {
            "type": "string", "pattern": TITLE,
            "description": "The layer's name; each layer has another one.",
        },
        "region": reference(region),
        "clear_of": {
            "type": "object", "additionalProperties": { "type": "number", "exclusiveMinimum": 0 },
            "description": "Names of earlier layers and the distances kept from their points, in \
                            world units. Not with count.",
        },
    });
    if let Value::Object(others) = others {
        properties.extend(others);
    }
    let mut rules = rules_of_set(set, None);
    rules.push(json!({
        "if": { "required": ["clear_of"], "properties": { "clear_of": { "minProperties": 1 } } },
        "then": { "properties": { COUNT.name: nothing() } },
    }));
    json!({
        "type": "object",
        "description": "One of several sets of points.",
        "required": ["name"],
        "properties": properties,
        "additionalProperties": false,
        "allOf": rules,
    })
}
