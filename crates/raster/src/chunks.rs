//! Whether the strips and tiles of a TIFF hold about what its pixels need, before any of them is inflated.
//!
//! A tile may be far wider than the picture, a pixel may have thousands of channels of which one is read, and all
//! tiles may be the same bytes: a small file could inflate to terabytes that are thrown away.

use std::io::{Read, Seek};

use tiff::{
    decoder::{ChunkType, Decoder},
    tags::Tag,
};

use super::{
    error::RasterError,
    tiff_faults::{broken, damaged},
};

/// Rows may be padded to this many pixels, or to four times their width: tiles are rarely wider.
const TILE: u128 = 1024;
/// The factor by which padding may enlarge the pixels.
const PADDING: u128 = 4;
/// The least pixels of a tile, whose sides are multiples of 16.
const LEAST: u128 = 256;
/// The bytes that a compressor may add to each strip or tile.
const OVERHEAD: u128 = 1024;

pub(super) struct Cut {
    /// Width and height in pixels.
    pub(super) size: [usize; 2],
    pub(super) channels: usize,
    /// The width of a strip or tile, and how many lie side by side.
    pub(super) across: [u32; 2],
    pub(super) chunks: u64,
}

impl Cut {
    /// Refuses what takes far more than the pixels.
    pub(super) fn check(&self, decoder: &mut Decoder<impl Read + Seek>) -> Result<(), RasterError> {
        let [width, height] = self.size.map(|side| side as u128);
        let most_chunks = width + height + width * height / LEAST;
        let chunks = u128::from(self.chunks);
        if chunks > most_chunks {
            let found = format!("{chunks} strips or tiles");
            return Err(self.refused(found, most_chunks, ""));
        }
        let samples = decoder.find_tag_unsigned::<u64>(Tag::SamplesPerPixel);
        let samples = samples.map_err(damaged)?.unwrap_or(1).into();
        let bits = decoder.find_tag_unsigned_vec::<u64>(Tag::BitsPerSample);
        let bits = bits.map_err(damaged)?.unwrap_or_default();
        let bits = bits.into_iter().max().unwrap_or(1).into();
        let inflated = |pixels: u128, samples: u128| {
            let bits = pixels.checked_mul(samples)?.checked_mul(bits)?;
            bits.div_ceil(8).checked_mul(height)
        };
        let [across, columns] = self.across.map(u128::from);
        let rows = (PADDING * width).max(TILE);
        let (Some(taken), Some(most)) = (
            inflated(across * columns, samples),
            inflated(rows, self.channels as u128),
        ) else {
            return Err(broken("its pixels have too many channels or bits"));
        };
        if taken > most {
            let found = format!("strips or tiles of {taken} bytes");
            return Err(self.refused(found, most, " bytes"));
        }
        let tag = match decoder.get_chunk_type() {
            ChunkType::Strip => Tag::StripByteCounts,
            ChunkType::Tile => Tag::TileByteCounts,
        };
        let stored = decoder.find_tag_unsigned_vec::<u64>(tag).map_err(damaged)?;
        let stored = stored.into_iter().flatten().map(u128::from).sum::<u128>();
        let most = 2 * taken + OVERHEAD * chunks;
        if stored > most {
            let found = format!("strips or tiles of {stored} compressed bytes");
            return Err(self.refused(found, most, " bytes"));
        }
        Ok(())
    }

    fn refused(&self, found: String, most: u128, unit: &str) -> RasterError {
        let [width, height] = self.size;
        RasterError::Wasteful {
            found,
            allowed: format!("up to {most}{unit} for {width} × {height} pixels"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Image, Limits, Meaning};

    macro_rules! shape {
        ($name:literal) => {
            include_bytes!(concat!("../../../fuzz/regressions/raster/", $name)).as_slice()
        };
    }

    #[test]
    fn files_that_inflate_to_more_than_their_pixels_are_refused() {
        for (file, expected) in [
            (
                shape!("wide_tiles.tif"),
                "it has strips or tiles of 268435456 bytes; allowed: up to 262144 bytes for 16 × 256 pixels",
            ),
            (
                shape!("many_channels.tif"),
                "it has strips or tiles of 204800 bytes; allowed: up to 196608 bytes for 16 × 64 pixels",
            ),
            (
                shape!("empty_blocks.tif"),
                "it has strips or tiles of 480768 compressed bytes; allowed: up to 98304 bytes",
            ),
            (
                shape!("single_pixels.tif"),
                "it has 4096 strips or tiles; allowed: up to 144 for 64 × 64 pixels",
            ),
            (
                shape!("large_webp.tif"),
                "the TIFF is damaged or truncated: a strip or tile has 16383 × 16383 pixels",
            ),
            (
                shape!("large_jpeg.tif"),
                "the TIFF is damaged or truncated: a strip or tile has 65535 × 65535 pixels",
            ),
        ] {
            let stop = strew_core::server::Stop::NEVER;
            let read = Image::from_bytes(file, Meaning::Data, Limits::FILES, &stop);
            let error = read.expect_err("wasteful").to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
