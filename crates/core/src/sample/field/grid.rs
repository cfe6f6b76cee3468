//! Pixels laid over the plane.

use core::ops::RangeInclusive;

use super::{
    canon::Canon,
    pixels::{Ends, Pixels, Store},
};
use crate::{
    error::{Error, ErrorKind},
    sample::area::Region,
};

/// What lies beyond the box of pixels.
///
/// ```
/// use strew_core::{Field, Raster, Region, field::Edges};
///
/// let raster = Raster::new(Region::new([0.0, 0.0], [2.0, 1.0])?, 2, vec![0.25, 0.75])?;
/// let beyond = |edges| raster.clone().edges(edges).share([2.5, 0.5]);
/// assert_eq!(beyond(Edges::Zero), 0.0);
/// assert_eq!(beyond(Edges::Clamp), 0.75);
/// assert_eq!(beyond(Edges::Repeat), 0.25);
/// assert_eq!(beyond(Edges::Mirror), 0.75);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Edges {
    /// Nothing. The box is half-open.
    Zero,
    /// The nearest pixel of the box.
    #[default]
    Clamp,
    /// The box again and again.
    Repeat,
    /// The box reflected at each side.
    Mirror,
}

/// What lies between the centers of pixels.
///
/// ```
/// use strew_core::{Field, Raster, Region, field::Filter};
///
/// let raster = Raster::new(Region::new([0.0, 0.0], [2.0, 1.0])?, 2, vec![0.25, 0.75])?;
/// assert_eq!(raster.share([0.9, 0.5]), 0.45);
/// assert_eq!(raster.filter(Filter::Nearest).share([0.9, 0.5]), 0.25);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// Linear along both axes.
    #[default]
    Linear,
    /// The pixel that a place lies in.
    Nearest,
}

/// Pixels over a box.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub(super) region: Region,
    /// Pixels per world unit.
    pub(super) scale: [f64; 2],
    /// In pixels.
    size: [usize; 2],
    pub(super) pixels: Pixels,
    pub(super) edges: Edges,
    pub(super) filter: Filter,
}

impl Grid {
    pub(super) fn new(region: Region, pixels: Pixels) -> Result<Self, Error> {
        let (min, max, size) = (region.min(), region.max(), pixels.size());
        let scale = [0, 1].map(|axis| size[axis] as f64 / (max[axis] - min[axis]));
        if scale
            .iter()
            .any(|scale| !scale.is_finite() || *scale == 0.0)
        {
            let allowed = "a box with an inside";
            return Err(Error::new(ErrorKind::Field, "region", "empty", allowed));
        }
        Ok(Self {
            region,
            scale,
            size,
            pixels,
            edges: Edges::Clamp,
            filter: Filter::Linear,
        })
    }

    /// Writes what the grid is made of, with the digest of the pixels that it was made from.
    pub(super) fn describe(&self, canon: &mut Canon) {
        canon.places(&[self.region.min(), self.region.max()]);
        canon.number(self.edges as u64);
        canon.number(self.filter as u64);
    }

    /// The place of a coordinate along an axis, in pixels from the lower side, within the box.
    #[inline(always)]
    fn place(&self, axis: usize, v: f64) -> f64 {
        let size = self.size[axis] as f64;
        let place = (v - self.region.min()[axis]) * self.scale[axis];
        let place = match self.edges {
            Edges::Zero | Edges::Clamp => place,
            Edges::Repeat => place - size * libm::floor(place / size),
            Edges::Mirror => {
                let folded = place - 2.0 * size * libm::floor(place / (2.0 * size));
                if folded > size {
                    2.0 * size - folded
                } else {
                    folded
                }
            }
        };
        // Not clamp(), which keeps NaN.
        place.max(0.0).min(size)
    }

    /// The number at a place. `number` has that of a pixel of each kind.
    #[inline(always)]
    pub(super) fn at(&self, at: [f64; 2], tones: Option<&[f32]>) -> f64 {
        if self.edges == Edges::Zero && !self.region.contains(at) {
            return 0.0;
        }
        let place = [self.place(0, at[0]), self.place(1, at[1])];
        let toned = |v: usize, one: f32| match tones {
            Some(tones) => tones[v],
            None => v as f32 / one,
        };
        match self.pixels.store() {
            Store::Floats(all) => self.between(place, |at| f64::from(all[at])),
            Store::Bytes(all) => self.between(place, |at| f64::from(toned(all[at].into(), 255.0))),
            Store::Words(all) => {
                self.between(place, |at| f64::from(toned(all[at].into(), 65535.0)))
            }
        }
    }

    #[inline(always)]
    fn between(&self, place: [f64; 2], pixel: impl Fn(usize) -> f64) -> f64 {
        let [width, height] = self.size;
        if self.filter == Filter::Nearest {
            let x = (place[0] as usize).min(width - 1);
            let y = (place[1] as usize).min(height - 1);
            return pixel(y * width + x);
        }
        let [(left, right, u), (bottom, top, v)] = [0, 1].map(|axis| self.pair(axis, place[axis]));
        let along = |row: usize| {
            let (a, b) = (pixel(row * width + left), pixel(row * width + right));
            a + (b - a) * u
        };
        let (low, high) = (along(bottom), along(top));
        low + (high - low) * v
    }

    /// The two pixels on both sides of a place along an axis, and how far it is from the first to the
    /// second.
    #[inline(always)]
    fn pair(&self, axis: usize, place: f64) -> (usize, usize, f64) {
        let last = self.size[axis] - 1;
        let from_center = place - 0.5;
        if self.edges == Edges::Repeat {
            let first = libm::floor(from_center);
            let u = from_center - first;
            // From −1 to the last.
            let first = if first < 0.0 {
                last
            } else {
                (first as usize).min(last)
            };
            let second = if first == last { 0 } else { first + 1 };
            return (first, second, u);
        }
        let within = from_center.max(0.0).min(last as f64);
        let first = within as usize;
        (first, (first + 1).min(last), within - first as f64)
    }

    /// Bounds of the stored numbers that matter within a box; none if none do. The flag tells whether
    /// places outside of the pixels lie within.
    pub(super) fn bounds(&self, within: &Region) -> (Option<Ends>, bool) {
        let (min, max) = (within.min(), within.max());
        let is_outside = self.edges == Edges::Zero
            && (0..2).any(|axis| {
                min[axis] < self.region.min()[axis] || self.region.max()[axis] <= max[axis]
            });
        if is_outside
            && (0..2).any(|axis| {
                max[axis] < self.region.min()[axis] || self.region.max()[axis] <= min[axis]
            })
        {
            return (None, true);
        }
        let [x, y] = [0, 1].map(|axis| self.ranges(axis, [min[axis], max[axis]]));
        let mut ends: Option<Ends> = None;
        for x in x.iter().flatten() {
            for y in y.iter().flatten() {
                let [low, high] = self.pixels.bounds(x.clone(), y.clone());
                ends = Some(match ends {
                    Some(ends) => [ends[0].min(low), ends[1].max(high)],
                    None => [low, high],
                });
            }
        }
        (ends, is_outside)
    }

    /// The pixels along an axis that matter between two coordinates.
    fn ranges(&self, axis: usize, [min, max]: [f64; 2]) -> [Option<RangeInclusive<usize>>; 2] {
        let size = self.size[axis];
        let last = size - 1;
        let pixels = |place: f64| match self.filter {
            Filter::Nearest => [(place as usize).min(last); 2],
            Filter::Linear => {
                let first = (place - 0.5).max(0.0).min(last as f64) as usize;
                [first, (first + 1).min(last)]
            }
        };
        match self.edges {
            Edges::Zero | Edges::Clamp => {
                let [first, _] = pixels(self.place(axis, min));
                let [_, last] = pixels(self.place(axis, max));
                [Some(first..=last), None]
            }
            Edges::Repeat | Edges::Mirror => {
                let place = |v: f64| (v - self.region.min()[axis]) * self.scale[axis];
                // Pixels before the first and after the last by a pixel, for what rounds.
                let [first, end] = [place(min) - 2.0, place(max) + 2.0];
                let period = size as f64;
                let is_short = end - first < period;
                let is_all = !is_short || first.abs().max(end.abs()) > 1e12;
                if is_all {
                    return [Some(0..=last), None];
                }
                let turn = libm::floor(first / period);
                let start = ((first - turn * period).max(0.0) as usize).min(last);
                let end = end - turn * period;
                let after = (end - period).max(0.0) as usize;
                let has_both = end >= period;
                let [one, two] = [start..=(end as usize).min(last), 0..=after.min(last)];
                if self.edges == Edges::Repeat {
                    return [Some(one), has_both.then_some(two)];
                }
                // Odd copies are reversed, so what goes on does so from the same side.
                let is_reversed = turn - 2.0 * libm::floor(turn / 2.0) != 0.0;
                let turned = |range: RangeInclusive<usize>, reverse: bool| {
                    if reverse {
                        last - range.end()..=last - range.start()
                    } else {
                        range
                    }
                };
                [
                    Some(turned(one, is_reversed)),
                    has_both.then(|| turned(two, !is_reversed)),
                ]
            }
        }
    }
}
