//! Strew's core: AA patterns, neighborhood maps, displacement tables and the region sampler.
//!
//! An *AA pattern* (Ahmed, Huang, Deussen, "AA Patterns for Point Sets with Controlled Spectral
//! Properties", SIGGRAPH Asia 2015) is an unbounded, structured subset of the integer grid with
//! full random access. A *displacement table* of a few kilobytes turns it into a point set of a
//! chosen noise profile. This crate answers "which points lie in this box" exactly, in any order,
//! on any machine, with the same bits.
//!
//! The floors, each built on the one before: [`pattern`] → [`map`] → [`table`] → [`sample`].
//!
//! The crate knows no wire, no async runtime, no file system and no JSON. It builds without the
//! standard library (`default-features = false`), so engines and browsers can embed it.
//!
//! ```
//! use std::sync::Arc;
//! use strew_core::{Alpha, Placement, Region, Sampler, Seed, Spacing, Table};
//!
//! // A table without displacements: the AA pattern itself.
//! let table = Table::undisplaced("sqrt(3)".parse::<Alpha>()?, 20, "pattern")?;
//! let sampler = Arc::new(Sampler::new(table));
//! let region = Region::new([-50.0, -50.0], [50.0, 50.0])?;
//! let plan = sampler.plan(Placement::new(Spacing::new(1.0)?, Seed::default()), region)?;
//! let mut points = vec![[0.0f64; 2]; usize::try_from(plan.count())?];
//! let filled = plan.blocks_f64().fill(&mut points);
//! assert_eq!(filled as u128, plan.count());
//! assert!(points.iter().all(|p| (-50.0..50.0).contains(&p[0])));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

pub mod map;
pub mod pattern;
pub mod sample;
pub mod table;

pub use map::{Map, Twin};
pub use pattern::{Alpha, Pattern};
pub use sample::{
    Area, Attribute, Attributes, Circle, Finder, Placement, Plan, Point, PointId, Polygon, Region,
    Sampler, Seed, Spacing, Warp,
};
pub use table::Table;

/// The version of the algorithm that turns a table, a density, a seed and a lattice address into
/// a point, and that orders the points of a region. Any change of any output raises it.
pub const ALGORITHM_VERSION: u32 = 1;
