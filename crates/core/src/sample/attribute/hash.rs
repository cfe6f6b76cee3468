//! The hash of a point, and the numbers made from it.
//!
//! It is the finalizer of SplitMix64 (Steele, Lea, Flood, 2014) over column and row, under a key made of
//! the seed and the attribute. Numbers are its upper 53 bits, so they are exact multiples of 2⁻⁵³ below 1.

use core::f64::consts::TAU;

use super::ScaleRange;
use crate::sample::{
    lattice::PointId,
    seed::{Seed, split_mix},
};

/// The key of an attribute with a [code](super::Attribute::code).
pub(crate) fn key(seed: Seed, code: u64) -> u64 {
    const PURPOSE: u64 = 0x4154_5452_4942_5554;
    split_mix(split_mix(seed.0 ^ PURPOSE).wrapping_add(code << 32))
}

/// The hash of a point under a key, uniform over `u64`.
#[inline]
pub(crate) fn hash(key: u64, id: PointId) -> u64 {
    let x = split_mix(key ^ (id.x as u64).wrapping_mul(0xd6e8_feb8_6659_fd93));
    split_mix(x.wrapping_add(key) ^ (id.y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
}

/// A number in [0, 1).
#[inline]
pub(crate) fn unit(hash: u64) -> f64 {
    (hash >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// A number in [0, 2π): the largest one, 2π·(1 − 2⁻⁵³), rounds to the number before 2π.
#[inline]
pub(crate) fn angle(hash: u64) -> f64 {
    unit(hash) * TAU
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
