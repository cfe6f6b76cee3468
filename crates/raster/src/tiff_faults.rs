//! Faults of TIFF files, in words.

use tiff::{ColorType, TiffError, TiffUnsupportedError};

use super::error::RasterError;

const ALLOWED: &str = "one channel of 1, 2, 4, 8, 16 or 32 bits (integers or floats) or of 64-bit floats, or a palette, or \
                       RGB of 8 or 16 bits, either with alpha; pixels side by side; compression with deflate, LZW or \
                       PackBits, or none, such as gdal_translate -co COMPRESS=DEFLATE makes";

pub(super) fn damaged(error: TiffError) -> RasterError {
    match error {
        TiffError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            error.into()
        }
        TiffError::UnsupportedError(error) => unsupported(match error {
            TiffUnsupportedError::UnsupportedColorType(color) => kind(color),
            TiffUnsupportedError::UnsupportedCompressionMethod(method) => {
                format!("compression by {}", compression(method.to_u16()))
            }
            TiffUnsupportedError::InconsistentBitsPerSample(_) => {
                "channels of different numbers of bits".into()
            }
            TiffUnsupportedError::UnsupportedSampleFormat(_) => {
                "numbers that are complex, or of different kinds".into()
            }
            TiffUnsupportedError::InterpretationWithBits(meaning, bits) => format!(
                "{meaning:?} pixels of {} channels of {} bits",
                bits.len(),
                bits.first().unwrap_or(&0)
            ),
            TiffUnsupportedError::UnknownInterpretation => "pixels of an unknown meaning".into(),
            other => other.to_string(),
        }),
        TiffError::LimitsExceeded => unsupported("strips, tiles or tags of too many bytes".into()),
        error => broken(&error.to_string()),
    }
}

fn compression(method: u16) -> String {
    let names = [
        (2, "CCITT"),
        (3, "CCITT fax 3"),
        (6, "JPEG of the kind before TIFF 6"),
        (34712, "JPEG 2000"),
        (34887, "LERC"),
        (34925, "LZMA"),
        (50002, "JPEG XL"),
    ];
    let known = names.into_iter().find(|(code, _)| *code == method);
    known.map_or_else(|| format!("method {method}"), |(_, name)| name.into())
}

pub(super) fn broken(detail: &str) -> RasterError {
    RasterError::damaged("TIFF", detail)
}

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

pub(super) fn unsupported(found: String) -> RasterError {
    RasterError::Unsupported {
        found,
        allowed: ALLOWED,
    }
}
