//! What an answer says about itself: the query as understood, the table, the count.

#[cfg(feature = "daemon")]
use schemars::JsonSchema;
use serde::Serialize;
use strew_core::ALGORITHM_VERSION;

use super::{Output, crs::Crs, members::write_json};
use crate::service::{Entry, Planned, query::Resolved};

/// The head of a document, or its summary.
#[cfg_attr(feature = "daemon", derive(JsonSchema))]
#[derive(Clone, Debug, Serialize)]
pub(super) struct Head {
    pub(super) query: QueryEcho,
    #[serde(flatten)]
    pub(super) tables: Tables,
    pub(super) count: u128,
    /// The cursor of the points after these, if there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) next: Option<String>,
}

/// The table, or that of each layer.
#[cfg_attr(feature = "daemon", derive(JsonSchema))]
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Tables {
    Table(TableEcho),
    Tables(Vec<TableEcho>),
}

#[cfg_attr(feature = "daemon", derive(JsonSchema))]
#[derive(Clone, Debug, Serialize)]
/// A query as answers echo it, with what the answer looks like.
pub struct QueryEcho {
    #[serde(flatten)]
    resolved: Resolved,
    format: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    decimals: Option<u8>,
    #[serde(skip_serializing_if = "Option::is_none")]
    relative_to: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    size: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    crs: Option<Crs>,
}

#[cfg_attr(feature = "daemon", derive(JsonSchema))]
#[derive(Clone, Debug, Serialize)]
/// A table that answers.
pub struct TableEcho {
    profile: String,
    alpha: String,
    radius: u32,
    pub(super) digest: String,
    algorithm: u32,
    /// The least nearest-neighbor distance, as measured on a set the table was not made on, in units
    /// of the hexagonal lattice's at the same density.
    #[serde(skip_serializing_if = "Option::is_none")]
    delta_min: Option<f64>,
    /// The mean one.
    #[serde(skip_serializing_if = "Option::is_none")]
    delta_avg: Option<f64>,
}

impl Head {
    /// The plane, if it was requested.
    pub(super) const fn crs(&self) -> Option<&Crs> {
        self.query.crs.as_ref()
    }

    /// What formats with room for named texts hold: query and table as JSON, and the count.
    pub(super) fn entries(&self) -> [(&'static str, String); 3] {
        fn json(value: &impl Serialize) -> String {
            let mut out = vec![];
            write_json(value, &mut out);
            String::from_utf8_lossy(&out).into_owned()
        }
        [
            ("strew.query", json(&self.query)),
            ("strew.table", json(&self.tables.content())),
            ("strew.count", self.count.to_string()),
        ]
    }

    pub(super) fn new(planned: &Planned, output: &Output, count: u128) -> Self {
        let mut echoes = planned.sets.iter().map(|set| TableEcho::new(&set.entry));
        let tables = match echoes.next() {
            Some(only) if !planned.query.is_layered => Tables::Table(only),
            first => Tables::Tables(first.into_iter().chain(echoes).collect()),
        };
        Self {
            query: QueryEcho {
                resolved: planned.resolved(),
                format: output.encoding.name(),
                decimals: output.decimals,
                relative_to: output.relative_to,
                size: output.encoding.is_picture().then_some(output.size),
                crs: output.crs.clone(),
            },
            tables,
            count,
            next: planned.next().map(|token| token.to_string()),
        }
    }
}

impl Tables {
    /// What stands under `table`, or a list of such.
    pub(super) fn content(&self) -> serde_json::Value {
        let written = match self {
            Self::Table(table) => serde_json::to_value(table),
            Self::Tables(tables) => serde_json::to_value(tables),
        };
        written.unwrap_or_default()
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
            radius: *radius,
            digest: digest.clone(),
            algorithm: ALGORITHM_VERSION,
            delta_min: entry.measured("delta_min"),
            delta_avg: entry.measured("delta_avg"),
        }
    }
}
