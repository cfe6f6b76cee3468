//! The numbers of coordinates of a range in each interval of a map, all at once.
//!
//! # One interval
//!
//! A coordinate v has the index I(v) = (α·v + b)/2 + origin on the circle of length 1, where b is the parity of the
//! others. Unrolled on a line, ⌊I − e⌋ is the number of times that I has passed the threshold e, so for two thresholds
//! of one turn
//!
//! ```text
//!     [ e ≤ I mod 1 < f ]  =  ⌊I − e⌋ − ⌊I − f⌋
//!
//!       0    e      f      1    e      f      2
//!     ──┼────┼──────┼──────┼────┼──────┼──────┼──        ⌊I − e⌋ rises at each e, ⌊I − f⌋ at each f;
//!            └──in──┘           └──in──┘                 they differ by 1 between the two.
//! ```
//!
//! and the number of coordinates of a range in an interval is the difference of two sums S(e) = Σ ⌊I(v) − e⌋. Such
//! a sum over a range of any length takes O(log) steps (`floor_sum`).
//!
//! # All intervals
//!
//! There are n intervals, four classes and about a hundred steps in a sum, which is too slow for the small boxes of
//! which a search asks dozens. But a threshold of a map is the shift of a neighbor at an offset of k lines:
//! e = −(α·k + c)/2, up to w whole turns, so
//!
//! ```text
//!     I(v) − e  =  (α·(v + k) + b + c)/2 + origin − w
//! ```
//!
//! is the index of the line v + k. S(e) is the sum for the threshold 0 over the range moved by k, less w for each
//! coordinate. Moving a range by one line takes one term away at its start and adds one at its end. So [`Turns`] makes
//! four sums in closed form (b + c is even or odd, v is even or odd) and moves them along: all of a map with
//! half-width R costs four O(log) sums and 2R + 2 corrections. Each interval is then one subtraction.
//!
//! Sums are taken modulo 2⁶⁴ and may wrap; differences of them are counts, below 2⁵³, and exact.

use alloc::vec::Vec;
use core::ops::Range;

use super::Map;
use crate::pattern::{Alpha, Turns};

/// The numbers of coordinates by the parity of their own, by that of the others, and by interval.
pub(crate) type Numbers = [[Vec<u64>; 2]; 2];

impl Map {
    /// The numbers of coordinates of a range in each interval, for an axis on which the coordinate 0 has the index
    /// `zero` if the others are even.
    pub(crate) fn numbers(&self, zero: u64, range: &Range<i64>) -> Numbers {
        let alpha: Alpha = self.alpha();
        let reach = i64::from(self.radius()) + 1;
        let turns = Turns::new(alpha, zero, range, -reach..reach);
        let ends = self.labels().iter();
        let ends: Vec<_> = ends.map(|label| (label, label.turns(alpha))).collect();
        let numbers = |own: u8, others: u8| {
            let first = range.start + ((range.start ^ i64::from(own)) & 1);
            let candidates = ((range.end - first).max(0) as u64).div_ceil(2);
            // Σ ⌊index − threshold⌋ over the coordinates of the class. Subtracting a threshold adds k
            // coordinates and b halves to the index.
            let below = |i: usize| {
                let (label, turned) = ends[i];
                let halves = others + label.b;
                let whole = i64::from(halves / 2) - turned;
                let sum = turns.sum(label.k, halves, own);
                sum.wrapping_add(candidates.wrapping_mul(whole as u64))
            };
            let mut start = below(0);
            let count = |i: usize| {
                let end = below(i + 1);
                core::mem::replace(&mut start, end).wrapping_sub(end)
            };
            (0..self.intervals()).map(count).collect()
        };
        [0, 1].map(|own| [0, 1].map(|others| numbers(own, others)))
    }
}
