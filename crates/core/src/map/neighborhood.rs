//! The neighborhood map: the intervals of index space with equal surroundings, and the numbers of coordinates of a range
//! in each interval, all at once.
//!
//! # The number in one interval
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
//! a sum over a range of any length takes O(log) steps (`pattern::rotation`).
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

use alloc::{vec, vec::Vec};
use core::ops::Range;

use super::{
    Size, Twin,
    cell::{self, Cell, Label},
    size::check_radius,
    twin::MAX_Q,
};
use crate::{
    error::Error,
    pattern::{Alpha, Turns},
    sort,
};

/// The intervals of [0, t) for one α and one half-width R. Both axes share them.
///
/// ```
/// use strew_core::Map;
///
/// let map = Map::new("(5-sqrt(3))/2".parse()?, 49)?;
/// assert_eq!(map.intervals(), 63);
/// // Maps are hierarchical: a wider one refines a narrower one.
/// let (finer, parents) = map.refine(100)?;
/// assert_eq!((finer.intervals(), parents.len()), (129, 129));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Map {
    alpha: Alpha,
    radius: u32,
    /// The start of each interval, ascending from 0, and t after the last.
    bounds: Vec<u64>,
    /// The neighbor shift of each bound.
    labels: Vec<Label>,
    /// For each bucket of 2^`shift` units the interval of its first unit, where a lookup starts.
    buckets: Vec<u32>,
    shift: u32,
}

impl Map {
    /// The map of half-width `radius`, in grid units.
    ///
    /// # Errors
    /// [`ErrorKind::MapSize`](crate::ErrorKind::MapSize) if `radius` is greater than [`MAX_RADIUS`](super::MAX_RADIUS).
    pub fn new(alpha: Alpha, radius: u32) -> Result<Self, Error> {
        check_radius(radius)?;
        let side = alpha.set_side();
        let mut labeled: Vec<_> = cell::labels(radius)
            .map(|label| (label.index(alpha), label))
            .filter(|&(index, _)| index < side)
            .chain([(0, Label::ZERO), (side, Label::SET_SIDE)])
            .enumerate()
            .collect();
        // Of equal ones the first stays.
        sort::by_key(&mut labeled, |&(i, (index, _))| (index, i));
        labeled.dedup_by_key(|&mut (_, (index, _))| index);
        let labeled = labeled.into_iter().map(|(_, labeled)| labeled);
        let (bounds, labels): (Vec<u64>, Vec<Label>) = labeled.unzip();
        let (buckets, shift) = buckets(&bounds);
        Ok(Self {
            alpha,
            radius,
            bounds,
            labels,
            buckets,
            shift,
        })
    }

    /// The α of the pattern.
    #[must_use]
    pub const fn alpha(&self) -> Alpha {
        self.alpha
    }

    /// The half-width as a named size.
    #[must_use]
    pub const fn size(&self) -> Size {
        Size::of_radius(self.radius)
    }

    /// The half-width R, in grid units.
    #[must_use]
    pub const fn radius(&self) -> u32 {
        self.radius
    }

    /// n, the number of intervals per axis.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.bounds.len() - 1
    }

    /// The n − 1 thresholds inside (0, t), ascending, in units of 2⁻⁶⁴.
    #[must_use]
    pub fn thresholds(&self) -> &[u64] {
        &self.bounds[1..self.bounds.len() - 1]
    }

    /// Interval number `i`, in units of 2⁻⁶⁴, or an empty range past the last.
    #[must_use]
    pub fn interval(&self, i: usize) -> Range<u64> {
        match self.bounds.get(i..i + 2) {
            Some(ends) => ends[0]..ends[1],
            None => 0..0,
        }
    }

    /// The neighbor shifts of the n + 1 bounds.
    pub(crate) fn labels(&self) -> &[Label] {
        &self.labels
    }

    /// The interval that holds an index, or `None` outside the set region [0, t).
    #[must_use]
    pub fn interval_of(&self, index: u64) -> Option<usize> {
        (index < self.alpha.set_side()).then(|| self.locate(index))
    }

    /// The interval that holds an index below t; the last one for any other index.
    pub(crate) fn locate(&self, index: u64) -> usize {
        let bucket = ((index >> self.shift) as usize).min(self.buckets.len() - 1);
        let mut i = self.buckets[bucket] as usize;
        while i + 2 < self.bounds.len() && self.bounds[i + 1] <= index {
            i += 1;
        }
        i
    }

    /// The map of a larger half-width and, for each of its intervals, the interval of this map that
    /// contains it. A `radius` below this map's own refines nothing; the own one is used instead.
    ///
    /// # Errors
    /// [`ErrorKind::MapSize`](crate::ErrorKind::MapSize) if `radius` is greater than [`MAX_RADIUS`](super::MAX_RADIUS).
    pub fn refine(&self, radius: u32) -> Result<(Self, Vec<usize>), Error> {
        let finer = Self::new(self.alpha, radius.max(self.radius))?;
        let parents = finer.bounds[..finer.intervals()]
            .iter()
            .map(|&start| self.locate(start))
            .collect();
        Ok((finer, parents))
    }

    /// The periodic twins of this map, smallest first: the fractions α' = p/q whose thresholds have
    /// the same order, so that a table optimized on one is valid for α. The list ends at q = 2²⁴. It is
    /// empty for an α at which thresholds coincide.
    ///
    /// The order of the thresholds holds on an open interval of α whose ends are ratios of small
    /// integers. The twins are the fractions inside it.
    pub fn twins(&self) -> impl Iterator<Item = Twin> + use<> {
        self.twins_within(1..MAX_Q)
    }

    /// The twins with p − q in a range.
    pub(crate) fn twins_within(&self, t: Range<u64>) -> impl Iterator<Item = Twin> + use<> {
        let cell = Cell::new(self.alpha, self.radius);
        (t.start.max(1)..t.end.min(MAX_Q)).flat_map(move |t| {
            cell.denominators(t)
                .filter_map(move |q| Twin::new(t + q, q))
        })
    }

    /// Whether p/q is a periodic twin of this map (see [`twins`](Self::twins)).
    #[must_use]
    pub fn has_twin(&self, twin: Twin) -> bool {
        Cell::new(self.alpha, self.radius).contains(twin.p(), twin.q())
    }
}

/// A start for the lookup of every index: some sixteen buckets per interval.
fn buckets(bounds: &[u64]) -> (Vec<u32>, u32) {
    let side = bounds[bounds.len() - 1];
    let wanted = (16 * bounds.len()).next_power_of_two().trailing_zeros();
    let shift = (64 - side.leading_zeros()).saturating_sub(wanted);
    let mut buckets = vec![0u32; (side.saturating_sub(1) >> shift) as usize + 1];
    let mut interval = 0;
    for (bucket, slot) in buckets.iter_mut().enumerate() {
        let first = (bucket as u64) << shift;
        while interval + 2 < bounds.len() && bounds[interval + 1] <= first {
            interval += 1;
        }
        *slot = interval as u32;
    }
    (buckets, shift)
}

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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn map(alpha: &str, radius: u32) -> Map {
        Map::new(alpha.parse().expect("valid"), radius).expect("small")
    }

    #[test]
    fn thresholds_are_the_published_ones() {
        // t/r = √3 as 191861/110771: α = 1 + t/(t + r). Source: the paper's list of 63 intervals.
        let (t, r) = (191_861u64, 110_771u64);
        let alpha = Alpha::from_fraction(2 * t + r, t + r).expect("valid");
        let map = Map::new(alpha, 49).expect("small");
        assert_eq!(map.intervals(), 63);
        let scale = t as f64 / alpha.set_side() as f64;
        let published = [2131.0, 5822.0, 7953.0, 13775.0];
        for (found, expected) in map.thresholds().iter().zip(published) {
            assert!((*found as f64 * scale - expected).abs() < 1e-3);
        }
    }

    proptest! {
        #[test]
        fn lookup_agrees_with_search(index: u64, radius in 0u32..120) {
            let map = map("(1+sqrt(5))/2", radius);
            let brute = (0..map.intervals()).find(|&i| map.interval(i).contains(&index));
            prop_assert_eq!(map.interval_of(index), brute);
            let inside = index % map.alpha().set_side();
            let i = map.interval_of(inside).expect("inside");
            prop_assert!(map.interval(i).contains(&inside));
        }

        #[test]
        fn refinement_splits_intervals(small in 0u32..60, more in 0u32..60) {
            let coarse = map("sqrt(3)", small);
            let (fine, parents) = coarse.refine(small + more).expect("small");
            prop_assert_eq!(parents.len(), fine.intervals());
            for (i, &parent) in parents.iter().enumerate() {
                let (inner, outer) = (fine.interval(i), coarse.interval(parent));
                prop_assert!(outer.start <= inner.start && inner.end <= outer.end);
            }
        }
    }
}
