//! The hash of a point, and the numbers made from it.
//!
//! It is the finalizer of SplitMix64 (Steele, Lea, Flood, 2014) over row and column, under a key made of the seed and
//! the attribute. The row comes first, so the points of a row share that round. Numbers are its upper 53 bits, so they
//! are exact multiples of 2⁻⁵³ below 1.

use core::{f64::consts::TAU, fmt::Debug};

use super::{Attribute, ScaleRange};
use crate::lattice::{
    Point, PointId,
    seed::{Seed, split_mix},
};

/// The key of an attribute with a [code](super::Attribute::code).
pub(crate) fn key(seed: Seed, code: u64) -> u64 {
    const PURPOSE: u64 = 0x4154_5452_4942_5554;
    split_mix(split_mix(seed.0 ^ PURPOSE).wrapping_add(code << 32))
}

/// The id of a point, in the plane or in space.
pub trait Hashed: Copy + Debug + Ord {
    /// The points that have such ids.
    type Point: Copy + Debug + Default + PartialEq;
    /// Whether they have rotations.
    const TURNS: bool;
    /// The id of a point.
    fn of(point: &Self::Point) -> Self;
    /// Whether both are of one row.
    fn shares_row(&self, other: &Self) -> bool;
    /// The part of the hash under a key that the points of the row share.
    fn of_row(self, key: u64) -> u64;
    /// The column.
    fn column(self) -> i64;
}

impl Hashed for PointId {
    type Point = Point;
    const TURNS: bool = false;

    fn of(point: &Point) -> Self {
        point.id
    }

    #[inline]
    fn shares_row(&self, other: &Self) -> bool {
        self.y == other.y
    }

    #[inline]
    fn of_row(self, key: u64) -> u64 {
        of_row(key, self.y)
    }

    #[inline]
    fn column(self) -> i64 {
        self.x
    }
}

/// The hash of a point under a key, uniform over `u64`.
#[inline]
pub(crate) fn hash(key: u64, id: impl Hashed) -> u64 {
    in_row(id.of_row(key), id.column())
}

/// The part of the hash that the points of a row share.
#[inline]
pub(crate) fn of_row(key: u64, y: i64) -> u64 {
    split_mix(key ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)).wrapping_add(key)
}

/// The hash of a point in a row.
#[inline]
pub(crate) fn in_row(row: u64, x: i64) -> u64 {
    split_mix(row ^ (x as u64).wrapping_mul(0xd6e8_feb8_6659_fd93))
}

/// A number in [0, 1).
#[inline]
pub(crate) fn unit(hash: u64) -> f64 {
    // (hash >> 11) as f64, which few machines convert in vectors: its halves as the lowest bits of 2⁵² and
    // 2⁸⁴. All three sums are exact.
    const LOW: u64 = 0x4330_0000_0000_0000;
    const HIGH: u64 = 0x4530_0000_0000_0000;
    let number = hash >> 11;
    let low = f64::from_bits(LOW | number & 0xffff_ffff) - f64::from_bits(LOW);
    let high = f64::from_bits(HIGH | number >> 32) - f64::from_bits(HIGH);
    (high + low) * (1.0 / (1u64 << 53) as f64)
}

/// A number in [0, 2π): the largest one, 2π·(1 − 2⁻⁵³), rounds to the number before 2π.
#[inline]
pub(crate) fn angle(hash: u64) -> f64 {
    unit(hash) * TAU
}

/// The keys of the numbers that rotations are made from.
pub(crate) fn turns(seed: Seed) -> [u64; 3] {
    [0, 1, 2].map(|i| key(seed, Attribute::ROTATION + i))
}

/// A rotation as a unit quaternion x, y, z, w, uniform for uniform numbers (Shoemake, "Uniform random rotations", 1992).
pub(crate) fn rotation(keys: [u64; 3], id: impl Hashed) -> [f64; 4] {
    let [u, v, w] = keys.map(|key| unit(hash(key, id)));
    let (low, high) = (libm::sqrt(1.0 - u), libm::sqrt(u));
    let (sine, cosine) = libm::sincos(TAU * v);
    let (other_sine, other_cosine) = libm::sincos(TAU * w);
    [
        low * sine,
        low * cosine,
        high * other_sine,
        high * other_cosine,
    ]
}

/// A number in a range, both ends included.
#[inline]
pub(crate) fn scale(range: ScaleRange, hash: u64) -> f64 {
    between(range.min(), range.max(), hash)
}

/// A number from `min` to `max`.
#[inline]
pub(crate) fn between(min: f64, max: f64, hash: u64) -> f64 {
    // Rounding may carry the sum past the end by a unit.
    (min + unit(hash) * (max - min)).min(max)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn units_are_the_upper_bits(hash: u64, fewer in 0u32..64) {
            for hash in [hash, hash >> fewer, !(hash >> fewer), 0, u64::MAX] {
                let converted = (hash >> 11) as f64 / (1u64 << 53) as f64;
                prop_assert_eq!(unit(hash).to_bits(), converted.to_bits());
            }
        }
    }
}
