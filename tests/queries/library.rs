//! The library without a server: the built-in tables, and queries as clients send them.

use std::{collections::BTreeMap, sync::OnceLock};

use serde_json::Value;
use strew_catalog::{Catalog, Key, Ready};
use strew_config::{Layers, Limits};
use strew_error::Error;
use strew_plan::Planned;
use strew_query::{Query, groups, read_body};

/// The built-in tables, and what a daemon with default settings makes of a query.
pub struct Library {
    pub catalog: Catalog,
    pub ready: BTreeMap<String, Ready>,
    pub limits: Limits,
}

/// The library, loaded on first use.
pub fn library() -> &'static Library {
    static ONCE: OnceLock<Library> = OnceLock::new();
    ONCE.get_or_init(|| {
        let catalog = Catalog::load(true, None).expect("built in");
        let ready = catalog.entries().map(|entry| {
            let ready = Ready::load(entry).expect("valid");
            (entry.key.to_string(), ready)
        });
        let settings = Layers::new().and_then(Layers::finish).expect("valid");
        Library {
            ready: ready.collect(),
            limits: settings.limits,
            catalog,
        }
    })
}

impl Library {
    /// The key of every table, and whether the table guarantees a distance.
    pub fn keys(&self) -> (Vec<Key>, Vec<bool>) {
        let promises = |ready: &Ready| {
            ready
                .table
                .least_distance()
                .with_warp(strew_core::Warp::OFF)
                > 0.1
        };
        let all = self.ready.values();
        all.map(|ready| (ready.entry.key.clone(), promises(ready)))
            .unzip()
    }

    /// Checks a query, as JSON.
    pub fn query(&self, body: &Value) -> Result<Query, Error> {
        let draft = read_body(body.to_string().as_bytes(), groups::QUERY)?;
        let (query, _) = draft.check(&self.catalog.clone().into(), 10_000)?;
        Ok(query)
    }

    /// Checks and plans a query, as JSON.
    pub fn planned(&self, body: &Value) -> Result<Planned, Error> {
        let query = self.query(body)?;
        let of = |set: &strew_query::Set| self.ready[&set.entry.key.to_string()].clone();
        let tables: Vec<Ready> = query.sets.iter().map(of).collect();
        Planned::new(query, &tables, &self.limits)
    }
}

/// A JSON object with further members.
pub fn with(body: &Value, members: &[(&str, Value)]) -> Value {
    let mut body = body.clone();
    for (name, value) in members {
        body[*name] = value.clone();
    }
    body
}
