//! The walk: makes the points of a plan, in order, no faster than they are taken.
//!
//! `blocks` walks the bands, rows and columns of a `window` and fills blocks of points; `place` is where it is, `sifting` what it knows of a sieve, and `template` holds
//! what the rows of a band share. `tile` cuts a plan into parts that threads fill independently.

mod blocks;
mod place;
mod sifting;
mod template;
mod tile;
mod window;

pub use blocks::Blocks;
pub(super) use blocks::{
    find_few,
    graded::{Counted, Mark, count as count_graded, locate as locate_graded},
};
pub use tile::Tile;
pub(super) use tile::{bands, tiles};
pub(super) use window::Window;
