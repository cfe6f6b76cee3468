//! Tables of points in space: making and judging them.
//!
//! A table is made on the exact frequencies of pairs of its blocks in the unbounded set (`meetings`, `pairs`), so no
//! twin is favored, and every periodic twin is one that the table was not made on.

mod descent;
mod energy;
mod job;
mod judge;
mod measure;
mod meetings;
mod order;
mod pairs;
mod push;
mod transform;

pub use job::{SpaceJob, SpaceProfile, forge};
pub use judge::{figures, judged};
pub use measure::{LocalPower, SpaceDistances, SpacePower};
pub use order::with_ranks;
pub use pairs::LONGEST;
