//! The echo of a query in its answers, and the hash that identifies a query.

use std::{borrow::Cow, collections::BTreeMap};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Serialize, Serializer};
use serde_json::{Map, Value as Json, json};
use strew_catalog::{except::Except, field::Document};
use strew_core::{ALGORITHM_VERSION, Spacing};
use strew_error::integer::Long;

use crate::{
    json::AnyRegionSchema,
    parameter::{Group, Parameter},
    parameters::{EXCEPT, FIELD, PARAMETERS, SEED, TERRAIN, VARIANT_FIELDS, WARP},
    period::{Period, PeriodEcho},
    query::Query,
    region_check::QueryRegion,
    schema::schema,
    set::Set,
    shape::Shape,
    space::SPACE_PARAMETERS,
    value::Value,
};

/// A query with everything filled in: of one set of points, or of layers.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Query")]
pub struct Resolved {
    /// A box around the region: min x, min y, max x, max y, or in space min x, min y, min z, max x, max y, max z.
    #[schemars(length(min = 4, max = 6))]
    pub bbox: Vec<f64>,
    /// The region, unless it is that box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "AnyRegionSchema")]
    pub region: Option<Json>,
    /// The world that a part of the query comes from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub world: Option<String>,
    /// Its digest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub world_digest: Option<String>,
    /// The one layer whose points are wanted.
    #[serde(default, skip_serializing_if = "Option::is_none", rename = "only")]
    #[schemars(with = "String")]
    pub only_layer: Option<String>,
    /// The points, if there are no layers.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub set: Option<ResolvedSet>,
    /// The layers, if there are any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<ResolvedSet>,
    /// The number of points of the region before those of the answer, if any.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset: Long<u128>,
    /// The greatest number of points of the answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Long<u64>")]
    pub limit: Option<Long<u64>>,
}

impl Resolved {
    /// The number of points of each kind, by name, in an object for each layer if there are layers.
    pub fn kinds(&self) -> Option<Json> {
        let named = |set: &ResolvedSet| {
            let kinds = set
                .kinds
                .iter()
                .map(|(name, count)| (name.clone(), json!(count)));
            Json::Object(kinds.collect())
        };
        let all = self.set.iter().chain(&self.layers);
        let mut with_kinds = all.filter(|set| !set.kinds.is_empty()).peekable();
        with_kinds.peek()?;
        Some(match &self.set {
            Some(set) => named(set),
            None => Json::Object(
                with_kinds
                    .map(|set| (set.name.clone(), named(set)))
                    .collect(),
            ),
        })
    }
}

/// A set of points with everything filled in.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Set")]
pub struct ResolvedSet {
    /// The name of the layer.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The layer's own region.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "AnyRegionSchema")]
    pub region: Option<Json>,
    /// Points per unit of area, in space of volume, before keep and clear_of.
    pub density: f64,
    /// The mean spacing: density^-1/2, in space density^-1/3.
    pub spacing: f64,
    /// No two points are nearer, in world units, by their f64 coordinates.
    pub least_distance: f64,
    /// The parameters that define the points, with everything filled in.
    #[serde(flatten)]
    pub values: Echoed,
    /// The digest of the ids that are left out, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub except_digest: Option<String>,
    /// The digest of the field, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub field_digest: Option<String>,
    /// The digest of the terrain's field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub terrain_digest: Option<String>,
    /// The digests of the fields of variants.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub variant_field_digests: BTreeMap<String, String>,
    /// The period that the points are of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "PeriodEcho")]
    pub period: Option<PeriodEcho>,
    /// The layers that are kept clear of, with the distances.
    #[serde(
        default,
        serialize_with = "as_map",
        skip_serializing_if = "Vec::is_empty"
    )]
    #[schemars(with = "BTreeMap<String, f64>")]
    pub clear_of: Vec<(String, f64)>,
    /// The number of points of the region with each variant, if variants are evenly spread.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub kinds: BTreeMap<String, Long<u128>>,
    /// The distances that the points of two evenly spread variants, or of one, keep.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub kind_distances: Vec<KindDistance>,
}

/// The distance that the points of two evenly spread variants, or of one, keep from each other.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(inline)]
pub struct KindDistance {
    /// The names of the variants.
    pub kinds: [String; 2],
    /// No point of one is nearer to a point of the other.
    pub least_distance: f64,
}

/// The values of a set's parameters with everything filled in, in the order of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Echoed(pub Vec<(&'static Parameter, Value)>);

impl Serialize for Echoed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(
            self.0
                .iter()
                .map(|(parameter, value)| (parameter.name, value)),
        )
    }
}

impl JsonSchema for Echoed {
    fn schema_name() -> Cow<'static, str> {
        "Echoed".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        // The shapes refer to it.
        generator.subschema_for::<Document>();
        let mut properties = Map::new();
        let mut required = vec![];
        for parameter in PARAMETERS.iter().filter(|parameter| parameter.is_echoed) {
            let mut echoed = match parameter.shape {
                // Text in requests, too, but always a number in answers.
                Shape::Strength { .. } => json!({ "type": "number" }),
                // Described ones are known by their digests.
                Shape::Field => json!({ "type": "string" }),
                shape => schema(shape),
            };
            let in_space = SPACE_PARAMETERS.iter().find(|other| *other == parameter);
            if let Some(in_space) = in_space.filter(|other| other.is_echoed) {
                echoed = json!({ "anyOf": [echoed, schema(in_space.shape)] });
            }
            echoed["description"] = parameter.about.into();
            properties.insert(parameter.name.into(), echoed);
            let is_always = [Group::Profile, Group::Table].contains(&parameter.group)
                || [&SEED, &WARP].contains(parameter);
            required.extend(is_always.then_some(parameter.name));
        }
        json_schema!({ "type": "object", "properties": properties, "required": required })
    }
}

fn is_zero(value: &Long<u128>) -> bool {
    value.0 == 0
}

/// Pairs as an object, in their order.
fn as_map<S: Serializer>(pairs: &[(String, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().map(|(name, distance)| (name, distance)))
}

fn distances(pairs: &[(String, f64)]) -> Map<String, Json> {
    let pairs = pairs.iter();
    pairs
        .map(|(name, distance)| (name.clone(), (*distance).into()))
        .collect()
}

impl Set {
    pub fn resolved(
        &self,
        all: &[Self],
        density: f64,
        spacing: Spacing,
        least_distance: f64,
        (kinds, kind_distances): (&[u128], &[KindDistance]),
    ) -> ResolvedSet {
        let names = self
            .kinds
            .iter()
            .flat_map(|kinds| kinds.variants.variants().names());
        ResolvedSet {
            name: self.name.clone(),
            region: self.region.as_ref().map(QueryRegion::full_echo),
            density,
            spacing: spacing.get(),
            least_distance,
            field_digest: self.field.as_ref().map(|field| field.digest.clone()),
            terrain_digest: self
                .terrain
                .as_ref()
                .map(|terrain| terrain.field.digest.clone()),
            variant_field_digests: self.variant_field_digests(),
            except_digest: self.except.as_ref().map(Except::digest),
            values: Echoed(self.values()),
            clear_of: self.named_clear_of(all),
            kinds: names
                .map(Into::into)
                .zip(kinds.iter().copied().map(Long))
                .collect(),
            kind_distances: kind_distances.into(),
            period: self.period.map(Period::echo),
        }
    }

    fn variant_field_digests(&self) -> BTreeMap<String, String> {
        let fields = self.kinds.iter().flat_map(|kinds| &kinds.fields);
        fields
            .map(|(name, field)| (name.clone(), field.digest.clone()))
            .collect()
    }

    fn named_clear_of(&self, all: &[Self]) -> Vec<(String, f64)> {
        let pairs = self.clear_of.iter();
        let named =
            pairs.filter_map(|&(place, distance)| Some((all.get(place)?.name.clone(), distance)));
        named.collect()
    }

    fn identity(&self, all: &[Self]) -> Json {
        let mut identity = json!({
            "name": self.name,
            "region": self.region.as_ref().map(QueryRegion::full_echo),
            "amount": self.amount,
            "clear_of": distances(&self.named_clear_of(all)),
        });
        if let Some(field) = &self.field {
            identity["field_digest"] = json!(field.digest);
        }
        if let Some(except) = &self.except {
            identity["except_digest"] = json!(except.digest());
        }
        if self.varies() {
            let digests: Vec<_> = self.variant_field_digests().into_iter().collect();
            identity["variant_field_digests"] = json!(digests);
        }
        if let Some(made) = self.kinds.as_ref().and_then(|kinds| kinds.made.as_ref()) {
            identity["kinds_table"] = json!(made.digest);
        }
        if let Some(terrain) = &self.terrain {
            identity["terrain_digest"] = json!(terrain.field.digest);
        }
        let named = [&FIELD, &VARIANT_FIELDS, &TERRAIN, &EXCEPT];
        let is_named = |parameter: &Parameter| named.contains(&parameter);
        let values = self.values();
        for (parameter, value) in values.iter().filter(|(parameter, _)| !is_named(parameter)) {
            identity[parameter.name] = json!(value);
        }
        identity
    }
}

impl QueryRegion {
    fn full_echo(&self) -> Json {
        self.echo
            .clone()
            .unwrap_or_else(|| json!({ "bbox": self.corners() }))
    }
}

impl Query {
    /// A hash of everything that the points depend on, the same for every window and format. `digests` are those of the
    /// sets' tables.
    pub fn identity(&self, digests: &[&str]) -> [u8; 32] {
        let mut document = json!({
            "algorithm": ALGORITHM_VERSION,
            "region": self.region.full_echo(),
            "sets": self.sets.iter().map(|set| set.identity(&self.sets)).collect::<Vec<_>>(),
            "tables": digests,
        });
        if let Some(only) = self.only {
            document["only"] = json!(only);
        }
        *blake3::hash(document.to_string().as_bytes()).as_bytes()
    }
}
