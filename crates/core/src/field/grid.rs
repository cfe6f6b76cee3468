//! Pixels laid over the plane.

use core::ops::{Range, RangeInclusive};

use super::{
    definition::Canon,
    pixels::{Ends, Pixels, Store},
};
use crate::{
    error::{Error, ErrorKind},
    kernel::{Backend, PlainLoop, compiled_loop},
    shape::Region,
};

/// The values beyond the box of pixels.
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

/// The values between the centers of pixels.
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

/// The number of places that are looked up at once.
const SOME: usize = 32;

/// The most pixels of a box whose slopes are looked up. It takes the time of about a hundred places.
const MOST_SLOPES: usize = 512;

/// Pixels over a box.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub(super) region: Region,
    /// Pixels per world unit.
    pub(super) scale: [f64; 2],
    /// In pixels.
    pub(super) size: [usize; 2],
    pub(super) pixels: Pixels,
    /// Whether some of them are missing.
    pub(super) is_partial: bool,
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
            is_partial: pixels.present().is_some(),
            pixels,
            edges: Edges::Clamp,
            filter: Filter::Linear,
        })
    }

    /// Writes the parts of the grid, with the digest of the pixels that it was made from.
    pub(super) fn describe(&self, canon: &mut Canon) {
        canon.places(&[self.region.min(), self.region.max()]);
        canon.number(self.edges as u64);
        canon.number(self.filter as u64);
    }

    /// The place of a coordinate along an axis, in pixels from the lower side, within the box.
    #[inline(always)]
    pub(super) fn place(&self, axis: usize, v: f64) -> f64 {
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
        match self.pixels.store() {
            Store::Floats(all) => self.of(at, |at| all[at]),
            Store::Bytes(all) => self.of(at, |at| tone(tones, all[at].into(), 255.0)),
            Store::Words(all) => self.of(at, |at| tone(tones, all[at].into(), 65535.0)),
        }
    }

    /// The numbers at some places; see [`at`](Self::at).
    pub(super) fn all_at(&self, places: &[[f64; 2]], tones: Option<&[f32]>, out: &mut [f64]) {
        match self.pixels.store() {
            Store::Floats(all) => self.each(places, out, |at| all[at]),
            Store::Bytes(all) => match tones.and_then(|tones| tones.first_chunk::<256>()) {
                Some(tones) => self.each(places, out, |at| tones[all[at] as usize]),
                None => self.each(places, out, |at| tone(None, all[at].into(), 255.0)),
            },
            Store::Words(all) => {
                self.each(places, out, |at| tone(tones, all[at].into(), 65535.0));
            }
        }
    }

    #[inline(always)]
    fn each(&self, places: &[[f64; 2]], out: &mut [f64], pixel: impl Fn(usize) -> f32) {
        let is_plain =
            self.edges == Edges::Clamp && self.filter == Filter::Linear && !self.is_partial;
        if !is_plain {
            for (out, &at) in out.iter_mut().zip(places) {
                let is_outside = self.edges == Edges::Zero && !self.region.contains(at);
                *out = if is_outside { 0.0 } else { self.of(at, &pixel) };
            }
            return;
        }
        let last = self.size.map(|size| (size - 1) as f64);
        let whole = self.size.map(|size| size as f64);
        let mut work = Look {
            min: self.region.min(),
            scale: self.scale,
            whole,
            last,
            width: self.size[0],
            places,
            out,
            pixel,
        };
        compiled_loop(Backend::best(), &mut work);
    }

    /// The number at a place inside.
    #[inline(always)]
    fn of(&self, at: [f64; 2], pixel: impl Fn(usize) -> f32) -> f64 {
        let (x, y) = (self.place(0, at[0]), self.place(1, at[1]));
        let [width, height] = self.size;
        if self.filter == Filter::Nearest {
            let column = (x as usize).min(width - 1);
            let row = (y as usize).min(height - 1);
            return f64::from(pixel(row * width + column));
        }
        let (left, right, u) = self.pair(0, x);
        let (bottom, top, v) = self.pair(1, y);
        if self.is_partial
            && let Some(mean) = self.mean_of_present([left, right], [bottom, top], [u, v], &pixel)
        {
            return mean;
        }
        let along = |row: usize| {
            let a = f64::from(pixel(row * width + left));
            let b = f64::from(pixel(row * width + right));
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

    /// Bounds of the stored numbers that matter within a box; none if none do. The flag is set if
    /// places outside of the pixels lie within.
    pub(super) fn bounds(&self, within: &Region) -> (Option<Ends>, bool) {
        self.bounds_of(&self.pixels, within)
    }

    pub(super) fn bounds_of(&self, pixels: &Pixels, within: &Region) -> (Option<Ends>, bool) {
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
                let [low, high] = pixels.bounds(x.clone(), y.clone());
                ends = Some(match ends {
                    Some(ends) => [ends[0].min(low), ends[1].max(high)],
                    None => [low, high],
                });
            }
        }
        (ends, is_outside)
    }

    /// Bounds of the change along x and y for each world unit, within a box of few pixels.
    pub(super) fn slopes(&self, within: &Region, tones: Option<&[f32]>) -> [f64; 2] {
        let unknown = [f64::INFINITY; 2];
        let ends = [0, 1].map(|axis| [within.min()[axis], within.max()[axis]]);
        // Away from the edges by a pixel they do not matter.
        let is_inside = (0..2).all(|axis| {
            let [first, last] =
                ends[axis].map(|v| (v - self.region.min()[axis]) * self.scale[axis]);
            first >= 1.0 && last <= self.size[axis] as f64 - 1.0
        });
        if self.filter == Filter::Nearest
            || !(self.edges == Edges::Clamp || is_inside)
            || self.missing(within)[0]
        {
            return unknown;
        }
        let [columns, rows] = [0, 1].map(|axis| {
            let [first, last] = ends[axis].map(|v| self.pair(axis, self.place(axis, v)));
            first.0..last.1 + 1
        });
        if columns.len() * rows.len() > MOST_SLOPES {
            return unknown;
        }
        let most = match self.pixels.store() {
            Store::Floats(all) => self.steps(columns, rows, |at| all[at]),
            Store::Bytes(all) => self.steps(columns, rows, |at| tone(tones, all[at].into(), 255.0)),
            Store::Words(all) => {
                self.steps(columns, rows, |at| tone(tones, all[at].into(), 65535.0))
            }
        };
        // With room for what rounds.
        [0, 1].map(|axis| f64::from(most[axis]) * self.scale[axis] * (1.0 + 1e-6))
    }

    /// The largest differences from one pixel to the next along x and y.
    #[inline(always)]
    fn steps(
        &self,
        columns: Range<usize>,
        rows: Range<usize>,
        pixel: impl Fn(usize) -> f32,
    ) -> [f32; 2] {
        let greater = |a: f32, b: f32| if a > b { a } else { b };
        let [mut across, mut up] = [0f32; 2];
        for y in rows.clone() {
            let (first, end) = (
                y * self.size[0] + columns.start,
                y * self.size[0] + columns.end,
            );
            let above = if y + 1 < rows.end { self.size[0] } else { 0 };
            let mut v = pixel(first);
            for at in first..end {
                up = greater((pixel(at + above) - v).abs(), up);
                if at + 1 < end {
                    let next = pixel(at + 1);
                    across = greater((next - v).abs(), across);
                    v = next;
                }
            }
        }
        [across, up]
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

/// The share of an integer pixel.
#[inline(always)]
fn tone(tones: Option<&[f32]>, v: usize, one: f32) -> f32 {
    match tones {
        Some(tones) => tones[v],
        None => v as f32 / one,
    }
}

/// A number within [0, `most`]. NaN becomes 0.
#[inline(always)]
fn within(v: f64, most: f64) -> f64 {
    let v = if v > 0.0 { v } else { 0.0 };
    if v < most { v } else { most }
}

/// Looks up places between the pixels of a clamped grid, some at a time, so that all but the look-ups is done
/// in vectors.
struct Look<'a, P> {
    min: [f64; 2],
    scale: [f64; 2],
    /// The size in pixels, and the place of the last pixel.
    whole: [f64; 2],
    last: [f64; 2],
    width: usize,
    places: &'a [[f64; 2]],
    out: &'a mut [f64],
    pixel: P,
}

/// 2⁵²: a number below that, added to it, is rounded to an integer, in the lowest bits.
const ROUNDER: f64 = 4_503_599_627_370_496.0;

/// The integer part of a number from 0 to 2³¹, as a number and as an integer.
#[inline(always)]
fn whole_part(v: f64) -> (f64, u32) {
    let rounded = (v + ROUNDER) - ROUNDER;
    let whole = if rounded > v { rounded - 1.0 } else { rounded };
    (whole, (whole + ROUNDER).to_bits() as u32)
}

impl<P: Fn(usize) -> f32> Look<'_, P> {
    /// The pixel before a place along an axis, the place after it, and whether there is another pixel.
    #[inline(always)]
    fn along(&self, axis: usize, v: f64) -> (u32, f64, u32) {
        let place = within((v - self.min[axis]) * self.scale[axis], self.whole[axis]);
        let place = within(place - 0.5, self.last[axis]);
        let (whole, pixel) = whole_part(place);
        (pixel, place - whole, u32::from(whole < self.last[axis]))
    }
}

impl<P: Fn(usize) -> f32> PlainLoop for Look<'_, P> {
    #[inline(always)]
    fn run(&mut self) {
        let mut some = [[0.0; 2]; SOME];
        let (mut us, mut vs) = ([0.0; SOME], [0.0; SOME]);
        let (mut columns, mut rows) = ([0u32; SOME], [0u32; SOME]);
        let (mut rights, mut aboves) = ([0u32; SOME], [0u32; SOME]);
        let mut corners = [[0f32; SOME]; 4];
        let mut shares = [0.0; SOME];
        for start in (0..self.places.len()).step_by(SOME) {
            let number = SOME.min(self.places.len() - start);
            some[..number].copy_from_slice(&self.places[start..start + number]);
            for i in 0..SOME {
                (columns[i], us[i], rights[i]) = self.along(0, some[i][0]);
                (rows[i], vs[i], aboves[i]) = self.along(1, some[i][1]);
            }
            for i in 0..number {
                let first = rows[i] as usize * self.width + columns[i] as usize;
                let right = rights[i] as usize;
                let above = first + aboves[i] as usize * self.width;
                corners[0][i] = (self.pixel)(first);
                corners[1][i] = (self.pixel)(first + right);
                corners[2][i] = (self.pixel)(above);
                corners[3][i] = (self.pixel)(above + right);
            }
            for i in 0..SOME {
                let [a, b] = [f64::from(corners[0][i]), f64::from(corners[1][i])];
                let low = a + (b - a) * us[i];
                let [a, b] = [f64::from(corners[2][i]), f64::from(corners[3][i])];
                let high = a + (b - a) * us[i];
                shares[i] = low + (high - low) * vs[i];
            }
            self.out[start..start + number].copy_from_slice(&shares[..number]);
        }
    }
}
