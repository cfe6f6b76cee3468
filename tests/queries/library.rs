//! The library as tests ask it: the built-in tables, and queries as clients send them.

use std::{collections::BTreeMap, sync::OnceLock};

use serde_json::Value;
use strew::{
    config::Layers,
    service::{Catalog, Error, Key, Limits, Planned, Query, Ready, query::read_body},
};

/// The built-in tables, ready, by their digests.
pub struct World {
    pub catalog: Catalog,
    ready: BTreeMap<String, Ready>,
    pub limits: Limits,
}

/// The one there is.
pub fn world() -> &'static World {
    static ONCE: OnceLock<World> = OnceLock::new();
    ONCE.get_or_init(|| {
        let catalog = Catalog::load(true, None).expect("built in");
        let ready = catalog.entries().map(|entry| {
            let ready = Ready::load(entry).expect("in order");
            (entry.key.to_string(), ready)
        });
        let settings = Layers::new().and_then(Layers::finish).expect("in order");
        World {
            ready: ready.collect(),
            limits: settings.limits,
            catalog,
        }
    })
}

impl World {
    /// Every table, and whether it promises a distance.
    pub fn keys(&self) -> (Vec<Key>, Vec<bool>) {
        let promises = |ready: &Ready| ready.least.with_warp(strew_core::Warp::OFF) > 0.1;
        let all = self.ready.values();
        all.map(|ready| (ready.entry.key.clone(), promises(ready)))
            .unzip()
    }

    /// A query as a client sends it, checked.
    pub fn query(&self, body: &Value) -> Result<Query, Error> {
        let body = read_body(body.to_string().as_bytes())?;
        body.draft.check(&self.catalog, 10_000, body.faults)
    }

    /// The same, planned.
    pub fn planned(&self, body: &Value) -> Result<Planned, Error> {
        let query = self.query(body)?;
        let of = |set: &strew::service::Set| self.ready[&set.entry.key.to_string()].clone();
        let tables: Vec<Ready> = query.sets.iter().map(of).collect();
        Planned::new(query, &tables, &self.limits)
    }
}
