//! The price of decoding a raster, known from its first bytes.

use std::iter::Sum;

use super::{Limits, PNG};

/// An upper bound of the cost of decoding. Rasters whose headers cannot be read cost nothing: they are refused.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Price {
    pub pixels: usize,
    /// The memory while it is decoded and of what becomes of it, in bytes.
    pub bytes: usize,
}

/// The bytes of a PNG up to the end of its header.
const PNG_HEADER: usize = 33;
/// The shares of all words of 16 bits, which a field of such pixels holds.
const TONES: usize = 4 << 16;

impl Price {
    /// The number of the first bytes that [`of_png`](Self::of_png) needs.
    pub const HEADER: usize = PNG_HEADER;

    /// Of a PNG that begins with these bytes.
    pub fn of_png(head: &[u8]) -> Self {
        Self::read_png(head).unwrap_or_default()
    }

    fn read_png(head: &[u8]) -> Option<Self> {
        let number = |at| Some(u32::from_be_bytes(*head.get(at..)?.first_chunk()?).into());
        let head = head.strip_prefix(PNG).and(Some(head))?;
        let (width, height) = (number(16)?, number(20)?);
        let [depth, color, _, _, interlaced] = *head.get(24..)?.first_chunk()?;
        let pixels = pixels(width, height)?;
        let channels = match color {
            2 => 3,
            // The palette may have alpha.
            3 | 6 => 4,
            4 => 2,
            _ => 1,
        };
        let deep = if depth == 16 { 2 } else { 1 };
        // Without interlacing only rows are held as they are stored.
        let rows = [2 * width as usize, pixels][usize::from(interlaced != 0)];
        let (words, tones) = match depth == 16 || !matches!(color, 0 | 4) {
            true => (2, TONES),
            false => (1, 0),
        };
        // Which pixels are missing, here and in a field, and the pixels before they are turned upright.
        let further = 2 + words;
        Some(Self {
            pixels,
            bytes: rows * channels * deep + pixels * (words + further) + tones,
        })
    }

    pub fn of_floats([width, height]: [usize; 2]) -> Self {
        let pixels = pixels(width as u64, height as u64).unwrap_or_default();
        Self {
            pixels,
            // As text that is decoded, as numbers, and as what shares or slopes are made of.
            bytes: 3 * size_of::<f32>() * pixels,
        }
    }
}

/// The number of pixels of a size that any raster may have.
fn pixels(width: u64, height: u64) -> Option<usize> {
    let [width, height] = Limits::FILES.check(width, height).ok()?;
    Some(width * height)
}

impl Sum for Price {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |sum, one| Self {
            pixels: sum.pixels.saturating_add(one.pixels),
            bytes: sum.bytes.saturating_add(one.bytes),
        })
    }
}
