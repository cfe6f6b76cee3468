//! Heights over a box.

use super::{
    canon::Canon,
    grid::{Edges, Filter, Grid},
    pixels::Pixels,
    scale::{Slide, widened},
};
use crate::{error::Error, shape::Region, stop::Stop, table::Digest};

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
    ///
    /// ```
    /// use strew_core::{Region, field::{Edges, Pixels, Terrain}};
    ///
    /// let heights = Pixels::from_floats(1, vec![400.0])?;
    /// let terrain = Terrain::new(Region::chunk(9.0, [0, 0])?, heights)?;
    /// assert_ne!(terrain.clone().edges(Edges::Mirror).digest(), terrain.digest());
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
    /// use strew_core::{Region, field::{Filter, Pixels, Terrain}};
    ///
    /// let heights = Pixels::from_floats(1, vec![400.0])?;
    /// let terrain = Terrain::new(Region::chunk(9.0, [0, 0])?, heights)?;
    /// assert_ne!(terrain.clone().filter(Filter::Nearest).digest(), terrain.digest());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
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
