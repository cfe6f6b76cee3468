//! Thinned sets: the order in which blocks leave, and the points that are left.

mod order;
mod twin;

pub use order::with_ranks;
pub use twin::ThinnedTwin;
