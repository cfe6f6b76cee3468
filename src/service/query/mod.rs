//! Queries: from raw parameters, a JSON body or typed fields to a checked [`Query`].
//!
//! There is one way in, [`Draft::check`]; beyond it nothing is checked again. It reports every
//! fault it finds, so that a client needs one round to learn them all. Text parameters, of an
//! address or a command line, become [`Parameters`] first; bodies are read by [`read_body`].

mod amount;
mod around;
mod attributes;
mod body;
mod cursor;
mod draft;
mod echo;
mod faults;
mod geojson;
mod parameters;
mod pin;
mod region;
mod table;
mod text;
mod values;
mod written;

use std::{fmt, sync::Arc};

use strew_core::{Area, Attributes, ErrorKind, Keep, Placement, Seed, Spacing, Warp};

use super::{Entry, Error, Fault};

pub use amount::{Amount, AmountDraft};
pub use around::{Around, AroundDraft};
pub use attributes::AttributesDraft;
pub use body::{Body, read_body};
pub use cursor::Token;
pub use draft::{Draft, LayerDraft, SetDraft, WindowDraft};
pub use echo::{Resolved, ResolvedSet};
pub use geojson::read_region;
pub use parameters::{
    LOOKS_NAMES, PARAMETERS, Parameter, REGION_NAMES, SET_NAMES, Shape, WINDOW_NAMES,
};
pub use region::{Asked, RegionDraft, Rings, ShapeDraft};
pub use table::TableDraft;
pub use text::{Parameters, parse_pairs};
pub use values::read_bbox;

/// The profile of a query that names none.
pub const DEFAULT_PROFILE: &str = "blue";
/// The α of a query that names none: the one whose pattern's spectrum is the most even.
pub const DEFAULT_ALPHA: &str = "(5-sqrt(3))/2";
/// The most layers of a query.
pub const MOST_LAYERS: usize = 16;
/// The most parts that a query is split into.
pub const MOST_PARTS: u32 = 10_000;

/// Regions in regions in regions are enough: so many levels of lists.
pub const MOST_LEVELS: usize = 8;

/// What a box must be.
const BOX: &str =
    "four finite numbers min_x,min_y,max_x,max_y with min_x < max_x and min_y < max_y";
/// How to say how densely points lie.
pub(in crate::service) const AMOUNT: &str = "one of density (points per unit of area), spacing (the mean, density^-1/2), \
                      min_distance (of any two points) and count (of the region)";
/// What a warp may be.
const WARP: &str = "off, on, or a strength from 0 (off) over 1 (on) to 2";
/// What a share to keep may be.
const KEEP: &str = "a number from 1e-6 to 1";

/// A checked query: what is asked for can be answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Query {
    /// Where.
    pub region: Asked,
    /// The sets of points: one, or one for each layer.
    pub sets: Arc<[Set]>,
    /// Whether the sets are named layers.
    pub is_layered: bool,
    /// Which of the points, in their order.
    pub window: Window,
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
    /// Whether the query names its digest.
    pub is_pinned: bool,
    /// How many points.
    pub amount: Amount,
    /// The seed.
    pub seed: Seed,
    /// How strongly the plane is warped.
    pub warp: Warp,
    /// Which share of the points is kept.
    pub keep: Keep,
    /// The further values of points.
    pub attributes: Attributes,
    /// Where the layer is; everywhere if `None`.
    pub region: Option<Asked>,
    /// The layers that are kept clear of, by position, with the distance; all before this one.
    pub clear_of: Vec<(usize, f64)>,
}

impl Query {
    /// Whether it names the digests of all of its tables, so that its answer never changes.
    #[must_use]
    pub fn is_pinned(&self) -> bool {
        self.sets.iter().all(|set| set.is_pinned)
    }

    /// Whether planning it and making its points takes no longer than handing it to another
    /// thread: a single set in a box of about 2,000 spacings' area at most, and not long and thin.
    #[must_use]
    pub fn is_small(&self) -> bool {
        let ([set], Area::Region(_)) = (&*self.sets, &self.region.area) else {
            return false;
        };
        let spacing = match set.amount {
            Amount::Spacing(spacing) => spacing,
            Amount::Density(density) => density.sqrt().recip(),
            Amount::MinDistance(_) | Amount::Count(_) => return false,
        };
        let [min_x, min_y, max_x, max_y] = self.region.bbox();
        let [width, height] = [(max_x - min_x) / spacing, (max_y - min_y) / spacing];
        let is_plain = set.region.is_none() && set.clear_of.is_empty();
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

    /// The part of the region that is asked for in which the layer is.
    pub(super) fn area(&self, asked: &Asked) -> Area {
        match &self.region {
            Some(own) => asked.and(own),
            None => asked.area.clone(),
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
        Error::Invalid(vec![Fault::new(&field, value, detail, allowed)])
    }
}

impl Asked {
    /// The error of a region that reaches too far for a spacing.
    pub(super) fn too_far(&self, spacing: Spacing, error: &strew_core::Error) -> Error {
        let listed = || region::listed(&self.bbox());
        let value = self.echo.as_ref().map_or_else(listed, ToString::to_string);
        Error::Invalid(vec![match (error.kind(), error.limit()) {
            (ErrorKind::TooFar, Some(limit)) => Fault::new(
                &self.path,
                value,
                format!(
                    "{} is {}, too far from the origin",
                    error.field(),
                    error.value()
                ),
                format!(
                    "within ±{} at spacing {}, where f64 still tells neighbors apart",
                    number(limit),
                    number(spacing.get())
                ),
            ),
            _ => Fault::new(&self.path, value, error.to_string(), region::REGION),
        }])
    }
}

/// Checks how many parts a query is to be split into.
///
/// # Errors
/// A [`Fault`] of `parts`.
pub fn check_parts(parts: u32) -> Result<u32, Fault> {
    if (1..=MOST_PARTS).contains(&parts) {
        return Ok(parts);
    }
    let detail = "it is out of range";
    Err(Fault::new("parts", parts, detail, parameters::PARTS))
}

/// The shortest digits of any number.
pub(in crate::service) fn number(value: f64) -> String {
    zmij::Buffer::new().format(value).into()
}
