//! Axis sets: the pattern is a union of four Cartesian products, one per pair of parities.
//!
//! dX depends on y only through its parity and dY on x only through its parity. With
//! S_b = {v : A·v + b·2⁶³ + origin < T}, a point (x, y) is in the pattern iff x ∈ S_(y mod 2) and
//! y ∈ S_(x mod 2). An [`AxisSet`] is the part of one S_b with one parity, or any interval of it.

use core::ops::Range;

use super::{
    Alpha,
    rotation::{count_hits, first_hit},
};

/// A lattice axis.
///
/// ```
/// use strew_core::{Pattern, pattern::Axis};
///
/// let pattern = Pattern::new("sqrt(3)".parse()?);
/// let (dx, dy) = pattern.index(3, 8);
/// // Row 8 is even, column 3 odd.
/// assert_eq!(dx, pattern.axis_index(Axis::X, 3, 0));
/// assert_eq!(dy, pattern.axis_index(Axis::Y, 8, 1));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Columns.
    X,
    /// Rows.
    Y,
}

/// A pair of parities: one of the four Cartesian products that make up a pattern.
///
/// ```
/// use strew_core::{Pattern, pattern::{Axis, Class}};
///
/// let pattern = Pattern::new("sqrt(3)".parse()?);
/// for (x, y) in (-9..9).flat_map(|x| (-9..9).map(move |y| (x, y))) {
///     let class = Class::of(x, y);
///     let [columns, rows] = [Axis::X, Axis::Y].map(|axis| pattern.axis_set(axis, class));
///     assert_eq!(pattern.contains(x, y), columns.contains(x) && rows.contains(y));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Class {
    /// The parity of x (0 or 1).
    pub x: u8,
    /// The parity of y (0 or 1).
    pub y: u8,
}

impl Class {
    /// All four, in the order of [`Class::ordinal`].
    pub const ALL: [Self; 4] = [
        Self { x: 0, y: 0 },
        Self { x: 1, y: 0 },
        Self { x: 0, y: 1 },
        Self { x: 1, y: 1 },
    ];

    /// The class of a lattice address.
    #[must_use]
    pub const fn of(x: i64, y: i64) -> Self {
        Self {
            x: (x & 1) as u8,
            y: (y & 1) as u8,
        }
    }

    /// The position in [`Class::ALL`].
    #[must_use]
    pub const fn ordinal(self) -> usize {
        self.x as usize + 2 * self.y as usize
    }
}

/// The lattice coordinates of one parity whose index lies in one interval of the circle.
///
/// ```
/// use strew_core::{Pattern, pattern::{Axis, Class}};
///
/// let pattern = Pattern::new("sqrt(3)".parse()?);
/// let columns = pattern.axis_set(Axis::X, Class { x: 0, y: 0 });
/// let listed: Vec<i64> = columns.iter(0..100).collect();
/// assert_eq!(listed.len() as u64, columns.count(0..100));
/// assert_eq!(columns.select(0, 5), Some(listed[5]));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisSet {
    /// A = α/2, in units of 2⁻⁶⁴.
    half: u64,
    /// Index of coordinate 0, less the interval's start: members have an index below `width`.
    zero: u64,
    width: u64,
    parity: u8,
}

impl AxisSet {
    /// The coordinates v ≡ `parity` (mod 2) with (A·v + `zero`) mod 1 in `interval`. `zero` is the
    /// index of coordinate 0: the origin, plus one half if the other coordinate is odd. `zero` and
    /// `interval` are in units of 2⁻⁶⁴.
    #[must_use]
    pub fn new(alpha: Alpha, zero: u64, parity: u8, interval: Range<u64>) -> Self {
        Self {
            half: alpha.half(),
            zero: zero.wrapping_sub(interval.start),
            width: interval.end.saturating_sub(interval.start),
            parity: parity & 1,
        }
    }

    fn index(&self, v: i64) -> u64 {
        self.half.wrapping_mul(v as u64).wrapping_add(self.zero)
    }

    /// The step of the index between two coordinates of one parity.
    fn step(&self) -> u64 {
        self.half.wrapping_mul(2)
    }

    /// The first coordinate ≥ `from` of this parity, or `None` at the end of `i64`.
    fn align(&self, from: i64) -> Option<i64> {
        if (from & 1) as u8 == self.parity {
            Some(from)
        } else {
            from.checked_add(1)
        }
    }

    /// The number of coordinates of this parity in `range`.
    fn candidates(&self, range: &Range<i64>) -> u64 {
        match self.align(range.start) {
            Some(first) if first < range.end => {
                ((i128::from(range.end) - i128::from(first)) as u128).div_ceil(2) as u64
            }
            _ => 0,
        }
    }

    /// Whether `v` belongs to the set.
    #[must_use]
    pub fn contains(&self, v: i64) -> bool {
        (v & 1) as u8 == self.parity && self.index(v) < self.width
    }

    /// The number of members in `range`: a floor sum, O(log).
    #[must_use]
    pub fn count(&self, range: Range<i64>) -> u64 {
        let candidates = self.candidates(&range);
        match self.align(range.start) {
            Some(first) if candidates > 0 => {
                count_hits(candidates, self.index(first), self.step(), self.width)
            }
            _ => 0,
        }
    }

    /// The first member ≥ `from`, or `None` if there is none within `i64`. O(log).
    #[must_use]
    pub fn first(&self, from: i64) -> Option<i64> {
        let first = self.align(from)?;
        let steps = first_hit(self.index(first), self.step(), self.width)?;
        i64::try_from(i128::from(first) + 2 * i128::from(steps)).ok()
    }

    /// Member number `k` (from 0) among those ≥ `from`, or `None` if `i64` holds fewer. A bisection on
    /// [`count`](Self::count).
    #[must_use]
    pub fn select(&self, from: i64, k: u64) -> Option<i64> {
        let need = k.checked_add(1)?;
        let has = |end: i64| self.count(from..end) >= need;
        // Members are spread evenly, so the search brackets the expected place.
        let expected = (k as f64) * 2.0 * 18_446_744_073_709_551_616.0 / (self.width.max(1) as f64);
        let mut high = from.saturating_add(expected as i64);
        let mut reach = 64i64;
        while !has(high) {
            if high == i64::MAX {
                // `count` excludes its end, so the last coordinate is tested by itself.
                return (self.contains(i64::MAX) && self.count(from..i64::MAX) == k)
                    .then_some(i64::MAX);
            }
            high = high.saturating_add(reach);
            reach = reach.saturating_mul(4);
        }
        let mut low = from;
        let mut reach = 64i64;
        loop {
            let candidate = high.saturating_sub(reach);
            if candidate <= from || !has(candidate) {
                low = low.max(candidate);
                break;
            }
            high = candidate;
            reach = reach.saturating_mul(4);
        }
        // Invariant: has(high), and not has(low).
        while i128::from(high) - i128::from(low) > 1 {
            let middle = ((i128::from(low) + i128::from(high)) / 2) as i64;
            if has(middle) {
                high = middle
            } else {
                low = middle
            }
        }
        Some(high - 1)
    }

    /// The members in `range`, ascending. Each step costs a comparison: a rotation returns to an
    /// interval after one of at most three gaps (the three-gap theorem).
    pub fn iter(&self, range: Range<i64>) -> impl Iterator<Item = i64> + use<> {
        let (set, gaps) = (*self, Gaps::new(self.step(), self.width));
        let mut next = set.first(range.start).filter(|&v| v < range.end);
        core::iter::from_fn(move || {
            let v = next?;
            next = gaps
                .after(set.index(v))
                .and_then(|gap| i64::try_from(i128::from(v) + 2 * i128::from(gap)).ok())
                .filter(|&v| v < range.end);
            Some(v)
        })
    }
}

/// The return times of a rotation to the interval [0, width).
#[derive(Clone, Copy)]
struct Gaps {
    /// The least number of steps that moves the index forward by less than the width, and by how much.
    up: Option<(u64, u64)>,
    /// The least number of steps that moves it backward by less than the width, and by how much.
    down: Option<(u64, u64)>,
    width: u64,
}

impl Gaps {
    fn new(step: u64, width: u64) -> Self {
        let movement = |step: u64| {
            let gap = first_hit(step, step, width)?.checked_add(1)?;
            Some((gap, gap.wrapping_mul(step)))
        };
        Self {
            up: movement(step),
            down: movement(step.wrapping_neg()),
            width,
        }
    }

    /// The number of steps from `index` (< width) to the next return.
    fn after(&self, index: u64) -> Option<u64> {
        match (self.up, self.down) {
            (Some((gap, by)), _) if index < self.width - by => Some(gap),
            (_, Some((gap, by))) if index >= by => Some(gap),
            (Some((up, _)), Some((down, _))) => up.checked_add(down),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    fn any_set() -> impl Strategy<Value = AxisSet> {
        (
            1.001f64..1.999,
            any::<u64>(),
            0u8..2,
            0.0f64..1.0,
            0.0f64..1.0,
        )
            .prop_map(|(alpha, zero, parity, from, to)| {
                let alpha: Alpha = alloc::format!("{alpha:.12}").parse().expect("in range");
                let side = alpha.set_side() as f64;
                let (from, to) = ((from * side) as u64, (to * side) as u64);
                AxisSet::new(alpha, zero, parity, from.min(to)..from.max(to))
            })
    }

    fn anywhere() -> impl Strategy<Value = i64> {
        prop_oneof![
            -5000i64..5000,
            any::<i64>(),
            Just(i64::MAX - 900),
            Just(i64::MIN)
        ]
    }

    proptest! {
        #[test]
        fn iterate_count_and_select_agree_with_membership(
            set in any_set(), from in anywhere(), length in 0i64..3000,
        ) {
            let to = from.saturating_add(length);
            let members: Vec<i64> = (from..to).filter(|&v| set.contains(v)).collect();
            prop_assert_eq!(set.iter(from..to).collect::<Vec<_>>(), members.clone());
            prop_assert_eq!(set.count(from..to), members.len() as u64);
            for (k, &v) in members.iter().enumerate() {
                prop_assert_eq!(set.select(from, k as u64), Some(v));
            }
            prop_assert_eq!(set.first(from).filter(|&v| v < to), members.first().copied());
        }

        #[test]
        fn select_inverts_count_far_out(set in any_set(), from: i64, k in 0u64..1 << 60) {
            if let Some(v) = set.select(from, k) {
                prop_assert!(set.contains(v));
                prop_assert_eq!(set.count(from..v), k);
            }
        }
    }
}
