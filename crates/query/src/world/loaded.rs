//! Loading worlds: from the configuration and from a folder, at the start and again.

use std::sync::Arc;

use strew_catalog::{
    Catalog,
    named::{self, Checked, Found, NamedError, Names, Places, Reread},
};
use strew_config::Worlds as Settings;
use strew_error::{Error, Fault};

use super::{World, Worlds};
use crate::{
    Draft, Parameter, Query, Set, groups,
    parameters::{COUNT, CURSOR, OFFSET, WORLD, WORLD_DIGEST},
    read_body,
};

const ALLOWED: &str = "members of a query but region, count, offset and cursor: layers or a set of points, seed, limit and the form of answers";

fn places(settings: &Settings) -> Places<'_> {
    Places {
        section: "worlds",
        named: &settings.named,
        folder: settings.folder(),
        endings: &["json", "toml"],
        rasters: &[],
        most_bytes: 4 << 20,
    }
}

fn check(
    found: &Found,
    json: &str,
    catalog: &Catalog,
    most_vertices: usize,
) -> Result<World, String> {
    let world = World::read(found, json, catalog, most_vertices);
    world.map_err(|error| with_path(error, &found.name))
}

impl Worlds {
    /// Loads the worlds that the settings name, over the tables and fields that they are of.
    pub fn load(
        settings: &Settings,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<Self, NamedError> {
        let none = Self {
            most_vertices,
            ..Self::default()
        };
        named::all_of(none.reload(settings, catalog))
    }

    pub fn reload(&self, settings: &Settings, catalog: &Catalog) -> Reread<Self> {
        let places = places(settings);
        let before = self.over(catalog);
        let (entries, refused) = (before.entries).read(&places, |found, json| {
            check(found, json, catalog, self.most_vertices)
        });
        let changes = self.entries.changes_to(&entries);
        (Self { entries, ..*self }, changes, refused)
    }

    /// These worlds over other tables and fields, with new digests. Worlds that do not fit the new ones keep their
    /// digests, and queries that name them are refused.
    pub fn over(&self, catalog: &Catalog) -> Self {
        let renewed = |(name, world): (&String, &Arc<World>)| {
            let query = world.draft.try_out(catalog, self.most_vertices).ok();
            let digest = query.as_ref().map(|query| digest(&world.json, query));
            let renewed = World {
                digest: digest.unwrap_or_else(|| world.digest.clone()),
                sets: query.as_ref().and_then(sets),
                ..World::clone(world)
            };
            (name.clone(), Arc::new(renewed))
        };
        Self {
            entries: Names(self.entries.0.iter().map(renewed).collect()),
            ..*self
        }
    }

    /// Reads every world by itself.
    pub fn each(
        settings: &Settings,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<Vec<Checked<World>>, NamedError> {
        places(settings).each(|found, json| check(found, json, catalog, most_vertices))
    }
}

impl World {
    fn read(
        found: &Found,
        json: &str,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<Self, Error> {
        let draft = read_body(json.as_bytes(), groups::QUERY)?;
        let given = |parameter: &Parameter| (parameter.name, draft.values.has(parameter));
        for (member, is_given) in [
            ("region", !matches!(draft.region, Ok(None))),
            given(&WORLD),
            given(&WORLD_DIGEST),
            // Chunks with these would not join.
            given(&OFFSET),
            given(&CURSOR),
            given(&COUNT),
        ] {
            if is_given {
                let detail = "not allowed in a world";
                let document: Option<serde_json::Value> = serde_json::from_str(json).ok();
                let value = document.and_then(|document| Some(document.get(member)?.to_string()));
                let value = value.unwrap_or_default();
                return Err(Fault::new(member, value, detail, ALLOWED).into());
            }
        }
        let counted = (draft.layers.iter().flatten()).find(|layer| layer.values.has(&COUNT));
        if let Some(layer) = counted {
            let field = format!("{}{}", layer.values.path(), COUNT.name);
            let detail = "not allowed in a world: each chunk would have this number of points";
            let fault = Fault::new(
                &field,
                layer.values.text(&COUNT),
                detail,
                "density or spacing",
            );
            return Err(by_layer(fault.into(), &draft));
        }
        let checked = draft.try_out(catalog, most_vertices);
        let query = checked.map_err(|error| by_layer(error, &draft))?;
        Ok(Self {
            name: found.name.clone(),
            source: found.source.clone(),
            digest: digest(json, &query),
            sets: sets(&query),
            json: json.into(),
            layers: (draft.layers.iter().flatten())
                .filter_map(|layer| layer.name.clone().ok()?)
                .collect(),
            draft,
        })
    }
}

/// The sets of a checked world, if they are layers: the amount of others may come from the query.
fn sets(query: &Query) -> Option<Arc<[Set]>> {
    query.is_layered.then(|| query.sets.clone())
}

/// The digest of a document with the tables and fields of its query.
fn digest(json: &str, query: &Query) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in [json].into_iter().chain(query.digests()) {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    hasher.update(&strew_core::ALGORITHM_VERSION.to_le_bytes());
    hasher.finalize().to_hex().to_string()
}

/// Names the layers of faults by their names: `layers[2].spacing` is `layers.oak.spacing`.
pub fn by_layer(error: Error, draft: &Draft) -> Error {
    let Error::Invalid(faults) = error else {
        return error;
    };
    let renamed = faults.rename(|field| {
        let named = || {
            let (number, rest) = field.strip_prefix("layers[")?.split_once("].")?;
            let layer = draft
                .layers
                .as_ref()
                .ok()?
                .get(number.parse::<usize>().ok()?)?;
            let name = layer.name.as_ref().ok()?.as_deref()?;
            Some(format!("layers.{name}.{rest}"))
        };
        named().unwrap_or_else(|| field.into())
    });
    renamed.into()
}

/// The text of an error, whose faults begin with `worlds.NAME`.
pub fn with_path(error: Error, name: &str) -> String {
    match error {
        Error::Invalid(faults) => {
            let faults = faults.rename(|field| format!("worlds.{name}.{field}"));
            Error::from(faults).to_string()
        }
        error => error.to_string(),
    }
}
