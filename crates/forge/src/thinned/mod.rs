//! Thinned sets: the order in which blocks leave, and the points that are left.

mod ground;
mod order;
mod twin;

pub(crate) use ground::{Ground, moves_of};
pub use order::with_ranks;
pub use twin::ThinnedTwin;
