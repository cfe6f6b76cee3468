//! What answers say of the query they answer, and what tells queries apart.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Serialize, Serializer, ser::SerializeMap as _};
use serde_json::{Map, Value as Json, json};
use strew_core::{ALGORITHM_VERSION, Spacing, map::Twin};

use super::{
    Parameter, Query, QueryRegion, Set, Value,
    parameters::{EXCEPT, FIELD, PARAMETERS, TERRAIN, VARIANT_FIELDS},
};
use crate::service::except::Except;

/// A query as answers echo it, with everything filled in.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Resolved {
    /// min x, min y, max x, max y: a box around the region.
    pub bbox: [f64; 4],
    /// The region, unless it is that box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub region: Option<Json>,
    /// The world that a part of the query comes from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub world: Option<String>,
    /// Its digest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub world_digest: Option<String>,
    /// The one layer whose points are wanted.
    #[serde(skip_serializing_if = "Option::is_none", rename = "only")]
    pub only_layer: Option<String>,
    /// The points, if there are no layers.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub set: Option<ResolvedSet>,
    /// The layers, if there are any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<ResolvedSet>,
    /// How many points of the region come before those of the answer, if any.
    #[serde(skip_serializing_if = "is_zero")]
    pub offset: u128,
    /// The greatest number of points of the answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<u64>,
}

impl Resolved {
    /// How many points each kind has, by name, in an object for each layer if there are layers.
    #[must_use]
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

/// A set of points as answers echo it.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedSet {
    /// The name of the layer.
    pub name: String,
    /// Where the layer is.
    pub region: Option<Json>,
    /// Points per unit of area, before a share of them is kept and layers are kept clear of.
    pub density: f64,
    /// The mean spacing, density^−½.
    pub spacing: f64,
    /// No two points are nearer than this.
    pub least_distance: f64,
    /// The digest of the field.
    pub field_digest: Option<String>,
    /// The digest of the ids that are left out.
    pub except_digest: Option<String>,
    /// The digest of the terrain's field.
    pub terrain_digest: Option<String>,
    /// The parameters that say which points, with everything filled in.
    pub values: Vec<(&'static Parameter, Value)>,
    /// The layers that are kept clear of, with the distances.
    pub clear_of: Vec<(String, f64)>,
    /// The digests of the fields of variants, by the names of these.
    pub variant_field_digests: Vec<(String, String)>,
    /// How many points of the region each variant has, if they are evenly spread.
    pub kinds: Vec<(String, u128)>,
    /// The distances that points of these variants keep.
    pub kind_distances: Vec<KindDistance>,
    /// The period that the points are of.
    pub period: Option<PeriodEcho>,
}

/// A period as answers echo it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Period")]
pub struct PeriodEcho {
    /// The fraction p/q, near α, whose pattern has the period.
    pub p: u64,
    /// Its denominator.
    pub q: u64,
    /// The number of points of the period, before any are left out.
    pub points: u64,
    /// The side L, in world units.
    pub side: f64,
}

impl PeriodEcho {
    /// The period of a twin on a side.
    pub(super) const fn new(twin: Twin, side: f64) -> Self {
        Self {
            p: twin.p(),
            q: twin.q(),
            points: twin.points(),
            side,
        }
    }
}

/// The distance that the points of two evenly spread variants, or of one, keep from each other.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindDistance {
    /// The names of the variants.
    pub kinds: [String; 2],
    /// No point of one is nearer to a point of the other.
    pub least_distance: f64,
}

impl Serialize for ResolvedSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        if !self.name.is_empty() {
            map.serialize_entry("name", &self.name)?;
        }
        if let Some(region) = &self.region {
            map.serialize_entry("region", region)?;
        }
        map.serialize_entry("density", &self.density)?;
        map.serialize_entry("spacing", &self.spacing)?;
        map.serialize_entry("least_distance", &self.least_distance)?;
        for (parameter, value) in &self.values {
            map.serialize_entry(parameter.name, value)?;
        }
        if let Some(digest) = &self.except_digest {
            map.serialize_entry("except_digest", digest)?;
        }
        if let Some(digest) = &self.field_digest {
            map.serialize_entry("field_digest", digest)?;
        }
        if let Some(digest) = &self.terrain_digest {
            map.serialize_entry("terrain_digest", digest)?;
        }
        if !self.variant_field_digests.is_empty() {
            let digests: BTreeMap<&str, &str> = (self.variant_field_digests.iter())
                .map(|(name, digest)| (name.as_str(), digest.as_str()))
                .collect();
            map.serialize_entry("variant_field_digests", &digests)?;
        }
        if let Some(period) = &self.period {
            map.serialize_entry("period", period)?;
        }
        if !self.clear_of.is_empty() {
            map.serialize_entry("clear_of", &distances(&self.clear_of))?;
        }
        if !self.kinds.is_empty() {
            let kinds: BTreeMap<&str, u128> = (self.kinds.iter())
                .map(|(name, count)| (name.as_str(), *count))
                .collect();
            map.serialize_entry("kinds", &kinds)?;
        }
        if !self.kind_distances.is_empty() {
            map.serialize_entry("kind_distances", &self.kind_distances)?;
        }
        map.end()
    }
}

fn is_zero(value: &u128) -> bool {
    *value == 0
}

fn distances(pairs: &[(String, f64)]) -> Map<String, Json> {
    let pairs = pairs.iter();
    pairs
        .map(|(name, distance)| (name.clone(), (*distance).into()))
        .collect()
}

impl Set {
    /// As answers echo it, given what the amount became.
    pub(in crate::service) fn resolved(
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
            values: self.echoes().collect(),
            clear_of: self.named_clear_of(all),
            kinds: names.map(Into::into).zip(kinds.iter().copied()).collect(),
            kind_distances: kind_distances.into(),
            period: self
                .period
                .map(|period| PeriodEcho::new(period.twin, period.side)),
        }
    }

    /// The digests of the fields of variants, by name.
    fn variant_field_digests(&self) -> Vec<(String, String)> {
        let fields = self.kinds.iter().flat_map(|kinds| &kinds.fields);
        fields
            .map(|(name, field)| (name.clone(), field.digest.clone()))
            .collect()
    }

    /// The parameters with their values.
    fn echoes(&self) -> impl Iterator<Item = (&'static Parameter, Value)> {
        let echo = |parameter: &&'static Parameter| Some((*parameter, parameter.echo?(self)?));
        PARAMETERS.iter().filter_map(echo)
    }

    fn named_clear_of(&self, all: &[Self]) -> Vec<(String, f64)> {
        let pairs = self.clear_of.iter();
        let named =
            pairs.filter_map(|&(place, distance)| Some((all.get(place)?.name.clone(), distance)));
        named.collect()
    }

    /// All that its points depend on.
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
            identity["variant_field_digests"] = json!(self.variant_field_digests());
        }
        if let Some(made) = self.kinds.as_ref().and_then(|kinds| kinds.made.as_ref()) {
            identity["kinds_table"] = json!(made.digest);
        }
        if self.whole != self.keep {
            identity["whole"] = json!(self.whole.get());
        }
        if let Some(terrain) = &self.terrain {
            identity["terrain_digest"] = json!(terrain.field.digest);
        }
        let named = [&FIELD, &VARIANT_FIELDS, &TERRAIN, &EXCEPT];
        let is_named = |parameter: &Parameter| named.contains(&parameter);
        for (parameter, value) in self.echoes().filter(|(parameter, _)| !is_named(parameter)) {
            identity[parameter.name] = json!(value);
        }
        identity
    }
}

impl QueryRegion {
    fn full_echo(&self) -> Json {
        self.echo
            .clone()
            .unwrap_or_else(|| json!({ "bbox": self.bbox() }))
    }
}

impl Query {
    /// What tells this query's points from those of every other one, whatever part of them is
    /// wanted and in whatever format: everything a point depends on, hashed. `digests` are those
    /// of the sets' tables.
    #[must_use]
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
