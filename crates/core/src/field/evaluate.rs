//! The shares of described fields, and the cost of a look at one, counted without a clock.

use core::fmt;

use super::{
    Field,
    grid::Grid,
    scale::{unit, widened},
    spec::{FieldSpec, Shape, in_space},
};
use crate::{shape::Region, table::Digest};

impl FieldSpec {
    /// The BLAKE3 digest of a canonical encoding of the description. Descriptions of one digest are equal.
    #[must_use]
    pub const fn digest(&self) -> Digest {
        self.digest
    }

    /// The number of shapes, those that join others included.
    #[must_use]
    pub const fn parts(&self) -> usize {
        self.parts
    }

    /// The depth to which shapes lie within others; 1 for a single one.
    #[must_use]
    pub const fn depth(&self) -> usize {
        self.depth
    }

    /// Whether it has places of three numbers, and so is a field of space alone.
    #[must_use]
    pub const fn is_in_space(&self) -> bool {
        self.is_in_space
    }

    /// The number of vertices.
    #[must_use]
    pub const fn vertices(&self) -> usize {
        self.vertices
    }
}

impl FieldSpec {
    /// Whether a box may have a place in a missing pixel, where the share is always 0. True
    /// also for a box less than a pixel beside one.
    #[must_use]
    pub fn has_missing(&self, within: &Region) -> bool {
        self.missing(&|grid| grid.missing(within))[0]
    }

    /// Whether some place is missing, and whether all are, by that of each raster. A product and the least of fields
    /// are missing where a part is, the greatest where all parts are.
    fn missing(&self, of: &dyn Fn(&Grid) -> [bool; 2]) -> [bool; 2] {
        if !self.is_partial {
            return [false; 2];
        }
        let over = |parts: &[Self], first: bool, join: fn(bool, bool) -> bool| {
            parts.iter().fold([first; 2], |found, part| {
                let missing = part.missing(of);
                [0, 1].map(|i| join(found[i], missing[i]))
            })
        };
        match &*self.shape {
            Shape::Raster(raster) => of(&raster.grid),
            Shape::Terrain(terrain, _) => of(&terrain.grid),
            Shape::Multiply(parts) | Shape::Min(parts) => over(parts, false, |a, b| a | b),
            Shape::Max(parts) => over(parts, true, |a, b| a & b),
            Shape::Invert(part) | Shape::Curve(part, _) => part.missing(of),
            _ => [false; 2],
        }
    }

    /// Whether a place is in a missing pixel; see [`has_missing`](Self::has_missing).
    #[must_use]
    pub fn is_missing(&self, at: [f64; 2]) -> bool {
        self.missing(&|grid| [grid.is_missing(at); 2])[0]
    }
}

impl PartialEq for FieldSpec {
    fn eq(&self, other: &Self) -> bool {
        self.digest == other.digest
    }
}

impl Eq for FieldSpec {}

impl core::hash::Hash for FieldSpec {
    fn hash<H: core::hash::Hasher>(&self, state: &mut H) {
        self.digest.hash(state);
    }
}

impl fmt::Debug for FieldSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FieldSpec")
            .field("parts", &self.parts)
            .field("digest", &self.digest)
            .finish_non_exhaustive()
    }
}

impl FieldSpec {
    fn share_at<const D: usize>(&self, at: [f64; D]) -> f64 {
        let [x, y, z] = in_space(at);
        if self.is_partial && self.is_missing([x, y]) {
            return 0.0;
        }
        let over = |parts: &[Self], first: f64, join: fn(f64, f64) -> f64| {
            parts
                .iter()
                .fold(first, |share, part| join(share, part.share_at(at)))
        };
        match &*self.shape {
            Shape::Constant(share) => *share,
            Shape::Ramp { from, per, shares } => along(*from, *per, *shares, [x, y, z]),
            Shape::Radial {
                center,
                is_flat,
                slide,
            } => {
                let height = if *is_flat { 0.0 } else { z - center[2] };
                slide.share(length([x - center[0], y - center[1], height]))
            }
            Shape::Distance(measure, slide) => slide.share(measure.distance([x, y])),
            Shape::Noise(noise) => noise.share(at),
            Shape::Raster(raster) => raster.share([x, y]),
            Shape::Terrain(terrain, slide) => terrain.share(slide, [x, y]),
            Shape::Multiply(parts) => over(parts, 1.0, |a, b| a * b),
            Shape::Min(parts) => over(parts, 1.0, f64::min),
            Shape::Max(parts) => over(parts, 0.0, f64::max),
            Shape::Invert(part) => 1.0 - part.share_at(at),
            Shape::Curve(part, points) => on(points, part.share_at(at)),
        }
    }

    fn shares_at<const D: usize>(&self, places: &[[f64; D]], shares: &mut [f64]) {
        match &*self.shape {
            Shape::Constant(share) => shares.fill(*share),
            Shape::Ramp {
                from,
                per,
                shares: ends,
            } => {
                for (share, at) in shares.iter_mut().zip(places) {
                    *share = along(*from, *per, *ends, in_space(*at));
                }
            }
            Shape::Raster(raster) if D == 2 => {
                raster.shares(places.as_flattened().as_chunks().0, shares)
            }
            Shape::Noise(noise) if D == 2 => {
                noise.shares(places.as_flattened().as_chunks().0, shares)
            }
            Shape::Multiply(parts) => together(parts, 1.0, |a, b| a * b, places, shares),
            Shape::Min(parts) => together(parts, 1.0, f64::min, places, shares),
            Shape::Max(parts) => together(parts, 0.0, f64::max, places, shares),
            Shape::Invert(part) => {
                part.shares_at(places, shares);
                shares.iter_mut().for_each(|share| *share = 1.0 - *share);
            }
            Shape::Curve(part, points) => {
                part.shares_at(places, shares);
                let map = |share: &mut f64| *share = on(points, *share);
                shares.iter_mut().for_each(map);
            }
            _ => {
                for (share, at) in shares.iter_mut().zip(places) {
                    *share = self.share_at(*at);
                }
            }
        }
        if self.is_partial {
            for (share, at) in shares.iter_mut().zip(places) {
                if self.is_missing([at[0], at[1]]) {
                    *share = 0.0;
                }
            }
        }
    }

    fn bounds_in<const D: usize>(&self, within: &Region<D>) -> [f64; 2] {
        let (min, max) = (in_space(within.min()), in_space(within.max()));
        let flat = &Region::between([min[0], min[1]], [max[0], max[1]]);
        let over = |parts: &[Self], first: f64, join: fn(f64, f64) -> f64| {
            parts.iter().fold([first; 2], |ends, part| {
                let bounds = part.bounds_in(within);
                [0, 1].map(|i| join(ends[i], bounds[i]))
            })
        };
        let ends = match &*self.shape {
            Shape::Constant(share) => [*share; 2],
            Shape::Ramp { from, per, shares } => {
                // Monotone along all axes, rounding included.
                let [low, high] = [0, 1].map(|end| {
                    let is_max = |axis: usize| (per[axis] < 0.0) != (end == 1);
                    let at = [0, 1, 2].map(|axis| if is_max(axis) { max[axis] } else { min[axis] });
                    along(*from, *per, *shares, at)
                });
                widened([low.min(high), low.max(high)])
            }
            Shape::Radial {
                center,
                is_flat,
                slide,
            } => {
                let ends = beside(*center, (min, max));
                slide.bounds(ends.map(|[x, y, z]| length([x, y, if *is_flat { 0.0 } else { z }])))
            }
            Shape::Distance(measure, slide) => slide.bounds(measure.bounds(flat)),
            Shape::Noise(noise) => noise.bounds(within),
            Shape::Raster(raster) => raster.bounds(flat),
            Shape::Terrain(terrain, slide) => terrain.bounds(slide, flat),
            Shape::Multiply(parts) => over(parts, 1.0, |a, b| a * b),
            Shape::Min(parts) => over(parts, 1.0, f64::min),
            Shape::Max(parts) => over(parts, 0.0, f64::max),
            Shape::Invert(part) => {
                let [low, high] = part.bounds_in(within);
                [1.0 - high, 1.0 - low]
            }
            Shape::Curve(part, points) => {
                let [low, high] = part.bounds_in(within);
                let [a, b] = [on(points, low), on(points, high)];
                let between = points.iter().filter(|[x, _]| low < *x && *x < high);
                let ends = between.fold([a.min(b), a.max(b)], |ends, [_, y]| {
                    [ends[0].min(*y), ends[1].max(*y)]
                });
                widened(ends)
            }
        };
        let [low, high] = ends.map(unit);
        match self.missing(&|grid| grid.missing(flat)) {
            [_, true] => [0.0; 2],
            [true, _] => [0.0, high],
            _ => [low, high],
        }
    }
}

impl Field for FieldSpec {
    fn share(&self, at: [f64; 2]) -> f64 {
        self.share_at(at)
    }

    fn shares(&self, places: &[[f64; 2]], shares: &mut [f64]) {
        self.shares_at(places, shares);
    }

    fn bounds(&self, within: &Region) -> [f64; 2] {
        self.bounds_in(within)
    }

    fn slopes(&self, within: &Region) -> [f64; 2] {
        if self.has_missing(within) {
            return [f64::INFINITY; 2];
        }
        let over = |parts: &[Self], join: fn(f64, f64) -> f64| {
            parts.iter().fold([0.0; 2], |all, part| {
                let slopes = part.slopes(within);
                [0, 1].map(|i| join(all[i], slopes[i]))
            })
        };
        match &*self.shape {
            Shape::Constant(_) => [0.0; 2],
            Shape::Ramp { per, shares, .. } => {
                let change = (shares[1] - shares[0]).abs() * (1.0 + 1e-9);
                [0, 1].map(|axis| per[axis].abs() * change)
            }
            Shape::Radial { center, slide, .. } => {
                let [near, far] = beside(*center, (in_space(within.min()), in_space(within.max())));
                let least = length(near);
                let slope = slide.slope([least, length(far)]);
                // Along an axis the distance changes by the part of it that lies along the axis.
                [0, 1].map(|axis| slope * (far[axis].abs() / least).min(1.0))
            }
            Shape::Distance(measure, slide) => [slide.slope(measure.bounds(within)); 2],
            Shape::Noise(noise) => noise.slopes(within),
            Shape::Raster(raster) => raster.slopes(within),
            Shape::Terrain(terrain, slide) => terrain.slopes(slide, within),
            // Shares are at most 1.
            Shape::Multiply(parts) => over(parts, |a, b| a + b),
            Shape::Min(parts) | Shape::Max(parts) => over(parts, f64::max),
            Shape::Invert(part) => part.slopes(within),
            Shape::Curve(part, points) => {
                let [low, high] = part.bounds(within);
                let pairs = points.windows(2);
                let touched = pairs.filter(|pair| pair[0][0] <= high && low <= pair[1][0]);
                let slope =
                    touched.map(|pair| (pair[1][1] - pair[0][1]).abs() / (pair[1][0] - pair[0][0]));
                let most = slope.fold(0.0, f64::max) * (1.0 + 1e-9);
                match most {
                    0.0 => [0.0; 2],
                    _ => part.slopes(within).map(|slope| slope * most),
                }
            }
        }
    }
}

/// Noise fills space, places of three numbers lie in it, and all else is the same at all heights.
impl Field<3> for FieldSpec {
    fn share(&self, at: [f64; 3]) -> f64 {
        self.share_at(at)
    }

    fn shares(&self, places: &[[f64; 3]], shares: &mut [f64]) {
        self.shares_at(places, shares);
    }

    fn bounds(&self, within: &Region<3>) -> [f64; 2] {
        self.bounds_in(within)
    }
}

/// The shares of fields at some places, joined.
fn together<const D: usize>(
    parts: &[FieldSpec],
    first: f64,
    join: fn(f64, f64) -> f64,
    places: &[[f64; D]],
    shares: &mut [f64],
) {
    const SOME: usize = 256;
    let mut own = [0.0; SOME];
    for (places, shares) in places.chunks(SOME).zip(shares.chunks_mut(SOME)) {
        shares.fill(first);
        for part in parts {
            let own = &mut own[..shares.len()];
            part.shares_at(places, own);
            for (share, own) in shares.iter_mut().zip(own) {
                *share = join(*share, *own);
            }
        }
    }
}

/// The square root of a sum of squares. Rounds alike everywhere, unlike `hypot`.
fn length([x, y, z]: [f64; 3]) -> f64 {
    libm::sqrt(x * x + y * y + z * z)
}

/// The least and the greatest distance of the places of a box from a place, along each axis.
fn beside(center: [f64; 3], (min, max): ([f64; 3], [f64; 3])) -> [[f64; 3]; 2] {
    let near = |i: usize| (min[i] - center[i]).max(center[i] - max[i]).max(0.0);
    let far = |i: usize| (max[i] - center[i]).max(center[i] - min[i]);
    [[0, 1, 2].map(near), [0, 1, 2].map(far)]
}

/// The share of a ramp.
fn along(from: [f64; 3], per: [f64; 3], [low, high]: [f64; 2], at: [f64; 3]) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|axis| (at[axis] - from[axis]) * per[axis]);
    let t = x + y + z;
    if t >= 1.0 {
        high
    } else if t > 0.0 {
        low + (high - low) * t
    } else {
        low
    }
}

/// The height of a curve.
fn on(points: &[[f64; 2]], share: f64) -> f64 {
    let after = points.partition_point(|[x, _]| *x <= share);
    match (after.checked_sub(1).map(|i| points[i]), points.get(after)) {
        (Some([a, low]), Some([b, high])) => low + (high - low) * ((share - a) / (b - a)).min(1.0),
        (Some([_, last]), None) => last,
        (None, first) => first.map_or(0.0, |[_, share]| *share),
    }
}

/// A look at one octave of noise, in nanoseconds.
const OCTAVE: f64 = 20.0;
/// At a pixel and those beside it.
const PIXELS: f64 = 15.0;
/// At a node of a tree of sides, or at a side.
const SIDE: f64 = 3.0;
/// At a shape, whatever it is.
const SHAPE: f64 = 5.0;
/// Places of a region that stand for all of it, along each axis.
const PLACES: u32 = 4;

impl FieldSpec {
    /// About the nanoseconds that a look at a place takes on a processor of some years ago: the mean over a few
    /// places of a region. It depends on nothing else, so it is the same on every machine.
    pub(crate) fn nanoseconds(&self, within: Region) -> f64 {
        let (min, max) = (within.min(), within.max());
        // Off the middles of even parts, where shapes that are symmetric are special.
        let along = |i: usize, k: u32| {
            let t = (f64::from(k) + 0.37) / f64::from(PLACES);
            min[i] + (max[i] - min[i]) * t
        };
        let places = (0..PLACES).flat_map(|x| (0..PLACES).map(move |y| [x, y]));
        let sum: f64 = places
            .map(|[x, y]| self.nanoseconds_at([along(0, x), along(1, y)]))
            .sum();
        sum / f64::from(PLACES * PLACES)
    }

    fn nanoseconds_at(&self, at: [f64; 2]) -> f64 {
        let all = |parts: &[Self]| parts.iter().map(|part| part.nanoseconds_at(at)).sum();
        SHAPE
            + match &*self.shape {
                Shape::Constant(_) | Shape::Ramp { .. } | Shape::Radial { .. } => 0.0,
                Shape::Distance(measure, _) => SIDE * measure.looks(at) as f64,
                Shape::Noise(noise) => OCTAVE * f64::from(noise.octaves),
                Shape::Raster(_) | Shape::Terrain(..) => PIXELS,
                Shape::Multiply(parts) | Shape::Min(parts) | Shape::Max(parts) => all(parts),
                Shape::Invert(part) | Shape::Curve(part, _) => part.nanoseconds_at(at),
            }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::field::{Marks, Noise};

    #[test]
    fn a_look_costs_what_it_looks_at() {
        let view = Region::new([0.0, 0.0], [100.0, 100.0]).expect("a box");
        let noise = |octaves| {
            let noise = Noise {
                seed: 1,
                wavelength: 9.0,
                octaves,
                range: [0.0, 1.0],
            };
            FieldSpec::noise(noise).expect("valid")
        };
        let look = |spec: &FieldSpec| spec.nanoseconds(view);
        assert!(look(&noise(8)) > 6.0 * look(&noise(1)));
        let many = FieldSpec::multiply(vec![noise(8); 63]).expect("valid");
        assert!(look(&many) > 60.0 * look(&noise(8)));
        // Boxes around sides that all cross the view do not show which is near; those of a street do.
        let line = |place: &dyn Fn(u32) -> [u32; 2]| {
            let line = (0..5000).map(|i| place(i).map(f64::from).map(|v| v * 0.02));
            let marks = Marks::Lines(vec![line.collect()]);
            FieldSpec::distance(marks, [0.0, 1.0], [0.0, 1.0]).expect("valid")
        };
        let tangled = look(&line(&|i| [i * 1871 % 5003, i * 3571 % 5009]));
        let street = look(&line(&|i| [i, i % 7]));
        assert!(tangled > 20.0 * street, "{tangled} {street}");
    }
}
