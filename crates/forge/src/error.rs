//! What can go wrong while making, reading and writing tables.

use std::{io, path::PathBuf};

use strew_core::table::MAX_FILE_BYTES;

/// Why the forge refused or failed. Every message says what was asked, and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ForgeError {
    /// A part of a job has a value that is not allowed.
    #[error("{field} is {value}; allowed: {allowed}")]
    Field {
        /// Which part.
        field: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: String,
    },
    /// The parts do not make a table.
    #[error(transparent)]
    Table(#[from] strew_core::Error),
    /// A file is not a table.
    #[error("{}: {source}", path.display())]
    NotATable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: strew_core::Error,
    },
    /// A file is larger than any table; it was not read.
    #[error("{}: {bytes} bytes; a table file has at most {MAX_FILE_BYTES}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size.
        bytes: u64,
    },
    /// A file is not a checkpoint.
    #[error("{}: {error}", path.display())]
    NotACheckpoint {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        error: Box<ForgeError>,
    },
    /// The file system refused.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// What was being done.
        action: &'static str,
        /// To which file or folder.
        path: PathBuf,
        /// Why it failed.
        source: io::Error,
    },
}
