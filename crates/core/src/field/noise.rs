//! Noise.

use core::array::from_fn;

use super::{
    definition::Canon,
    scale::{check_numbers, check_share, unit, widened},
};
use crate::{
    error::{Error, ErrorKind, number},
    kernel::{Backend, PlainLoop, compiled_loop},
    lattice::seed::split_mix,
    shape::Region,
};

/// Smooth patches of a size, of no end and without a pattern: value noise.
///
/// Octave i has hashed numbers in [0, 1) at the corners of squares, in space of cubes, with a side of wavelength / 2ⁱ,
/// joined by 6t⁵ − 15t⁴ + 10t³ along all axes, and half the weight of the octave before. Each octave is turned by
/// atan ¾ from the one before, in space about z, then about x. The weighted mean is laid between the two ends of
/// `range`.
///
/// ```
/// use strew_core::{Field, field::{FieldSpec, Noise}};
///
/// let noise = Noise { seed: 7, wavelength: 50.0, octaves: 3, range: [0.2, 0.9] };
/// let patches = FieldSpec::noise(noise)?;
/// for x in 0..100 {
///     assert!((0.2..=0.9).contains(&patches.share([f64::from(x), 3.5])));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Another seed makes other patches. It has nothing to do with the seed of the points.
    pub seed: u64,
    /// The size of the largest patches in world units, above 0.
    pub wavelength: f64,
    /// The number of sizes, 1 to 8: more makes patches rougher.
    pub octaves: u32,
    /// The shares between which the noise lies, each in [0, 1]. The first may be above the second.
    pub range: [f64; 2],
}

/// Cells of an octave up to which bounds look at each corner.
const FEW: f64 = 6.0;

impl Noise {
    pub(super) fn check(&self) -> Result<(), Error> {
        let refused =
            |name, value, allowed| Err(Error::new(ErrorKind::Field, name, value, allowed));
        check_numbers("wavelength", &[self.wavelength])?;
        if self.wavelength < 1e-100 {
            let allowed = "a number from 1e-100 to 1e100";
            return refused("wavelength", number(self.wavelength), allowed);
        }
        if !(1..=8).contains(&self.octaves) {
            let value = alloc::format!("{}", self.octaves);
            return refused("octaves", value, "an integer from 1 to 8");
        }
        check_share("range", self.range[0])?;
        check_share("range", self.range[1])
    }

    pub(super) fn describe(&self, canon: &mut Canon) {
        canon.number(self.seed);
        canon.numbers(&[self.wavelength]);
        canon.number(self.octaves.into());
        canon.numbers(&self.range);
    }

    #[inline]
    pub(super) fn share<const D: usize>(&self, at: [f64; D]) -> f64 {
        let mut place = at.map(|v| v / self.wavelength);
        let (mut sum, mut weight, mut weights) = (0.0, 1.0, 0.0);
        let floor = |v: f64| {
            let whole = libm::floor(v);
            (whole, whole as i64)
        };
        for octave in 0..self.octaves {
            sum += weight * octave_at(self.key(octave), place, floor);
            weights += weight;
            weight *= 0.5;
            place = next(place);
        }
        self.within_range(sum / weights)
    }

    /// The shares at some places.
    pub(super) fn shares<const D: usize>(&self, places: &[[f64; D]], shares: &mut [f64]) {
        let backend = Backend::best();
        for (places, shares) in places.chunks(SOME).zip(shares.chunks_mut(SOME)) {
            let mut work = Batch {
                noise: self,
                places: [[0.0; SOME]; D],
                sums: [0.0; SOME],
            };
            for (i, place) in places.iter().enumerate() {
                for (all, v) in work.places.iter_mut().zip(place) {
                    all[i] = v / self.wavelength;
                }
            }
            let is_far = |v: &f64| v.is_nan() || v.abs() > FAR;
            if work.places.as_flattened().iter().any(is_far) {
                for (share, at) in shares.iter_mut().zip(places) {
                    *share = self.share(*at);
                }
                continue;
            }
            compiled_loop(backend, &mut work);
            for (share, sum) in shares.iter_mut().zip(work.sums) {
                *share = self.within_range(sum);
            }
        }
    }

    pub(super) fn bounds<const D: usize>(&self, within: &Region<D>) -> [f64; 2] {
        let (mut center, mut half) = self.around(within);
        let (mut low, mut high, mut weight, mut weights) = (0.0, 0.0, 1.0, 0.0);
        for octave in 0..self.octaves {
            let ends = octave_between(self.key(octave), center, half);
            low += weight * ends[0];
            high += weight * ends[1];
            weights += weight;
            weight *= 0.5;
            center = next(center);
            half = next_half(half);
        }
        let [a, b] = [low / weights - 1e-9, high / weights + 1e-9].map(|v| self.within_range(v));
        widened([a.min(b), a.max(b)])
    }

    /// Bounds of the change along x and y for each world unit, over a box.
    pub(super) fn slopes(&self, within: &Region) -> [f64; 2] {
        // Of 6t⁵ − 15t⁴ + 10t³, at ½.
        const STEEPEST: f64 = 1.875;
        let (mut center, mut half) = self.around(within);
        let (mut sums, mut weight, mut weights) = ([0.0; 2], 1.0, 0.0);
        // The axes of an octave, in wavelengths of the first.
        let mut axes = [1.0, 0.0];
        for octave in 0..self.octaves {
            let [across, up] = steps_between(self.key(octave), center, half);
            let [c, s] = axes.map(f64::abs);
            sums[0] += weight * (c * across + s * up);
            sums[1] += weight * (s * across + c * up);
            weights += weight;
            weight *= 0.5;
            center = next(center);
            half = next_half(half);
            axes = next(axes);
        }
        let range = (self.range[1] - self.range[0]).abs();
        // With room for what rounds.
        let factor = STEEPEST / weights / self.wavelength * range * (1.0 + 1e-9);
        sums.map(|sum| sum * factor)
    }

    /// The middle and the half sides of a box, in wavelengths.
    fn around<const D: usize>(&self, within: &Region<D>) -> ([f64; D], [f64; D]) {
        let (min, max) = (within.min(), within.max());
        let center = from_fn(|i| (0.5 * min[i] + 0.5 * max[i]) / self.wavelength);
        let half = from_fn(|i| (0.5 * max[i] - 0.5 * min[i]) / self.wavelength);
        (center, half)
    }

    fn within_range(&self, v: f64) -> f64 {
        let [low, high] = self.range;
        low + (high - low) * unit(v)
    }

    fn key(&self, octave: u32) -> u64 {
        split_mix(self.seed.wrapping_add(u64::from(octave) << 56))
    }
}

/// The number of places that are looked up at once, in vectors.
const SOME: usize = 32;

/// Up to here, all octaves of a place are below 2⁵⁰, where whole parts come from rounding.
const FAR: f64 = 1e12;

/// 1.5 · 2⁵²: a number within ±2⁵¹, added to it, is rounded to an integer, in the lower bits.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Some places, and their numbers.
struct Batch<'a, const D: usize> {
    noise: &'a Noise,
    places: [[f64; SOME]; D],
    sums: [f64; SOME],
}

/// The largest integer up to a number within ±2⁵⁰, twice.
#[inline(always)]
fn floor(v: f64) -> (f64, i64) {
    let rounded = (v + ROUNDER) - ROUNDER;
    let whole = if rounded > v { rounded - 1.0 } else { rounded };
    let bits = (whole + ROUNDER).to_bits().wrapping_sub(ROUNDER.to_bits());
    (whole, bits as i64)
}

impl<const D: usize> PlainLoop for Batch<'_, D> {
    #[inline(always)]
    fn run(&mut self) {
        let (mut weight, mut weights) = (1.0, 0.0);
        for octave in 0..self.noise.octaves {
            let key = self.noise.key(octave);
            for (i, sum) in self.sums.iter_mut().enumerate() {
                let mut place = [0.0; D];
                for (v, list) in place.iter_mut().zip(&self.places) {
                    *v = list[i];
                }
                *sum += weight * octave_at(key, place, floor);
                for (list, v) in self.places.iter_mut().zip(next(place)) {
                    list[i] = v;
                }
            }
            weights += weight;
            weight *= 0.5;
        }
        for sum in &mut self.sums {
            *sum /= weights;
        }
    }
}

/// The place of a place in the next octave.
#[inline(always)]
fn next<const D: usize>(mut place: [f64; D]) -> [f64; D] {
    let [x, y] = [place[0], place[1]];
    place[0] = 2.0 * (0.8 * x - 0.6 * y);
    place[1] = 2.0 * (0.6 * x + 0.8 * y);
    if D == 3 {
        let [y, z] = [place[1], 2.0 * place[2]];
        place[1] = 0.8 * y - 0.6 * z;
        place[2] = 0.6 * y + 0.8 * z;
    }
    place
}

/// The key of the corners of a plane of space.
#[inline(always)]
const fn plane(key: u64, z: i64) -> u64 {
    split_mix(key ^ (z as u64).wrapping_mul(0x9e6c_63d0_676a_9a99))
}

/// The number at a corner, in [0, 1).
#[inline(always)]
fn corner(key: u64, x: i64, y: i64) -> f64 {
    in_row(row(key, y), x)
}

/// The part of the hash that a row of corners shares.
#[inline(always)]
const fn row(key: u64, y: i64) -> u64 {
    split_mix(key ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
}

/// The number at a corner of a row.
#[inline(always)]
fn in_row(row: u64, x: i64) -> f64 {
    let hash = split_mix(row ^ (x as u64).wrapping_mul(0xd6e8_feb8_6659_fd93));
    (hash >> 11) as f64 / (1u64 << 53) as f64
}

/// 6t⁵ − 15t⁴ + 10t³.
#[inline(always)]
fn eased(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

#[inline(always)]
fn octave_at<const D: usize>(
    key: u64,
    place: [f64; D],
    floor: impl Fn(f64) -> (f64, i64) + Copy,
) -> f64 {
    let flat = [place[0], place[1]];
    let Some(&height) = place.get(2) else {
        return octave_in_plane(key, flat, floor);
    };
    let (cell, z) = floor(height);
    let of = |z| octave_in_plane(plane(key, z), flat, floor);
    let (low, high) = (of(z), of(z.wrapping_add(1)));
    low + (high - low) * eased(height - cell)
}

#[inline(always)]
fn octave_in_plane(key: u64, place: [f64; 2], floor: impl Fn(f64) -> (f64, i64)) -> f64 {
    let ((left, x), (bottom, y)) = (floor(place[0]), floor(place[1]));
    let (u, v) = (eased(place[0] - left), eased(place[1] - bottom));
    let along = |row: u64| {
        let (a, b) = (in_row(row, x), in_row(row, x.wrapping_add(1)));
        a + (b - a) * u
    };
    let (low, high) = (along(row(key, y)), along(row(key, y.wrapping_add(1))));
    low + (high - low) * v
}

/// The range of corners around the places of a box, from the first to the last along each axis; `None` if they are
/// many.
fn corners<const D: usize>(center: [f64; D], half: [f64; D]) -> Option<[[i64; 2]; D]> {
    // Room for what rounds.
    let room = 1e-9;
    let ends: [_; D] = from_fn(|i| {
        let (half, room) = (half[i] + room, 1e-12 * center[i].abs());
        [center[i] - half - room, center[i] + half + room].map(libm::floor)
    });
    let is_far = |v: &f64| v.is_nan() || v.abs() > 1e9;
    let is_large = ends.iter().any(|[a, b]| b - a > FEW);
    if is_large || ends.iter().flatten().any(is_far) {
        return None;
    }
    Some(ends.map(|[first, last]| [first as i64, last as i64 + 1]))
}

fn octave_between<const D: usize>(key: u64, center: [f64; D], half: [f64; D]) -> [f64; 2] {
    let Some(ends) = corners(center, half) else {
        return [0.0, 1.0];
    };
    let ([left, right], [bottom, top]) = (ends[0], ends[1]);
    let in_plane = |found: [f64; 2], key: u64| {
        let all = (bottom..=top).flat_map(|y| (left..=right).map(move |x| corner(key, x, y)));
        all.fold(found, |[low, high], v| [low.min(v), high.max(v)])
    };
    match ends.get(2) {
        Some(&[first, last]) => (first..=last)
            .map(|z| plane(key, z))
            .fold([1.0, 0.0], in_plane),
        None => in_plane([1.0, 0.0], key),
    }
}

/// The greatest differences of neighboring corners along x and y around the places of a box.
fn steps_between(key: u64, center: [f64; 2], half: [f64; 2]) -> [f64; 2] {
    let Some([[left, right], [bottom, top]]) = corners(center, half) else {
        return [1.0; 2];
    };
    let mut most = [0.0f64; 2];
    for y in bottom..=top {
        for x in left..=right {
            let own = corner(key, x, y);
            if x < right {
                most[0] = most[0].max((corner(key, x + 1, y) - own).abs());
            }
            if y < top {
                most[1] = most[1].max((corner(key, x, y + 1) - own).abs());
            }
        }
    }
    most
}

/// The half sides of a box around the places of a box in the next octave.
fn next_half<const D: usize>(mut half: [f64; D]) -> [f64; D] {
    let [x, y] = [half[0], half[1]];
    half[0] = 2.0 * (0.8 * x + 0.6 * y);
    half[1] = 2.0 * (0.6 * x + 0.8 * y);
    if D == 3 {
        let [y, z] = [half[1], 2.0 * half[2]];
        half[1] = 0.8 * y + 0.6 * z;
        half[2] = 0.6 * y + 0.8 * z;
    }
    half
}
