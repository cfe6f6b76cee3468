//! A raster in memory, and whether a size is allowed.

use super::{error::RasterError, limits::Limits, samples::Samples};

/// A raster as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// A number for each pixel, row by row from the top.
    pub samples: Samples,
    /// The place that the file states, if any: min x, min y, max x, max y.
    pub frame: Option<[f64; 4]>,
    /// The code of EPSG of the plane of that place, if the file states it.
    pub epsg: Option<u16>,
}

impl Limits {
    /// The number of pixels of a size.
    ///
    /// # Errors
    /// [`RasterError::Size`] if it is empty or beyond the limits.
    pub(super) fn check(self, width: u64, height: u64) -> Result<[usize; 2], RasterError> {
        let side = self.side as u64;
        let is_within = (1..=side).contains(&width) && (1..=side).contains(&height);
        if !is_within || width * height > self.pixels as u64 {
            return Err(RasterError::Size {
                width,
                height,
                limits: self,
            });
        }
        Ok([width as usize, height as usize])
    }
}
