//! The seeded warp: area-preserving shears that end the pattern's quasi-periodicity.
//!
//! A displaced pattern repeats itself almost exactly, so a large window shows Bragg peaks: its
//! speckle is frozen. Moving points along a few directions d by smooth random functions of the
//! coordinate across, p ← p + d·g(d⊥·p), one direction after another, decorrelates distant parts.
//! Every shear preserves area exactly, so low-frequency power does not rise; it inverts exactly, so
//! random access stays.
//!
//! All of it is integer arithmetic on fixed-point positions but for g, whose cubic is evaluated in
//! `f32` with plain multiplications and additions: the same bits on every machine, in any lane.

use core::ops::{Add, Sub};

use super::{Seed, seed::split_mix};
use crate::table::FRACTION_BITS;

/// How strongly the plane is warped: 0 is not at all, 1 the measured default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Warp {
    /// In units of 1/256.
    strength: u16,
}

/// A warp strength that is not allowed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("warp strength is {0}; it must be a number from 0 (off) to {max}", max = Warp::MAX_STRENGTH)]
pub struct WarpError(pub f64);

impl Warp {
    /// No warp.
    pub const OFF: Self = Self { strength: 0 };
    /// The strength with the best trade between isotropy and distances.
    pub const ON: Self = Self { strength: 256 };
    /// The greatest strength.
    pub const MAX_STRENGTH: f64 = 2.0;

    /// A warp of a given strength, rounded to 1/256.
    ///
    /// # Errors
    /// [`WarpError`] outside 0 to [`MAX_STRENGTH`](Self::MAX_STRENGTH) or for NaN.
    pub fn new(strength: f64) -> Result<Self, WarpError> {
        if (0.0..=Self::MAX_STRENGTH).contains(&strength) {
            Ok(Self {
                strength: libm::round(strength * 256.0) as u16,
            })
        } else {
            Err(WarpError(strength))
        }
    }

    /// The strength, a multiple of 1/256.
    #[must_use]
    pub fn strength(self) -> f64 {
        f64::from(self.strength) / 256.0
    }

    /// Whether points stay where the table puts them.
    #[must_use]
    pub const fn is_off(self) -> bool {
        self.strength == 0
    }
}

/// Knots of the noise stand this many bits of grid units apart: 2⁷ = 128.
const KNOT_BITS: u32 = 7;
/// The same in fixed point.
pub(super) const CELL_BITS: u32 = FRACTION_BITS + KNOT_BITS;
const CELL_MASK: i128 = (1 << CELL_BITS) - 1;

/// Control values reach this many mean spacings at strength 1, for a shear along an axis.
const AMPLITUDE: f64 = 2.5;
/// And at most so many grid units, which only matters where α is near 1 and the pattern sparse: a
/// patch with its surroundings then spans few enough cells for [`PatchShears`].
const MAX_AMPLITUDE: f64 = 32.0;

/// One direction: points move by g(s), s the coordinate across.
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

/// The directions in the order they are applied.
const DIRECTIONS: [Direction; 4] = [
    Direction::X,
    Direction::Y,
    Direction::Rising,
    Direction::Falling,
];

/// The warp of one seed, ready to apply.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shears {
    keys: [u64; 4],
    /// The largest control value of each direction, in fixed-point units.
    amplitudes: [i32; 4],
}

/// The cubic of one cell of one direction, constant term first; in fixed-point units.
pub(super) type Cubic = [f32; 4];

impl Shears {
    /// The shears of a seed, or `None` if the warp is off. `set_side` is t.
    pub(super) fn new(warp: Warp, seed: Seed, set_side: f64) -> Option<Self> {
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

    /// How far a point moves along x or y at most, in fixed-point units.
    pub(super) fn reach(&self) -> i32 {
        // A cubic B-spline stays within its control values; a few units for rounding.
        let [x, y, rising, falling] = self.amplitudes;
        x.max(y) + rising + falling + 64
    }

    /// The largest control value of each shear, in fixed-point units.
    pub(super) const fn amplitudes(&self) -> [i32; 4] {
        self.amplitudes
    }

    /// The steepest slope of each shear's g: adjacent control values differ by twice the amplitude
    /// at most.
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

    /// Where a fixed-point position goes.
    pub(super) fn apply(&self, position: [i128; 2]) -> [i128; 2] {
        (0..4).fold(position, |p, i| shear(i, p, |s| self.noise(i, s)))
    }

    /// Where it came from: the exact inverse.
    pub(super) fn invert(&self, position: [i128; 2]) -> [i128; 2] {
        (0..4)
            .rev()
            .fold(position, |p, i| shear(i, p, |s| -self.noise(i, s)))
    }
}

/// One shear, `g` of the coordinate across.
#[inline(always)]
fn shear<T>(i: usize, [x, y]: [T; 2], g: impl FnOnce(T) -> T) -> [T; 2]
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

/// Shears for points near each other: positions are relative to a place near them, and the cubics
/// used last are remembered.
#[derive(Debug)]
pub(super) struct NearShears<'a> {
    shears: &'a Shears,
    /// The cells of the origin, by direction.
    cells: [i64; 4],
    last: [(i64, Cubic); 4],
}

impl<'a> NearShears<'a> {
    /// Near a place, and the origin that positions are relative to: a multiple of the knot distance
    /// along both axes, so that all coordinates across are whole cells there.
    pub(super) fn new(shears: &'a Shears, place: [i128; 2]) -> (Self, [i128; 2]) {
        let [x, y] = place.map(|v| (v >> CELL_BITS) as i64);
        let cells = [y, x, x - y, x + y];
        let mut last = [(0, [0.0; 4]); 4];
        for (i, last) in last.iter_mut().enumerate() {
            last.1 = shears.cubic(i, cells[i]);
        }
        let near = Self {
            shears,
            cells,
            last,
        };
        (near, [x, y].map(|v| i128::from(v) << CELL_BITS))
    }

    /// [`Shears::apply`], relative to the origin.
    #[inline]
    pub(super) fn apply(&mut self, position: [i64; 2]) -> [i64; 2] {
        (0..4).fold(position, |p, i| {
            shear(i, p, |s| {
                let cell = s >> CELL_BITS;
                if self.last[i].0 != cell {
                    self.last[i] = (cell, self.shears.cubic(i, self.cells[i].wrapping_add(cell)));
                }
                evaluate(&self.last[i].1, (s & CELL_MASK as i64) as i32).into()
            })
        })
    }
}

/// g at a place in a cell: `at` in [0, 2^[`CELL_BITS`]).
#[inline(always)]
pub(super) fn evaluate(cubic: &Cubic, at: i32) -> i32 {
    let u = at as f32 * (1.0 / (1u32 << CELL_BITS) as f32);
    (((cubic[3] * u + cubic[2]) * u + cubic[1]) * u + cubic[0]) as i32
}

/// Cells that the points of a patch may touch per direction, at most: one vector of numbers. A patch
/// is 1024 × 256 grid units; with displacements below 127 and shears of up to 32, coordinates across
/// the diagonals stay within 1280 + 4·127 + 2·32 of them, less than 15 cells of 128.
pub(super) const PATCH_CELLS: usize = 16;
/// The first cell across each direction, relative to the patch's origin.
const FIRST_CELLS: [i64; 4] = [-4, -4, -5, -3];

/// The shears near one patch: positions relative to its origin fit 32 bits, and all cubics are at
/// hand. The origin is a multiple of the knot distance along both axes.
#[derive(Clone, Debug)]
pub struct PatchShears {
    /// By direction, by power of u, by the lowest four bits of the cell's number.
    pub(super) cubics: [[[f32; PATCH_CELLS]; 4]; 4],
}

impl PatchShears {
    pub(super) fn new(shears: &Shears, origin: [i64; 2]) -> Self {
        let [x, y] = origin.map(|v| v >> KNOT_BITS);
        let first = [y, x, x - y, x + y];
        let mut cubics = [[[0.0; PATCH_CELLS]; 4]; 4];
        for (direction, table) in cubics.iter_mut().enumerate() {
            for relative in (FIRST_CELLS[direction]..).take(PATCH_CELLS) {
                let cubic = shears.cubic(direction, first[direction] + relative);
                for (of_power, coefficient) in table.iter_mut().zip(cubic) {
                    of_power[relative.rem_euclid(PATCH_CELLS as i64) as usize] = coefficient;
                }
            }
        }
        Self { cubics }
    }

    #[inline(always)]
    fn noise(&self, direction: usize, s: i32) -> i32 {
        let cell = (s >> CELL_BITS) as usize % PATCH_CELLS;
        let [a, b, c, d] = &self.cubics[direction];
        evaluate(&[a[cell], b[cell], c[cell], d[cell]], s & PATCH_CELL_MASK)
    }

    /// [`Shears::apply`], relative to the origin.
    #[inline(always)]
    pub(super) fn apply(&self, x: i32, y: i32) -> [i32; 2] {
        let x = x + self.noise(0, y);
        let y = y + self.noise(1, x);
        let rising = self.noise(2, x - y);
        let (x, y) = (x + rising, y + rising);
        let falling = self.noise(3, x + y);
        [x + falling, y - falling]
    }
}

/// The place of a coordinate in its cell.
pub(super) const PATCH_CELL_MASK: i32 = (1 << CELL_BITS) - 1;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn shears(seed: u64) -> Shears {
        Shears::new(Warp::ON, Seed(seed), 0.317).expect("on")
    }

    proptest! {
        #[test]
        fn inverts_exactly(seed: u64, x in -(1i128 << 72)..1 << 72, y in -(1i128 << 72)..1 << 72) {
            let shears = shears(seed);
            let there = shears.apply([x, y]);
            prop_assert_eq!(shears.invert(there), [x, y]);
            let reach = i128::from(shears.reach());
            prop_assert!((there[0] - x).abs() <= reach && (there[1] - y).abs() <= reach);
        }

        #[test]
        fn points_near_a_place_get_the_same_bits(
            seed: u64, x in -(1i128 << 72)..1 << 72, y in -(1i128 << 72)..1 << 72,
            near in proptest::collection::vec([-1i64 << 30..1 << 30, -1i64 << 30..1 << 30], 1..20),
        ) {
            let shears = shears(seed);
            let (mut relative, [left, bottom]) = NearShears::new(&shears, [x, y]);
            for [dx, dy] in near {
                let there = shears.apply([left + i128::from(dx), bottom + i128::from(dy)]);
                let [dx, dy] = relative.apply([dx, dy]).map(i128::from);
                prop_assert_eq!(there, [left + dx, bottom + dy]);
            }
        }

        #[test]
        fn a_patch_gives_the_same_bits(
            seed: u64, column in -(1i64 << 42)..1 << 42, row in -(1i64 << 42)..1 << 42,
            x in -127i32 << FRACTION_BITS..1151 << FRACTION_BITS,
            y in -127i32 << FRACTION_BITS..383 << FRACTION_BITS,
            corner in 0u8..8,
            set_side in prop_oneof![Just(0.317), Just(0.01), 0.01..0.5f64], strength in 0.1..=2.0f64,
        ) {
            // The corners reach the farthest cells.
            let [x, y] = match corner {
                0 => [-127 << FRACTION_BITS, -127 << FRACTION_BITS],
                1 => [(1151 << FRACTION_BITS) - 1, -127 << FRACTION_BITS],
                2 => [-127 << FRACTION_BITS, (383 << FRACTION_BITS) - 1],
                3 => [(1151 << FRACTION_BITS) - 1, (383 << FRACTION_BITS) - 1],
                _ => [x, y],
            };
            let warp = Warp::new(strength).expect("in range");
            let shears = Shears::new(warp, Seed(seed), set_side).expect("on");
            let origin = [column * 1024, row * 256];
            let base = origin.map(|v| i128::from(v) << FRACTION_BITS);
            let there = shears.apply([base[0] + i128::from(x), base[1] + i128::from(y)]);
            let patch = PatchShears::new(&shears, origin).apply(x, y);
            prop_assert_eq!([there[0] - base[0], there[1] - base[1]], patch.map(i128::from));
        }
    }

    #[test]
    fn strengths_are_checked() {
        assert_eq!(Warp::new(1.0), Ok(Warp::ON));
        assert_eq!(Warp::new(0.0), Ok(Warp::OFF));
        for bad in [-0.1, 2.1, f64::NAN, f64::INFINITY] {
            assert!(Warp::new(bad).is_err());
        }
    }
}
