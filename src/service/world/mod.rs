//! Worlds: queries that are described once, so that an address only names them.
//!
//! A world is a document with the members of a query but its region: layers or one set of points, a common seed,
//! a limit, the form of answers. [`Worlds`] holds those of the configuration and of a folder, checked against the
//! tables and fields that are loaded. A query that names one takes from it what it leaves open.

mod loaded;

use std::{borrow::Cow, collections::BTreeMap, sync::Arc};

use super::{
    Catalog, Draft, Error, Fault,
    named::{self, Found, Source},
    query::{
        Faults, Group, Query, groups,
        parameters::{EXCEPT, FIELD, ONLY, WORLD, WORLD_DIGEST},
        read_body, unknown,
    },
};

#[cfg(feature = "daemon")]
pub(crate) use loaded::with_path;

/// The worlds that are loaded, by name.
#[derive(Clone, Debug, Default)]
pub struct Worlds {
    entries: BTreeMap<String, Arc<World>>,
    /// The most vertices of the polygons of one.
    most_vertices: usize,
}

/// A world.
#[derive(Clone, Debug)]
pub struct World {
    /// Its name.
    pub name: String,
    /// Where it comes from.
    pub source: Source,
    /// The members of a query, as JSON.
    pub json: Arc<str>,
    /// The BLAKE3 digest of all that its points depend on, in hexadecimal: the document, its tables and its
    /// fields.
    pub digest: String,
    draft: Draft,
}

/// The world that a query names.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Its name.
    pub name: String,
    /// Its digest.
    pub digest: String,
    /// Whether the query names this digest, and nothing beside it that a server could change.
    pub is_pinned: bool,
}

/// What a world may be.
const ALLOWED: &str =
    "members of a query: layers or a set of points, seed, limit and the form of answers";

impl Worlds {
    /// The world of a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Arc<World>> {
        self.entries.get(name)
    }

    /// All worlds, by name.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Arc<World>> {
        self.entries.values()
    }

    /// The names, for faults.
    #[must_use]
    pub fn names(&self) -> String {
        named::listed("world", self.entries.keys().map(String::as_str))
    }

    /// A draft with what it lacks taken from the world that it names, and that world.
    ///
    /// # Errors
    /// [`Error::Invalid`] if there is none of that name, and [`Error::OtherWorld`] if it has another digest than
    /// the draft wants.
    pub fn fill<'a>(&self, draft: &'a Draft) -> Result<(Cow<'a, Draft>, Option<Named>), Error> {
        let pin = draft.values.get::<String>(&WORLD_DIGEST);
        let (Ok(named), Ok(pin)) = (draft.values.get::<String>(&WORLD), pin) else {
            // What could not be read is a fault of the draft.
            return Ok((Cow::Borrowed(draft), None));
        };
        let Some(name) = named else {
            return match pin {
                Some(_) => {
                    let detail = "has no effect without world";
                    Err(draft.values.fault(&WORLD_DIGEST, detail).into())
                }
                None => Ok((Cow::Borrowed(draft), None)),
            };
        };
        let Some(world) = self.get(&name) else {
            return Err(self.no_world(draft).into());
        };
        let pin = pin.map(|pin| pin.to_lowercase());
        if let Some(pinned) = pin.as_ref().filter(|pin| **pin != world.digest) {
            return Err(Error::OtherWorld {
                name,
                pinned: pinned.clone(),
                loaded: world.digest.clone(),
            });
        }
        let used = Named {
            is_pinned: pin.is_some() && world.is_whole_of(draft),
            digest: world.digest.clone(),
            name,
        };
        let mut draft = draft.clone();
        draft.fill_from(&world.draft);
        Ok((Cow::Owned(draft), Some(used)))
    }

    fn no_world(&self, draft: &Draft) -> Faults {
        let name = draft.values.text(&WORLD);
        let names = self.entries.keys().map(String::as_str);
        let fault = Fault {
            allowed: self.names(),
            ..draft.values.fault(&WORLD, unknown("world", &name, names))
        };
        fault.into()
    }

    /// The same worlds over other tables and fields: their digests follow. Worlds that these do not fit keep
    /// theirs, and queries that name them are refused.
    #[must_use]
    pub fn over(&self, catalog: &Catalog) -> Self {
        let renewed = |(name, world): (&String, &Arc<World>)| {
            let query = world.draft.try_out(catalog, self.most_vertices);
            let digest = query.map(|query| digest(&world.json, &query));
            let world = match digest {
                Ok(digest) if digest != world.digest => Arc::new(World {
                    digest,
                    ..World::clone(world)
                }),
                _ => Arc::clone(world),
            };
            (name.clone(), world)
        };
        Self {
            entries: self.entries.iter().map(renewed).collect(),
            ..*self
        }
    }
}

impl World {
    /// Reads and checks a document.
    fn read(
        found: &Found,
        json: &str,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<Self, Error> {
        let draft = read_body(json.as_bytes(), groups::QUERY)?;
        for (member, is_given) in [
            ("region", !matches!(draft.region, Ok(None))),
            (WORLD.name, draft.values.has(&WORLD)),
            (WORLD_DIGEST.name, draft.values.has(&WORLD_DIGEST)),
        ] {
            if is_given {
                let detail = "not allowed in a world";
                return Err(Fault::new(member, json, detail, ALLOWED).into());
            }
        }
        let checked = draft.try_out(catalog, most_vertices);
        let query = checked.map_err(|error| by_layer(error, &draft))?;
        Ok(Self {
            name: found.name.clone(),
            source: found.source.clone(),
            digest: digest(json, &query),
            json: json.into(),
            draft,
        })
    }

    /// The members of a query, without a region.
    #[must_use]
    pub const fn draft(&self) -> &Draft {
        &self.draft
    }

    /// The names of its layers.
    pub fn layers(&self) -> impl Iterator<Item = &str> {
        let layers = self.draft.layers.iter().flatten();
        layers.filter_map(|layer| layer.name.as_ref().ok()?.as_deref())
    }

    /// Whether all that a server could change of a query comes from the world.
    fn is_whole_of(&self, draft: &Draft) -> bool {
        let own = [Group::Profile, Group::Table, Group::Attributes];
        let is_own = |(parameter, _): (&'static _, &_)| {
            let parameter: &super::query::Parameter = parameter;
            [&FIELD, &EXCEPT].contains(&parameter)
                || own.contains(&parameter.group) && *parameter != ONLY
        };
        matches!(&draft.layers, Ok(layers) if layers.is_empty())
            && !draft.values.given().any(is_own)
    }
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
#[must_use]
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

#[cfg(test)]
mod tests;
