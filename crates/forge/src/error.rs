//! Errors of making, reading and writing tables.

use std::{
    io,
    path::{Path, PathBuf},
};

use strew_core::table::MAX_FILE_BYTES;

/// A setting of a figure or a mask is out of range.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{field} is {value}; it must be {allowed}")]
pub struct SettingError {
    pub field: String,
    pub value: String,
    pub allowed: String,
}

impl From<strew_core::Error> for SettingError {
    fn from(error: strew_core::Error) -> Self {
        Self {
            field: error.field().into(),
            value: error.value().into(),
            allowed: error.allowed().into(),
        }
    }
}

impl SettingError {
    pub(crate) fn new(field: &str, value: impl ToString, allowed: impl Into<String>) -> Self {
        Self {
            field: field.into(),
            value: value.to_string(),
            allowed: allowed.into(),
        }
    }
}

/// An error of the forge. Messages about input state the refused value and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ForgeError {
    /// A part of a job, a curve or a checkpoint has a value that is not allowed.
    #[error("{field} is {value}; allowed: {allowed}")]
    Field {
        field: &'static str,
        value: String,
        allowed: String,
    },
    /// The parts of a job do not make a table.
    #[error(transparent)]
    Table(#[from] strew_core::Error),
    /// A file is not a table.
    #[error("{}: {source}", path.display())]
    NotATable {
        path: PathBuf,
        source: strew_core::Error,
    },
    /// A file is a table of points in space, where one of the plane is wanted.
    #[error("{}: a table of points in space; allowed here: a table of the plane", path.display())]
    InSpace { path: PathBuf },
    /// A file is larger than any table.
    #[error("{}: {bytes} bytes; a table file has at most {MAX_FILE_BYTES}", path.display())]
    TooLarge {
        path: PathBuf,
        /// The size of the file, or of the part that was read.
        bytes: u64,
    },
    /// A file is not a checkpoint.
    #[error("{}: {error}", path.display())]
    NotACheckpoint {
        path: PathBuf,
        error: Box<ForgeError>,
    },
    /// An operation on a file or folder failed.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        action: &'static str,
        path: PathBuf,
        source: io::Error,
    },
}

impl ForgeError {
    /// The refusal of a part.
    pub(crate) fn field(
        field: &'static str,
        value: impl ToString,
        allowed: impl Into<String>,
    ) -> Self {
        Self::Field {
            field,
            value: value.to_string(),
            allowed: allowed.into(),
        }
    }

    /// Refuses a part that is 0 or more than `most`.
    pub(crate) fn unless_in_range(field: &'static str, value: u32, most: u32) -> Result<(), Self> {
        match (1..=most).contains(&value) {
            true => Ok(()),
            false => Err(Self::field(field, value, format!("1 to {most}"))),
        }
    }

    /// The error of an operation on a file or folder, of its cause.
    pub(crate) fn file(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::File {
            action,
            path,
            source,
        }
    }
}
