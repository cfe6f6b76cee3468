//! Tables of points in space: making and judging them.
//!
//! [`forge`](crate::forge()) works off a [`SpaceJob`] in phases: descents of a Gaussian energy, first on a coarse
//! map, and pushes (both in `descent`). The table is made on the exact frequencies of pairs of its blocks in the unbounded
//! set (`pairs`), so no twin is favored, and every periodic twin is one that it was not made on. `job` has the phases
//! and the bounds, `measure` points and their power.

mod descent;
mod job;
mod judge;
mod measure;
mod pairs;

pub use crate::file::{
    read_space_table as read_table, space_file_name as table_file_name,
    write_space_table as write_table,
};
pub use job::{MAX_SPACE_RADIUS, SpaceJob, SpaceProfile};
pub use judge::{PLACES, SIDE, SpaceReport, unseen_twins};
pub use measure::{LocalPower, SpacePower, is_uniform_in_space, twin_set, window_set};
pub use pairs::{LONGEST, with_ranks};
