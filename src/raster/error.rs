//! What can be wrong with a raster.

use std::io;

use super::limits::Limits;

/// Why a raster cannot be read. The file or field is named by whoever reads it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RasterError {
    /// The file system refuses.
    #[error("it cannot be read: {0}")]
    Io(#[from] io::Error),
    /// It is of no known format.
    #[error("it is of no known format; allowed: {0}")]
    Unknown(&'static str),
    /// It is empty or too large.
    #[error(
        "it has {width} × {height} pixels; allowed: 1 to {} along each side and {} in all",
        limits.side, limits.pixels
    )]
    Size {
        /// Its width.
        width: u64,
        /// Its height.
        height: u64,
        /// What is allowed.
        limits: Limits,
    },
    /// Its format has kinds that are not read.
    #[error("{found}; allowed: {allowed}")]
    Unsupported {
        /// What it has.
        found: String,
        /// What it may have.
        allowed: &'static str,
    },
    /// It would take far more work than its pixels are worth.
    #[error("it has {found}; allowed: {allowed}")]
    Wasteful {
        /// What it has.
        found: String,
        /// How much its pixels allow.
        allowed: String,
    },
    /// It breaks the rules of its format, or ends early.
    #[error("the {format} is damaged or truncated: {detail}")]
    Damaged {
        /// The name of its format.
        format: &'static str,
        /// What is wrong where.
        detail: String,
    },
    /// It was not wanted any more while it was read.
    #[error("it was not read to its end")]
    Stopped,
    /// A pixel is no number.
    #[error("the pixel in column {x}, row {y} is {value}; allowed: finite numbers")]
    NotFinite {
        /// Its column, from 0.
        x: usize,
        /// Its row from the top, from 0.
        y: usize,
        /// What it is.
        value: f64,
    },
}
