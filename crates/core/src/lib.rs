//! Strew's core: unbounded, blue-noise point sets with random access, from tiny tables.
//!
//! A [`PointSet`] answers questions about an unbounded set of evenly spread points: which lie in this
//! chunk, how many in that polygon, which are nearest, where is the one with this id. Nothing is stored.
//! The same question has the same answer in every order, on every machine, with the same bits.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::PointSet;
//! # fn spawn(_: strew_core::PointId, _: [f64; 2], _: f64, _: f64) {}
//!
//! let trees = PointSet::blue().spacing(4.0)?.seed(7);
//! for p in trees.chunk(64.0, [3, -2])? {
//!     spawn(p.id(), p.at(), p.angle(), p.scale(0.8..=1.2));
//! }
//! let near = trees.nearest([10.0, 3.0], 5)?;
//! # let id = near[0].member.id();
//! let same = trees.point(id);
//! # assert_eq!(same, Some(near[0].member));
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! [`cookbook`] has recipes for common tasks, and what a debug build needs to be fast; [`comparison`] says how this differs from Poisson-disk
//! libraries, Wang tiles and jittered grids.
//!
//! # How it works
//!
//! An *AA pattern* (Ahmed, Huang, Deussen, "AA Patterns for Point Sets with Controlled Spectral
//! Properties", SIGGRAPH Asia 2015) is an unbounded, structured subset of the integer grid with random
//! access. A *displacement table*, of which the default has 0.2 MB, moves its points, which determines the noise
//! profile of the set. The modules build on each other: [`pattern`] → [`map`] → [`table`] → the point set.
//!
//! # Features
//!
//! - `std` (default): vector instructions of x86-64 are found at run time, and some results are kept.
//!   Without it the crate needs `alloc` only; all results have the same bits.
//! - `tables` (default): [`PointSet::blue`] and its table, 0.2 MB. Others are read from files by
//!   [`Table::from_bytes`].
//! - `clearance`, `fields`, `kinds`, `polygons`, `words` (default): sets that keep clear of others, sets in fields,
//!   kinds of points, polygons, and decimal numbers in errors, for programs that need not be small.
//! - `cells`: some results are kept without `std`, too.
//! - `even-1-1`, `even-1-3`, `even-1-1-2`, `even-1-3-10`: labels of that table for [evenly spread kinds](Kinds::even) in
//!   the ratio of the name, 50 kB each.
//! - `joint-1-1`, `joint-1-3`, `joint-1-1-2`, `joint-1-3-10`: tables of [joint kinds](Kinds::joint), 0.19 MB each.
//!
//! The crate knows no network, no async runtime, no file system and no serialization framework.
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(
    not(all(
        feature = "clearance",
        feature = "fields",
        feature = "kinds",
        feature = "polygons"
    )),
    allow(
        dead_code,
        unreachable_code,
        unused_imports,
        unused_mut,
        unused_variables,
        reason = "of the parts that are left out"
    )
)]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

mod attribute;
mod batch;
pub mod comparison;
pub mod cookbook;
mod distance;
mod error;
pub mod field;
mod kernel;
mod lattice;
pub mod map;
mod methods;
mod near;
mod once;
mod parts;
pub mod pattern;
mod periodic;
mod plan;
pub mod server;
mod set;
mod settle;
mod shape;
mod sort;
pub mod space;
mod stop;
pub mod table;
mod walk;
mod warp;
mod window;

pub use attribute::{
    Attribute, Attributes, BoundAttributes, Column, Kinds, ScaleRange, UniformNumber,
    VariantScales, Variants,
};
pub use distance::LeastDistance;
pub use error::{Error, ErrorKind};
pub use field::{Field, Raster};
pub use kernel::{Backend, Exact, F32, F64, Format, Offsets, Place, Points};
pub use lattice::{
    Keep, LATTICE_LIMIT, Placement, Point, PointId, Settle, Spacing, VaryingKinds, seed::Seed,
};
pub use map::{Map, Twin};
pub use near::{Clearance, Neighbor};
pub use pattern::{Alpha, Pattern};
pub use periodic::{PeriodicBlocks, PeriodicPlan, PeriodicSet};
pub use plan::{
    Plan,
    member::{Member, Members},
};
pub use set::{Kind, PointSet};
pub use shape::{Area, Circle, Polygon, Region, Shape};
pub use table::Table;
pub use walk::{Blocks, Tile};
pub use warp::Warp;
pub use window::Cursor;

/// The version of the algorithm that turns a table, a density, a seed and a lattice address into a point,
/// and that orders the points of a region. Any change of any output raises it.
///
/// ```
/// use strew_core::{ALGORITHM_VERSION, PointId};
///
/// // A saved game that keeps ids keeps the version with them.
/// let saved = (4, PointId { x: -31, y: 52 });
/// assert_eq!(saved.0, ALGORITHM_VERSION, "made with other points");
/// ```
pub const ALGORITHM_VERSION: u32 = 4;
