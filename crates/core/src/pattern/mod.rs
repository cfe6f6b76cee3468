//! AA patterns: which grid points belong to one, and how to list, count and find them.
//!
//! A grid point (x, y) has the *index* dX = {(αx + y)/2}, dY = {(αy + x)/2} on the unit torus. It
//! belongs to AA(α) iff dX < t and dY < t, with t = (α − 1)/2 (Ahmed, Huang, Deussen 2015, Eqs. 2 to
//! 4). The torus is held as `u64`, one unit = 2⁻⁶⁴, so {·} is wrapping arithmetic: exact, and the
//! same bits on every machine, at every coordinate an `i64` holds.
//!
//! `alpha` is the number α (`quadratic` reads it exactly), `index` membership, `axis` the sets of
//! columns and rows whose products make up the pattern. `rotation` counts and finds members of
//! such a set in O(log), and counts for all intervals of a map at once. `arrangement` (with `occurrences`, its places in
//! order) is another result of the paper.

mod alpha;
mod arrangement;
mod axis;
mod index;
mod occurrences;
mod quadratic;
mod rotation;

pub use alpha::Alpha;
pub use arrangement::Arrangement;
pub use axis::{Axis, AxisSet, Class};
pub use index::{IndexOrigin, Pattern, forward_map, is_vacant};
pub(crate) use rotation::Turns;
