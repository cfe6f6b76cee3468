//! The service within a program, without a daemon: queries go in as text, points come out as columns.
//!
//! The bindings for other languages use it. A [`Library`] reads the bodies and the addresses that
//! REST takes, of the plane and of space, refuses them with the same words, and has the same points. It answers in the calling thread and
//! fills large answers on all threads of rayon's pool.

mod columns;
#[cfg(feature = "measure")]
pub mod measured;
mod work;

use std::{
    collections::HashMap,
    path::Path,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use strew_catalog::{
    Catalog, CatalogError, Entry, Ready,
    field::{self, Allowance, Document, Fields, NamedField},
    mix::{self, Made},
    named::NamedError,
    sent::Sender,
};
#[cfg(feature = "shipped")]
use strew_config::Layers;
use strew_config::{ConfigError, Limits};
use strew_core::{Table, server::Visits};
use strew_encode::{Answer, Encoding, Output, Place};
use strew_error::{Audience, Error, Fault};
use strew_query as query;
use strew_query::{
    Assets, Draft, Group, Nearest, Options, Query, Set, Token, Values, groups, parse_pairs,
    read_body,
};

use crate::{
    Found, Placed, Planned,
    store::{self, Store},
};

pub use columns::{Columns, Further, FurtherValues};
#[cfg(feature = "measure")]
pub use measured::{Measured, measure};
pub use work::Work;

/// Clones have the same tables and fields.
#[derive(Clone, Debug)]
pub struct Library {
    assets: Arc<Assets>,
    limits: Limits,
    work: Work,
    /// Tables that were used, by their digests; mixes by those and their shares.
    ready: Arc<Mutex<HashMap<String, Ready>>>,
}

/// Why there is no library.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Unavailable {
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error(transparent)]
    Catalog(#[from] CatalogError),
    #[error(transparent)]
    Field(#[from] NamedError),
}

/// The most pixels that a query of a program may include: a program has them in memory anyway.
pub const MOST_PIXELS: usize = 1 << 28;
/// The most memory of fields that are held to be named, in bytes.
const ROOM: usize = 1 << 30;

impl Library {
    /// The built-in tables and fields, with the limits that a daemon has by default.
    ///
    /// # Errors
    /// [`Unavailable`] only if the program is damaged.
    pub fn new() -> Result<Self, Unavailable> {
        Self::open(None)
    }

    /// A library that also has the tables of a folder, if there is one; they replace built-in ones with the same key.
    ///
    /// # Errors
    /// [`Unavailable`] with the file that cannot be read.
    pub fn open(folder: Option<&Path>) -> Result<Self, Unavailable> {
        let catalog = Catalog::load(true, folder)?.with_fields(shipped_fields()?);
        Ok(Self::of(catalog, Limits::default()))
    }

    /// The tables of these files alone, without fields, with the limits that a daemon has by default.
    ///
    /// # Errors
    /// [`Unavailable`] with the number of the file that is no table.
    pub fn of_tables(files: impl IntoIterator<Item = Vec<u8>>) -> Result<Self, Unavailable> {
        Ok(Self::of(Catalog::of_files(files)?, Limits::default()))
    }

    #[must_use]
    pub fn of(catalog: Catalog, limits: Limits) -> Self {
        let catalog = catalog.with_room(ROOM).with_pixels(MOST_PIXELS);
        Self {
            assets: Arc::new(catalog.with_audience(&Audience::PROCESS).into()),
            limits,
            work: Work::default(),
            ready: Arc::default(),
        }
    }

    /// This library for work that may be stopped, with limits of its own.
    #[must_use]
    pub fn with(&self, work: Work, limits: Limits, pixels: usize) -> Self {
        let mut own = self.clone();
        if pixels != own.catalog().most_pixels() {
            let assets = Arc::make_mut(&mut own.assets);
            assets.catalog = assets.catalog.clone().with_pixels(pixels);
        }
        Self {
            work,
            limits,
            ..own
        }
    }

    /// The library with the audience of its errors.
    #[must_use]
    pub fn for_audience(mut self, audience: &'static Audience) -> Self {
        let assets = Arc::make_mut(&mut self.assets);
        assets.catalog = assets.catalog.clone().with_audience(audience);
        self
    }

    #[must_use]
    pub fn catalog(&self) -> &Catalog {
        &self.assets.catalog
    }

    #[must_use]
    pub const fn limits(&self) -> &Limits {
        &self.limits
    }

    #[must_use]
    pub const fn work(&self) -> &Work {
        &self.work
    }

    /// Plans the query of a body of `POST /v1/points:query`: its points are counted and not made yet.
    ///
    /// # Errors
    /// The error that the daemon answers to this body, except for too many points.
    pub fn plan(&self, body: &[u8]) -> Result<(Planned, Options), Error> {
        self.plan_draft(&read_body(body, groups::QUERY)?)
    }

    /// Plans the query of an address, the text after `/v1/points?`.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub fn plan_address(&self, address: &str) -> Result<(Planned, Options), Error> {
        self.plan_draft(&Draft::of(parse_pairs(address, groups::POINTS)))
    }

    /// Plans the query of a body of `POST /v1/space/points`.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub fn plan_in_space(&self, body: &[u8]) -> Result<(Planned, Options), Error> {
        self.plan_draft(&read_body(body, groups::SPACE_QUERY)?)
    }

    /// Reads a query: a body if it begins with `{`, else an address. It is not checked yet.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a body that is not JSON.
    pub fn read(text: &str) -> Result<Draft, Error> {
        read(text, groups::QUERY, groups::POINTS)
    }

    /// Reads a query in space: a body of `POST /v1/space/points`, or the text after `/v1/space/points?`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_in_space(text: &str) -> Result<Draft, Error> {
        read(text, groups::SPACE_QUERY, groups::SPACE_POINTS)
    }

    /// Plans a query.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub fn plan_draft(&self, draft: &Draft) -> Result<(Planned, Options), Error> {
        let (query, options) = draft.check(&self.assets, self.limits.max_vertices)?;
        Ok((self.planned(query)?, options))
    }

    fn planned(&self, query: Query) -> Result<Planned, Error> {
        // Tables in space are ready as they are.
        let flat = query.sets.iter().filter(|set| set.space().is_none());
        let tables = flat.map(|set| store::ready(set, self));
        let tables = tables.collect::<Result<Vec<_>, _>>()?;
        Planned::unless_stopped(query, &tables, &self.limits, &self.work.stop)
    }

    /// The points of a planned query.
    ///
    /// # Errors
    /// [`Error::TooManyPoints`] over the limit, [`Error::Internal`] without memory for them.
    pub fn columns(&self, planned: &Planned) -> Result<Columns, Error> {
        Columns::of(planned, self.count_to_make(planned)?, &self.work)
    }

    /// The coordinates of a planned query's points alone, which takes a fraction of the time: as many numbers for each
    /// point as it has [`axes`](Planned::axes).
    ///
    /// # Errors
    /// As [`columns`](Self::columns).
    pub fn coordinates(&self, planned: &Planned) -> Result<Vec<f64>, Error> {
        columns::coordinates(planned, self.count_to_make(planned)?, &self.work)
    }

    /// Writes the coordinates of a planned query's points to the beginning of `at`, and returns their number.
    ///
    /// # Errors
    /// As [`columns`](Self::columns); [`Error::Invalid`] if `at` is too short.
    pub fn fill_coordinates(&self, planned: &Planned, at: &mut [f64]) -> Result<usize, Error> {
        let at = self.places(planned, at)?;
        columns::fill_coordinates(planned, at, &self.work)?;
        Ok(at.len() / planned.axes())
    }

    /// Writes the offsets of a planned query's points to the beginning of `at`: the coordinates of the format `f32`.
    /// Returns their number and their origin.
    ///
    /// # Errors
    /// As [`fill_coordinates`](Self::fill_coordinates).
    pub fn fill_offsets(&self, planned: &Planned, at: &mut [f32]) -> Result<(usize, Place), Error> {
        let at = self.places(planned, at)?;
        let origin = columns::fill_offsets(planned, at)?;
        Ok((at.len() / planned.axes(), origin))
    }

    fn places<'a, T>(&self, planned: &Planned, room: &'a mut [T]) -> Result<&'a mut [T], Error> {
        let (count, axes) = (self.count_to_make(planned)?, planned.axes());
        let length = room.len() / axes;
        room.get_mut(..count.saturating_mul(axes)).ok_or_else(|| {
            let detail = format!("has room for fewer than the {count} points");
            Fault::new("capacity", length, detail, format!("{count} or more")).into()
        })
    }

    /// The points of a planned query as a document: the bytes that the daemon answers with. The options are
    /// [of the plane](Options::of_plane) that the query is in.
    ///
    /// # Errors
    /// [`Error::Invalid`] if an option has no effect in the format or the format is not written here;
    /// [`Error::TooManyPoints`] over the limit.
    pub fn document(
        &self,
        planned: &Planned,
        options: Options,
        otherwise: Encoding,
    ) -> Result<Answer, Error> {
        self.count_to_make(planned)?;
        let encoding = options.encoding.unwrap_or(otherwise);
        let output = Output {
            relative_to: planned.query.region.corner,
            ..options.output(encoding)?
        };
        planned.answer(&output, self.limits.block_bytes)
    }

    /// Splits a planned query into parts of equal size, give or take one point: the cursor at which each begins, and
    /// its number of points. With `cursor` and `limit` set to these, the query has the points of the part.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a number of parts that is not allowed, else as [`Planned::split`].
    pub fn split(&self, planned: &Planned, parts: &str) -> Result<Vec<(Token, u64)>, Error> {
        let mut values = Values::new(groups::SPLIT, "");
        values.add_text(query::parameters::PARTS.name, parts);
        planned.split(query::parts(&values)?)
    }

    /// The point of an id, in the set of an address: the text after `/v1/points/{id}?`.
    pub fn point(&self, id: &str, address: &str) -> Result<Found, Error> {
        self.point_of(id, &parse_pairs(address, groups::SINGLE))
    }

    /// The point in space of an id, in the set of an address: the text after `/v1/space/points/{id}?`.
    pub fn point_in_space(&self, id: &str, address: &str) -> Result<Found, Error> {
        self.point_of(id, &parse_pairs(address, groups::SPACE_SINGLE))
    }

    fn point_of(&self, id: &str, set: &Values) -> Result<Found, Error> {
        let set = Set::single(set, &self.assets.catalog)?;
        self.placed(set)?.point(id)
    }

    /// The points nearest to a place, by an address: the text after `/v1/nearest?`.
    pub fn nearest(&self, address: &str) -> Result<Vec<Found>, Error> {
        self.nearest_of(&parse_pairs(address, groups::NEAREST))
    }

    /// The points in space nearest to a place, by an address: the text after `/v1/space/nearest?`.
    pub fn nearest_in_space(&self, address: &str) -> Result<Vec<Found>, Error> {
        self.nearest_of(&parse_pairs(address, groups::SPACE_NEAREST))
    }

    fn nearest_of(&self, values: &Values) -> Result<Vec<Found>, Error> {
        let (set, nearest) = Nearest::of_set(values, &self.assets.catalog)?;
        let visits = Visits::new(usize::MAX, self.work.stop.clone());
        self.placed(set)?.nearest_visiting(nearest, &visits)
    }

    /// Holds a field, a body of `POST /v1/fields`, and returns the digest by which queries name it.
    pub fn hold_field(&self, body: &str) -> Result<String, Error> {
        let document = field::read_json("field", body)?;
        let held = hold_field(
            &self.assets.catalog,
            document,
            self.assets.catalog.most_pixels(),
            Allowance::UNLIMITED,
            Sender::default(),
        )?;
        Ok(held.name.clone())
    }

    fn placed(&self, set: Box<Set>) -> Result<Placed, Error> {
        if set.space().is_some() {
            return Placed::in_space(set);
        }
        let ready = store::ready(&set, self)?;
        Placed::new(set, ready)
    }

    /// The number of points of a planned query.
    ///
    /// # Errors
    /// [`Error::TooManyPoints`] for more than an answer may have.
    pub fn count_to_make(&self, planned: &Planned) -> Result<usize, Error> {
        let (count, limit) = (planned.count(), self.limits.max_points);
        match usize::try_from(count) {
            Ok(few) if count <= u128::from(limit) => Ok(few),
            _ => Err(Error::TooManyPoints { count, limit }),
        }
    }

    /// The table of a name. It is made without the lock, so that other calls go on meanwhile.
    fn kept(
        &self,
        name: &str,
        make: impl FnOnce() -> Result<Ready, Error>,
    ) -> Result<Ready, Error> {
        if let Some(known) = self.known().get(name) {
            return Ok(known.clone());
        }
        let made = make()?;
        self.known().insert(name.into(), made.clone());
        Ok(made)
    }

    fn known(&self) -> MutexGuard<'_, HashMap<String, Ready>> {
        self.ready.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(feature = "shipped")]
fn shipped_fields() -> Result<Fields, Unavailable> {
    Ok(Fields::load(&Layers::new()?.finish()?.fields)?)
}

/// No fields: they are written as TOML, whose parser is as large as a table.
#[cfg(not(feature = "shipped"))]
fn shipped_fields() -> Result<Fields, Unavailable> {
    Ok(Fields::default())
}

/// Reads a query of some parameters: a body, or an address, which may have the region among them.
fn read(text: &str, body: &'static [Group], address: &'static [Group]) -> Result<Draft, Error> {
    let text = text.trim();
    match text.starts_with('{') {
        true => Ok(read_body(text.as_bytes(), body)?),
        false => Ok(Draft::of(parse_pairs(text, address))),
    }
}

/// Tables are read, and mixes made, the first time.
impl Store for Library {
    fn load(&self, entry: &Arc<Entry>) -> Result<Ready, Error> {
        self.kept(&entry.digest, || Ready::load(entry))
    }

    fn make(&self, plain: &Ready, what: &Made) -> Result<Table, Error> {
        let name = format!("{} {what}", plain.entry.digest);
        let made = self.kept(&name, || {
            let table = mix::make(&plain.table, what, &self.work.stop)?;
            Ok(Ready::new(plain.entry.clone(), table))
        })?;
        Ok(made.table)
    }
}

/// Holds a field that a client sends, of a limited number of pixels, under its digest.
///
/// # Errors
/// [`Error::Invalid`] for a field that is not valid or too large to be held.
pub fn hold_field(
    catalog: &Catalog,
    document: Document,
    pixels: usize,
    allowance: Allowance<'_>,
    sender: Sender,
) -> Result<Arc<NamedField>, Error> {
    let (spec, built) = catalog.build_field("field", &document, pixels, allowance);
    if let Some(error) = built.refused {
        return Err(error);
    }
    let field = NamedField::sent(document, spec?, built.bytes, built.frame);
    catalog.sent().hold(field, sender).ok_or_else(|| {
        let detail = format!("takes {} bytes, which there is no room for", built.bytes);
        Fault::new("field", "", detail, catalog.audience().field).into()
    })
}

#[cfg(test)]
mod tests;
