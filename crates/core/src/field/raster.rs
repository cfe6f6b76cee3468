//! Fields of pixels, and heights over a box.
//!
//! Pixels may be missing: then it is known which places lie in one, and what lies beside. All of that is off the path
//! of grids without gaps, which know that they have none.

use alloc::{format, sync::Arc, vec::Vec};

use super::{
    Field,
    definition::Canon,
    grid::{Edges, Filter, Grid},
    pixels::{Pixels, Store, check_shares},
    scale::{Slide, check_share, unit, widened},
};
use crate::{
    error::{Error, ErrorKind, number},
    shape::Region,
    stop::Stop,
    table::Digest,
};

/// Shares of pixels over a box: at the centers of pixels, by default linear between them and constant
/// beyond the outermost centers. The share of a [missing](Pixels::without) pixel is 0 in all of it.
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
    pub(super) grid: Grid,
    /// The digest of the pixels that were handed in.
    source: Digest,
    tone: [f64; 3],
    /// The share of each integer pixel.
    tones: Option<Arc<[f32]>>,
}

/// Shares are the pixels themselves: low, high and gamma.
const PLAIN: [f64; 3] = [0.0, 1.0, 1.0];

impl Raster {
    /// A raster of `width` pixels a row over a box, the rows from the least y upward.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless there are whole rows, at least one, of shares from 0 to 1.
    pub fn new(region: Region, width: usize, pixels: Vec<f32>) -> Result<Self, Error> {
        Self::of(region, Pixels::from_floats(width, pixels)?)
    }

    /// A raster of pixels, which it shares with others, over a box.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless the pixels are shares from 0 to 1 and the box has an inside.
    pub fn of(region: Region, pixels: Pixels) -> Result<Self, Error> {
        check_shares(&pixels)?;
        let shares = |last: u16| (0..=last).map(move |v| f32::from(v) / f32::from(last));
        Ok(Self {
            source: pixels.digest(),
            tones: match pixels.store() {
                Store::Bytes(_) => Some(shares(255).collect()),
                Store::Words(_) => Some(shares(65535).collect()),
                Store::Floats(_) => None,
            },
            grid: Grid::new(region, pixels)?,
            tone: PLAIN,
        })
    }

    /// Sets the values beyond the box.
    #[must_use]
    pub const fn edges(mut self, edges: Edges) -> Self {
        self.grid.edges = edges;
        self
    }

    /// Sets the values between the centers of pixels.
    #[must_use]
    pub const fn filter(mut self, filter: Filter) -> Self {
        self.grid.filter = filter;
        self
    }

    /// Sets the share of each pixel v: low + (high − low)·v^gamma, rounded to `f32`. `low` may be above
    /// `high`. It is computed here, once.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless `low` and `high` are from 0 to 1 and `gamma` is from 0.01 to 100.
    ///
    /// ```
    /// use strew_core::{Field, Raster, Region};
    ///
    /// let raster = Raster::new(Region::new([0.0, 0.0], [1.0, 1.0])?, 1, vec![0.5])?;
    /// let share = |low, high, gamma| {
    ///     Ok::<_, strew_core::Error>(raster.clone().tone(low, high, gamma)?.share([0.5, 0.5]))
    /// };
    /// assert_eq!(share(0.0, 1.0, 2.0)?, 0.25);
    /// assert_eq!(share(1.0, 0.0, 1.0)?, 0.5);
    /// assert_eq!(share(0.5, 1.0, 1.0)?, 0.75);
    /// assert_eq!(share(0.0, 1.0, 0.0).unwrap_err().field(), "gamma");
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn tone(self, low: f64, high: f64, gamma: f64) -> Result<Self, Error> {
        self.tone_unless([low, high, gamma], &Stop::default())
    }

    /// As [`tone`](Self::tone), unless stopped.
    pub(crate) fn tone_unless(
        mut self,
        [low, high, gamma]: [f64; 3],
        stop: &Stop,
    ) -> Result<Self, Error> {
        check_share("low", low)?;
        check_share("high", high)?;
        if !(0.01..=100.0).contains(&gamma) {
            let allowed = "a number from 0.01 to 100";
            return Err(Error::new(
                ErrorKind::Field,
                "gamma",
                number(gamma),
                allowed,
            ));
        }
        if self.tone != PLAIN {
            let value = format!("{:?}", self.tone);
            return Err(Error::new(ErrorKind::Field, "tone", value, "set once"));
        }
        self.tone = [low, high, gamma];
        if self.tone == PLAIN {
            return Ok(self);
        }
        let share = |v: f64| {
            let v = if gamma == 1.0 { v } else { libm::pow(v, gamma) };
            unit(low + (high - low) * v) as f32
        };
        let tones = |last: u32| {
            (0..=last)
                .map(|v| share(f64::from(v) / f64::from(last)))
                .collect()
        };
        match self.grid.pixels.store() {
            Store::Bytes(_) => self.tones = Some(tones(255)),
            Store::Words(_) => self.tones = Some(tones(65535)),
            Store::Floats(_) => {
                self.grid.pixels = self.grid.pixels.map(stop, |v| share(f64::from(v)))?;
            }
        }
        Ok(self)
    }

    /// The digest of the pixels, the box and the settings.
    #[must_use]
    pub fn digest(&self) -> Digest {
        let mut canon = Canon::new("raster");
        canon.digest(self.source);
        self.grid.describe(&mut canon);
        canon.numbers(&self.tone);
        canon.finish()
    }

    /// The pixels.
    #[must_use]
    pub const fn pixels(&self) -> &Pixels {
        &self.grid.pixels
    }
}

impl Field for Raster {
    #[inline]
    fn share(&self, at: [f64; 2]) -> f64 {
        if self.grid.is_missing(at) {
            return 0.0;
        }
        // Interpolation rounds.
        self.grid.at(at, self.tones.as_deref()).min(1.0)
    }

    fn shares(&self, places: &[[f64; 2]], shares: &mut [f64]) {
        self.grid.all_at(places, self.tones.as_deref(), shares);
        for share in shares.iter_mut() {
            *share = share.min(1.0);
        }
        if self.grid.is_partial {
            for (share, at) in shares.iter_mut().zip(places) {
                if self.grid.is_missing(*at) {
                    *share = 0.0;
                }
            }
        }
    }

    fn bounds(&self, within: &Region) -> [f64; 2] {
        let (ends, is_outside) = self.grid.bounds(within);
        let Some(ends) = ends else {
            return [0.0; 2];
        };
        let ends = match &self.tones {
            // Tones rise or fall with the pixels.
            Some(tones) => {
                let last = (tones.len() - 1) as f32;
                let [a, b] = ends.map(|v| tones[libm::roundf(v * last) as usize]);
                [a.min(b), a.max(b)]
            }
            None => ends,
        };
        let [low, high] = widened(ends.map(f64::from));
        match self.grid.missing(within) {
            [_, true] => [0.0; 2],
            [true, _] => [0.0, high],
            _ => [if is_outside { 0.0 } else { low }, high],
        }
    }

    fn slopes(&self, within: &Region) -> [f64; 2] {
        self.grid.slopes(within, self.tones.as_deref())
    }
}

impl Grid {
    /// The mean of those pixels that are there, by their weights; none if all are there.
    #[cold]
    pub(super) fn mean_of_present(
        &self,
        [left, right]: [usize; 2],
        [bottom, top]: [usize; 2],
        [u, v]: [f64; 2],
        pixel: impl Fn(usize) -> f32,
    ) -> Option<f64> {
        let of = |row: usize, column: usize| row * self.size[0] + column;
        let corners = [
            (of(bottom, left), (1.0 - u) * (1.0 - v)),
            (of(bottom, right), u * (1.0 - v)),
            (of(top, left), (1.0 - u) * v),
            (of(top, right), u * v),
        ];
        let present = corners.into_iter().filter(|(at, _)| self.pixels.has(*at));
        let [number, sum, weight] = present.fold([0.0; 3], |[number, sum, all], (at, weight)| {
            let part = weight * f64::from(pixel(at));
            [number + 1.0, sum + part, all + weight]
        });
        match weight > 0.0 {
            true if number == 4.0 => None,
            true => Some(sum / weight),
            // A place in a missing pixel.
            false => Some(0.0),
        }
    }

    /// Whether a place lies in a pixel that is missing.
    #[inline]
    pub(super) fn is_missing(&self, at: [f64; 2]) -> bool {
        self.is_partial && self.is_in_missing(at)
    }

    #[cold]
    fn is_in_missing(&self, at: [f64; 2]) -> bool {
        if self.edges == Edges::Zero && !self.region.contains(at) {
            return false;
        }
        let [column, row] =
            [0, 1].map(|axis| (self.place(axis, at[axis]) as usize).min(self.size[axis] - 1));
        !self.pixels.has(row * self.size[0] + column)
    }

    /// Whether a place of a box may be in a missing pixel, and whether all are.
    pub(super) fn missing(&self, within: &Region) -> [bool; 2] {
        let Some(present) = self.pixels.present() else {
            return [false; 2];
        };
        match self.bounds_of(present, within) {
            (Some([low, high]), is_outside) => [low < 1.0, high <= 0.0 && !is_outside],
            (None, _) => [false; 2],
        }
    }
}

/// Heights of pixels over a box, for fields of [height](super::FieldSpec::height) and
/// [slope](super::FieldSpec::slope).
///
/// ```
/// use strew_core::{Field, Region, field::{FieldSpec, Pixels, Terrain}};
///
/// let heights = Pixels::from_floats(3, vec![400.0, 800.0, 1200.0])?;
/// let terrain = Terrain::new(Region::new([0.0, 0.0], [300.0, 100.0])?, heights)?;
/// // No tree above 1000 m, all below 600 m.
/// let trees = FieldSpec::height(terrain, [600.0, 1000.0], [1.0, 0.0])?;
/// assert_eq!(trees.share([150.0, 50.0]), 0.5);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Terrain {
    pub(super) grid: Grid,
    /// The digest of the heights.
    source: Digest,
}

impl Terrain {
    /// Heights over a box.
    ///
    /// # Errors
    /// [`ErrorKind::Field`](crate::ErrorKind::Field) unless the box has an inside.
    pub fn new(region: Region, heights: Pixels) -> Result<Self, Error> {
        Ok(Self {
            source: heights.digest(),
            grid: Grid::new(region, heights)?,
        })
    }

    /// Sets the values beyond the box.
    #[must_use]
    pub const fn edges(mut self, edges: Edges) -> Self {
        self.grid.edges = edges;
        self
    }

    /// Sets the values between the centers of pixels.
    #[must_use]
    pub const fn filter(mut self, filter: Filter) -> Self {
        self.grid.filter = filter;
        self
    }

    /// The digest of the heights, the box and the settings.
    #[must_use]
    pub fn digest(&self) -> Digest {
        let mut canon = Canon::new("terrain");
        canon.digest(self.source);
        self.grid.describe(&mut canon);
        canon.finish()
    }

    /// This terrain with steepness in place of height: rise over run at each pixel, from its neighbors along
    /// both axes, and linear between pixels.
    pub(super) fn steepness(mut self, stop: &Stop) -> Result<Self, Error> {
        let [width, height] = self.grid.pixels.size();
        let (scale, edges) = (self.grid.scale, self.grid.edges);
        let pixels = &self.grid.pixels;
        let store = pixels.store();
        let rise = |[x, y]: [usize; 2], axis: usize| {
            let (at, size) = ([x, y][axis], [width, height][axis]);
            let place = |v: usize| match axis {
                0 => y * width + v,
                _ => v * width + x,
            };
            let [before, after] = match edges {
                Edges::Repeat => [((at + size - 1) % size, 1), ((at + 1) % size, 1)],
                _ => {
                    let [before, after] = [at.saturating_sub(1), (at + 1).min(size - 1)];
                    [(before, at - before), (after, after - at)]
                }
            };
            // The pixel itself stands for a neighbor without a height.
            let [(before, back), (after, ahead)] = [before, after].map(|(v, step)| {
                if pixels.has(place(v)) {
                    (v, step)
                } else {
                    (at, 0)
                }
            });
            let run = back + ahead;
            let z = |v: usize| f64::from(store.get(place(v)));
            match run {
                0 => 0.0,
                run => (z(after) - z(before)) * scale[axis] / run as f64,
            }
        };
        let steep = |at: usize| {
            let at = [at % width, at / width];
            let [x, y] = [rise(at, 0), rise(at, 1)];
            libm::sqrt(x * x + y * y).min(1e30) as f32
        };
        self.grid.pixels = self.grid.pixels.made(stop, steep)?;
        Ok(self)
    }

    #[inline]
    pub(super) fn share(&self, slide: &Slide, at: [f64; 2]) -> f64 {
        slide.share(self.grid.at(at, None))
    }

    pub(super) fn bounds(&self, slide: &Slide, within: &Region) -> [f64; 2] {
        let (ends, is_outside) = self.grid.bounds(within);
        let mut ends = ends.unwrap_or_default().map(f64::from);
        if is_outside {
            ends = [ends[0].min(0.0), ends[1].max(0.0)];
        }
        slide.bounds(widened(ends))
    }

    pub(super) fn slopes(&self, slide: &Slide, within: &Region) -> [f64; 2] {
        let (ends, is_outside) = self.grid.bounds(within);
        let ends = ends.unwrap_or_default().map(f64::from);
        if is_outside {
            return [f64::INFINITY; 2];
        }
        match slide.slope(widened(ends)) {
            0.0 => [0.0; 2],
            slope => self.grid.slopes(within, None).map(|rise| rise * slope),
        }
    }
}
