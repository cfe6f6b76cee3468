//! Makes and judges the displacement tables of Strew.
//!
//! A [`Job`] says which table: α, the size of the neighborhood map, a [noise profile](profile), a
//! seed. [`forge`] optimizes the table's vectors — not points — and accepts the table only after it
//! has been [measured](measure) on point sets it was not optimized on. The result is a
//! [`Table`](strew_core::Table) with its history, which [`write_table`] puts on disk.
//!
//! Equal jobs give equal tables on every machine and with any number of threads: what reaches a
//! table is computed with plain arithmetic in a fixed order (see [`numeric`]).
//!
//! ```
//! use strew_forge::{Job, forge};
//!
//! let mut job = Job::new("sqrt(3)".parse()?);
//! (job.radius, job.steps) = (12, Some(20)); // tiny, for the example
//! let outcome = forge(&job, &())?;
//! assert_eq!(outcome.table.profile(), "blue");
//! // So few steps and blocks do not make a good table, and it says so.
//! assert!(!outcome.accepted);
//! assert!(outcome.complaints[0].to_string().contains("low_power"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod checkpoint;
pub mod curve;
mod domain;
pub mod energy;
mod error;
mod estimate;
mod file;
mod forge;
mod job;
pub mod judge;
pub mod measure;
pub mod numeric;
pub mod optimize;
mod picture;
mod plan;
pub mod profile;
mod report;
mod twins;
mod watch;

pub use checkpoint::Checkpoint;
pub use curve::Target;
pub use error::ForgeError;
pub use estimate::Estimate;
pub use file::{EXTENSION, file_name, read_table, write_table};
pub use forge::{Outcome, forge, resume};
pub use job::{DEFAULT_SEED, Job, MAX_RADIUS, MAX_STEPS};
pub use judge::{Complaint, Figure};
pub use picture::{PictureError, picture};
pub use profile::{Aim, Profile};
pub use report::{Report, Resolution};
pub use watch::{Meter, Progress, Stage, Watch};
