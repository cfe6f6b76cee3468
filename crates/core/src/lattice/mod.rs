//! The lattice of a point set: which addresses have points, and where in the world these are.
//!
//! `placement` holds the parameters (those of `seed` and warp have files of their own), and
//! `world` joins them with a table into the [`Lattice`]. Positions are integers in fixed point, 2⁻²⁰ grid
//! units, until the last conversion: one multiplication by the step, the world size of a unit. That
//! conversion is monotone, so the bounds of a region become integers once (`span`), and integers decide
//! membership. The bounds of chunks are exact multiples of their size (`multiple`).
//!
//! `bounds` has the boxes of that grid.
//!
//! Work proceeds in pieces: `lines` lists the columns and rows that hold points, `patch` has the bands and patches in which
//! positions fit 32 bits, and lists the points of a patch without gaps. `point` is what comes out, with its rank, the place
//! in the order in which points leave; `kinds` has the points of one kind (where shares vary, `picked`), and `grade` the field that says
//! how many have left.

pub(crate) mod bounds;
mod grade;
mod kinds;
mod lines;
mod multiple;
mod patch;
mod picked;
mod placement;
mod point;
pub(crate) mod seed;
mod span;
mod without;
mod world;

pub(crate) use grade::{Grade, alike};
pub use kinds::VaryingKinds;
pub(super) use kinds::{OneKind, check_kind};
pub(super) use lines::{Columns, PrefixCounts, lines_of_class, places};
pub(crate) use multiple::Multiple;
pub(super) use patch::{BAND_WIDTH, Flat, Found, PATCH_HEIGHT, Patch, Scale, clip_to_band};
pub use placement::{Keep, Placement, Settle, Spacing};
pub(crate) use point::lattice_of;
pub use point::{Point, PointId};
pub(super) use span::{Span, places_of};
pub(crate) use without::Without;
pub use world::LATTICE_LIMIT;
pub(super) use world::{Lattice, Line};
