//! Thinned sets: the order in which blocks leave, and the displacements of those that are left.

mod ground;
mod order;
mod thinned;

pub use order::with_ranks;
pub use thinned::ThinnedTwin;
