//! The definition of the warp, and its strength.

use core::ops::{Add, Sub};

use super::walk::Walk;
use crate::{
    error::{Error, ErrorKind, number},
    sample::seed::{Seed, split_mix},
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
    ///
    /// ```
    /// use strew_core::{ErrorKind, Warp};
    ///
    /// assert_eq!((Warp::new(0.0)?, Warp::new(1.0)?), (Warp::OFF, Warp::ON));
    /// assert_eq!(Warp::new(-0.1).unwrap_err().kind(), ErrorKind::Warp);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn new(strength: f64) -> Result<Self, Error> {
        if (0.0..=Self::MAX_STRENGTH).contains(&strength) {
            Ok(Self {
                strength: libm::round(strength * 256.0) as u16,
            })
        } else {
            let allowed = alloc::format!("a number from 0 (off) to {}", Self::MAX_STRENGTH);
            Err(Error::new(
                ErrorKind::Warp,
                "warp",
                number(strength),
                allowed,
            ))
        }
    }

    /// The strength, a multiple of 1/256.
    ///
    /// ```
    /// use strew_core::Warp;
    ///
    /// assert_eq!(Warp::ON.strength(), 1.0);
    /// assert_eq!(Warp::new(0.3)?.strength(), 77.0 / 256.0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn strength(self) -> f64 {
        f64::from(self.strength) / 256.0
    }

    /// Whether points stay where the table puts them.
    ///
    /// ```
    /// use strew_core::Warp;
    ///
    /// assert!(Warp::OFF.is_off() && !Warp::ON.is_off());
    /// // Rounding to 1/256 turns a tiny strength off.
    /// assert!(Warp::new(0.001)?.is_off());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn is_off(self) -> bool {
        self.strength == 0
    }
}

/// The distance of the knots of g, in bits of grid units: 2⁷ = 128.
pub(super) const KNOT_BITS: u32 = 7;
/// The distance of the knots, in bits of fixed-point units.
pub(crate) const CELL_BITS: u32 = FRACTION_BITS + KNOT_BITS;
pub(super) const CELL_MASK: i128 = (1 << CELL_BITS) - 1;

/// The steepest slope of the shears along the axes at strength 1. Diagonal ones have half of it: their true
/// slope across is twice that of g, so all four strain alike.
const SLOPE: f64 = 0.06;

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
    pub(crate) fn new(warp: Warp, seed: Seed) -> Option<Self> {
        let walks = directed(warp, seed, f64::from(1 << CELL_BITS))?;
        Some(Self { walks })
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
        self.walks.map(|walk| walk.amplitude())
    }

    /// The steepest slope of each shear's g.
    pub(super) fn slopes(&self) -> [f64; 4] {
        let unit = f64::from(1 << CELL_BITS);
        self.walks.map(|walk| f64::from(walk.step()) / unit)
    }

    /// The control values of successive knots of a direction, from `first` on.
    pub(super) fn controls(&self, direction: usize, first: i64, out: &mut [i32]) {
        self.walks[direction].controls(first, out);
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

/// The walks of a seed's four directions for knots at a distance in fixed-point units, or `None` if the warp
/// is off.
pub(super) fn directed(warp: Warp, seed: Seed, knot: f64) -> Option<[Walk; 4]> {
    if warp.is_off() {
        return None;
    }
    let step = SLOPE * warp.strength() * knot;
    let steps = [step, step, step / 2.0, step / 2.0].map(|step| libm::round(step) as i32);
    let first = split_mix(seed.0 ^ 0x5745_4156_4552_5321);
    Some(core::array::from_fn(|i| {
        let key = split_mix(first.wrapping_add((i as u64 + 1) << 56));
        Walk::new(key, steps[i])
    }))
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
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn inverts_exactly(seed: u64, x in -(1i128 << 72)..1 << 72, y in -(1i128 << 72)..1 << 72) {
            let shears = Shears::new(Warp::ON, Seed(seed)).expect("on");
            let there = shears.apply([x, y]);
            prop_assert_eq!(shears.invert(there), [x, y]);
            let reach = i128::from(shears.reach());
            prop_assert!((there[0] - x).abs() <= reach && (there[1] - y).abs() <= reach);
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
