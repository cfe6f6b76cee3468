//! Errors of rasters.

use std::io;

use super::limits::Limits;

/// Why a raster cannot be read. The caller names the file or field.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RasterError {
    /// The file system refuses.
    #[error("it cannot be read: {0}")]
    Io(#[from] io::Error),
    /// The format is unknown.
    #[error("it is of no known format; allowed: {0}")]
    Unknown(&'static str),
    /// The raster is empty or too large.
    #[error(
        "it has {width} × {height} pixels; allowed: 1 to {} along each side and {} in all",
        limits.side, limits.pixels
    )]
    Size {
        /// Its width.
        width: u64,
        /// Its height.
        height: u64,
        /// The limits.
        limits: Limits,
    },
    /// Its format has kinds that are not read.
    #[error("{found}; allowed: {allowed}")]
    Unsupported {
        /// The kind that the file has.
        found: String,
        /// The kinds that are read.
        allowed: &'static str,
    },
    /// It would take far more work than its pixels are worth.
    #[error("it has {found}; allowed: {allowed}")]
    Wasteful {
        /// The number that the file has.
        found: String,
        /// The most that its pixels allow.
        allowed: String,
    },
    /// It breaks the rules of its format, or ends early.
    #[error("the {format} is damaged or truncated: {detail}")]
    Damaged {
        /// The name of its format.
        format: &'static str,
        /// The fault and its place.
        detail: String,
    },
    /// Reading stopped because the result was no longer wanted.
    #[error("it was not read to its end")]
    Stopped,
    /// A pixel is no number.
    #[error("the pixel in column {x}, row {y} is {value}; allowed: finite numbers")]
    NotFinite {
        /// Its column, from 0.
        x: usize,
        /// Its row from the top, from 0.
        y: usize,
        /// The pixel's value.
        value: f64,
    },
}
