//! Checking a set: from values to a table laid into the world.

use strew_catalog::{Catalog, field::Allowance};
use strew_core::{Attribute, Keep, Placement, Seed, Settle, Warp};
use strew_error::{Checked, Error, Together as _};

use crate::{
    amount::Amount,
    attributes, except,
    field::Loaded,
    kinds::Kinds,
    parameters::{
        ALPHA, ATTRIBUTES, EXCEPT, HEIGHTS, KEEP, LOD, MAP, NORMALS, PROFILE, SCALE_RANGE, SEED,
        SETTLE, SPREAD, WARP,
    },
    period::Period,
    set::{Resolved, Set, replace_in, resolved_of},
    table, terrain,
    value::Value,
    values::Values,
};

impl Set {
    pub(super) fn of(values: &Values, loaded: &Loaded<'_>) -> Checked<Box<Self>> {
        let kinds = Kinds::check(values);
        let known = kinds.as_ref().ok().and_then(Option::as_ref);
        let checked = (
            Amount::of(values),
            values.get::<u64>(&SEED),
            warp(values),
            (keep(values), settle(values), lod(values)).together(),
            (attributes::check(values, known), kinds.clone()).together(),
            table::check(values, None, loaded.catalog),
            (loaded.field(values), terrain::check(values, loaded)).together(),
        );
        let (
            amount,
            seed,
            warp,
            (keep, settle, lod),
            (attributes, mut kinds),
            (entry, pin),
            (field, terrain),
        ) = checked.together()?;
        let entry = match &mut kinds {
            Some(kinds) => {
                kinds.vary(values, loaded)?;
                kinds.find(entry, values, loaded.catalog)?
            }
            None => entry,
        };
        let period = Period::check(values, amount, &entry)?;
        let seed = Seed(seed.unwrap_or(0));
        Ok(Box::new(Self {
            path: values.path().into(),
            name: String::new(),
            entry,
            pin,
            amount,
            seed,
            warp: warp.unwrap_or_else(|| Placement::default_warp(seed)),
            keep: keep.unwrap_or(Keep::ALL),
            settle: settle.unwrap_or_default(),
            lod: lod.unwrap_or(Keep::ALL),
            attributes,
            kinds,
            period,
            field,
            except: None,
            terrain,
            region: None,
            clear_of: vec![],
            given: resolved_of(values),
        }))
    }

    /// The values of its parameters in the order of the table: with those that the query omits or expresses by other
    /// parameters, and without those that change nothing. Answers echo them, and its identity has them.
    pub(crate) fn values(&self) -> Resolved {
        let text = |text: &str| Some(Value::Text(text.into()));
        let key = &self.entry.key;
        let attributes = self.attributes.as_slice();
        let names: Vec<_> = attributes
            .iter()
            .map(|own| own.name().to_string())
            .collect();
        let scale = attributes.iter().find_map(|attribute| match attribute {
            Attribute::Scale(range) => Some(Value::Numbers(vec![range.min(), range.max()])),
            _ => None,
        });
        let terrain = self.terrain.as_ref();
        let except = self.except.as_ref().map(|except| &except.names);
        let filled = [
            (&PROFILE, text(&key.profile)),
            (&ALPHA, text(&key.alpha.to_string())),
            (&MAP, text(&key.size.to_string())),
            (&SEED, Some(Value::Integer(self.seed.0))),
            (&WARP, Some(Value::Number(self.warp.strength()))),
            (
                &KEEP,
                (self.keep != Keep::ALL).then(|| Value::Number(self.keep.get())),
            ),
            (
                &SETTLE,
                self.steps().map(|steps| Value::Integer(steps.into())),
            ),
            (
                &LOD,
                (self.lod != Keep::ALL).then(|| Value::Number(self.lod.get())),
            ),
            (
                &ATTRIBUTES,
                (!names.is_empty()).then_some(Value::Names(names)),
            ),
            (&SCALE_RANGE, scale),
            (
                &EXCEPT,
                except
                    .filter(|names| !names.is_empty())
                    .map(|names| Value::Names(names.clone())),
            ),
            (
                &SPREAD,
                self.kinds
                    .as_ref()
                    .and_then(|kinds| text(kinds.spread.name())),
            ),
            (
                &HEIGHTS,
                terrain.map(|terrain| Value::Numbers(terrain.heights.into())),
            ),
            (
                &NORMALS,
                terrain
                    .filter(|terrain| terrain.has_normals)
                    .map(|_| Value::Switch(true)),
            ),
        ];
        let mut values = self.given.clone();
        replace_in(&mut values, filled);
        values
    }

    /// Checks a set that is no layer, with what it is without.
    pub(super) fn alone(values: &Values, loaded: &Loaded<'_>) -> Checked<Box<Self>> {
        let except = except::of_set(values, loaded.catalog);
        let (mut set, except) = (Self::of(values, loaded), except).together()?;
        set.except = except;
        Ok(set)
    }

    /// Checks a set without a region.
    pub fn single(values: &Values, catalog: &Catalog) -> Result<Box<Self>, Error> {
        Self::single_within(values, catalog, Allowance::UNLIMITED)
    }

    /// As [`single`](Self::single), with no more than is allowed.
    pub fn single_within(
        values: &Values,
        catalog: &Catalog,
        allowance: Allowance<'_>,
    ) -> Result<Box<Self>, Error> {
        let loaded = Loaded::new(catalog, allowance);
        let set = Self::alone(values, &loaded);
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

fn settle(values: &Values) -> Checked<Option<Settle>> {
    let steps = values.get::<u64>(&SETTLE)?;
    let settle = steps.map(|steps| Settle::new(u32::try_from(steps).unwrap_or(u32::MAX)));
    settle
        .transpose()
        .map_err(|error| values.fault(&SETTLE, error.to_string()).into())
}

pub(crate) fn lod(values: &Values) -> Checked<Option<Keep>> {
    let lod = values.get(&LOD)?.map(Keep::new).transpose();
    lod.map_err(|error| values.fault(&LOD, error.to_string()).into())
}

fn keep(values: &Values) -> Checked<Option<Keep>> {
    let keep = values.get(&KEEP)?.map(Keep::new).transpose();
    keep.map_err(|error| values.fault(&KEEP, error.to_string()).into())
}
