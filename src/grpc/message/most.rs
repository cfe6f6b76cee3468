//! The bounds on repeated fields of a request, checked before its message is decoded.
//!
//! The names are those of the contract: `Layer.clear_of` is `LAYER_CLEAR_OF`. The table made from it names one for
//! every field that is repeated, so a new one does not compile without its limit. Queries are checked against the same
//! limits once they are read; here they bound the memory of reading.

use strew_catalog::except::MOST_GIVEN;
use strew_config::Limits;
use strew_core::{Variants, field::FieldSpec, table::Shares};
use strew_query::{MOST_LAYERS, MOST_NAMES, MOST_REGIONS};

/// The bound on a field, and the name of its values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Most {
    pub(super) among: Among,
    pub(super) limit: Limit,
    pub(super) what: &'static str,
}

impl Most {
    /// Whether the field is not repeated.
    pub(super) const fn is_once(self) -> bool {
        matches!(self.limit, Limit::Fixed(1))
    }
}

/// The items that are counted together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Among {
    /// Each list for itself.
    List,
    /// All lists of the request that count the same.
    Request(Tally),
    /// All lists of one field, with those that it is joined of.
    Field(Tally),
}

/// The items that are counted over several lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tally {
    Regions,
    Polygons,
    Rings,
    Positions,
    Parts,
    Marks,
}

/// The number of tallies.
pub(super) const TALLIES: usize = 6;

#[derive(Clone, Copy, Debug)]
pub(super) enum Limit {
    Fixed(usize),
    /// The most vertices that regions may have.
    Vertices,
}

impl Limit {
    pub(super) const fn of(self, limits: &Limits) -> usize {
        match self {
            Self::Fixed(limit) => limit,
            Self::Vertices => limits.max_vertices,
        }
    }
}

const fn each(limit: usize, what: &'static str) -> Most {
    let (among, limit) = (Among::List, Limit::Fixed(limit));
    Most { among, limit, what }
}

const fn of_regions(tally: Tally, what: &'static str) -> Most {
    let (among, limit) = (Among::Request(tally), Limit::Vertices);
    Most { among, limit, what }
}

const fn of_field(tally: Tally, limit: usize, what: &'static str) -> Most {
    let (among, limit) = (Among::Field(tally), Limit::Fixed(limit));
    Most { among, limit, what }
}

/// A field that is not repeated. Decoders join messages that occur again.
pub(super) const ONCE: Most = each(1, "values");

pub(super) const STREAM_POINTS_REQUEST_LAYERS: Most = each(MOST_LAYERS, "layers");
pub(super) const LAYER_CLEAR_OF: Most = each(MOST_LAYERS, "distances");

const REGIONS: Most = Most {
    among: Among::Request(Tally::Regions),
    limit: Limit::Fixed(MOST_REGIONS),
    what: "regions",
};
pub(super) const COMBINED_INCLUDE: Most = REGIONS;
pub(super) const COMBINED_EXCLUDE: Most = REGIONS;
// Each has vertices.
pub(super) const POLYGONS_POLYGONS: Most = of_regions(Tally::Polygons, "polygons");
pub(super) const POLYGON_RINGS: Most = of_regions(Tally::Rings, "rings");
pub(super) const RING_POSITIONS: Most = of_regions(Tally::Positions, "vertices");

pub(super) const POINT_SET_ATTRIBUTES: Most = each(MOST_NAMES, "attributes");
pub(super) const POINT_SET_EXCEPT: Most = each(MOST_GIVEN, "items");
pub(super) const POINT_SET_VARIANTS: Most = each(Variants::MAX, "variants");
pub(super) const POINT_SET_SCALE_RANGES: Most = each(Variants::MAX, "ranges");
pub(super) const POINT_SET_VARIANT_FIELDS: Most = each(Shares::MAX_KINDS, "fields");

const PARTS: Most = of_field(Tally::Parts, FieldSpec::MAX_PARTS, "parts");
const MARKS: Most = of_field(Tally::Marks, FieldSpec::MAX_VERTICES, "vertices");
pub(super) const FIELD_PARTS_FIELDS: Most = PARTS;
pub(super) const FIELD_CURVE_POINTS: Most = each(FieldSpec::MAX_CURVE, "points");
pub(super) const FIELD_DISTANCE_POINTS: Most = MARKS;
pub(super) const FIELD_LINE_VERTICES: Most = MARKS;
pub(super) const FIELD_DISTANCE_LINES: Most = each(FieldSpec::MAX_VERTICES, "lines");
pub(super) const FIELD_DISTANCE_POLYGONS: Most = each(FieldSpec::MAX_VERTICES, "polygons");
