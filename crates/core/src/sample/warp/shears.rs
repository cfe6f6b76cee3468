//! The definition of the warp.

use core::ops::{Add, Sub};

use super::Warp;
use crate::{
    sample::seed::{Seed, split_mix},
    table::FRACTION_BITS,
};

/// The distance of the knots of g, in bits of grid units: 2⁷ = 128.
pub(super) const KNOT_BITS: u32 = 7;
/// The distance of the knots, in bits of fixed-point units.
pub(crate) const CELL_BITS: u32 = FRACTION_BITS + KNOT_BITS;
pub(super) const CELL_MASK: i128 = (1 << CELL_BITS) - 1;

/// The largest control value at strength 1 of a shear along an axis, in mean spacings.
const AMPLITUDE: f64 = 2.5;
/// The largest control value at any strength, in grid units. It bounds the cells that a patch touches,
/// and matters only where α is near 1 and the pattern sparse.
const MAX_AMPLITUDE: f64 = 32.0;

/// A direction of shear. Points move by g(s), where s is the coordinate across.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    /// x += g(y).
    X,
    /// y += g(x).
    Y,
    /// (x, y) += (g, g), g of x − y.
    Rising,
    /// (x, y) += (g, −g), g of x + y.
    Falling,
}

/// The directions, in the order of their application.
const DIRECTIONS: [Direction; 4] = [
    Direction::X,
    Direction::Y,
    Direction::Rising,
    Direction::Falling,
];

/// The warp of one seed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shears {
    keys: [u64; 4],
    /// The largest control value of each direction, in fixed-point units.
    amplitudes: [i32; 4],
}

/// The cubic of one cell of one direction, constant term first; in fixed-point units.
pub(super) type Cubic = [f32; 4];

impl Shears {
    /// The shears of a seed, or `None` if the warp is off. `set_side` is t.
    pub(crate) fn new(warp: Warp, seed: Seed, set_side: f64) -> Option<Self> {
        if warp.is_off() {
            return None;
        }
        let unit = (AMPLITUDE * warp.strength() / set_side).min(MAX_AMPLITUDE);
        let unit = unit * f64::from(1 << FRACTION_BITS);
        // A diagonal shear moves by √2·g.
        let diagonal = unit * core::f64::consts::FRAC_1_SQRT_2;
        let first = split_mix(seed.0 ^ 0x5745_4156_4552_5321);
        Some(Self {
            keys: [1, 2, 3, 4].map(|i: u64| split_mix(first.wrapping_add(i << 56))),
            amplitudes: [unit, unit, diagonal, diagonal].map(|a| a as i32),
        })
    }

    /// The largest movement along x or y, in fixed-point units.
    pub(crate) fn reach(&self) -> i32 {
        // A cubic B-spline stays within its control values. The rest is room for rounding.
        let [x, y, rising, falling] = self.amplitudes;
        x.max(y) + rising + falling + 64
    }

    /// The largest control value of each shear, in fixed-point units.
    pub(super) const fn amplitudes(&self) -> [i32; 4] {
        self.amplitudes
    }

    /// The steepest slope of each shear's g. Adjacent control values differ by at most twice the
    /// amplitude.
    pub(super) fn slopes(&self) -> [f64; 4] {
        self.amplitudes
            .map(|a| 2.0 * f64::from(a) / f64::from(1 << CELL_BITS))
    }

    /// The control value of a knot.
    fn control(&self, direction: usize, knot: i64) -> i32 {
        let hash =
            split_mix(self.keys[direction] ^ (knot as u64).wrapping_mul(0xd6e8_feb8_6659_fd93));
        // The upper 32 bits as a number in [−1, 1) times the amplitude.
        ((i64::from((hash >> 32) as i32) * i64::from(self.amplitudes[direction])) >> 31) as i32
    }

    /// The uniform cubic B-spline of the control values on one cell.
    pub(super) fn cubic(&self, direction: usize, cell: i64) -> Cubic {
        let [a, b, c, d] =
            [-1, 0, 1, 2].map(|i| f64::from(self.control(direction, cell.wrapping_add(i))));
        [
            ((a + 4.0 * b + c) / 6.0) as f32,
            ((c - a) / 2.0) as f32,
            ((a - 2.0 * b + c) / 2.0) as f32,
            ((d - a + 3.0 * (b - c)) / 6.0) as f32,
        ]
    }

    fn noise(&self, direction: usize, s: i128) -> i128 {
        let cubic = self.cubic(direction, (s >> CELL_BITS) as i64);
        evaluate(&cubic, (s & CELL_MASK) as i32).into()
    }

    /// The place to which the warp moves a fixed-point position.
    pub(crate) fn apply(&self, position: [i128; 2]) -> [i128; 2] {
        (0..4).fold(position, |p, i| shear(i, p, |s| self.noise(i, s)))
    }

    /// The exact inverse of [`apply`](Self::apply).
    pub(crate) fn invert(&self, position: [i128; 2]) -> [i128; 2] {
        (0..4)
            .rev()
            .fold(position, |p, i| shear(i, p, |s| -self.noise(i, s)))
    }
}

/// Shear number `i`, with `g` as a function of the coordinate across.
#[inline(always)]
pub(super) fn shear<T>(i: usize, [x, y]: [T; 2], g: impl FnOnce(T) -> T) -> [T; 2]
where
    T: Copy + Add<Output = T> + Sub<Output = T>,
{
    match DIRECTIONS[i] {
        Direction::X => [x + g(y), y],
        Direction::Y => [x, y + g(x)],
        Direction::Rising => {
            let g = g(x - y);
            [x + g, y + g]
        }
        Direction::Falling => {
            let g = g(x + y);
            [x + g, y - g]
        }
    }
}

/// g at the place `at` of a cell, in [0, 2^[`CELL_BITS`]).
#[inline(always)]
pub(super) fn evaluate(cubic: &Cubic, at: i32) -> i32 {
    let u = at as f32 * (1.0 / (1u32 << CELL_BITS) as f32);
    (((cubic[3] * u + cubic[2]) * u + cubic[1]) * u + cubic[0]) as i32
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn inverts_exactly(seed: u64, x in -(1i128 << 72)..1 << 72, y in -(1i128 << 72)..1 << 72) {
            let shears = Shears::new(Warp::ON, Seed(seed), 0.317).expect("on");
            let there = shears.apply([x, y]);
            prop_assert_eq!(shears.invert(there), [x, y]);
            let reach = i128::from(shears.reach());
            prop_assert!((there[0] - x).abs() <= reach && (there[1] - y).abs() <= reach);
        }
    }
}
