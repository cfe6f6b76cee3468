//! Tables of points in space: making and judging them.
//!
//! A [`SpaceJob`] is worked off in phases (`job`): descents of a Gaussian energy (`energy`), first on a coarse map, and
//! pushes (both in `descent`). Between two steps there is no more than a state, which checkpoints keep. The table is made
//! on the exact frequencies of pairs of its blocks in the unbounded set (`pairs`), so no twin is favored, and every
//! periodic twin is one that it was not made on. `make` runs the phases, adds the `order` in which blocks leave and has
//! the table judged; `measure` has the figures.

mod descent;
mod energy;
mod estimate;
mod file;
mod job;
mod judge;
mod make;
mod measure;
mod order;
mod pairs;

pub(crate) use descent::SpaceState;
pub use estimate::SpaceEstimate;
pub use file::{read_table, table_file_name, write_table};
pub use job::{MAX_SPACE_RADIUS, SpaceJob, SpaceProfile};
pub use judge::{PLACES, SIDE, SpaceReport, unseen_twins};
pub use make::{forge, resume};
pub use measure::{
    LocalPower, Shell, SpaceDistances, SpacePoints, SpacePower, SpaceShared, is_uniform_in_space,
};
pub use order::with_ranks;
pub use pairs::LONGEST;
