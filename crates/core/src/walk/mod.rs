//! The walk: makes the points of a plan, in order, no faster than they are taken.
//!
//! A `scope` is the part of a lattice that a plan covers, and its `sieve` what the points must satisfy. `count` says how
//! many there are, without making them.
//!
//! `blocks` fills blocks of points of a window or a tile. Four walks make the points: `rows` in boxes and areas, `graded`
//! in a field, `settled` where points settle, and `few` has those of small plans, which were found when `counted`
//! counted them. `bands` is where a walk is, and has the tiles that threads fill independently; `sifting` the state of a walk in a sieve, and `template` holds the columns that the rows of a
//! band share.

mod bands;
mod blocks;
pub(crate) mod count;
mod counted;
mod few;
mod graded;
pub(crate) mod missing;
mod rows;
pub(crate) mod scope;
mod settled;
pub(crate) mod sieve;
mod sifting;
mod template;

pub use bands::Tile;
pub(super) use bands::{format_of, tiles};
pub use blocks::Blocks;
pub(super) use counted::{Counted, Mark, locate_graded};
