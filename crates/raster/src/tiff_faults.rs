//! Faults of TIFF files, in words.

use tiff::{ColorType, TiffError, TiffUnsupportedError};

use super::error::RasterError;

/// The TIFF files that are read.
const ALLOWED: &str = "one channel of 8, 16 or 32 bits (integers or floats) or of 64-bit floats, or RGB of \
                       8 or 16 bits, either with alpha; pixels side by side; compression with LZW or \
                       deflate, or none";

pub(super) fn damaged(error: TiffError) -> RasterError {
    match error {
        TiffError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            error.into()
        }
        TiffError::UnsupportedError(error) => unsupported(match error {
            TiffUnsupportedError::UnsupportedColorType(color) => kind(color),
            TiffUnsupportedError::UnsupportedCompressionMethod(method) => {
                format!("compression by method {}", method.to_u16())
            }
            _ => "a layout of pixels that is rarely used".into(),
        }),
        TiffError::LimitsExceeded => unsupported("strips, tiles or tags of too many bytes".into()),
        error => broken(&error.to_string()),
    }
}

pub(super) fn broken(detail: &str) -> RasterError {
    RasterError::Damaged {
        format: "TIFF",
        detail: detail.into(),
    }
}

/// The kind of pixels, in words.
pub(super) fn kind(color: ColorType) -> String {
    match color {
        ColorType::Palette(_) => "pixels of a palette".into(),
        ColorType::CMYK(_) | ColorType::CMYKA(_) => "CMYK pixels".into(),
        ColorType::YCbCr(_) => "YCbCr pixels".into(),
        ColorType::Lab(_) => "Lab pixels".into(),
        ColorType::Multiband {
            bit_depth,
            num_samples,
        } => format!("pixels of {num_samples} channels of {bit_depth} bits"),
        other => format!("pixels of {} bits", other.bit_depth()),
    }
}

pub(super) fn askew(found: &str) -> RasterError {
    RasterError::Unsupported {
        found: found.into(),
        allowed: "rows from west to east, the northernmost first",
    }
}

pub(super) fn unsupported(found: String) -> RasterError {
    RasterError::Unsupported {
        found,
        allowed: ALLOWED,
    }
}
