//! Neighborhood maps: which places of index space have the same surroundings.
//!
//! A neighbor at offset (i, j) shifts dX by (αi + j)/2. So the neighborhood of half-width R is fixed,
//! axis by axis, by the thresholds {e − (αk + b)/2 mod 1 : e ∈ {0, t}, |k| ≤ R, b ∈ {0, 1}} inside
//! (0, t). They cut [0, t) into n(R) intervals. A *block* is a pair of intervals, and the n² blocks hold
//! n² displacement vectors.
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
