//! The head of an answer: the query as understood, the tables, the count.

use schemars::JsonSchema;
use serde::Serialize;
use strew_catalog::{Dimension, Entry};
use strew_core::ALGORITHM_VERSION;
use strew_encode::{Answer, Crs, Head, Json, Output, Place, Tables};
use strew_error::{Error, integer::Long};
use strew_query::Resolved;

use crate::{effort, planned::Planned};

/// A query as answers echo it, with what the answer looks like.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct QueryEcho {
    #[serde(flatten)]
    resolved: Resolved,
    format: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    decimals: Option<u8>,
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<Vec<f64>>")]
    relative_to: Option<Place>,
    #[serde(skip_serializing_if = "Option::is_none")]
    size: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<String>")]
    crs: Option<Crs>,
}

/// A table that answers.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TableEcho {
    profile: String,
    alpha: String,
    /// 3 if its points lie in space.
    #[serde(skip_serializing_if = "Option::is_none")]
    dimensions: Option<u32>,
    radius: u32,
    digest: String,
    algorithm: u32,
    /// The least nearest-neighbor distance, as measured on a set the table was not made on, in units
    /// of the hexagonal lattice's at the same density.
    #[serde(skip_serializing_if = "Option::is_none")]
    delta_min: Option<f64>,
    /// The mean one.
    #[serde(skip_serializing_if = "Option::is_none")]
    delta_avg: Option<f64>,
}

impl Planned {
    /// The answer, in blocks of about `block_bytes`, less where points are costly.
    pub fn answer(&self, output: &Output, block_bytes: usize) -> Result<Answer, Error> {
        let bytes = effort::block_bytes(self, block_bytes);
        Answer::new(
            self.parts()?,
            |count| self.head(output, count),
            output,
            bytes,
        )
    }

    fn head(&self, output: &Output, count: u128) -> Head {
        let mut echoes = (self.sets.iter()).map(|set| Json::of(&TableEcho::new(&set.entry)));
        let tables = match echoes.next() {
            Some(only) if !self.query.is_layered => Tables::Table(only),
            first => Tables::Tables(first.into_iter().chain(echoes).collect()),
        };
        let query = QueryEcho {
            resolved: self.resolved(),
            format: output.encoding.name(),
            decimals: output.decimals,
            relative_to: output.relative_to,
            size: output.encoding.traits().is_picture.then_some(output.size),
            crs: output.crs.clone(),
        };
        Head {
            query: Json::of(&query),
            tables,
            count: Long(count),
            next: self.next().map(|token| token.to_string()),
            crs: output.crs.clone(),
        }
    }
}

impl TableEcho {
    fn new(entry: &Entry) -> Self {
        let Entry {
            key,
            radius,
            digest,
            ..
        } = entry;
        Self {
            profile: key.profile.as_ref().into(),
            alpha: key.alpha.to_string(),
            dimensions: (key.dimension == Dimension::Space).then(|| key.dimension.axes()),
            radius: *radius,
            digest: digest.clone(),
            algorithm: ALGORITHM_VERSION,
            delta_min: entry.measured("delta_min"),
            delta_avg: entry.measured("delta_avg"),
        }
    }
}
