//! Makes and judges the displacement tables of Strew.
//!
//! A [`Job`] says which table to make: α, the size of the neighborhood map, a
//! [noise profile](profile) and a seed. [`forge()`] optimizes the vectors of the table and accepts
//! it only after it has been [judged](judge) on point sets it was not optimized on. The result is a
//! [`Table`](strew_core::Table) with its history, which [`write_table`] writes to disk.
//!
//! Equal jobs make the same table, bit for bit, on every machine and with any number of threads:
//! everything that reaches a table is computed with plain arithmetic in a fixed order (see
//! [`numeric`]).
//!
//! ```
//! use strew_forge::{Job, forge};
//!
//! let mut job = Job::new("sqrt(3)".parse()?);
//! (job.radius, job.steps) = (12, Some(20)); // tiny, for the example
//! let outcome = forge(&job, &())?;
//! assert_eq!(outcome.table.profile(), "blue");
//! // So few steps and blocks do not make a good table.
//! assert!(!outcome.accepted);
//! assert!(outcome.complaints[0].to_string().contains("low_power"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # How a table is made
//!
//! A job is checked and becomes a plan: the recipe of its [`profile`], the map and the twins to
//! optimize on, and the panel of point sets to judge on. The recipe runs in phases, each of which
//! lowers an [`energy`] as a function of the table's vectors ([`optimize`]). Some profiles follow a
//! radial power [`curve`]; their energy is the error against it. Then the panel is
//! [measured](measure) and the figures are compared with the bounds of the profile ([`judge`]).
//!
//! Meanwhile a [`Watch`] follows the [`Progress`], keeps [`Checkpoint`]s and may stop the work; [`resume`] goes on from
//! a checkpoint. For an existing table, [`with_ranks`] makes the order in which its points leave, and [`labels`] and
//! [`mix()`] make kinds of points. Apart from jobs, a [`Report`] measures any point set, and [`figure::report`] draws it.

#![allow(missing_docs, reason = "internal: names say what items are")]

mod cell_list;
mod checkpoint;
pub mod curve;
pub mod energy;
mod error;
mod estimate;
pub mod figure;
mod file;
mod forge;
mod job;
pub mod judge;
pub mod mask;
pub mod measure;
mod mix;
pub mod numeric;
pub mod optimize;
mod order;
pub mod profile;
mod report;
pub mod space;
mod twins;
mod watch;

pub use checkpoint::{Checkpoint, State};
pub use curve::Target;
pub use error::{ForgeError, SettingError};
pub use estimate::{Estimate, estimate};
pub use file::{EXTENSION, file_name, read_table, write_table};
pub use forge::{Outcome, TableOf, Task, forge, resume};
pub use job::{DEFAULT_SEED, FEW_INTERVALS, Job, MAX_RADIUS, MAX_STEPS, Prospect};
pub use judge::{Complaint, Figure, gravest};
pub use measure::ThinnedTwin;
pub use mix::{MixJob, MixOutcome, labels, mix, mix_file_name, second_order};
pub use order::with_ranks;
pub use profile::{Aim, Profile};
pub use report::{Report, Resolution};
pub use watch::{Meter, Progress, Stage, Watch};
