//! Settings of making tables on demand.

use serde::{Deserialize, Serialize};

use super::{
    Tables,
    range::{DAY, out_of_range},
};

/// The clients that may have tables made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Allow {
    /// No client.
    #[default]
    Off,
    /// Keys with `admin = true`, and the address of administrators.
    Admin,
    /// Every client that is admitted.
    Anyone,
}

/// The settings of tables that are made on demand, and of the effort for them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Forge {
    /// The clients that may have tables made.
    pub allow: Allow,
    /// The most tables that are made at once. Bounds memory and processor time.
    pub max_running: usize,
    /// The threads of each, at the lowest priority.
    pub threads: usize,
    /// The most jobs that wait.
    pub max_queued: usize,
    /// The most jobs of one client that wait or run.
    pub max_jobs_per_client: usize,
    /// The largest half-width R of a map. The time and the memory of a job grow as its square.
    pub max_radius: u32,
    /// The time between two checkpoints, in seconds: the most work that a crash costs.
    pub checkpoint_seconds: f64,
    /// The most jobs that are remembered after their end.
    pub max_ended: usize,
    /// The most files of tables in the folder, beyond which none is made.
    pub max_tables: usize,
    /// The most bytes of these files.
    pub max_bytes: u64,
}

/// The greatest half-width of maps that tables are made of: the forge's own limit, which a test of the service holds
/// equal.
pub const MOST_RADIUS: u32 = 256;

impl Forge {
    /// Whether any client may have tables made.
    #[must_use]
    pub fn is_on(&self) -> bool {
        self.allow != Allow::Off
    }

    pub(super) fn faults(&self, tables: &Tables) -> Vec<String> {
        let mut faults = out_of_range!(self, "forge",
            max_running: 1.0..=64.0,
            threads: 1.0..=64.0,
            max_queued: 0.0..=1e4,
            max_jobs_per_client: 1.0..=1e4,
            max_radius: 1.0..=f64::from(MOST_RADIUS),
            checkpoint_seconds: 0.0..=DAY,
            max_ended: 0.0..=1e4,
            max_tables: 1.0..=1e6,
            max_bytes: 1.0..=1e15,
        );
        if self.is_on() && tables.folder().is_none() {
            faults.push("forge.allow needs tables.folder, where finished tables are kept".into());
        }
        faults
    }
}
