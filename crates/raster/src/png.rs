//! Rasters from PNG.

use std::io::{BufRead, Seek};

use png::{BitDepth, ColorType, Decoder, DecodingError, Transformations};
use strew_core::server::Stop;

use super::{
    error::RasterError,
    image::{Image, orientation},
    limits::Limits,
    samples::{Samples, each},
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
    let info = decoder.read_header_info().map_err(damaged)?;
    let size = limits.check(info.width.into(), info.height.into())?;
    let is_interlaced = info.interlaced;
    let is_gray = info.color_type == ColorType::Grayscale;
    let is_sharp = is_gray && info.bit_depth == BitDepth::One;
    let has_numbers = is_gray || info.color_type == ColorType::Indexed;
    let is_expanded = !has_numbers || meaning != Meaning::Numbers;
    let (bits, transformed) = match is_expanded {
        true => (8, Transformations::EXPAND),
        false => (info.bit_depth as u8, Transformations::IDENTITY),
    };
    decoder.set_transformations(transformed);
    let mut reader = decoder.read_info().map_err(damaged)?;
    let exif = reader.info().exif_metadata.as_deref();
    let orientation = exif.map_or(1, orientation);
    // The numbers that are transparent, of those that are not expanded.
    let clear: Vec<u16> = match reader.info().trns.as_deref() {
        Some(alpha) if !is_expanded && !is_gray => {
            let all = (0..).zip(alpha).filter(|(_, alpha)| **alpha == 0);
            all.map(|(index, _)| index).collect()
        }
        Some(&[high, low]) if !is_expanded => vec![u16::from_be_bytes([high, low])],
        _ => vec![],
    };
    let (color, depth) = reader.output_color_type();
    let channels = Channels {
        has_colors: matches!(color, ColorType::Rgb | ColorType::Rgba),
        has_alpha: matches!(color, ColorType::GrayscaleAlpha | ColorType::Rgba),
    };
    let mut rows = Rows {
        channels,
        meaning,
        bits,
        width: size[0],
        words: vec![],
        missing: vec![],
        samples: match depth {
            BitDepth::Sixteen => Samples::U16(vec![]),
            _ if channels.are_plain(meaning) => Samples::U8(vec![]),
            _ => Samples::U16(vec![]),
        },
        is_deep: depth == BitDepth::Sixteen,
    };
    let width = match bits {
        1 | 2 | 4 => size[0].div_ceil(usize::from(8 / bits)),
        _ => size[0] * channels.count() * if rows.is_deep { 2 } else { 1 },
    };
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
            let row =
                row.ok_or_else(|| RasterError::damaged("PNG", "it ends before its last row"))?;
            rows.add(row.data());
        }
    }
    let (mut samples, missing) = (rows.samples, rows.missing);
    each!(&mut samples, values => values.shrink_to_fit());
    if samples.len() != size[0] * size[1] {
        let detail = "its rows are not as long as its header says";
        return Err(RasterError::damaged("PNG", detail));
    }
    let is_clear = |i| clear.iter().any(|of| samples.get(i) == f64::from(*of));
    let missing = match clear.is_empty() {
        true => missing,
        false => (0..samples.len()).map(is_clear).collect(),
    };
    let image = Image {
        is_picture: true,
        is_sharp,
        full: if bits < 8 {
            f64::from((1 << bits) - 1)
        } else {
            samples.full()
        },
        ..Image::new(size, samples)
    };
    image.without(missing).upright(orientation, stop)
}

/// The rows read so far.
struct Rows {
    channels: Channels,
    meaning: Meaning,
    /// Whether numbers have 16 bits, the upper eight first.
    is_deep: bool,
    /// The bits of numbers, if they are packed, and how many a row has.
    bits: u8,
    width: usize,
    missing: Vec<bool>,
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
            tone::clear(&self.words, channels, meaning, &mut self.missing);
        } else {
            tone::clear(row, channels, meaning, &mut self.missing);
        }
        match &mut self.samples {
            Samples::U8(values) if self.bits < 8 => {
                tone::unpacked(row, self.bits, self.width, values);
            }
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

fn damaged(error: DecodingError) -> RasterError {
    match error {
        DecodingError::LimitsExceeded => RasterError::Unsupported {
            found: "a PNG whose chunks take too much memory".into(),
            allowed: "up to 8 MiB besides the pixels",
        },
        DecodingError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            error.into()
        }
        error => RasterError::damaged("PNG", error),
    }
}
