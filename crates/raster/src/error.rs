//! Errors of rasters.

use std::io;

use super::limits::Limits;

/// Why a raster cannot be read. The caller names the file or field.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RasterError {
    #[error("it cannot be read: {0}")]
    Io(#[from] io::Error),
    #[error("it is of no known format; allowed: {0}")]
    Unknown(&'static str),
    #[error(
        "it has {width} × {height} pixels; allowed: 1 to {} along each side and {} in all",
        limits.side, limits.pixels
    )]
    Size {
        width: u64,
        height: u64,
        limits: Limits,
    },
    #[error("{found}; allowed: {allowed}")]
    Unsupported {
        found: String,
        allowed: &'static str,
    },
    #[error("it has {found}; allowed: {allowed}")]
    Wasteful { found: String, allowed: String },
    #[error("the {format} is damaged or truncated: {detail}")]
    Damaged {
        format: &'static str,
        detail: String,
    },
    #[error("it was not read to its end")]
    Stopped,
    #[error("the pixel in column {x}, row {y} is {value}; allowed: finite numbers")]
    NotFinite {
        /// Its column, from 0.
        x: usize,
        /// Its row from the top, from 0.
        y: usize,
        value: f64,
    },
}

impl RasterError {
    pub(super) fn damaged(format: &'static str, detail: impl ToString) -> Self {
        let detail = detail.to_string();
        Self::Damaged { format, detail }
    }
}
