//! Thinned sets: the order in which blocks leave, and the displacements of those that are left.

mod clearance;
mod climb;
mod events;
mod ground;
mod judge;
mod make;
mod order;
mod polish;
mod segment;
mod thinned;

pub(crate) use ground::{Ground, moves_of};
pub use make::{LadderJob, LadderOutcome, ladder};
pub use order::with_ranks;
pub use thinned::ThinnedTwin;
