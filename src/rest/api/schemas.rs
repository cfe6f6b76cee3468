//! JSON Schemas: of types, derived from them, and of queries, from the table of parameters.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, generate::SchemaSettings, json_schema};
use serde_json::{Value, json};
use strew_catalog::field::Document;
use strew_query::{RegionSchema, VolumeSchema, groups};

use super::sets;

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

/// The schema of a type.
pub(in crate::rest) fn of<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    generator.subschema_for::<T>()
}

/// The schema of text.
pub fn text(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string" })
}

/// The schema of anything.
pub fn any(_: &mut SchemaGenerator) -> Schema {
    json_schema!({})
}

/// The schema of any object.
pub fn object(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "object" })
}

/// The body of `POST /v1/points:query`.
#[derive(Debug)]
pub(in crate::rest) struct PointsQuery;

/// The body of `POST /v1/count`.
#[derive(Debug)]
pub(in crate::rest) struct CountQuery;

/// The body of requests about points in space.
#[derive(Debug)]
pub(in crate::rest) struct SpaceQuery;

/// A body of one kind or the other.
#[derive(Debug)]
pub(in crate::rest) struct AnyQuery;

/// The body of `POST /v1/pattern/arrangements`.
#[derive(Debug)]
pub(in crate::rest) struct ArrangementQuery;

/// A layer of the plane.
struct Layer;

/// A layer in space.
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
        sets::points_query()
    };
    CountQuery = "CountQuery", |generator| {
        refer(generator);
        sets::count_query()
    };
    AnyQuery = "AnyQuery", |generator| json!({
        "description": "A query for points of the plane or in space.",
        "anyOf": [of::<PointsQuery>(generator), of::<SpaceQuery>(generator)],
    });
    ArrangementQuery = "ArrangementQuery", |_| {
        sets::body(groups::ARRANGEMENT, "An arrangement, and where its occurrences are wanted.")
    };
    SpaceQuery = "SpaceQuery", |generator| {
        of::<VolumeSchema>(generator);
        of::<SpaceLayer>(generator);
        sets::space_query()
    };
    Layer = "Layer", |_| sets::layer();
    SpaceLayer = "SpaceLayer", |_| sets::space_layer();
}

/// Defines what queries refer to.
fn refer(generator: &mut SchemaGenerator) {
    of::<RegionSchema>(generator);
    of::<Document>(generator);
    of::<Layer>(generator);
}
