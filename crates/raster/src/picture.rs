//! Pictures from JPEG and WebP.

use std::io::{self, BufRead, Read as _, Seek, SeekFrom};

use image_webp::{DecodingError, WebPDecoder};
use strew_core::server::Stop;
use zune_jpeg::{
    JpegDecoder,
    zune_core::{colorspace::ColorSpace, options::DecoderOptions},
};

use super::{
    error::RasterError,
    image::{Image, orientation},
    limits::Limits,
    samples::Samples,
    tone::{self, Channels, Meaning},
};

/// A WebP decoder may take this much besides the picture.
const WORKING_BYTES: usize = 1 << 30;

pub(super) fn jpeg(mut from: impl BufRead + Seek, limits: Limits) -> Result<Image, RasterError> {
    let damaged = |error: zune_jpeg::errors::DecodeErrors| RasterError::Damaged {
        format: "JPEG",
        detail: error.to_string(),
    };
    // The decoder takes gray for what is cut off.
    if !is_whole(&mut from)? {
        return Err(RasterError::Damaged {
            format: "JPEG",
            detail: "it ends before its last pixel".into(),
        });
    }
    from.seek(SeekFrom::Start(0))?;
    let options = DecoderOptions::default()
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX))
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(from, options);
    decoder.decode_headers().map_err(damaged)?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let size = limits.check(width as u64, height as u64)?;
    let pixels = decoder.decode().map_err(damaged)?;
    let exif = decoder.exif().map_or(1, |exif| orientation(exif));
    picture("JPEG", size, &pixels, false, exif)
}

/// Whether the end of the picture is there: a marker that is no part of a segment.
fn is_whole(from: &mut impl BufRead) -> io::Result<bool> {
    let is_whole = || -> io::Result<bool> {
        loop {
            from.skip_until(0xff)?;
            let mut marker = [0xff];
            while marker == [0xff] {
                from.read_exact(&mut marker)?;
            }
            match marker {
                [0xd9] => return Ok(true),
                // Pixels, and marks among them.
                [0x00 | 0x01 | 0xd0..=0xd8] => {}
                _ => {
                    let mut length = [0; 2];
                    from.read_exact(&mut length)?;
                    let rest = u64::from(u16::from_be_bytes(length)).saturating_sub(2);
                    io::copy(&mut from.take(rest), &mut io::sink())?;
                }
            }
        }
    };
    match { is_whole }() {
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
        other => other,
    }
}

pub(super) fn webp(from: impl BufRead + Seek, limits: Limits) -> Result<Image, RasterError> {
    let damaged = |error: DecodingError| match error {
        DecodingError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            error.into()
        }
        error => RasterError::Damaged {
            format: "WebP",
            detail: error.to_string(),
        },
    };
    let mut decoder = WebPDecoder::new(from).map_err(damaged)?;
    decoder.set_memory_limit(WORKING_BYTES);
    let (width, height) = decoder.dimensions();
    let size = limits.check(width.into(), height.into())?;
    let has_alpha = decoder.has_alpha();
    let bytes = size[0] * size[1] * if has_alpha { 4 } else { 3 };
    let mut pixels = vec![0; decoder.output_buffer_size().unwrap_or(bytes)];
    decoder.read_image(&mut pixels).map_err(damaged)?;
    let exif = decoder.exif_metadata().ok().flatten();
    let exif = exif.map_or(1, |exif| orientation(&exif));
    picture("WebP", size, &pixels, has_alpha, exif)
}

/// A picture from the bytes of its pixels.
fn picture(
    format: &'static str,
    size: [usize; 2],
    pixels: &[u8],
    has_alpha: bool,
    orientation: u16,
) -> Result<Image, RasterError> {
    let channels = Channels {
        has_colors: true,
        has_alpha,
    };
    let mut light = Vec::with_capacity(size[0] * size[1]);
    tone::light(pixels, channels, Meaning::Picture, &mut light);
    if light.len() != size[0] * size[1] {
        return Err(RasterError::Damaged {
            format,
            detail: "it does not have the pixels that its header says".into(),
        });
    }
    let image = Image {
        is_picture: true,
        ..Image::new(size, Samples::U16(light))
    };
    image.upright(orientation, &Stop::NEVER)
}
