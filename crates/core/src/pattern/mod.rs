//! AA patterns: which grid points belong, and how to list, count and find them axis by axis.
//!
//! A grid point (x, y) has the *index* dX = {(αx + y)/2}, dY = {(αy + x)/2} on the unit torus, and
//! belongs to AA(α) iff dX < t and dY < t with t = (α − 1)/2 (paper, Eqs. 2 to 4). The torus is
//! kept as `u64`, one unit = 2⁻⁶⁴, so that {·} is wrapping arithmetic: exact, with the same bits
//! on every machine, at every coordinate an `i64` admits.

mod alpha;
mod arrangement;
mod axis;
mod first_hit;
mod floor_sum;
mod forward;
mod index;
mod quadratic;
mod turns;

pub use alpha::{Alpha, AlphaError};
pub use arrangement::arrangement_frequency;
pub use axis::{Axis, AxisSet, Class};
pub use forward::{forward_map, is_vacant};
pub use index::{IndexOrigin, Pattern};
pub(crate) use turns::Turns;
