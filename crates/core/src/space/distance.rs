//! The least distance between any two points, which is the same wherever points are requested.
//!
//! Two blocks meet across an offset of the lattice if along each axis the shift of the offset carries a part of one
//! interval into the other. The least length over all such pairs and offsets is attained by points of the unbounded
//! set, and no two points are nearer.

use alloc::vec::Vec;

use super::{
    table::{Table, VECTOR_BITS},
    warp::Stretch3,
};
use crate::{
    error::{Error, ErrorKind, number},
    map::Map,
    sample::{Spacing, Warp},
    table::FRACTION_BITS,
};

/// The distance between neighbors of the densest packing at unit density: 2^(1/6).
const DENSEST: f64 = 1.122_462_048_309_373;

/// The guaranteed distance between points of a table.
///
/// ```
/// use strew_core::{Warp, space::Table};
///
/// let least = Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?.least_distance();
/// assert!(least.with_warp(Warp::ON) < least.with_warp(Warp::OFF));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastDistance {
    /// Squared, in fixed-point units.
    squared: u64,
    set_side: f64,
}

impl Table {
    /// The least distance between any two points of the table's sets. The first call looks at the pairs of blocks that can
    /// meet near each other.
    #[must_use]
    pub fn least_distance(&self) -> LeastDistance {
        LeastDistance {
            squared: self.least_squared(|| least_squared(self)),
            set_side: self.map().alpha().set_side_f64(),
        }
    }
}

impl LeastDistance {
    /// The least [`relative`](Self::relative) distance that is useful.
    pub const MIN_RELATIVE: f64 = 0.3;
    /// The part by which [`spacing_for`](Self::spacing_for) widens a spacing, more than the rounding of reported
    /// coordinates takes near the origin.
    const MARGIN: f64 = 1e-6;

    /// δ_min: the distance without warp in units of that of the densest packing, (√2/N)^⅓; at most 1.
    #[must_use]
    pub fn relative(&self) -> f64 {
        self.with_warp(Warp::OFF) / DENSEST
    }

    /// The guaranteed distance in mean spacings, for a strength of the warp and every seed. Without warp it is
    /// attained. With warp it is a bound: the table's distance divided by the largest factor by which the warp shrinks
    /// distances.
    #[must_use]
    pub fn with_warp(&self, warp: Warp) -> f64 {
        let Stretch3 { factor, slack } = Stretch3::of(warp);
        let units = libm::sqrt(self.squared as f64) / factor - 2.0 * slack;
        units.max(0.0) / f64::from(1u32 << FRACTION_BITS) * self.set_side
    }

    /// The mean spacing at which no two points are nearer than `distance` world units, for a strength of the warp and
    /// every seed.
    ///
    /// # Errors
    /// [`ErrorKind::Distance`] unless the distance is a positive finite number, [`ErrorKind::NoLeastDistance`] if the
    /// table's is below [`MIN_RELATIVE`](Self::MIN_RELATIVE), and [`ErrorKind::Spacing`] if the spacing would leave
    /// [`Spacing`]'s range.
    ///
    /// ```
    /// use strew_core::{ErrorKind, Warp, space::Table};
    ///
    /// let least = Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?.least_distance();
    /// let [plain, warped] = [least.spacing_for(2.0, Warp::OFF)?, least.spacing_for(2.0, Warp::ON)?];
    /// assert!(warped > plain);
    /// assert_eq!(least.spacing_for(0.0, Warp::ON).unwrap_err().kind(), ErrorKind::Distance);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn spacing_for(&self, distance: f64, warp: Warp) -> Result<Spacing, Error> {
        const FIELD: &str = "min_distance";
        let value = number(distance);
        if !(distance.is_finite() && distance > 0.0) {
            let allowed = "a finite number greater than 0";
            return Err(Error::new(ErrorKind::Distance, FIELD, value, allowed));
        }
        let kept = self.with_warp(warp);
        if self.relative() < Self::MIN_RELATIVE || kept <= 0.0 {
            let problem = alloc::format!(
                "the profile guarantees no least distance: its nearest points are {:.4} of the densest packing's \
                 distance apart, and at least {} is needed",
                self.relative(),
                Self::MIN_RELATIVE
            );
            let error = Error::new(ErrorKind::NoLeastDistance, FIELD, value, "");
            return Err(error.because(problem));
        }
        Spacing::new(distance / kept * (1.0 + Self::MARGIN)).map_err(|error| {
            let allowed = alloc::format!("a distance with a {error}");
            Error::new(ErrorKind::Spacing, FIELD, value, allowed)
        })
    }
}

/// The pairs of intervals of an axis that meet across a shift of the index, as (from, to).
fn meetings(map: &Map, shift: u64) -> Vec<(usize, usize)> {
    let n = map.intervals();
    let side = map.alpha().set_side();
    let mut found = Vec::new();
    for from in 0..n {
        let interval = map.interval(from);
        // The image may wrap around the circle once, and both of its parts may lie in the set region.
        let (start, length) = (
            interval.start.wrapping_add(shift),
            interval.end - interval.start,
        );
        let parts = match start.checked_add(length) {
            Some(end) => [(start, end), (0, 0)],
            None => [(start, u64::MAX), (0, start.wrapping_add(length))],
        };
        for (start, end) in parts {
            if start >= side || start >= end {
                continue;
            }
            let first = map.locate(start);
            let last = map.locate((end - 1).min(side - 1));
            found.extend((first..=last).map(|to| (from, to)));
        }
    }
    found
}

/// The least and the greatest component of some vectors along each axis.
fn spans(vectors: &[[i16; 3]]) -> [[i64; 2]; 3] {
    [0, 1, 2].map(|axis| {
        let components = vectors.iter().map(|vector| i64::from(vector[axis]));
        components.fold([i64::MAX, i64::MIN], |[least, most], v| {
            [least.min(v), most.max(v)]
        })
    })
}

/// The least squared distance between two points, in fixed-point units.
fn least_squared(table: &Table) -> u64 {
    let map = table.map();
    let (n, vectors) = (map.intervals(), table.vectors());
    let densest = DENSEST / map.alpha().set_side_f64();
    // In units of vectors. No pattern keeps points farther apart than the densest packing.
    let limit = densest * f64::from(1u32 << VECTOR_BITS);
    let mut least = (limit * limit) as i64 + 1;
    let reach = vectors.iter().flatten().map(|v| v.unsigned_abs()).max();
    let units = f64::from(reach.unwrap_or(0)) * 2.0 + limit;
    let far = (units / f64::from(1u32 << VECTOR_BITS)) as i64 + 1;
    let by_offset = |offset: i64, parity: i64| {
        let shift = map.alpha().half().wrapping_mul(offset as u64);
        meetings(map, shift.wrapping_add((parity as u64) << 63))
    };
    let all: Vec<[Vec<(usize, usize)>; 2]> = (-far..=far)
        .map(|offset| [0, 1].map(|parity| by_offset(offset, parity)))
        .collect();
    let pairs = |offset: i64, others: i64| &all[(offset + far) as usize][(others & 1) as usize];
    let row = -far..=far;
    let planes = (0..=far).flat_map(|z| row.clone().map(move |y| (z, y)));
    let offsets = planes.flat_map(|(z, y)| row.clone().map(move |x| [x, y, z]));
    // One of two opposite offsets, short ones first, where the least distance is.
    let mut offsets: Vec<[i64; 3]> = offsets.filter(|&[x, y, z]| (z, y, x) > (0, 0, 0)).collect();
    offsets.sort_by_key(|offset| offset.iter().map(|v| v * v).sum::<i64>());
    // The least and the greatest component along each axis of the vectors of a row of blocks, and of all.
    let rows: Vec<[[i64; 2]; 3]> = vectors.chunks(n).map(spans).collect();
    let whole = spans(vectors);
    // No two blocks of such spans are nearer, squared.
    let bound = |offset: [i64; 3], [a, b]: [&[[i64; 2]; 3]; 2]| -> i64 {
        let apart = |axis: usize| {
            let ([a_least, a_most], [b_least, b_most]) = (a[axis], b[axis]);
            let [low, high] = [
                offset[axis] + b_least - a_most,
                offset[axis] + b_most - a_least,
            ];
            low.max(-high).max(0)
        };
        (0..3).map(|axis| apart(axis) * apart(axis)).sum()
    };
    for [x, y, z] in offsets {
        let offset = [x, y, z].map(|v| v << VECTOR_BITS);
        if bound(offset, [&whole, &whole]) >= least {
            continue;
        }
        let (along_x, along_y, along_z) = (pairs(x, y + z), pairs(y, x + z), pairs(z, x + y));
        for &(k, to_k) in along_z {
            for &(j, to_j) in along_y {
                if bound(offset, [&rows[k * n + j], &rows[to_k * n + to_j]]) >= least {
                    continue;
                }
                for &(i, to_i) in along_x {
                    let [a, b] = [(k, j, i), (to_k, to_j, to_i)]
                        .map(|(k, j, i)| vectors[(k * n + j) * n + i]);
                    let d = [0, 1, 2]
                        .map(|axis| offset[axis] + i64::from(b[axis]) - i64::from(a[axis]));
                    let squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                    least = least.min(squared);
                }
            }
        }
    }
    let finer = 2 * (FRACTION_BITS - VECTOR_BITS);
    (least as u64) << finer
}
