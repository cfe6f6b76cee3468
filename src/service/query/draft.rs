//! Drafts: queries as they were read, with their faults in their places, not checked yet.

use std::sync::Arc;

use serde_json::{Map, Value as Json};
use strew_core::{Keep, Placement, Seed, Warp};

use super::{
    Amount, Checked, Kinds, LayerDraft, MOST_LAYERS, Query, QueryRegion, RegionDraft, Set,
    Together as _, Value, Values, Window, attributes,
    cursor::Token,
    except,
    faults::all,
    field::Loaded,
    parameter::{Group, Parameter, groups, unknown},
    parameters::{
        BBOX, CRS, CURSOR, DECIMALS, EXCEPT, FORMAT, KEEP, LIMIT, OFFSET, ONLY, PARTS, PERIODIC,
        SEED, SIZE, SUMMARY, WARP, WORLD, WORLD_DIGEST,
    },
    period::Period,
    region::REGION,
    table, terrain,
    text::parse_pairs,
};
use crate::service::{Catalog, Encoding, Entry, Error, Fault, encode::Options, field::Allowance};

/// A query as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// Where; it must be there.
    pub region: Checked<Option<RegionDraft>>,
    /// The set of points, if there are no layers; the window, and what the answer looks like.
    pub values: Values,
    /// The layers; none if there is one set.
    pub layers: Checked<Vec<LayerDraft>>,
}

impl Draft {
    /// A query of one set, without a region yet.
    #[must_use]
    pub const fn new(values: Values) -> Self {
        Self {
            region: Ok(None),
            values,
            layers: Ok(vec![]),
        }
    }

    /// A query by the parameters of an address, which may hold its region.
    #[must_use]
    pub fn of(values: Values) -> Self {
        Self {
            region: RegionDraft::of(&values),
            ..Self::new(values)
        }
    }

    /// The same query in another region.
    #[must_use]
    pub fn within(mut self, region: Checked<RegionDraft>) -> Self {
        self.region = region.map(Some);
        self
    }

    /// Takes over what a world has and this query lacks.
    pub fn fill_from(&mut self, world: &Self) {
        self.values.replace(&WORLD, None);
        self.values.replace(&WORLD_DIGEST, None);
        let is_layered =
            |layers: &Checked<Vec<LayerDraft>>| !matches!(layers, Ok(layers) if layers.is_empty());
        let groups = if is_layered(&self.layers) {
            // They take the place of all sets of the world.
            groups::ANSWER
        } else {
            self.layers.clone_from(&world.layers);
            self.join_except(world);
            groups::QUERY
        };
        self.values.fill_from(&world.values, groups);
    }

    /// Leaves out what a world leaves out, too: what was taken away stays away.
    fn join_except(&mut self, world: &Self) {
        let items = |draft: &Self| draft.values.get::<Vec<String>>(&EXCEPT).ok().flatten();
        if let (Some(mut own), Some(others)) = (items(self), items(world)) {
            let more: Vec<String> = others
                .into_iter()
                .filter(|item| !own.contains(item))
                .collect();
            own.extend(more);
            self.values.replace(&EXCEPT, Some(Value::Names(own)));
        }
    }

    /// Whether all of it could be read. What it means is not checked.
    ///
    /// # Errors
    /// Every fault.
    pub fn read(&self) -> Checked<()> {
        let region = self.region.as_ref().map(drop).map_err(Clone::clone);
        let layers = match &self.layers {
            Ok(layers) => all(layers.iter().map(LayerDraft::read)).map(drop),
            Err(faults) => Err(faults.clone()),
        };
        (self.values.read(), region, layers).together().map(drop)
    }

    /// Checks a part of a query, with a region and an amount of its own in place of those that it lacks.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn try_out(&self, catalog: &Catalog, most_vertices: usize) -> Result<Query, Error> {
        let whole = self.tried("bbox=0,0,1,1");
        Ok(whole.check(catalog, most_vertices)?.0)
    }

    /// A part of a query, made whole with a region and an amount where it has none.
    #[must_use]
    pub fn tried(&self, region: &str) -> Self {
        let missing = parse_pairs(&format!("{region}&spacing=1"), groups::COUNT);
        let mut whole = self.clone();
        if !self.values.has(&PERIODIC) {
            whole.region = RegionDraft::of(&missing);
        }
        if matches!(&self.layers, Ok(layers) if layers.is_empty()) {
            whole.values.fill_from(&missing, groups::SET);
        }
        whole
    }

    /// Checks everything against what is loaded; `most_vertices` bounds the polygons of all regions.
    ///
    /// # Errors
    /// [`Error::Invalid`] with every fault, [`Error::OtherTable`] if a pinned table is not loaded.
    pub fn check(
        &self,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<(Query, Options), Error> {
        self.check_within(catalog, most_vertices, Allowance::UNLIMITED)
    }

    /// As [`check`](Self::check), with no more than is allowed.
    ///
    /// # Errors
    /// As [`check`](Self::check), and why there is no memory.
    pub fn check_within(
        &self,
        catalog: &Catalog,
        most_vertices: usize,
        allowance: Allowance<'_>,
    ) -> Result<(Query, Options), Error> {
        let (draft, world) = self.filled(catalog.worlds())?;
        let (mut query, options) = draft.check_whole(catalog, most_vertices, allowance)?;
        query.world = world;
        Ok((query, options))
    }

    /// Checks a query that takes nothing from a world.
    fn check_whole(
        &self,
        catalog: &Catalog,
        most_vertices: usize,
        allowance: Allowance<'_>,
    ) -> Result<(Query, Options), Error> {
        self.check_vertices(most_vertices)?;
        let loaded = Loaded::new(catalog, allowance);
        let sets = match &self.layers {
            Ok(layers) if layers.is_empty() => self.alone(&loaded).map(|set| vec![set]),
            Ok(layers) => self.layers(layers, &loaded),
            Err(faults) => Err(faults.clone()),
        };
        loaded.had_room()?;
        let (read, region, sets, window, options) = (
            self.values.read(),
            self.region(),
            sets,
            window(&self.values),
            options(&self.values),
        );
        let ((), region, sets, window, options) =
            (read, region, sets, window, options).together()?;
        let region = match (region, sets.first().and_then(|set| set.period)) {
            (Some(region), _) => region,
            (None, Some(period)) => period.region()?,
            (None, None) => return Err(Fault::missing("region", REGION).into()),
        };
        for set in &sets {
            table::hold(&set.entry, set.pin.as_deref())?;
        }
        let query = Query {
            region,
            sets: sets.into(),
            is_layered: !matches!(&self.layers, Ok(layers) if layers.is_empty()),
            window,
            world: None,
            only: self.only()?,
        };
        Ok((query, options))
    }

    /// Polygons are only read if there are not too many vertices.
    fn check_vertices(&self, most: usize) -> Result<(), Fault> {
        let layers = self.layers.iter().flatten().map(|layer| &layer.region);
        let regions = [&self.region].into_iter().chain(layers).flatten().flatten();
        let with_any = regions.filter(|region| region.vertices() > 0);
        let vertices: usize = with_any.clone().map(RegionDraft::vertices).sum();
        match with_any.clone().next() {
            Some(first) if vertices > most => Err(Fault::new(
                &first.path,
                format!("{vertices} vertices"),
                "the regions of the query have too many vertices in all",
                format!("at most {most}"),
            )),
            _ => Ok(()),
        }
    }

    /// The region; none for a period.
    fn region(&self) -> Checked<Option<QueryRegion>> {
        match &self.region {
            Ok(Some(region)) if self.values.has(&PERIODIC) => {
                let detail = "not with periodic: a period is [0, L)² and has no region";
                let allowed = "either a region or periodic";
                Err(Fault::new(&region.path, region.echo(), detail, allowed).into())
            }
            Ok(None) if self.values.has(&PERIODIC) => Ok(None),
            Ok(Some(region)) => region.check().map(Some),
            Ok(None) if self.values.takes().any(|p| p.group == Group::Region) => Err(
                Fault::missing(BBOX.name, "one of bbox, circle and polygon, or periodic").into(),
            ),
            Ok(None) => Err(Fault::missing("region", REGION).into()),
            Err(faults) => Err(faults.clone()),
        }
    }

    /// The one set.
    fn alone(&self, loaded: &Loaded<'_>) -> Checked<Set> {
        let except = except::of_set(&self.values, loaded.catalog);
        let (set, except) = (Set::of(&self.values, loaded), except).together()?;
        Ok(Set { except, ..set })
    }

    fn layers(&self, layers: &[LayerDraft], loaded: &Loaded<'_>) -> Checked<Vec<Set>> {
        if layers.len() > MOST_LAYERS {
            let allowed = format!("at most {MOST_LAYERS} layers");
            return Err(Fault::new("layers", layers.len(), "too many layers", allowed).into());
        }
        let is_of_set = |parameter: &Parameter| {
            let is_one = groups::SET.contains(&parameter.group) || parameter.group == Group::Period;
            is_one && ![&SEED, &ONLY, &EXCEPT, &KEEP].contains(&parameter)
        };
        let own = self
            .values
            .given()
            .filter(|(parameter, _)| is_of_set(parameter));
        let beside = own.map(|(parameter, _)| {
            let detail = "has no effect beside layers: each layer has its own";
            let field = format!("{}{}", self.values.path(), parameter.name);
            let text = self.values.text(parameter);
            Err::<(), _>(Fault::new(&field, text, detail, "either layers or one set").into())
        });
        let seed = self.values.get::<u64>(&SEED);
        let common = seed.as_ref().ok().copied().flatten();
        let sets = layers.iter().enumerate();
        let sets = sets.map(|(i, layer)| match common {
            Some(seed) => layer.seeded(seed).check(&layers[..i], loaded),
            None => layer.check(&layers[..i], loaded),
        });
        let (beside, only, common) = (all(beside), self.only(), keep(&self.values));
        let (_, mut sets, _, _, common) = (beside, all(sets), seed, only, common).together()?;
        if let Some(common) = common {
            for set in &mut sets {
                set.thin_out(common);
            }
        }
        let values: Vec<&Values> = layers.iter().map(|layer| &layer.values).collect();
        except::of_layers(&self.values, &values, &mut sets, loaded.catalog)?;
        Ok(sets)
    }

    /// The one layer that is wanted, by number; all without layers.
    fn only(&self) -> Checked<Option<usize>> {
        let layers = match &self.layers {
            Ok(layers) if !layers.is_empty() => layers,
            _ => return Ok(None),
        };
        let Some(only) = self.values.get::<String>(&ONLY)? else {
            return Ok(None);
        };
        let names = || layers.iter().filter_map(LayerDraft::known_name);
        let place = layers
            .iter()
            .position(|layer| layer.known_name() == Some(&only));
        place.map(Some).ok_or_else(|| {
            let names: Vec<&str> = names().collect();
            let fault = Fault {
                allowed: names.join(", "),
                ..self
                    .values
                    .fault(&ONLY, unknown("layer", &only, names.iter().copied()))
            };
            fault.into()
        })
    }

    /// The part of the query that begins at a place and has a number of points.
    #[must_use]
    pub fn part(&self, token: &Token, count: u64) -> Self {
        let mut part = self.clone();
        part.values.replace(&OFFSET, None);
        let cursor = Value::Text(token.to_string());
        part.values.replace(&CURSOR, Some(cursor));
        part.values.replace(&LIMIT, Some(Value::Integer(count)));
        part
    }

    /// The body of `POST /v1/points:query` that asks for this.
    #[must_use]
    pub fn to_body(&self) -> Map<String, Json> {
        let mut body = Map::new();
        if let Ok(Some(region)) = &self.region {
            body.insert("region".into(), region.echo());
        }
        if let Ok(layers) = &self.layers
            && !layers.is_empty()
        {
            let layers: Vec<Json> = layers.iter().map(LayerDraft::to_json).collect();
            body.insert("layers".into(), layers.into());
        }
        body.extend(written(&self.values));
        body
    }
}

/// Values as members of JSON.
pub(super) fn written(values: &Values) -> Map<String, Json> {
    let in_body = |group: &Group| groups::QUERY.contains(group);
    let given = values
        .given()
        .filter(|(parameter, _)| in_body(&parameter.group));
    let member = given.filter_map(|(parameter, value)| {
        Some((parameter.name.to_owned(), serde_json::to_value(value).ok()?))
    });
    member.collect()
}

impl Set {
    /// Checks the set of some values.
    pub(super) fn of(values: &Values, loaded: &Loaded<'_>) -> Checked<Self> {
        let kinds = Kinds::check(values);
        let known = kinds.as_ref().ok().and_then(Option::as_ref);
        let checked = (
            Amount::of(values),
            values.get::<u64>(&SEED),
            warp(values),
            keep(values),
            (attributes::check(values, known), kinds.clone()).together(),
            table::check(values, None, loaded.catalog),
            (loaded.field(values), terrain::check(values, loaded)).together(),
        );
        let (amount, seed, warp, keep, (attributes, mut kinds), (entry, pin), (field, terrain)) =
            checked.together()?;
        let entry = match &mut kinds {
            Some(kinds) => {
                kinds.vary(values, loaded)?;
                kinds.find(entry, values, loaded.catalog)?
            }
            None => entry,
        };
        let period = Period::check(values, amount, &entry)?;
        let seed = Seed(seed.unwrap_or(0));
        Ok(Self {
            path: values.path().into(),
            name: String::new(),
            entry,
            pin,
            amount,
            seed,
            warp: warp.unwrap_or_else(|| Placement::default_warp(seed)),
            keep: keep.unwrap_or(Keep::ALL),
            whole: keep.unwrap_or(Keep::ALL),
            attributes,
            kinds,
            period,
            field,
            except: None,
            terrain,
            region: None,
            clear_of: vec![],
        })
    }

    /// Checks a set without a region.
    ///
    /// # Errors
    /// As [`Draft::check`].
    pub fn single(values: &Values, catalog: &Catalog) -> Result<Self, Error> {
        Self::single_within(values, catalog, Allowance::UNLIMITED)
    }

    /// As [`single`](Self::single), with no more than is allowed.
    ///
    /// # Errors
    /// As [`Draft::check_within`].
    pub fn single_within(
        values: &Values,
        catalog: &Catalog,
        allowance: Allowance<'_>,
    ) -> Result<Self, Error> {
        let loaded = Loaded::new(catalog, allowance);
        let set = Self::of(values, &loaded);
        loaded.had_room()?;
        let ((), set) = (values.read(), set).together()?;
        table::hold(&set.entry, set.pin.as_deref())?;
        Ok(set)
    }
}

fn warp(values: &Values) -> Checked<Option<Warp>> {
    let warp = values.get(&WARP)?.map(Warp::new).transpose();
    warp.map_err(|error| values.fault(&WARP, error.to_string()).into())
}

fn keep(values: &Values) -> Checked<Option<Keep>> {
    let keep = values.get(&KEEP)?.map(Keep::new).transpose();
    keep.map_err(|error| values.fault(&KEEP, error.to_string()).into())
}

fn window(values: &Values) -> Checked<Window> {
    let cursor = values.get::<String>(&CURSOR).and_then(|text| {
        let token = text.as_deref().map(Token::parse).transpose();
        token.map_err(Into::into)
    });
    let (offset, limit, cursor) = (values.get(&OFFSET), values.get(&LIMIT), cursor).together()?;
    Ok(Window {
        offset: offset.unwrap_or(0),
        limit,
        cursor,
    })
}

/// What the answer looks like.
///
/// # Errors
/// Every fault.
pub fn options(values: &Values) -> Checked<Options> {
    let encoding = values.get::<String>(&FORMAT).and_then(|name| {
        let Some(name) = name else { return Ok(None) };
        let encoding = Encoding::from_name(&name);
        let encoding = encoding.ok_or_else(|| values.fault(&FORMAT, "unknown format"))?;
        Ok(Some(encoding))
    });
    // Their shapes bound both.
    let crs = values.get::<String>(&CRS).and_then(|text| {
        let crs = text.map(|text| text.parse()).transpose();
        crs.map_err(|_| {
            values
                .fault(&CRS, "not a coordinate reference system")
                .into()
        })
    });
    let (encoding, decimals, size, summary, crs) = (
        encoding,
        values.get::<u64>(&DECIMALS),
        values.get::<u64>(&SIZE),
        values.get(&SUMMARY),
        crs,
    )
        .together()?;
    Ok(Options {
        encoding,
        decimals: decimals.and_then(|decimals| decimals.try_into().ok()),
        size: size.and_then(|size| size.try_into().ok()),
        summary,
        crs,
    })
}

/// The table of a profile that some values choose.
///
/// # Errors
/// As [`Draft::check`].
pub fn entry(values: &Values, profile: &str, catalog: &Catalog) -> Result<Arc<Entry>, Error> {
    let table = table::check(values, Some(profile), catalog);
    let ((), (entry, pin)) = (values.read(), table).together()?;
    table::hold(&entry, pin.as_deref())?;
    Ok(entry)
}

/// How many parts some values ask for.
///
/// # Errors
/// Every fault.
pub fn parts(values: &Values) -> Checked<u32> {
    let ((), parts) = (values.read(), values.require::<u64>(&PARTS)).together()?;
    Ok(u32::try_from(parts).unwrap_or(u32::MAX))
}
