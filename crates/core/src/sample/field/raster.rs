//! Fields of pixels.

use alloc::{format, sync::Arc, vec::Vec};

use super::{
    Field,
    canon::Canon,
    grid::{Edges, Filter, Grid},
    pixels::{Pixels, Store, check_shares},
    scale::{check_share, unit, widened},
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
    ///
    /// ```
    /// use strew_core::{Field, Raster, Region, field::Pixels};
    ///
    /// let mask = Pixels::from_bytes(2, vec![0, 255])?;
    /// let [a, b] = [Region::chunk(64.0, [0, 0])?, Region::chunk(64.0, [1, 0])?]
    ///     .map(|region| Raster::of(region, mask.clone()));
    /// assert_eq!((a?.share([64.0, 0.0]), b?.share([64.0, 0.0])), (1.0, 0.0));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
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
    ///
    /// ```
    /// use strew_core::{Field, Raster, Region, field::Edges};
    ///
    /// let raster = Raster::new(Region::new([0.0, 0.0], [2.0, 1.0])?, 2, vec![0.5, 1.0])?;
    /// assert_eq!(raster.edges(Edges::Zero).share([2.0, 0.5]), 0.0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn edges(mut self, edges: Edges) -> Self {
        self.grid.edges = edges;
        self
    }

    /// Sets the values between the centers of pixels.
    ///
    /// ```
    /// use strew_core::{Field, Raster, Region, field::Filter};
    ///
    /// let raster = Raster::new(Region::new([0.0, 0.0], [2.0, 1.0])?, 2, vec![0.0, 1.0])?;
    /// assert_eq!(raster.filter(Filter::Nearest).share([0.99, 0.5]), 0.0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
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
    ///
    /// ```
    /// use strew_core::{Raster, Region, field::Edges};
    ///
    /// let raster = Raster::new(Region::chunk(64.0, [0, 0])?, 2, vec![0.0, 1.0])?;
    /// assert_eq!(raster.clone().digest(), raster.digest());
    /// assert_ne!(raster.clone().edges(Edges::Zero).digest(), raster.digest());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
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
