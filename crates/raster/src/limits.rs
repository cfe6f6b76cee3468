//! How large rasters may be.

/// The longest side of a raster, in pixels.
pub const MOST_SIDE: usize = 16_384;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The longest side, in pixels.
    pub side: usize,
    pub pixels: usize,
}

impl Limits {
    /// The limits of files: 16,384 × 16,384 pixels.
    pub const FILES: Self = Self {
        side: MOST_SIDE,
        pixels: MOST_SIDE * MOST_SIDE,
    };
}
