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

/// The size of a picture, its pixels and its orientation.
type Pixels = ([usize; 2], Vec<u8>, u16);

pub(super) fn jpeg(from: impl BufRead + Seek, limits: Limits) -> Result<Image, RasterError> {
    let check = |[width, height]: [usize; 2], _| limits.check(width as u64, height as u64);
    picture("JPEG", jpeg_pixels(from, true, check)?, false)
}

/// The pixels as RGB, or as they are stored, if `check` admits the size and the number of channels.
pub(super) fn jpeg_pixels<T>(
    mut from: impl BufRead + Seek,
    is_rgb: bool,
    check: impl FnOnce([usize; 2], usize) -> Result<T, RasterError>,
) -> Result<Pixels, RasterError> {
    let damaged = |error| RasterError::damaged("JPEG", error);
    // The decoder takes gray for what is cut off.
    if !is_whole(&mut from)? {
        let detail = "it ends before its last pixel";
        return Err(RasterError::damaged("JPEG", detail));
    }
    from.seek(SeekFrom::Start(0))?;
    let mut options = DecoderOptions::default()
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX))
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(from, options);
    decoder.decode_headers().map_err(damaged)?;
    let size = decoder.dimensions().unwrap_or_default().into();
    let stored = decoder.input_colorspace().unwrap_or(ColorSpace::RGB);
    check(size, stored.num_components())?;
    if !is_rgb {
        options = options.jpeg_set_out_colorspace(stored);
        decoder.set_options(options);
    }
    let pixels = decoder.decode().map_err(damaged)?;
    let exif = decoder.exif().map_or(1, |exif| orientation(exif));
    Ok((size, pixels, exif))
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
    let mut has_alpha = false;
    let check = |[width, height]: [usize; 2], channels| {
        has_alpha = channels == 4;
        limits.check(width as u64, height as u64)
    };
    let pixels = webp_pixels(from, check)?;
    picture("WebP", pixels, has_alpha)
}

/// The pixels, if `check` admits the size and the number of channels.
pub(super) fn webp_pixels<T>(
    from: impl BufRead + Seek,
    check: impl FnOnce([usize; 2], usize) -> Result<T, RasterError>,
) -> Result<Pixels, RasterError> {
    let damaged = |error: DecodingError| match error {
        DecodingError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            error.into()
        }
        error => RasterError::damaged("WebP", error),
    };
    let mut decoder = WebPDecoder::new(from).map_err(damaged)?;
    decoder.set_memory_limit(WORKING_BYTES);
    let (width, height) = decoder.dimensions();
    let size = [width, height].map(|side| side as usize);
    let channels = if decoder.has_alpha() { 4 } else { 3 };
    check(size, channels)?;
    let mut pixels = vec![0; size[0] * size[1] * channels];
    decoder.read_image(&mut pixels).map_err(damaged)?;
    let exif = decoder.exif_metadata().ok().flatten();
    Ok((size, pixels, exif.map_or(1, |exif| orientation(&exif))))
}

/// A picture from the bytes of its pixels.
fn picture(
    format: &'static str,
    (size, pixels, orientation): Pixels,
    has_alpha: bool,
) -> Result<Image, RasterError> {
    let channels = Channels {
        has_colors: true,
        has_alpha,
    };
    let mut light = Vec::with_capacity(size[0] * size[1]);
    tone::light(&pixels, channels, Meaning::Picture, &mut light);
    if light.len() != size[0] * size[1] {
        let detail = "it does not have the pixels that its header says";
        return Err(RasterError::damaged(format, detail));
    }
    let image = Image {
        is_picture: true,
        ..Image::new(size, Samples::U16(light))
    };
    image.upright(orientation, &Stop::NEVER)
}
