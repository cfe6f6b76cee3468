//! Why tables cannot be loaded, naming the file.

use std::{io, path::PathBuf};

use super::{Key, Source};

/// Why the tables cannot be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CatalogError {
    #[error("cannot list the tables folder {}: {error}", path.display())]
    Folder { path: PathBuf, error: io::Error },
    #[error("cannot read the table {}: {error}", path.display())]
    File { path: PathBuf, error: io::Error },
    #[error("the table {source_name} is not valid: {error}")]
    Table {
        source_name: Source,
        error: strew_core::Error,
    },
    #[error("the tables {first} and {second} are both for {key}: keep one")]
    Twice {
        key: Key,
        first: Source,
        /// The other.
        second: Source,
    },
}
