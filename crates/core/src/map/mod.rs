//! Neighborhood maps: which places of index space have the same surroundings.
//!
//! A neighbor at offset (i, j) shifts dX by (αi + j)/2. So the neighborhood of half-width R is fixed,
//! axis by axis, by the thresholds {e − (αk + b)/2 mod 1 : e ∈ {0, t}, |k| ≤ R, b ∈ {0, 1}} inside
//! (0, t). They cut [0, t) into n(R) intervals. A *block* is a pair of intervals, and the n² blocks hold
//! n² displacement vectors.
//!
//! ```
//! use strew_core::{Map, Pattern};
//!
//! let map = Map::new("(5-sqrt(3))/2".parse()?, 20)?;
//! let pattern = Pattern::new(map.alpha());
//! let block = |(dx, dy)| (map.interval_of(dx), map.interval_of(dy));
//! // Points of one block have the same neighbors up to 20 grid units along either axis.
//! let around = |x, y| [[0, 2], [2, 0], [3, 1]].map(|[i, j]| pattern.contains(x + i, y + j));
//! for x in (0..100_000).filter(|&x| block(pattern.index(x, 0)) == block(pattern.index(0, 0))) {
//!     assert_eq!(around(x, 0), around(0, 0));
//! }
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! `neighborhood` has the intervals and their lookup, `size` the names of common half-widths. The
//! order of the thresholds holds for an interval of α (`cell`); the fractions in it are the map's
//! periodic twins (`twin`), whose points and blocks `site` lists. `surroundings` lists the neighbors that a
//! block's points have; `clusters` finds the connected groups of points.

mod cell;
mod clusters;
mod neighborhood;
mod shape;
mod site;
mod size;
mod surroundings;
mod twin;

pub use clusters::Clusters;
pub use neighborhood::Map;
pub(crate) use neighborhood::Numbers;
pub use shape::Shape;
pub use site::Site;
pub use size::{MAX_RADIUS, Size};
pub use twin::Twin;
