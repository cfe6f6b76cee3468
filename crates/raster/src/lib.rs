//! Rasters and pictures from files: PNG, GeoTIFF, npy, raw floats; for pictures also JPEG and WebP.
//!
//! A raster is read in one pass. Its header is checked against [`Limits`] before memory is taken, and memory grows with
//! the actual length of the file, so a short file with a huge header takes nothing. The result is one number for each
//! pixel: see [`Meaning`] for how colors become one.
//!
//! Depends on the core alone, for its flags that stop long work. Knows no field and no query.

#![allow(missing_docs, reason = "internal: names say what items are")]

#[cfg(feature = "tiff")]
mod chunks;
#[cfg(feature = "compressions")]
mod embedded;
#[cfg(all(feature = "tiff", not(feature = "compressions")))]
#[path = "not_embedded.rs"]
mod embedded;
mod error;
mod image;
mod limits;
mod npy;
#[cfg(feature = "pictures")]
mod picture;
mod png;
mod price;
mod samples;
#[cfg(feature = "tiff")]
mod tags;
#[cfg(feature = "tiff")]
mod tiff;
#[cfg(feature = "tiff")]
mod tiff_faults;
mod tone;
mod wanted;

use std::io::{BufRead, Cursor, Read, Seek, SeekFrom};

pub use error::RasterError;
pub use image::{Image, Place};
pub use limits::{Limits, MOST_SIDE};
pub use price::Price;
pub use samples::Samples;
pub use tone::Meaning;

use strew_core::server::Stop;
use wanted::{Wanted, look};

impl Image {
    /// Reads a PNG, a TIFF or a npy file, whichever it is. Stops soon after the flag is raised.
    pub fn read(
        mut from: impl BufRead + Seek,
        meaning: Meaning,
        limits: Limits,
        stop: &Stop,
    ) -> Result<Self, RasterError> {
        let format = Format::of(&mut from)?;
        let from = Wanted::new(from, stop);
        let read = match format {
            Some(Format::Png) => png::read(from, meaning, limits, stop),
            #[cfg(feature = "tiff")]
            Some(Format::Tiff) => tiff::read(from, meaning, limits, stop),
            Some(Format::Npy) => npy::read(from, limits, stop),
            _ => Err(RasterError::Unknown("a PNG, TIFF or npy file")),
        };
        unless_stopped(read, stop)
    }

    /// Reads a PNG, and no other format: of those, the bytes that are to be decoded are known from the header.
    pub fn read_png(
        bytes: &[u8],
        meaning: Meaning,
        limits: Limits,
        stop: &Stop,
    ) -> Result<Self, RasterError> {
        let mut from = Cursor::new(bytes);
        match Format::of(&mut from)? {
            Some(Format::Png) => Self::read(from, meaning, limits, stop),
            Some(other) => Err(RasterError::Unsupported {
                found: format!("it is {}", other.name()),
                allowed: ONLY_PNG,
            }),
            None => Err(RasterError::Unknown(ONLY_PNG)),
        }
    }

    /// Reads 32-bit floats, little endian, row by row from the top. Stops soon after the flag is raised.
    pub fn read_floats(
        from: impl Read + Seek,
        [width, height]: [usize; 2],
        limits: Limits,
        stop: &Stop,
    ) -> Result<Self, RasterError> {
        let size = limits.check(width as u64, height as u64)?;
        let read = npy::read_floats(Wanted::new(from, stop), size, stop);
        unless_stopped(read, stop)
    }

    #[cfg(feature = "pictures")]
    /// Reads a picture: also JPEG and WebP. Its numbers are shares of the greatest light.
    pub fn read_picture(
        mut from: impl BufRead + Seek,
        limits: Limits,
    ) -> Result<Self, RasterError> {
        match Format::of(&mut from)? {
            Some(Format::Jpeg) => picture::jpeg(from, limits),
            Some(Format::WebP) => picture::webp(from, limits),
            Some(_) => Self::read(from, Meaning::Picture, limits, &Stop::default()),
            None => Err(RasterError::Unknown("a PNG, JPEG, WebP, TIFF or npy file")),
        }
    }

    /// How dark each pixel of a picture is, or how light if it is inverted: 65535 for black. Missing pixels are neither.
    pub fn darkness(&self, is_inverted: bool) -> Vec<u16> {
        let (samples, full) = (&self.samples, self.full);
        let light = |i: usize| (samples.get(i) / full).clamp(0.0, 1.0);
        let word = |light: f64| (light * 65535.0 + 0.5) as u16;
        let mut words = match (samples, is_inverted) {
            (Samples::U16(values), true) => values.clone(),
            (Samples::U16(values), false) => values.iter().map(|v| u16::MAX - v).collect(),
            (_, true) => (0..samples.len()).map(|i| word(light(i))).collect(),
            (_, false) => (0..samples.len()).map(|i| word(1.0 - light(i))).collect(),
        };
        for (word, is_missing) in words.iter_mut().zip(self.missing.iter().flatten()) {
            if *is_missing {
                *word = 0;
            }
        }
        words
    }

    pub fn from_bytes(
        bytes: &[u8],
        meaning: Meaning,
        limits: Limits,
        stop: &Stop,
    ) -> Result<Self, RasterError> {
        Self::read(Cursor::new(bytes), meaning, limits, stop)
    }
}

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The allowed files where only PNG is read.
const ONLY_PNG: &str = "a PNG";

/// A flag that is raised comes out of decoders as an error of reading.
fn unless_stopped(read: Result<Image, RasterError>, stop: &Stop) -> Result<Image, RasterError> {
    look(stop)?;
    read
}

enum Format {
    Png,
    Tiff,
    Npy,
    Jpeg,
    WebP,
}

impl Format {
    const fn name(&self) -> &'static str {
        match self {
            Self::Png => "a PNG",
            Self::Tiff => "a TIFF",
            Self::Npy => "a npy array",
            Self::Jpeg => "a JPEG",
            Self::WebP => "a WebP",
        }
    }

    fn of(from: &mut (impl BufRead + Seek)) -> Result<Option<Self>, RasterError> {
        let mut head = vec![];
        from.by_ref().take(12).read_to_end(&mut head)?;
        from.seek(SeekFrom::Start(0))?;
        let is_webp = head.starts_with(b"RIFF") && head.get(8..) == Some(b"WEBP");
        let known: [(&[u8], Self); 7] = [
            (PNG, Self::Png),
            (b"II*\0", Self::Tiff),
            (b"II+\0", Self::Tiff),
            (b"MM\0*", Self::Tiff),
            (b"MM\0+", Self::Tiff),
            (b"\x93NUMPY", Self::Npy),
            (b"\xff\xd8\xff", Self::Jpeg),
        ];
        let mut known = known.into_iter();
        let found = known.find_map(|(magic, format)| head.starts_with(magic).then_some(format));
        Ok(found.or(is_webp.then_some(Self::WebP)))
    }
}

#[cfg(test)]
mod tests;
