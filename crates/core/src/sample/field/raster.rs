//! Fields of pixels.

use alloc::{format, string::ToString as _, vec::Vec};

use super::Field;
use crate::{
    error::{Error, ErrorKind, number},
    sample::area::Region,
};

/// The least and the greatest share of a square of pixels.
type Ends = [f32; 2];

/// The width of the squares of the finest level of bounds, in pixels.
const SQUARE: usize = 8;

/// Pixels over a box: shares at the centers of pixels, linear between them, and constant beyond the
/// outermost centers.
///
/// ```
/// use strew_core::{Field, Raster, Region};
///
/// // A row of two pixels: nothing on the left, everything on the right.
/// let raster = Raster::new(Region::new([0.0, 0.0], [2.0, 1.0])?, 2, vec![0.0, 1.0])?;
/// assert_eq!(raster.share([1.0, 0.5]), 0.5);
/// assert_eq!(raster.share([99.0, 0.5]), 1.0);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Raster {
    region: Region,
    /// Pixels per world unit.
    scale: [f64; 2],
    /// In pixels.
    size: [usize; 2],
    pixels: Vec<f32>,
    /// The bounds of squares of pixels; each level has squares of twice the width of the one before.
    levels: Vec<Level>,
}

#[derive(Clone, Debug)]
struct Level {
    size: [usize; 2],
    ends: Vec<Ends>,
}

impl Raster {
    /// A raster of `width` pixels a row over a box, the rows from the least y upward.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless there are whole rows, at least one, of shares from 0 to 1.
    ///
    /// ```
    /// use strew_core::{ErrorKind, Raster, Region};
    ///
    /// let unit = Region::new([0.0, 0.0], [1.0, 1.0])?;
    /// assert!(Raster::new(unit, 2, vec![0.0, 0.5, 0.5, 1.0]).is_ok());
    /// for bad in [vec![], vec![0.5], vec![0.5, f32::NAN], vec![0.5, 1.5]] {
    ///     assert_eq!(Raster::new(unit, 2, bad).unwrap_err().kind(), ErrorKind::Field);
    /// }
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(region: Region, width: usize, pixels: Vec<f32>) -> Result<Self, Error> {
        let refused = |field, value, allowed| Error::new(ErrorKind::Field, field, value, allowed);
        if width == 0 || pixels.is_empty() || !pixels.len().is_multiple_of(width) {
            let value = format!("{} in rows of {width}", pixels.len());
            return Err(refused("pixels", value, "whole rows, at least one"));
        }
        if let Some(pixel) = pixels.iter().find(|v| !(0.0..=1.0).contains(*v)) {
            let value = number(f64::from(*pixel));
            return Err(refused("pixels", value.to_string(), "shares from 0 to 1"));
        }
        let size = [width, pixels.len() / width];
        let (min, max) = (region.min(), region.max());
        let scale = [0, 1].map(|axis| size[axis] as f64 / (max[axis] - min[axis]));
        if scale.iter().any(|scale| !scale.is_finite()) {
            return Err(refused("region", "empty".into(), "a box with an inside"));
        }
        let levels = levels(size, &pixels);
        Ok(Self {
            region,
            scale,
            size,
            pixels,
            levels,
        })
    }

    /// The place of a coordinate along an axis, in pixels from the first center, within the centers.
    #[inline]
    fn place(&self, axis: usize, v: f64) -> f64 {
        let place = (v - self.region.min()[axis]) * self.scale[axis] - 0.5;
        // Not clamp(), which keeps NaN.
        place.max(0.0).min((self.size[axis] - 1) as f64)
    }
}

impl Field for Raster {
    #[inline]
    fn share(&self, at: [f64; 2]) -> f64 {
        let [x, y] = [self.place(0, at[0]), self.place(1, at[1])];
        let (left, bottom) = (x as usize, y as usize);
        let (u, v) = (x - left as f64, y - bottom as f64);
        let right = (left + 1).min(self.size[0] - 1);
        let top = (bottom + 1).min(self.size[1] - 1);
        let pixel = |x: usize, y: usize| f64::from(self.pixels[y * self.size[0] + x]);
        let along = |y: usize| {
            let (a, b) = (pixel(left, y), pixel(right, y));
            a + (b - a) * u
        };
        let (low, high) = (along(bottom), along(top));
        low + (high - low) * v
    }

    fn bounds(&self, within: &Region) -> [f64; 2] {
        let (min, max) = (within.min(), within.max());
        let first = [0, 1].map(|axis| self.place(axis, min[axis]) as usize);
        let last = [0, 1].map(|axis| {
            let place = self.place(axis, max[axis]) as usize + 1;
            place.min(self.size[axis] - 1)
        });
        let mut width = SQUARE;
        let mut ends = [1f32, 0f32];
        for level in &self.levels {
            let [x, y] = [0, 1].map(|axis| first[axis] / width..=last[axis] / width);
            let is_coarse = x.end() - x.start() < 4 && y.end() - y.start() < 4;
            if is_coarse || level.ends.len() == 1 {
                for y in y {
                    for x in x.clone() {
                        let [low, high] = level.ends[y * level.size[0] + x];
                        ends = [ends[0].min(low), ends[1].max(high)];
                    }
                }
                break;
            }
            width *= 2;
        }
        // Interpolation rounds.
        [f64::from(ends[0]) - 1e-12, f64::from(ends[1]) + 1e-12]
    }
}

/// The levels of bounds, from the finest to a single square.
fn levels(size: [usize; 2], pixels: &[f32]) -> Vec<Level> {
    let of = |size: [usize; 2], width: usize, at: &dyn Fn(usize, usize) -> Ends| {
        let squares = size.map(|v| v.div_ceil(width));
        let mut ends = Vec::with_capacity(squares[0] * squares[1]);
        for square in 0..squares[0] * squares[1] {
            let [x, y] = [square % squares[0] * width, square / squares[0] * width];
            let mut found = [1f32, 0f32];
            for y in y..(y + width).min(size[1]) {
                for x in x..(x + width).min(size[0]) {
                    let [low, high] = at(x, y);
                    found = [found[0].min(low), found[1].max(high)];
                }
            }
            ends.push(found);
        }
        Level {
            size: squares,
            ends,
        }
    };
    let mut levels = alloc::vec![of(size, SQUARE, &|x, y| [pixels[y * size[0] + x]; 2])];
    while let Some(last) = levels.last().filter(|last| last.ends.len() > 1) {
        let next = of(last.size, 2, &|x, y| last.ends[y * last.size[0] + x]);
        levels.push(next);
    }
    levels
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn no_place_of_a_box_leaves_its_bounds(
            width in 1usize..70, height in 1usize..40, salt: u32, x in -5.0..25.0f64, y in -5.0..25.0f64,
            w in 0.001..30.0f64, h in 0.001..30.0f64, inside in prop::array::uniform2(0.0..=1.0f64),
        ) {
            let pixel = |i: usize| ((i as u32).wrapping_mul(0x9e37_79b9) ^ salt) as f32 / u32::MAX as f32;
            let pixels = (0..width * height).map(|i| pixel(i).powi(8).clamp(0.0, 1.0)).collect();
            let region = Region::new([0.0, 0.0], [20.0, 20.0]).expect("ordered");
            let raster = Raster::new(region, width, pixels).expect("shares");
            let within = Region::new([x, y], [x + w, y + h]).expect("ordered");
            let [low, high] = raster.bounds(&within);
            for [u, v] in [inside, [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
                let share = raster.share([x + w * u, y + h * v]);
                prop_assert!(low <= share && share <= high, "{} {} {}", low, share, high);
            }
        }
    }
}
