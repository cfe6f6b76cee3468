//! Queries: from raw parameters, a JSON body or typed fields to a checked [`Query`].
//!
//! [`parameters`] is the table of all parameters. Addresses ([`parse_pairs`]), bodies ([`read_body`]),
//! flags and messages become [`Values`], each read by the parameter's [`Shape`]; with a region and
//! layers they are a [`Draft`]. The one way on is [`Draft::check`]; beyond it nothing is checked again.
//! It reports every fault it finds, so that a client needs one round to learn them all.

mod amount;
mod attributes;
mod cursor;
mod draft;
mod echo;
mod except;
mod faults;
mod field;
mod json;
mod kinds;
mod layer;
mod lists;
mod named;
mod nearest;
mod parameter;
pub mod parameters;
pub mod patterns;
mod period;
#[cfg(test)]
mod recipe;
mod region;
mod shape;
mod table;
mod terrain;
mod text;
mod value;
mod values;
mod world;

use std::{fmt, sync::Arc};

use strew_core::{Area, Attributes, ErrorKind, Keep, Placement, PointSet, Seed, Spacing, Warp};

use super::{Entry, Error, Fault, Ready, except::Except, world::Named};

pub use amount::Amount;
pub use cursor::Token;
pub use draft::{Draft, entry, options, parts};
pub use echo::{KindDistance, PeriodEcho, Resolved, ResolvedSet};
pub use faults::{Checked, Faults, Together, all};
pub use field::SetField;
pub use json::{RegionSchema, read_body, read_members, read_region};
pub use kinds::{Kinds, Spread};
pub use layer::LayerDraft;
pub use nearest::Nearest;
pub(super) use parameter::unknown;
pub use parameter::{Group, Parameter, groups, of};
pub use period::{Period, Periods};
pub use region::{QueryRegion, RegionDraft, Rings, ShapeDraft};
pub use shape::Shape;
pub use table::chosen;
pub use terrain::Terrain;
pub use text::parse_pairs;
pub use value::Value;
pub use values::Values;

/// The profile of a query that names none.
pub const DEFAULT_PROFILE: &str = "blue";
/// The α of a query that names none: the one whose pattern's spectrum is the most even.
pub const DEFAULT_ALPHA: &str = "(5-sqrt(3))/2";
/// The most layers of a query.
pub const MOST_LAYERS: usize = 16;
/// The most regions that lists of regions have in one query.
pub const MOST_REGIONS: usize = 1000;
/// The most names in a list, such as attributes.
pub const MOST_NAMES: usize = 64;
/// The most parts that a query is split into.
pub const MOST_PARTS: u64 = 10_000;

/// The most levels of regions in regions, and of collections in GeoJSON.
pub const MOST_LEVELS: usize = 8;

/// A checked query.
#[derive(Clone, Debug, PartialEq)]
pub struct Query {
    /// Where.
    pub region: QueryRegion,
    /// The sets of points: one, or one for each layer.
    pub sets: Arc<[Set]>,
    /// Whether the sets are named layers.
    pub is_layered: bool,
    /// Which of the points, in their order.
    pub window: Window,
    /// The world that a part of it comes from.
    pub world: Option<Named>,
    /// The number of the one layer whose points are wanted.
    pub only: Option<usize>,
}

/// Which part of the points is asked for, in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Window {
    /// How many are left out at the beginning, or after the cursor.
    pub offset: u64,
    /// How many are wanted at most.
    pub limit: Option<u64>,
    /// Where to begin.
    pub cursor: Option<Token>,
}

/// A set of points: a table laid into the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Set {
    /// What is put before its fields' names in faults: nothing, or `layers[3].`.
    pub path: String,
    /// The name of the layer.
    pub name: String,
    /// The table. It is found once, when the query is checked, and answers to the end, whatever is
    /// loaded in its place meanwhile.
    pub entry: Arc<Entry>,
    /// The digest that the query wants it to have, in lower case.
    pub pin: Option<String>,
    /// How many points.
    pub amount: Amount,
    /// The seed.
    pub seed: Seed,
    /// How strongly the plane is warped.
    pub warp: Warp,
    /// Which share of the points is kept.
    pub keep: Keep,
    /// The share that later layers keep clear of: the set's own, without the common one of a query with layers. So
    /// a smaller common share has a part of the points of a larger one.
    pub whole: Keep,
    /// The field that the set is in.
    pub field: Option<SetField>,
    /// The further values of points.
    pub attributes: Attributes,
    /// The terrain that points stand on.
    pub terrain: Option<Terrain>,
    /// The variants that are evenly spread.
    pub kinds: Option<Kinds>,
    /// The period that the points are of, instead of a region.
    pub period: Option<Period>,
    /// The points that it is without.
    pub except: Option<Except>,
    /// Where the layer is; everywhere if `None`.
    pub region: Option<QueryRegion>,
    /// The layers that are kept clear of, by position, with the distance; all before this one.
    pub clear_of: Vec<(usize, f64)>,
}

impl Query {
    /// Whether it holds all that its answer depends on: it names the digests of all of its tables, no field that may
    /// change, no list of points, and no kinds of a loaded table; or the digest of a world that all of these come from.
    #[must_use]
    pub fn is_pinned(&self) -> bool {
        let is_named = |field: &SetField| field.name.is_some();
        let has_lists =
            |set: &Set| (set.except.as_ref()).is_some_and(|except| !except.names.is_empty());
        let is_fixed = |set: &Set| {
            let terrain = set.terrain.iter().map(|terrain| &terrain.field);
            let has_names = set.fields().chain(terrain).any(is_named) || has_lists(set);
            set.pin.is_some() && !has_names
        };
        let is_given = |set: &Set| set.kinds.as_ref().is_some_and(|kinds| kinds.made.is_some());
        match &self.world {
            Some(world) => world.is_pinned,
            None => self.sets.iter().all(|set| is_fixed(set) && !is_given(set)),
        }
    }

    /// The digests of everything that its points depend on beyond the query itself: tables, then fields, then lists.
    pub fn digests(&self) -> impl Iterator<Item = &str> {
        let except = self.sets.iter().filter_map(|set| set.except.as_ref());
        let except = except.flat_map(|except| except.parts.iter().map(|part| part.digest()));
        let tables = self.sets.iter().map(|set| set.entry.digest.as_str());
        let mixes = self
            .sets
            .iter()
            .filter_map(|set| set.kinds.as_ref()?.made.as_ref());
        let fields = self.sets.iter().flat_map(|set| {
            let none = if set.field.is_none() { Some("") } else { None };
            none.into_iter()
                .chain(set.fields().map(|field| field.digest.as_str()))
        });
        let terrains = self.sets.iter().filter_map(|set| {
            let terrain = set.terrain.as_ref()?;
            Some(terrain.field.digest.as_str())
        });
        tables
            .chain(fields)
            .chain(terrains)
            .chain(mixes.map(|entry| entry.digest.as_str()))
            .chain(except)
    }

    /// Whether planning it and making its points takes no longer than handing it to another
    /// thread: a single set in a box of about 2,000 spacings' area at most, and not long and thin.
    #[must_use]
    pub fn is_small(&self) -> bool {
        let ([set], Area::Region(_)) = (&*self.sets, &self.region.area) else {
            return false;
        };
        if set.period.is_some() {
            return false;
        }
        let spacing = match set.amount {
            Amount::Spacing(spacing) => spacing,
            Amount::Density(density) => density.sqrt().recip(),
            Amount::MinDistance(_) | Amount::Count(_) => return false,
        };
        let [min_x, min_y, max_x, max_y] = self.region.bbox();
        let [width, height] = [(max_x - min_x) / spacing, (max_y - min_y) / spacing];
        let is_plain = set.region.is_none() && set.clear_of.is_empty() && set.except.is_none();
        // A look at a field of many parts takes longer.
        let is_quick = |field: &SetField| field.spec.parts() <= 4;
        let terrain = set.terrain.iter().map(|terrain| &terrain.field);
        let is_plain = is_plain && set.fields().chain(terrain).all(is_quick);
        is_plain && width * height <= 2048.0 && width.max(height) <= 128.0
    }
}

impl Set {
    /// How the table's points are laid into the world, given the spacing.
    #[must_use]
    pub const fn placement(&self, spacing: Spacing) -> Placement {
        Placement::new(spacing, self.seed)
            .with_warp(self.warp)
            .with_keep(self.keep)
    }

    /// The points of a table at a spacing.
    #[must_use]
    pub(super) fn points(&self, ready: &Ready, spacing: Spacing) -> PointSet {
        let mut points = PointSet::new(ready.table.clone()).placed(self.placement(spacing));
        if let Some(kinds) = &self.kinds {
            points = kinds.of(points, ready);
        }
        match &self.field {
            Some(field) => points.in_field(field.spec.clone()),
            None => points,
        }
    }

    /// Keeps a share of its points, while other layers keep clear of all of them.
    pub(super) fn thin_out(&mut self, share: Keep) {
        let product = (self.whole.get() * share.get()).max(Keep::MIN);
        self.keep = Keep::new(product).unwrap_or(share);
    }

    /// All points that the table has for it, whatever its share, its kinds and its fields leave out.
    #[must_use]
    pub(super) fn every_point(&self, ready: &Ready) -> PointSet {
        PointSet::new(ready.table.clone()).placed(Placement::new(Spacing::ONE, self.seed))
    }

    /// The fields that it depends on: its own, then those of its variants.
    pub(super) fn fields(&self) -> impl Iterator<Item = &SetField> {
        let of_variants = self.kinds.iter().flat_map(|kinds| &kinds.fields);
        self.field.iter().chain(of_variants.map(|(_, field)| field))
    }

    /// Whether it has kinds whose shares vary from place to place.
    pub(super) fn varies(&self) -> bool {
        self.kinds.as_ref().is_some_and(Kinds::vary_by_place)
    }

    /// The share of the table's points that are of the set, without a field.
    pub(super) fn share(&self) -> f64 {
        let kind = self.kinds.as_ref().map_or(1.0, Kinds::share);
        self.keep.get() * kind
    }

    /// The part of the query's region in which the layer lies.
    pub(super) fn area(&self, query: &QueryRegion) -> Area {
        match &self.region {
            Some(own) => query.and(own),
            None => query.area.clone(),
        }
    }

    /// A fault of one of its fields.
    pub(super) fn fault(
        &self,
        field: &str,
        value: impl fmt::Display,
        detail: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Error {
        let field = format!("{}{field}", self.path);
        Fault::new(&field, value, detail, allowed).into()
    }
}

impl QueryRegion {
    /// The error of a region that reaches too far for a spacing.
    pub(super) fn too_far(&self, spacing: Spacing, error: &strew_core::Error) -> Error {
        let listed = || region::listed(&self.bbox());
        let value = self.echo.as_ref().map_or_else(listed, ToString::to_string);
        let fault = match (error.kind(), error.limit()) {
            (ErrorKind::TooFar, Some(limit)) => Fault::new(
                &self.path,
                value,
                match &self.echo {
                    None => {
                        let (field, value) = (error.field(), error.value());
                        format!("{field} is {value}, too far from the origin")
                    }
                    Some(_) => format!("reaches to {}, too far from the origin", error.value()),
                },
                format!(
                    "within ±{} at spacing {}, where f64 still tells neighbors apart",
                    number(limit),
                    number(spacing.get())
                ),
            ),
            _ => Fault::new(&self.path, value, error.to_string(), region::REGION),
        };
        fault.into()
    }
}

/// The shortest digits of any number.
pub(in crate::service) fn number(value: f64) -> String {
    zmij::Buffer::new().format(value).into()
}
