//! Rasters from PNG.

use std::io::{BufRead, Seek};

use png::{BitDepth, ColorType, Decoder, DecodingError, Transformations};
use strew_core::server::Stop;

use super::{
    error::RasterError,
    image::Image,
    limits::Limits,
    samples::Samples,
    tone::{self, Channels, Meaning},
    wanted::look,
};

/// The bytes that the decoder may use besides the pixels: a few rows, a palette.
const WORKING_BYTES: usize = 8 << 20;
/// An interlaced file is decoded as a whole; it may take this much.
const INTERLACED_BYTES: usize = 256 << 20;

pub(super) fn read(
    from: impl BufRead + Seek,
    meaning: Meaning,
    limits: Limits,
    stop: &Stop,
) -> Result<Image, RasterError> {
    let mut decoder = Decoder::new_with_limits(
        from,
        png::Limits {
            bytes: WORKING_BYTES,
        },
    );
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    decoder.set_transformations(Transformations::EXPAND);
    let info = decoder.read_header_info().map_err(damaged)?;
    let size = limits.check(info.width.into(), info.height.into())?;
    let is_interlaced = info.interlaced;
    let mut reader = decoder.read_info().map_err(damaged)?;
    let (color, depth) = reader.output_color_type();
    let channels = Channels {
        has_colors: matches!(color, ColorType::Rgb | ColorType::Rgba),
        has_alpha: matches!(color, ColorType::GrayscaleAlpha | ColorType::Rgba),
    };
    let mut rows = Rows {
        channels,
        meaning,
        words: vec![],
        samples: match depth {
            BitDepth::Sixteen => Samples::U16(vec![]),
            _ if channels.are_plain(meaning) => Samples::U8(vec![]),
            _ => Samples::U16(vec![]),
        },
        is_deep: depth == BitDepth::Sixteen,
    };
    let width = size[0] * channels.count() * if rows.is_deep { 2 } else { 1 };
    if is_interlaced {
        let bytes = width * size[1];
        if bytes > INTERLACED_BYTES {
            return Err(RasterError::Unsupported {
                found: format!("an interlaced PNG of {bytes} bytes"),
                allowed: "without interlacing, or up to 268435456 bytes when decoded",
            });
        }
        let mut whole = vec![0; reader.output_buffer_size().unwrap_or(bytes)];
        reader.next_frame(&mut whole).map_err(damaged)?;
        for row in whole.chunks_exact(width).take(size[1]) {
            look(stop)?;
            rows.add(row);
        }
    } else {
        for _ in 0..size[1] {
            look(stop)?;
            let row = reader.next_row().map_err(damaged)?;
            let row = row.ok_or_else(|| damaged("it ends before its last row"))?;
            rows.add(row.data());
        }
    }
    let mut samples = rows.samples;
    match &mut samples {
        Samples::U8(values) => values.shrink_to_fit(),
        Samples::U16(values) => values.shrink_to_fit(),
        Samples::F32(_) => {}
    }
    if samples.len() != size[0] * size[1] {
        return Err(damaged("its rows are not as long as its header says"));
    }
    Ok(Image {
        size,
        samples,
        frame: None,
        epsg: None,
    })
}

/// The rows read so far.
struct Rows {
    channels: Channels,
    meaning: Meaning,
    /// Whether numbers have 16 bits, the upper eight first.
    is_deep: bool,
    /// A row of 16 bits.
    words: Vec<u16>,
    samples: Samples,
}

impl Rows {
    fn add(&mut self, row: &[u8]) {
        let (channels, meaning) = (self.channels, self.meaning);
        if self.is_deep {
            let word = |pair: &[u8]| u16::from_be_bytes([pair[0], pair[1]]);
            self.words.clear();
            self.words.extend(row.chunks_exact(2).map(word));
        }
        match &mut self.samples {
            Samples::U8(values) => tone::plain(row, channels, values),
            Samples::U16(values) if self.is_deep && channels.are_plain(meaning) => {
                tone::plain(&self.words, channels, values);
            }
            Samples::U16(values) if self.is_deep => {
                tone::light(&self.words, channels, meaning, values);
            }
            Samples::U16(values) => tone::light(row, channels, meaning, values),
            Samples::F32(_) => {}
        }
    }
}

fn damaged(error: impl Into<PngProblem>) -> RasterError {
    let detail = match error.into() {
        PngProblem::Decoding(DecodingError::LimitsExceeded) => {
            return RasterError::Unsupported {
                found: "a PNG whose chunks take too much memory".into(),
                allowed: "up to 8 MiB besides the pixels",
            };
        }
        PngProblem::Decoding(DecodingError::IoError(error))
            if error.kind() != std::io::ErrorKind::UnexpectedEof =>
        {
            return error.into();
        }
        PngProblem::Decoding(error) => error.to_string(),
        PngProblem::Other(detail) => detail.into(),
    };
    RasterError::Damaged {
        format: "PNG",
        detail,
    }
}

/// An error of the decoder, or of the checks here.
enum PngProblem {
    Decoding(DecodingError),
    Other(&'static str),
}

impl From<DecodingError> for PngProblem {
    fn from(error: DecodingError) -> Self {
        Self::Decoding(error)
    }
}

impl From<&'static str> for PngProblem {
    fn from(detail: &'static str) -> Self {
        Self::Other(detail)
    }
}
