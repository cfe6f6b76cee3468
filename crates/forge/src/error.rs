//! Errors of making, reading and writing tables.

use std::{io, path::PathBuf};

use strew_core::table::MAX_FILE_BYTES;

/// An error of the forge. Messages about input state the refused value and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ForgeError {
    /// A part of a job, a curve or a checkpoint has a value that is not allowed.
    #[error("{field} is {value}; allowed: {allowed}")]
    Field {
        /// The name of the part.
        field: &'static str,
        /// The value of the part.
        value: String,
        /// What is allowed.
        allowed: String,
    },
    /// The parts of a job do not make a table.
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
    /// A file is larger than any table.
    #[error("{}: {bytes} bytes; a table file has at most {MAX_FILE_BYTES}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The size of the file, or of the part that was read.
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
    /// An operation on a file or folder failed.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// The operation, as a verb.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
}
