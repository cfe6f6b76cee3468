//! Tallies: how many columns or rows of a stretch belong to each class and block, all at once.
//!
//! Short stretches are listed. For others, the number of coordinates whose index lies between two
//! thresholds is a difference of sums of whole turns, and as thresholds are neighbor shifts, those
//! sums differ from a few only at the ends of the stretch: see [`Turns`].

use alloc::vec::Vec;
use core::ops::Range;

use super::{Frame, Sampler, count::listed};
use crate::pattern::{Axis, Class, Turns};

/// Counts by class (in the order of [`Class::ordinal`]) and block.
pub(super) type Tally = [Vec<u64>; 4];

/// Listing as many coordinates as this times the intervals takes as long as adding up.
const WORTH: usize = 8;

pub(super) fn tally(sampler: &Sampler, frame: &Frame, axis: Axis, range: &Range<i64>) -> Tally {
    let intervals = sampler.map().intervals();
    if range.end - range.start < (WORTH * intervals) as i64 {
        by_listing(sampler, frame, axis, range)
    } else {
        by_turns(sampler, frame, axis, range)
    }
}

fn by_listing(sampler: &Sampler, frame: &Frame, axis: Axis, range: &Range<i64>) -> Tally {
    Class::ALL.map(|class| {
        let mut counts = alloc::vec![0; sampler.map().intervals()];
        let ranges = [range.clone(), range.end..range.end];
        for (_, block) in listed(sampler, frame, axis, class, ranges) {
            counts[block as usize] += 1;
        }
        counts
    })
}

fn by_turns(sampler: &Sampler, frame: &Frame, axis: Axis, range: &Range<i64>) -> Tally {
    let (map, pattern) = (sampler.map(), &frame.pattern);
    let alpha = pattern.alpha();
    let reach = i64::from(map.radius()) + 1;
    let turns = Turns::new(pattern, axis, range, -reach..reach);
    let ends = map.labels().iter().map(|label| (label, label.turns(alpha)));
    let ends: Vec<_> = ends.collect();
    Class::ALL.map(|class| {
        let (own, other) = match axis {
            Axis::X => (class.x, class.y),
            Axis::Y => (class.y, class.x),
        };
        let first = range.start + ((range.start ^ i64::from(own)) & 1);
        let candidates = ((range.end - first).max(0) as u64).div_ceil(2);
        // Σ ⌊index − threshold⌋ over the class's coordinates: a threshold turns the index by k
        // coordinates and b halves.
        let below = |i: usize| {
            let (label, turned) = ends[i];
            let halves = other + label.b;
            let whole = i64::from(halves / 2) - turned;
            let sum = turns.sum(label.k, halves, own);
            sum.wrapping_add(candidates.wrapping_mul(whole as u64))
        };
        let window = pattern.window(other);
        let mut start = below(0);
        let count = |i: usize| {
            let end = below(i + 1);
            let all = core::mem::replace(&mut start, end).wrapping_sub(end);
            let interval = map.interval(i);
            if window.start <= interval.start && interval.end <= window.end {
                all
            } else {
                // A thinned pattern ends within the block, or before it.
                pattern
                    .axis_subset(axis, class, interval)
                    .count(range.clone())
            }
        };
        (0..map.intervals()).map(count).collect()
    })
}

#[cfg(test)]
mod tests {
    use alloc::sync::Arc;

    use proptest::prelude::*;

    use super::*;
    use crate::{Placement, Seed, Spacing, Table, sample::Keep};

    proptest! {
        #[test]
        fn turns_agree_with_listing(
            alpha in prop_oneof![Just("(5-sqrt(3))/2"), Just("sqrt(2)"), Just("3/2"), Just("1.07")],
            radius in 0u32..60, seed: u64, share in prop_oneof![0.01..1.0f64, Just(1.0)],
            start in prop_oneof![-3000i64..3000, -(1i64 << 52)..1 << 52], length in 0i64..2500,
        ) {
            let table = Table::undisplaced(alpha.parse().expect("valid"), radius, "test");
            let sampler = Arc::new(Sampler::new(table.expect("small")));
            let placement = Placement::new(Spacing::new(1.0).expect("valid"), Seed(seed))
                .with_keep(Keep::new(share).expect("in range"));
            let frame = Frame::new(&sampler, placement);
            let range = start..start + length;
            for axis in [Axis::X, Axis::Y] {
                let expected = by_listing(&sampler, &frame, axis, &range);
                prop_assert_eq!(by_turns(&sampler, &frame, axis, &range), expected);
            }
        }

        #[test]
        fn tallies_of_long_stretches_add_up(
            seed: u64, start in -(1i64 << 52)..1 << 52, length in 0i64..1 << 52, cut in 0.0..1.0f64,
        ) {
            let alpha = "(5-sqrt(3))/2".parse().expect("valid");
            let sampler = Arc::new(Sampler::new(Table::undisplaced(alpha, 49, "test").expect("small")));
            let placement = Placement::new(Spacing::new(1.0).expect("valid"), Seed(seed));
            let frame = Frame::new(&sampler, placement);
            let middle = start + (length as f64 * cut) as i64;
            let of = |range| by_turns(&sampler, &frame, Axis::Y, &range);
            let (whole, a, b) = (of(start..start + length), of(start..middle), of(middle..start + length));
            for class in 0..4 {
                for i in 0..whole[class].len() {
                    prop_assert_eq!(whole[class][i], a[class][i] + b[class][i]);
                }
            }
            let set = frame.pattern.axis_set(Axis::Y, Class::ALL[2]);
            prop_assert_eq!(whole[2].iter().sum::<u64>(), set.count(start..start + length));
        }
    }
}
