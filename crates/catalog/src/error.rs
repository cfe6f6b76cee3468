//! Why tables cannot be loaded, naming the file.

use std::{io, path::PathBuf};

use super::{Key, Source};

/// Why the tables cannot be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CatalogError {
    /// The folder cannot be listed.
    #[error("cannot list the tables folder {}: {error}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// A file cannot be read.
    #[error("cannot read the table {}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// A file is not a valid table.
    #[error("the table {source_name} is not valid: {error}")]
    Table {
        /// Where it is.
        source_name: Source,
        /// The fault and its place.
        error: strew_core::Error,
    },
    /// Two tables of one place answer the same queries.
    #[error("the tables {first} and {second} are both for {key}: keep one")]
    Twice {
        /// The key of both.
        key: Key,
        /// One.
        first: Source,
        /// The other.
        second: Source,
    },
}
