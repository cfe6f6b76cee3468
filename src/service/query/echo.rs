//! What answers say of the query they answer, and what tells queries apart.

use serde::Serialize;
use serde_json::{Value, json};
use strew_core::{ALGORITHM_VERSION, Spacing};

use super::{Query, Set, attributes};

/// A query as answers echo it, with everything filled in.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Resolved {
    /// min x, min y, max x, max y: a box around the region.
    pub bbox: [f64; 4],
    /// The region, unless it is that box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub region: Option<Value>,
    /// The points, if there are no layers.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub set: Option<ResolvedSet>,
    /// The layers, if there are any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<ResolvedSet>,
    /// How many points of the region come before those of the answer, if any.
    #[serde(skip_serializing_if = "is_zero")]
    pub offset: u128,
    /// How many were wanted at most.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<u64>,
}

/// A set of points as answers echo it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ResolvedSet {
    /// The name of the layer.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Where the layer is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub region: Option<Value>,
    /// Points per unit of area, before a share of them is kept and layers are kept clear of.
    pub density: f64,
    /// The mean spacing, density^−½.
    pub spacing: f64,
    /// No two points are nearer than this.
    pub least_distance: f64,
    /// The name of the noise profile.
    pub profile: String,
    /// The number α in its canonical form.
    pub alpha: String,
    /// The size of the map.
    pub map: String,
    /// The seed.
    pub seed: u64,
    /// The strength of the warp; 0 is off.
    pub warp: f64,
    /// The share of points that is kept, if not all are.
    #[serde(skip_serializing_if = "is_one")]
    pub keep: f64,
    /// The further values of points.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub attributes: Value,
    /// The layers that are kept clear of, with the distances.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub clear_of: Value,
}

fn is_zero(value: &u128) -> bool {
    *value == 0
}

fn is_one(value: &f64) -> bool {
    *value == 1.0
}

impl Set {
    /// As answers echo it, given what the amount became.
    pub(in crate::service) fn resolved(
        &self,
        all: &[Self],
        density: f64,
        spacing: Spacing,
        least_distance: f64,
    ) -> ResolvedSet {
        let has_attributes = !self.attributes.as_slice().is_empty();
        ResolvedSet {
            name: self.name.clone(),
            region: self.region.as_ref().map(super::Asked::full_echo),
            density,
            spacing: spacing.get(),
            least_distance,
            profile: self.entry.key.profile.as_ref().into(),
            alpha: self.entry.key.alpha.to_string(),
            map: self.entry.key.size.to_string(),
            seed: self.seed.0,
            warp: self.warp.strength(),
            keep: self.keep.get(),
            attributes: if has_attributes {
                attributes::echo(&self.attributes)
            } else {
                Value::Null
            },
            clear_of: self.clear_of(all),
        }
    }

    fn clear_of(&self, all: &[Self]) -> Value {
        if self.clear_of.is_empty() {
            return Value::Null;
        }
        let pair = |(place, distance): &(usize, f64)| {
            let name = all.get(*place).map(|set| set.name.clone());
            (name.unwrap_or_default(), json!(distance))
        };
        Value::Object(self.clear_of.iter().map(pair).collect())
    }

    fn asked(&self, all: &[Self]) -> Value {
        json!({
            "name": self.name,
            "region": self.region.as_ref().map(super::Asked::full_echo),
            "amount": self.amount,
            "profile": self.entry.key.profile.as_ref(),
            "alpha": self.entry.key.alpha.to_string(),
            "map": self.entry.key.size.to_string(),
            "seed": self.seed.0,
            "warp": self.warp.strength(),
            "keep": self.keep.get(),
            "attributes": attributes::echo(&self.attributes),
            "clear_of": self.clear_of(all),
        })
    }
}

impl super::Asked {
    fn full_echo(&self) -> Value {
        self.echo
            .clone()
            .unwrap_or_else(|| json!({ "bbox": self.bbox() }))
    }
}

impl Query {
    /// What tells this query's points from those of every other one, whatever part of them is
    /// asked for and in whatever format: everything a point depends on, hashed. `digests` are those
    /// of the sets' tables.
    #[must_use]
    pub fn identity(&self, digests: &[&str]) -> [u8; 32] {
        let document = json!({
            "algorithm": ALGORITHM_VERSION,
            "region": self.region.full_echo(),
            "sets": self.sets.iter().map(|set| set.asked(&self.sets)).collect::<Vec<_>>(),
            "tables": digests,
        });
        *blake3::hash(document.to_string().as_bytes()).as_bytes()
    }
}
