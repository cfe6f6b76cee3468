//! The cell of a map: the interval of α on which its thresholds keep their order.
//!
//! While no threshold crosses another or an end of the set region, each is a linear function of α,
//! m − (αk + b)/2 with integers m, k, b. Comparing two of them means comparing α with a ratio of
//! integers, and the tightest of these ratios bound the interval.

use core::ops::RangeInclusive;

use super::twin::MAX_Q;
use crate::pattern::Alpha;

/// A neighbor shift −(αk + b)/2: the place in index space where a neighbor appears or disappears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Label {
    pub(crate) k: i64,
    pub(crate) b: u8,
}

/// The shifts of half-width R. Those of e = t are those of e = 0 one step further,
/// t − (αk + b)/2 = −(α(k − 1) + (b + 1))/2, so k runs from −R − 1 to R.
pub(super) fn labels(radius: u32) -> impl Iterator<Item = Label> {
    let r = i64::from(radius);
    (-r - 1..=r).flat_map(|k| [Label { k, b: 0 }, Label { k, b: 1 }])
}

impl Label {
    /// 0 itself.
    pub(super) const ZERO: Self = Self { k: 0, b: 0 };
    /// t = −(1 − α)/2.
    pub(super) const SET_SIDE: Self = Self { k: -1, b: 1 };

    /// The integer m for which m − (αk + b)/2 lies in [0, 1).
    pub(crate) fn turns(self, alpha: Alpha) -> i64 {
        let shift = i128::from(alpha.half()) * i128::from(self.k) + (i128::from(self.b) << 63);
        ((shift + i128::from(self.index(alpha))) >> 64) as i64
    }

    /// The value modulo 1, in units of 2⁻⁶⁴.
    pub(super) fn index(self, alpha: Alpha) -> u64 {
        alpha
            .half()
            .wrapping_mul(self.k as u64)
            .wrapping_add(u64::from(self.b) << 63)
            .wrapping_neg()
    }

    /// The value modulo 1 as a linear function of α, valid near `alpha`.
    fn linear(self, alpha: Alpha) -> Linear {
        Linear {
            constant: 2 * self.turns(alpha) - i64::from(self.b),
            slope: self.k,
        }
    }
}

/// (constant − slope·α)/2.
#[derive(Clone, Copy, Debug)]
struct Linear {
    constant: i64,
    slope: i64,
}

impl Linear {
    const ZERO: Self = Self {
        constant: 0,
        slope: 0,
    };
    const SET_SIDE: Self = Self {
        constant: -1,
        slope: -1,
    };
    const ONE: Self = Self {
        constant: 2,
        slope: 0,
    };
}

/// A ratio of integers with a positive denominator.
#[derive(Clone, Copy, Debug)]
struct Ratio {
    n: i64,
    d: i64,
}

impl Ratio {
    fn less_than(self, n: u64, d: u64) -> bool {
        i128::from(self.n) * i128::from(d) < i128::from(n) * i128::from(self.d)
    }

    fn greater_than(self, n: u64, d: u64) -> bool {
        i128::from(self.n) * i128::from(d) > i128::from(n) * i128::from(self.d)
    }

    fn max(self, other: Self) -> Self {
        if self.is_less(other) { other } else { self }
    }

    fn min(self, other: Self) -> Self {
        if other.is_less(self) { other } else { self }
    }

    fn is_less(self, other: Self) -> bool {
        i128::from(self.n) * i128::from(other.d) < i128::from(other.n) * i128::from(self.d)
    }
}

/// The open interval of α with one map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    low: Ratio,
    high: Ratio,
}

impl Cell {
    pub(super) fn new(alpha: Alpha, radius: u32) -> Self {
        let mut cell = Self {
            low: Ratio { n: 1, d: 1 },
            high: Ratio { n: 2, d: 1 },
        };
        let side = alpha.set_side();
        let mut inside: alloc::vec::Vec<(u64, Linear)> = alloc::vec::Vec::new();
        // Two labels are the ends of the set region. Any further one coincides with an end.
        let mut at_ends = 0;
        for label in labels(radius) {
            let (index, line) = (label.index(alpha), label.linear(alpha));
            if index == 0 || index == side {
                at_ends += 1;
            } else if index > side {
                // It must stay outside the set region.
                cell.keep_less(Linear::SET_SIDE, line);
                cell.keep_less(line, Linear::ONE);
            } else {
                inside.push((index, line));
            }
        }
        inside.sort_unstable_by_key(|&(index, _)| index);
        let mut last = Linear::ZERO;
        for (_, line) in inside {
            cell.keep_less(last, line);
            last = line;
        }
        cell.keep_less(last, Linear::SET_SIDE);
        if at_ends > 2 || !cell.contains(alpha.half(), 1 << 63) {
            // Thresholds coincide at α, so it lies between two cells.
            cell.low = cell.high;
        }
        cell
    }

    /// Narrows the interval to where `left` < `right`.
    fn keep_less(&mut self, left: Linear, right: Linear) {
        // (right − left)·2 = c − s·α > 0.
        let (c, s) = (right.constant - left.constant, right.slope - left.slope);
        if s > 0 {
            self.high = self.high.min(Ratio { n: c, d: s });
        } else if s < 0 {
            self.low = self.low.max(Ratio { n: -c, d: -s });
        }
    }

    /// Whether p/q lies inside.
    pub(super) fn contains(&self, p: u64, q: u64) -> bool {
        self.low.less_than(p, q) && self.high.greater_than(p, q)
    }

    /// The denominators q for which (t + q)/q lies inside.
    pub(super) fn denominators(&self, t: u64) -> impl Iterator<Item = u64> + use<> {
        let cell = *self;
        // 1 + t/q < high  ⇔  q > t·d/(n − d), and likewise for low. One candidate more on either side
        // leaves the exact test in one place.
        let bound = |ratio: Ratio| {
            let excess = i128::from(ratio.n - ratio.d);
            (excess > 0).then(|| (i128::from(t) * i128::from(ratio.d) / excess) as u64)
        };
        #[expect(clippy::reversed_empty_ranges, reason = "an empty range on purpose")]
        let empty: RangeInclusive<u64> = 1..=0;
        let range: RangeInclusive<u64> = match (bound(cell.high), bound(cell.low)) {
            (Some(first), Some(last)) => first.max(1)..=MAX_Q.min(last + 1),
            (Some(first), None) => first.max(1)..=MAX_Q,
            _ => empty,
        };
        range.filter(move |&q| cell.contains(t + q, q))
    }
}
