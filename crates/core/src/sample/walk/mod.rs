//! The walk: makes the points of a plan, in order, no faster than they are taken.
//!
//! `blocks` fills blocks of points of a window or a tile (`tile` cuts a plan into tiles, which threads fill
//! independently). Four walks make the points: `rows` in boxes and areas, `graded` in a field, `settled` where points
//! settle, and `few` has those of small plans, which were found when `counted` counted them. `bands` is where a walk
//! is, `strips` where one of points that settle is and `inside` what these must meet, `sifting` its state in a sieve, and
//! `template` holds the columns that the rows of a band share.

mod bands;
mod blocks;
mod counted;
mod few;
mod graded;
mod inside;
mod rows;
mod settled;
mod sifting;
mod strips;
mod template;
mod tile;

pub(super) use bands::format_of;
pub use blocks::Blocks;
pub(super) use counted::{Counted, Mark, locate_graded};
pub use tile::Tile;
pub(super) use tile::tiles;
