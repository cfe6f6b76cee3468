//! The lattice of a point set: which addresses have points, and where in the world these are.
//!
//! `placement` holds the parameters (`spacing`, seed and warp have files of their own), and
//! `world` joins them with a table into the [`Lattice`]. Positions are integers in fixed point, 2⁻²⁰ grid
//! units, until the last conversion: one multiplication by the step, the world size of a unit. That
//! conversion is monotone, so the bounds of a region become integers once (`span`), and integers decide
//! membership. The bounds of chunks are exact multiples of their size (`multiple`).
//!
//! Work proceeds in pieces: `lines` lists the columns and rows that hold points (each a `line`), `prefix` counts them,
//! `patch` has the bands and patches in which positions fit 32 bits, `flat` lists the points of a patch without gaps. `point`
//! is what comes out, `rank` its place in the order in which points leave and its kind, `kinds` the points of one kind,
//! `varied` kinds whose shares vary (`picked` has their points), and `grade` the field that says how many have left.

mod flat;
mod grade;
mod keep;
mod kinds;
mod line;
mod lines;
mod multiple;
mod patch;
mod picked;
mod placement;
mod point;
mod prefix;
mod rank;
mod settle;
mod spacing;
mod span;
mod varied;
mod world;

pub(super) use flat::{Flat, Found};
pub(crate) use grade::Grade;
pub use keep::Keep;
pub(super) use kinds::{OneKind, check_kind};
pub(super) use line::Line;
pub(super) use lines::{Columns, lines_of_class, places};
pub(crate) use multiple::Multiple;
pub(super) use patch::{BAND_WIDTH, PATCH_HEIGHT, Patch, clip_to_band};
pub use placement::Placement;
pub(crate) use point::lattice_of;
pub use point::{Point, PointId};
pub(super) use prefix::PrefixCounts;
pub(super) use rank::{kind, rank};
pub use settle::Settle;
pub use spacing::Spacing;
pub(super) use span::{Span, places_of};
pub use varied::VaryingKinds;
pub use world::LATTICE_LIMIT;
pub(super) use world::Lattice;
