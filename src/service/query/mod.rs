//! Queries: from raw parameters, a JSON body or typed fields to a checked [`Query`].
//!
//! [`parameters`] is the table of all parameters. Addresses ([`parse_pairs`]), bodies ([`read_body`]),
//! flags and messages become [`Values`], each read by the parameter's [`Shape`]; with a region and
//! layers they are a [`Draft`]. The one way on is [`Draft::check`]; beyond it nothing is checked again.
//! It reports every fault it finds, so that a client needs one round to learn them all.

mod amount;
mod attributes;
mod cursor;
mod depends;
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
mod price;
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

use strew_core::{
    Area, Attributes, ErrorKind, Keep, Placement, PointSet, Seed, Spacing, Warp, server,
};

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

/// What the looks at fields of a small query may take, in nanoseconds.
const QUICK: f64 = 3e5;

impl Query {
    /// Whether it holds all that its answer depends on: in its sets, or in the digest of a world that all of it comes
    /// from.
    #[must_use]
    pub fn is_pinned(&self) -> bool {
        match &self.world {
            Some(world) => world.is_pinned,
            None => self.sets.iter().all(Set::is_pinned),
        }
    }

    /// The digests of everything that its points depend on beyond the query itself.
    pub fn digests(&self) -> impl Iterator<Item = &str> {
        self.sets.iter().flat_map(Set::digests)
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
        if !is_plain || width * height > 2048.0 || width.max(height) > 128.0 {
            return false;
        }
        let terrain = set.terrain.iter().map(|terrain| &terrain.field);
        let mut fields = set.fields().chain(terrain).map(|field| &field.spec);
        let mut looks = 0.0;
        let is_quick = fields.all(|field| {
            // What a look takes is found out by a few looks.
            let is_plain = field.parts() <= 4 && field.vertices() <= 64;
            looks += if is_plain {
                server::look(field, self.region.bounds)
            } else {
                0.0
            };
            is_plain
        });
        // A point may look around itself, too.
        is_quick && width * height * looks * 5.0 <= QUICK
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
    ///
    /// # Errors
    /// As [`Kinds::of`].
    pub(super) fn points(&self, ready: &Ready, spacing: Spacing) -> Result<PointSet, Error> {
        let mut points = PointSet::new(ready.table.clone()).placed(self.placement(spacing));
        if let Some(kinds) = &self.kinds {
            points = kinds.of(points, ready)?;
        }
        Ok(match &self.field {
            Some(field) => points.in_field(field.spec.clone()),
            None => points,
        })
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
