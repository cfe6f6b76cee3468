//! The definition of the warp, and its strength.
//!
//! Knots are 32 grid units apart, some ten mean spacings: far enough for neighborhoods to keep their shape, and near
//! enough that a place of the pattern which returns some hundred spacings away does not look alike there. Long waves
//! of a low amplitude add little to that. They matter to a profile with much power at low frequencies, whose peaks
//! only large movements blur: `pink` has a second walk in each direction, with knots four times as far apart.
//! A quadratic spline is one of closer knots, too, so the two walks make one spline, and everything behind the control
//! values is the same for both.

use core::ops::{Add, Sub};

use super::walk::Walk;
use crate::{
    error::{Error, ErrorKind, number},
    lattice::seed::{Seed, split_mix},
    table::FRACTION_BITS,
};

/// The strength of the warp: 0 is none, 1 the measured default.
///
/// ```
/// use strew_core::Warp;
///
/// assert_eq!(Warp::new(0.5)?.strength(), 0.5);
/// assert!(Warp::new(2.5).is_err());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Warp {
    /// In units of 1/256.
    strength: u16,
}

impl Warp {
    /// No warp.
    pub const OFF: Self = Self { strength: 0 };
    /// The default strength: the best trade between isotropy and distances.
    pub const ON: Self = Self { strength: 256 };
    /// The greatest strength.
    pub const MAX_STRENGTH: f64 = 2.0;

    /// A warp of a strength, rounded to 1/256.
    ///
    /// # Errors
    /// [`ErrorKind::Warp`] outside 0 to [`MAX_STRENGTH`](Self::MAX_STRENGTH) and for NaN.
    pub fn new(strength: f64) -> Result<Self, Error> {
        if (0.0..=Self::MAX_STRENGTH).contains(&strength) {
            Ok(Self {
                strength: libm::round(strength * 256.0) as u16,
            })
        } else {
            let allowed = alloc::format!("a number from 0 (off) to {}", number(Self::MAX_STRENGTH));
            Err(Error::new(
                ErrorKind::Warp,
                "warp",
                number(strength),
                allowed,
            ))
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

/// The distance of the knots of g, in bits of grid units: 2⁵ = 32.
pub(crate) const KNOT_BITS: u32 = 5;
/// The distance of the knots, in bits of fixed-point units.
pub(crate) const CELL_BITS: u32 = FRACTION_BITS + KNOT_BITS;
pub(super) const CELL_MASK: i128 = (1 << CELL_BITS) - 1;

/// The steepest slope of the shears along the axes at strength 1. Diagonal ones have half of it: their true
/// slope across is twice that of g, so all four strain alike.
const SLOPE: f64 = 0.09;
/// The slope of long waves, which adds to that.
const LONG_SLOPE: f64 = 0.06;
/// The number of knots to one of long waves, in bits: 2² = 4.
pub(super) const LONG_BITS: u32 = 2;

/// The waves that the warp of a table has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Waves {
    /// Short ones.
    Short,
    /// Short and long ones.
    All,
}

impl Waves {
    /// The waves for a noise profile.
    pub(crate) fn of(profile: &str) -> Self {
        match profile {
            "pink" => Self::All,
            _ => Self::Short,
        }
    }
}

/// A direction of shear. Points move by g(s), where s is the coordinate across.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    /// y += g(x).
    Y,
    /// x += g(y).
    X,
    /// (x, y) += (g, g), g of x − y.
    Rising,
    /// (x, y) += (g, −g), g of x + y.
    Falling,
}

/// The directions, in the order of their application. The first depends on the column alone, so rows that
/// share their columns share it.
const DIRECTIONS: [Direction; 4] = [
    Direction::Y,
    Direction::X,
    Direction::Rising,
    Direction::Falling,
];

/// The warp of one seed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shears {
    walks: [Walk; 4],
    /// The walks of long waves, if there are such.
    long: Option<[Walk; 4]>,
}

/// The quadratic of one cell of one direction, constant term first; in fixed-point units, also of its
/// argument.
pub(super) type Quadratic = [f32; 3];

/// The coordinates across each direction, in their order.
#[inline(always)]
pub(super) fn across<T: Copy + Add<Output = T> + Sub<Output = T>>([x, y]: [T; 2]) -> [T; 4] {
    [x, y, x - y, x + y]
}

impl Shears {
    /// The shears of a seed, or `None` if the warp is off.
    pub(crate) fn new(waves: Waves, warp: Warp, seed: Seed) -> Option<Self> {
        let knot = f64::from(1 << CELL_BITS);
        let walks = short(warp, seed, knot)?;
        let long = long(waves, warp, seed, knot * f64::from(1 << LONG_BITS));
        Some(Self { walks, long })
    }

    /// The largest movement along x or y, in fixed-point units.
    #[cfg(test)]
    pub(crate) fn reach(&self) -> i32 {
        // A B-spline stays within its control values. The rest is room for rounding.
        let [y, x, rising, falling] = self.amplitudes();
        x.max(y) + rising + falling + 64
    }

    /// A bound of the control values of each shear, in fixed-point units.
    pub(super) fn amplitudes(&self) -> [i32; 4] {
        let amplitudes = self.walks.map(|walk| walk.amplitude());
        match &self.long {
            None => amplitudes,
            // Refined values lie between those that they are made of.
            Some(long) => core::array::from_fn(|i| amplitudes[i] + long[i].amplitude() + 1),
        }
    }

    /// The steepest slope of each shear's g.
    pub(super) fn slopes(&self) -> [f64; 4] {
        let unit = f64::from(1 << CELL_BITS);
        core::array::from_fn(|i| {
            let step = f64::from(self.walks[i].step());
            let long = self.long.map_or(0.0, |long| {
                // Refined values are rounded, each by less than a unit.
                f64::from(long[i].step()) / f64::from(1 << LONG_BITS) + 1.0
            });
            (step + long) / unit
        })
    }

    /// The control values of successive knots of a direction, from `first` on.
    pub(super) fn controls(&self, direction: usize, first: i64, out: &mut [i32]) {
        self.walks[direction].controls(first, out);
        let Some(long) = &self.long else {
            return;
        };
        let parts = 1 << LONG_BITS;
        let (mut number, mut part) = (first >> LONG_BITS, first as usize & (parts - 1));
        let mut rest = out;
        while !rest.is_empty() {
            let mut knots = [0; 3];
            long[direction].controls(number.wrapping_sub(1), &mut knots);
            let (here, after) = rest.split_at_mut((parts - part).min(rest.len()));
            for (part, control) in (part..).zip(here) {
                *control += refined(knots, part, parts);
            }
            (number, part, rest) = (number.wrapping_add(1), 0, after);
        }
    }

    /// The uniform quadratic B-spline of the control values on one cell.
    pub(super) fn quadratic(&self, direction: usize, cell: i64) -> Quadratic {
        let mut controls = [0; 3];
        self.controls(direction, cell.wrapping_sub(1), &mut controls);
        quadratic(controls)
    }

    #[cfg(test)]
    fn noise(&self, direction: usize, s: i128) -> i128 {
        let quadratic = self.quadratic(direction, (s >> CELL_BITS) as i64);
        evaluate(&quadratic, (s & CELL_MASK) as i32).into()
    }

    /// The place to which the warp moves a fixed-point position, without the shortcuts of
    /// [`NearShears`](super::NearShears) and [`PatchShears`](super::PatchShears).
    #[cfg(test)]
    pub(crate) fn apply(&self, position: [i128; 2]) -> [i128; 2] {
        (0..4).fold(position, |p, i| shear(i, p, |s| self.noise(i, s)))
    }

    /// The exact inverse of [`apply`](Self::apply).
    #[cfg(test)]
    pub(crate) fn invert(&self, position: [i128; 2]) -> [i128; 2] {
        (0..4)
            .rev()
            .fold(position, |p, i| shear(i, p, |s| -self.noise(i, s)))
    }
}

impl Shears {
    /// The shears of a plane of space, of which there are three, or `None` if the warp is off.
    pub(crate) fn in_space(warp: Warp, seed: Seed, plane: u64) -> Option<Self> {
        let step = SLOPE * warp.strength() * f64::from(1 << CELL_BITS);
        let seed = Seed(seed.0 ^ SPACE_KEY);
        (!warp.is_off()).then(|| Self {
            walks: directed(step, seed, 4 * plane + 1),
            long: None,
        })
    }
}

impl Shears {
    /// The place to which the warps of three planes of space, one after another, move a fixed-point position.
    ///
    /// Movements are short, so most quadratics are those of the cells where the position is at first: they are made
    /// together.
    #[inline(always)]
    pub(crate) fn apply_in_space(
        planes: &[Self; 3],
        axes: [[usize; 2]; 3],
        mut position: [i64; 3],
    ) -> [i64; 3] {
        let cell = |s: i64| s >> CELL_BITS;
        let mut cells = [0; 12];
        for (cells, [a, b]) in cells.chunks_exact_mut(4).zip(axes) {
            cells.copy_from_slice(&across([position[a], position[b]]).map(cell));
        }
        let walks: [Walk; 12] = core::array::from_fn(|i| planes[i / 4].walks[i % 4]);
        let controls = Walk::three(walks, cells.map(|cell| cell - 1));
        for (plane, [a, b]) in axes.into_iter().enumerate() {
            let [mut x, mut y] = [position[a], position[b]];
            for i in 0..4 {
                let (s, number) = (across([x, y])[i], 4 * plane + i);
                let quadratic = if cell(s) == cells[number] {
                    quadratic(controls[number])
                } else {
                    planes[plane].quadratic(i, cell(s))
                };
                let moved = i64::from(evaluate(&quadratic, (s & CELL_MASK as i64) as i32));
                [x, y] = shear(i, [x, y], |_| moved);
            }
            [position[a], position[b]] = [x, y];
        }
        position
    }
}

/// Tells the walks of space from those of the plane: "SPACE  3".
const SPACE_KEY: u64 = 0x5350_4143_4520_2033;

/// The walks of a seed's four directions for knots at a distance in fixed-point units, or `None` if the warp
/// is off.
pub(super) fn short(warp: Warp, seed: Seed, knot: f64) -> Option<[Walk; 4]> {
    (!warp.is_off()).then(|| directed(SLOPE * warp.strength() * knot, seed, 1))
}

/// The walks of long waves, for their knots, if there are such.
pub(super) fn long(waves: Waves, warp: Warp, seed: Seed, knot: f64) -> Option<[Walk; 4]> {
    (waves == Waves::All && !warp.is_off())
        .then(|| directed(LONG_SLOPE * warp.strength() * knot, seed, 5))
}

/// Walks of a greatest step along the axes, with keys from number `first` on.
fn directed(step: f64, seed: Seed, first: u64) -> [Walk; 4] {
    let steps = [step, step, step / 2.0, step / 2.0].map(|step| libm::round(step) as i32);
    let common = split_mix(seed.0 ^ 0x5745_4156_4552_5321);
    core::array::from_fn(|i| {
        let key = split_mix(common.wrapping_add((i as u64 + first) << 56));
        Walk::new(key, steps[i])
    })
}

/// The control value of part `part` of a cell for a spline whose knots are `parts` times as close, from those of the
/// knots before the cell, at its start and at its end: the blossom of the cell's quadratic at the ends of the part
/// (de Boor, "A Practical Guide to Splines", ch. XI), rounded down.
pub(super) fn refined([before, start, end]: [i32; 3], part: usize, parts: usize) -> i32 {
    let [a, b, c] = [before, start, end].map(i64::from);
    let (i, n) = (part as i64, parts as i64);
    let sum = n * n * (a + b) + n * (2 * i + 1) * (b - a) + i * (i + 1) * (a - 2 * b + c);
    sum.div_euclid(2 * n * n) as i32
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

/// The quadratic of a cell from the control values of the knots before it, at its start and at its end (de
/// Boor, "A Practical Guide to Splines", ch. X). Its slope goes straight from one step to the next.
#[inline(always)]
pub(super) fn quadratic([before, start, end]: [i32; 3]) -> Quadratic {
    const UNIT: f32 = 1.0 / (1u32 << CELL_BITS) as f32;
    // Control values fit 27 bits, so the sums are exact. Powers of two scale without rounding.
    [
        (before + start) as f32 * 0.5,
        (start - before) as f32 * UNIT,
        (before - 2 * start + end) as f32 * (0.5 * UNIT * UNIT),
    ]
}

/// g at the place `at` of a cell, in [0, 2^[`CELL_BITS`]).
#[inline(always)]
pub(super) fn evaluate(quadratic: &Quadratic, at: i32) -> i32 {
    let at = at as f32;
    ((quadratic[2] * at + quadratic[1]) * at + quadratic[0]) as i32
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn inverts_exactly(seed: u64, x in -(1i128 << 72)..1 << 72, y in -(1i128 << 72)..1 << 72) {
            for waves in [Waves::Short, Waves::All] {
                let shears = Shears::new(waves, Warp::ON, Seed(seed)).expect("on");
                let there = shears.apply([x, y]);
                prop_assert_eq!(shears.invert(there), [x, y]);
                let reach = i128::from(shears.reach());
                prop_assert!((there[0] - x).abs() <= reach && (there[1] - y).abs() <= reach);
            }
        }

        #[test]
        fn long_waves_are_the_same_spline_with_closer_knots(seed: u64, s in -(1i128 << 60)..1 << 60) {
            let shears = |waves| Shears::new(waves, Warp::ON, Seed(seed)).expect("on");
            let [only_short, all] = [Waves::Short, Waves::All].map(shears);
            let long = all.long.expect("all waves");
            let knot = f64::from(1 << (CELL_BITS + LONG_BITS));
            let cell = s >> (CELL_BITS + LONG_BITS);
            let at = (s - (cell << (CELL_BITS + LONG_BITS))) as f64 / knot;
            for (direction, long) in long.iter().enumerate() {
                let mut knots = [0; 3];
                long.controls(cell as i64 - 1, &mut knots);
                let [a, b, c] = knots.map(f64::from);
                let expected = (a + b) / 2.0 + ((b - a) + (a - 2.0 * b + c) / 2.0 * at) * at;
                let found = all.noise(direction, s) - only_short.noise(direction, s);
                // Rounding in `f32`: values are below 2²⁶.
                prop_assert!((found as f64 - expected).abs() <= 32.0, "{} {}", found, expected);
            }
        }

        #[test]
        fn controls_are_the_same_from_any_knot(seed: u64, first: i64, length in 0usize..60, skipped in 0usize..60) {
            let shears = Shears::new(Waves::All, Warp::ON, Seed(seed)).expect("on");
            let (mut all, mut part) = (vec![0; skipped + length], vec![0; length]);
            for direction in 0..4 {
                shears.controls(direction, first, &mut all);
                shears.controls(direction, first.wrapping_add(skipped as i64), &mut part);
                prop_assert_eq!(&all[skipped..], &part);
            }
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
