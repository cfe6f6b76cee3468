//! Checked sets of points: a table laid into the world.

use std::{fmt, sync::Arc};

use strew_catalog::{Entry, Ready, except::Except};
use strew_core::{
    Area, Attributes, Keep, PeriodicSet, Placement, PointSet, Seed, Settle, Spacing, Table, Warp,
    space::{self, SpaceSet},
};
use strew_error::{Error, Fault};

use crate::{
    amount::Amount, field::SetField, kinds::Kinds, parameter::Parameter, parameters::PARAMETERS,
    period::Period, region_check::QueryRegion, terrain::Terrain, value::Value, values::Values,
};

/// A set of points: a table laid into the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Set {
    /// The prefix of its fields' names in faults: empty, or `layers[3].`.
    pub path: String,
    pub name: String,
    /// The table. It is found once, when the query is checked, and answers to the end, whatever is
    /// loaded in its place meanwhile.
    pub entry: Arc<Entry>,
    /// The digest that the query wants it to have, in lower case.
    pub pin: Option<String>,
    pub amount: Amount,
    pub seed: Seed,
    pub warp: Warp,
    /// The share of the points that are kept.
    pub keep: Keep,
    pub settle: Settle,
    /// The level of detail: the set's own times the common one of a query with layers. Later layers keep clear of all
    /// points, so a coarser level has a part of the points of a finer one.
    pub lod: Keep,
    pub field: Option<SetField>,
    pub attributes: Attributes,
    pub terrain: Option<Terrain>,
    pub kinds: Option<Kinds>,
    pub period: Option<Period>,
    /// The points that it is without.
    pub except: Option<Except>,
    pub(crate) given: Resolved,
    /// Where the layer is; everywhere if `None`.
    pub region: Option<QueryRegion>,
    /// The layers that are kept clear of, by position, with the distance; all before this one.
    pub clear_of: Vec<(usize, f64)>,
}

impl Set {
    /// How the table's points are laid into the world, given the spacing.
    pub const fn placement(&self, spacing: Spacing) -> Placement {
        Placement::new(spacing, self.seed)
            .with_warp(self.warp)
            .with_keep(self.keep)
            .with_settle(self.settle)
            .with_lod(self.lod)
    }

    pub fn points(&self, ready: &Ready, spacing: Spacing) -> Result<PointSet, Error> {
        let mut points = PointSet::new(ready.table.clone()).placed(self.placement(spacing));
        if let Some(kinds) = &self.kinds {
            points = kinds.of(points, ready)?;
        }
        Ok(match &self.field {
            Some(field) => points.in_field(field.spec.clone()),
            None => points,
        })
    }

    /// Its table, if its points lie in space.
    pub fn space(&self) -> Option<&space::Table> {
        self.entry.space()
    }

    pub fn points_in_space(
        &self,
        table: &space::Table,
        spacing: Spacing,
    ) -> Result<SpaceSet, Error> {
        let placed = || {
            SpaceSet::new(table.clone())
                .seed(self.seed.0)
                .warp(self.warp.strength())?
                .keep(self.keep.get())?
                .lod(self.lod.get())?
                .settle(self.settle.steps())?
                .spacing(spacing.get())
        };
        let set = placed().map_err(|_| Error::Internal("a checked set is out of range"))?;
        Ok(match &self.field {
            Some(field) => set.in_field(field.spec.clone()),
            None => set,
        })
    }

    /// Shows a part of its points, while other layers keep clear of all of them.
    pub(crate) fn show(&mut self, part: Keep) {
        let product = (self.lod.get() * part.get()).max(Keep::MIN);
        self.lod = Keep::new(product).unwrap_or(part);
    }

    /// The number of steps by which points settle; `None` in sets whose points do not settle by default: those of all
    /// points, and of a tiny part of them. In space these stay.
    pub fn steps(&self) -> Option<u32> {
        if self.field.is_some() {
            return Some(self.settle.steps());
        }
        let steps = self.settle.steps_at(self.keep);
        let is_thinned = (Settle::LEAST_SHARE..1.0).contains(&self.keep.get());
        let stays = !is_thinned && self.space().is_some();
        (is_thinned || steps > 0).then_some(if stays { 0 } else { steps })
    }

    /// Whether points move so that those of a kind, or in a field any, keep no distance of their own.
    pub fn moves(&self) -> bool {
        self.steps().is_some_and(|steps| steps > 0)
    }

    /// All points that the table has for it, whatever its share, its kinds and its fields leave out.
    pub fn every_point(&self, ready: &Ready) -> PointSet {
        PointSet::new(ready.table.clone()).placed(Placement::new(Spacing::ONE, self.seed))
    }

    /// The fields that it depends on: its own, then those of its variants.
    pub fn fields(&self) -> impl Iterator<Item = &SetField> {
        let of_variants = self.kinds.iter().flat_map(|kinds| &kinds.fields);
        self.field.iter().chain(of_variants.map(|(_, field)| field))
    }

    /// Whether it has kinds whose shares vary from place to place.
    pub fn varies(&self) -> bool {
        self.kinds.as_ref().is_some_and(Kinds::vary_by_place)
    }

    /// The share of the table's points that are of the set, without a field.
    pub fn share(&self) -> f64 {
        let kind = self.kinds.as_ref().map_or(1.0, Kinds::share);
        self.keep.get() * self.lod.get() * kind
    }

    pub fn area(&self, query: &QueryRegion) -> Area {
        match &self.region {
            Some(own) => query.and(own),
            None => query.area.clone(),
        }
    }

    pub fn fault(
        &self,
        field: &str,
        value: impl fmt::Display,
        detail: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Error {
        let field = format!("{}{field}", self.path);
        Fault::new(&field, value, detail, allowed).into()
    }

    pub fn periodic(
        &self,
        table: &Table,
        period: Period,
    ) -> Result<PeriodicSet, strew_core::Error> {
        let set = PeriodicSet::new(table.clone(), period.least)?;
        let set = set.side(period.side)?.seed(self.seed.0);
        let mut set = set
            .warp(self.warp.strength())?
            .keep(self.keep.get())?
            .lod(self.lod.get())?;
        if self.settle != Settle::default() {
            set = set.settle(self.settle.steps())?;
        }
        if let Some((_, kind)) = self.kinds.as_ref().and_then(|kinds| kinds.only.as_ref()) {
            set = set.only(*kind)?;
        }
        Ok(match &self.field {
            Some(field) => set.in_field(field.spec.clone()),
            None => set,
        })
    }

    /// Whether it has a part of the points of its table only, so that a period is counted point by point.
    pub fn is_part(&self) -> bool {
        self.share() < 1.0 || self.field.is_some()
    }
}

/// The values of a set with everything filled in.
pub(crate) type Resolved = Vec<(&'static Parameter, Value)>;

/// The given values that answers echo. Fields are there by their names; others are known by their digests.
pub(crate) fn resolved_of(values: &Values) -> Resolved {
    let echoed = values.given().filter(|(parameter, _)| parameter.is_echoed);
    let named = echoed.filter_map(|(parameter, value)| Some((parameter, value.named()?)));
    named.collect()
}

/// Replaces values, or removes them, and puts all in the order of the table.
pub(crate) fn replace_in(
    all: &mut Resolved,
    others: impl IntoIterator<Item = (&'static Parameter, Option<Value>)>,
) {
    for (parameter, value) in others {
        let known = all.iter().position(|(known, _)| *known == parameter);
        match (known, value) {
            (Some(place), Some(value)) => all[place].1 = value,
            (Some(place), None) => drop(all.remove(place)),
            (None, value) => all.extend(value.map(|value| (parameter, value))),
        }
    }
    all.sort_by_cached_key(|(parameter, _)| {
        let mut table = PARAMETERS.iter();
        table.position(|known| known == parameter)
    });
}
