//! The head of an answer: the query as understood, the tables, the count.

use serde::Serialize;
use serde_json::value::RawValue;

use strew_error::integer::Long;

use crate::{crs::Crs, members::write_json};

/// The head of a document, or its summary.
#[derive(Clone, Debug, Serialize)]
pub struct Head {
    /// The query as answers echo it.
    pub query: Json,
    /// The tables that answer.
    #[serde(flatten)]
    pub tables: Tables,
    /// The exact number of points.
    pub count: Long<u128>,
    /// The cursor of the points after these, if there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next: Option<String>,
    /// The plane, if it was requested.
    #[serde(skip)]
    pub crs: Option<Crs>,
}

/// The table, or that of each layer.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Tables {
    /// The table of the one set.
    Table(Json),
    /// The tables of the layers.
    Tables(Vec<Json>),
}

/// JSON that is written already.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub struct Json(Box<RawValue>);

impl Json {
    /// Something as JSON.
    pub fn of(value: &impl Serialize) -> Self {
        let mut out = vec![];
        write_json(value, &mut out);
        let text = String::from_utf8(out).unwrap_or_default();
        Self(RawValue::from_string(text).unwrap_or_else(|_| RawValue::NULL.to_owned()))
    }

    /// Its text.
    pub fn text(&self) -> &str {
        self.0.get()
    }
}

impl Head {
    /// The entries of formats with room for named texts: query and table as JSON, and the count.
    pub(crate) fn entries(&self) -> [(&'static str, String); 3] {
        [
            ("strew.query", self.query.text().into()),
            ("strew.table", self.tables.text()),
            ("strew.count", self.count.0.to_string()),
        ]
    }
}

impl Tables {
    /// The JSON under `table`, or a list of such.
    pub(crate) fn text(&self) -> String {
        match self {
            Self::Table(table) => table.text().into(),
            Self::Tables(tables) => Json::of(tables).text().into(),
        }
    }
}
