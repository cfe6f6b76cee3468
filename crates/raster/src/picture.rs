//! Pictures from JPEG and WebP.

use std::io::{BufRead, Seek};

use image_webp::{DecodingError, WebPDecoder};
use zune_jpeg::{
    JpegDecoder,
    zune_core::{colorspace::ColorSpace, options::DecoderOptions},
};

use super::{
    error::RasterError,
    image::Image,
    limits::Limits,
    samples::Samples,
    tone::{self, Channels, Meaning},
};

/// A WebP decoder may take this much besides the picture.
const WORKING_BYTES: usize = 1 << 30;

pub(super) fn jpeg(from: impl BufRead + Seek, limits: Limits) -> Result<Image, RasterError> {
    let damaged = |error: zune_jpeg::errors::DecodeErrors| RasterError::Damaged {
        format: "JPEG",
        detail: error.to_string(),
    };
    let options = DecoderOptions::default()
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX))
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(from, options);
    decoder.decode_headers().map_err(damaged)?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let size = limits.check(width as u64, height as u64)?;
    let pixels = decoder.decode().map_err(damaged)?;
    picture("JPEG", size, &pixels, false)
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
    picture("WebP", size, &pixels, has_alpha)
}

/// A picture from the bytes of its pixels.
fn picture(
    format: &'static str,
    size: [usize; 2],
    pixels: &[u8],
    has_alpha: bool,
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
    Ok(Image {
        size,
        samples: Samples::U16(light),
        frame: None,
        epsg: None,
    })
}
