//! Drafts: queries as they were read, with their faults in their places, not checked yet.

use std::sync::Arc;

use serde_json::{Map, Value as Json};
use strew_catalog::{Catalog, Dimension, Entry, field::Allowance};
use strew_encode::Encoding;
use strew_error::{Checked, Error, Fault, Together as _, faults::all, unknown};
use strew_raster::Price;

use crate::{
    Options, Query, QueryRegion, Set, Window,
    cursor::Token,
    defaults::{MOST_FEATURES, MOST_LAYERS},
    except,
    field::Loaded,
    layer::LayerDraft,
    parameter::{Group, Parameter, groups},
    parameters::{
        BBOX, CRS, CURSOR, DECIMALS, EXCEPT, FORMAT, LIMIT, LOD, OFFSET, ONLY, PARTS, PERIODIC,
        SEED, SIZE, SUMMARY, WORLD, WORLD_DIGEST,
    },
    region::RegionDraft,
    region_check::{REGION, VOLUME},
    set_check::lod,
    table,
    text::parse_pairs,
    value::Value,
    values::Values,
};

#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// The region; a query must have one.
    pub region: Checked<Option<RegionDraft>>,
    /// The set of points, if there are no layers; the window, and the form of the answer.
    pub values: Values,
    /// The layers; none if there is one set.
    pub layers: Checked<Vec<LayerDraft>>,
}

impl Draft {
    /// A query of one set, without a region yet.
    pub const fn new(values: Values) -> Self {
        Self {
            region: Ok(None),
            values,
            layers: Ok(vec![]),
        }
    }

    /// A query by the parameters of an address, which may hold its region.
    pub fn of(values: Values) -> Self {
        Self {
            region: RegionDraft::of(&values),
            ..Self::new(values)
        }
    }

    pub fn within(mut self, region: Checked<RegionDraft>) -> Self {
        self.region = region.map(Some);
        self
    }

    /// Whether the sets of a world with layers are those of this query, which names it.
    pub(crate) fn leaves_sets(&self) -> bool {
        let is_of_set = |parameter: &Parameter| {
            groups::SET.contains(&parameter.group) || parameter.group == Group::Period
        };
        let mut given = self.values.given().map(|(parameter, _)| parameter);
        matches!(&self.layers, Ok(layers) if layers.is_empty())
            && self.values.read().is_ok()
            && !given.any(|parameter| *parameter != ONLY && is_of_set(parameter))
    }

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

    /// Checks a part of a query, with a region and an amount of its own in place of those that it lacks.
    pub fn try_out(&self, catalog: &Catalog, most_vertices: usize) -> Result<Query, Error> {
        let whole = self.tried("bbox=0,0,1,1");
        let loaded = Loaded::new(catalog, Allowance::UNLIMITED);
        Ok(whole.check_whole(&loaded, most_vertices, None)?.0)
    }

    /// A part of a query, made whole with a region and an amount where it has none.
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

    /// Checks a query that takes nothing from a world but `known` sets, which were checked before.
    pub(crate) fn check_whole(
        &self,
        loaded: &Loaded<'_>,
        most_vertices: usize,
        known: Option<Arc<[Set]>>,
    ) -> Result<(Query, Options), Error> {
        self.check_vertices(most_vertices)?;
        let sets = match (&self.layers, known) {
            (Ok(_), Some(sets)) => Ok(sets),
            (Ok(layers), None) if layers.is_empty() => {
                Set::alone(&self.values, loaded).map(|set| [*set].into())
            }
            (Ok(layers), None) => self.layers(layers, loaded).map(Into::into),
            (Err(faults), _) => Err(faults.clone()),
        };
        loaded.had_room()?;
        let (read, region, sets, window, options) = (
            self.values.read(),
            self.region(),
            sets,
            window(&self.values),
            options(&self.values),
        );
        let ((), region, sets, window, mut options) =
            (read, region, sets, window, options).together()?;
        options.plane = self.plane(&sets, options.crs.as_ref())?;
        let region = match (region, sets.first().and_then(|set| set.period)) {
            (Some(region), _) => region,
            (None, Some(period)) => period.region()?,
            (None, None) => return Err(Fault::missing("region", REGION).into()),
        };
        hold_heights(&sets, &region)?;
        for set in &*sets {
            table::hold(&set.entry, set.pin.as_deref())?;
        }
        let query = Query {
            region,
            sets,
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
            Ok(None) if self.values.takes().any(|p| p.group == Group::Volume) => {
                Err(Fault::missing(BBOX.name, "one of bbox and ball").into())
            }
            Ok(None) => {
                let allowed = match self.values.dimension() {
                    Dimension::Plane => REGION,
                    Dimension::Space => VOLUME,
                };
                Err(Fault::missing("region", allowed).into())
            }
            Err(faults) => Err(faults.clone()),
        }
    }

    fn layers(&self, layers: &[LayerDraft], loaded: &Loaded<'_>) -> Checked<Vec<Set>> {
        let most = match layers.windows(2).all(|pair| pair[0].is_like(&pair[1])) {
            true => MOST_FEATURES,
            false => MOST_LAYERS,
        };
        if layers.len() > most {
            let allowed = format!(
                "at most {MOST_LAYERS} layers, or {MOST_FEATURES} that differ in name, region, amount, seed and \
                 field alone"
            );
            return Err(Fault::new("layers", layers.len(), "too many layers", allowed).into());
        }
        let is_of_set = |parameter: &Parameter| {
            let is_one = groups::SET.contains(&parameter.group) || parameter.group == Group::Period;
            is_one && ![&SEED, &ONLY, &EXCEPT, &LOD].contains(&parameter)
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
        let (beside, only, common) = (all(beside), self.only(), lod(&self.values));
        let (_, mut sets, _, _, common) = (beside, all(sets), seed, only, common).together()?;
        if let Some(common) = common {
            for set in &mut sets {
                set.show(common);
            }
        }
        let values: Vec<&Values> = layers.iter().map(|layer| &layer.values).collect();
        except::of_layers(&self.values, &values, &mut sets, loaded.catalog)?;
        Ok(sets)
    }

    /// The number of the one requested layer; `None` for all layers, or without layers.
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
    pub fn part(&self, token: &Token, count: u64) -> Self {
        let mut part = self.clone();
        part.values.replace(&OFFSET, None);
        let cursor = Value::Text(token.to_string());
        part.values.replace(&CURSOR, Some(cursor));
        part.values.replace(&LIMIT, Some(Value::Integer(count)));
        part
    }

    /// The body of `POST /v1/points:query` with this query.
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
        body.extend(self.values.written());
        body
    }
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
        plane: None,
    })
}

pub fn entry(values: &Values, profile: &str, catalog: &Catalog) -> Result<Arc<Entry>, Error> {
    let table = table::check(values, Some(profile), catalog);
    let ((), (entry, pin)) = (values.read(), table).together()?;
    table::hold(&entry, pin.as_deref())?;
    Ok(entry)
}

pub fn parts(values: &Values) -> Checked<u32> {
    let ((), parts) = (values.read(), values.require::<u64>(&PARTS)).together()?;
    Ok(u32::try_from(parts).unwrap_or(u32::MAX))
}

/// Refuses terrains without a height somewhere in the box of a region: no number stands for it.
fn hold_heights(sets: &[Set], region: &QueryRegion) -> Checked<()> {
    let partial = sets.iter().find(|set| {
        let within = set.region.as_ref().unwrap_or(region).bounds;
        let terrain = set.terrain.as_ref();
        terrain.is_some_and(|terrain| terrain.field.spec.has_missing(&within))
    });
    let Some(set) = partial else {
        return Ok(());
    };
    let name = set
        .terrain
        .iter()
        .find_map(|terrain| terrain.field.name.clone());
    let detail = "it has pixels without a height in the box of the region";
    let allowed = "a region in which all pixels have heights, or a terrain whose gaps are filled";
    let path = format!("{}{}", set.path, crate::parameters::TERRAIN.name);
    Err(Fault::new(&path, name.unwrap_or_default(), detail, allowed).into())
}

impl Draft {
    pub fn price(&self) -> Price {
        let layers = self.layers.iter().flatten().map(|layer| &layer.values);
        let all = [&self.values].into_iter().chain(layers);
        all.map(Values::price).sum()
    }
}

impl Values {
    pub fn price(&self) -> Price {
        let of = |value: &Value| match value {
            Value::Field(field) => field.price(),
            Value::Fields(fields) => fields.iter().map(|(_, field)| field.price()).sum(),
            _ => Price::default(),
        };
        self.given().map(|(_, value)| of(value)).sum()
    }
}
