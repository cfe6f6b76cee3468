//! Rasters and pictures from files: PNG, GeoTIFF, npy, raw floats; for pictures also JPEG and WebP.
//!
//! A raster is read in one pass. Its header is checked against [`Limits`] before memory is taken, and memory
//! grows with what the file really holds, so a short file with a huge header takes nothing. What is read is
//! one number for each pixel: see [`Meaning`] for how colors become one.

mod error;
mod image;
mod limits;
mod npy;
mod picture;
mod png;
mod samples;
mod tiff;
mod tone;

use std::io::{BufRead, Cursor, Read, Seek, SeekFrom};

pub use error::RasterError;
pub use image::Image;
pub use limits::{Limits, MOST_SIDE};
pub use samples::Samples;
pub use tone::Meaning;

impl Image {
    /// Reads a PNG, a TIFF or a npy file, whichever it is.
    ///
    /// # Errors
    /// [`RasterError`].
    pub fn read(
        mut from: impl BufRead + Seek,
        meaning: Meaning,
        limits: Limits,
    ) -> Result<Self, RasterError> {
        match Format::of(&mut from)? {
            Some(Format::Png) => png::read(from, meaning, limits),
            Some(Format::Tiff) => tiff::read(from, meaning, limits),
            Some(Format::Npy) => npy::read(from, limits),
            _ => Err(RasterError::Unknown("a PNG, TIFF or npy file")),
        }
    }

    /// Reads 32-bit floats, little endian, row by row from the top.
    ///
    /// # Errors
    /// [`RasterError`], if there are not exactly as many as the size says.
    pub fn read_floats(
        from: impl Read + Seek,
        [width, height]: [usize; 2],
        limits: Limits,
    ) -> Result<Self, RasterError> {
        let size = limits.check(width as u64, height as u64)?;
        npy::read_floats(from, size)
    }

    /// Reads a picture: also JPEG and WebP. Its numbers are shares of the greatest light.
    ///
    /// # Errors
    /// [`RasterError`].
    pub fn read_picture(
        mut from: impl BufRead + Seek,
        limits: Limits,
    ) -> Result<Self, RasterError> {
        match Format::of(&mut from)? {
            Some(Format::Jpeg) => picture::jpeg(from, limits),
            Some(Format::WebP) => picture::webp(from, limits),
            Some(_) => Self::read(from, Meaning::Picture, limits),
            None => Err(RasterError::Unknown("a PNG, JPEG, WebP, TIFF or npy file")),
        }
    }

    /// How dark each pixel of a picture is, or how light if it is inverted: 65535 for black.
    #[must_use]
    pub fn darkness(&self, is_inverted: bool) -> Vec<u16> {
        let samples = &self.samples;
        let full = samples.full();
        let light = |i: usize| (samples.get(i) / full).clamp(0.0, 1.0);
        let word = |light: f64| (light * 65535.0 + 0.5) as u16;
        match (samples, is_inverted) {
            (Samples::U16(values), true) => values.clone(),
            (Samples::U16(values), false) => values.iter().map(|v| u16::MAX - v).collect(),
            (_, true) => (0..samples.len()).map(|i| word(light(i))).collect(),
            (_, false) => (0..samples.len()).map(|i| word(1.0 - light(i))).collect(),
        }
    }

    /// Reads what is in memory.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes(bytes: &[u8], meaning: Meaning, limits: Limits) -> Result<Self, RasterError> {
        Self::read(Cursor::new(bytes), meaning, limits)
    }
}

/// A format, by how its files begin.
enum Format {
    Png,
    Tiff,
    Npy,
    Jpeg,
    WebP,
}

impl Format {
    fn of(from: &mut (impl BufRead + Seek)) -> Result<Option<Self>, RasterError> {
        let mut head = vec![];
        from.by_ref().take(12).read_to_end(&mut head)?;
        from.seek(SeekFrom::Start(0))?;
        let begins = |magic: &[u8]| head.starts_with(magic);
        Ok(if begins(b"\x89PNG\r\n\x1a\n") {
            Some(Self::Png)
        } else if [b"II*\0", b"II+\0", b"MM\0*", b"MM\0+"]
            .iter()
            .any(|magic| begins(*magic))
        {
            Some(Self::Tiff)
        } else if begins(b"\x93NUMPY") {
            Some(Self::Npy)
        } else if begins(b"\xff\xd8\xff") {
            Some(Self::Jpeg)
        } else if begins(b"RIFF") && head.get(8..12) == Some(b"WEBP") {
            Some(Self::WebP)
        } else {
            None
        })
    }
}

#[cfg(test)]
mod tests;
