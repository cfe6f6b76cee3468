//! Counting points, and finding the place of one by its number.

use alloc::sync::Arc;
use core::ops::Range;

use super::{
    batch::Batch,
    closed,
    columns::{COLUMN_BITS, columns},
    scope::{Scope, State, common},
    sieve::Sifted,
    volume::Volume,
    walk::few,
};
use crate::table::FRACTION_BITS;

/// Boxes of the lattice up to this side are counted point by point.
const LEAF: i64 = 64;

/// The number of points of a scope at places of a box of the lattice. It is meaningless once the scope's flag is raised.
pub(super) fn count(scope: &Arc<Scope>, ranges: &[Range<i64>; 3]) -> u128 {
    let ranges = scope.clip(ranges);
    if ranges.iter().any(Range::is_empty) {
        return 0;
    }
    if scope.is_closed() {
        return closed::count(scope, &ranges);
    }
    divide(scope, ranges, scope.volume.as_ref())
}

/// Counts by halves, until all points of a part lie inside or outside, or they are few.
fn divide(scope: &Arc<Scope>, ranges: [Range<i64>; 3], volume: Option<&Volume>) -> u128 {
    if scope.stop.is_raised() {
        return 0;
    }
    let near = match scope.state(&ranges, volume) {
        State::Out => return 0,
        State::In if scope.clear.is_empty() => {
            return closed::count_all(&scope.lattice, &ranges);
        }
        State::In => None,
        State::Test(near) => near,
    };
    let side = |axis: usize| ranges[axis].end - ranges[axis].start;
    let longest = [1, 2]
        .into_iter()
        .fold(0, |a, b| if side(b) > side(a) { b } else { a });
    if side(longest) <= LEAF {
        return walked(scope, &ranges);
    }
    // Parts that begin at multiples of the side of a leaf.
    let range = &ranges[longest];
    let middle = (range.start + side(longest) / 2) & !(LEAF - 1);
    let middle = if middle > range.start {
        middle
    } else {
        range.start + LEAF / 2
    };
    let mut halves = [ranges.clone(), ranges.clone()];
    halves[0][longest].end = middle;
    halves[1][longest].start = middle;
    halves
        .map(|half| divide(scope, half, near.as_ref()))
        .iter()
        .sum()
}

/// Counts point by point.
fn walked(scope: &Arc<Scope>, ranges: &[Range<i64>; 3]) -> u128 {
    let mut walk = Sifted::new(scope.clone(), ranges, None, false);
    let (mut batch, mut count) = (Batch::default(), 0);
    while walk.next(&mut batch) {
        count += batch.len() as u128;
    }
    count
}

/// The address of point number `k` of a scope, if there are more than k.
pub(super) fn locate(scope: &Arc<Scope>, k: u128) -> Option<[i64; 3]> {
    let mut ranges = scope.all.clone();
    let mut k = k;
    // Columns by x, then by y, then planes, then rows: each is the first up to whose end there are more than k.
    for (axis, bits) in [(0, COLUMN_BITS), (1, COLUMN_BITS), (2, 0), (1, 0)] {
        if ranges[axis].is_empty() {
            return None;
        }
        let whole = ranges[axis].clone();
        let parts = match bits {
            0 => whole.clone(),
            _ => columns(&whole),
        };
        let up_to = |part: i64| {
            let mut upper = ranges.clone();
            upper[axis].end = whole.end.min(part << bits);
            if upper[axis].is_empty() {
                0
            } else {
                count(scope, &upper)
            }
        };
        // Before the first part none, up to the end of the last one more than k.
        let (mut low, mut high, mut below) = (parts.start, parts.end, 0);
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            let number = up_to(middle);
            if scope.stop.is_raised() {
                return None;
            }
            if number > k {
                high = middle;
            } else {
                (low, below) = (middle, number);
            }
        }
        k -= below;
        let part = low << bits..(low + 1) << bits;
        ranges[axis] = common(&part, &whole);
    }
    let mut walk = Sifted::new(scope.clone(), &ranges, None, true);
    let mut batch = Batch::default();
    while walk.next(&mut batch) {
        let point = usize::try_from(k).ok();
        if let Some(at) = point.and_then(|point| batch.address(point)) {
            return Some(at);
        }
        k -= batch.len() as u128;
    }
    None
}

/// All points of a scope of few, relative to one origin.
pub(super) fn keep(scope: &Arc<Scope>) -> Batch {
    if let Some(few) = few(scope) {
        return few;
    }
    let mut walk = Sifted::new(scope.clone(), &scope.all, None, true);
    let mut kept = Batch::default();
    let mut batch = Batch::default();
    let mut is_first = true;
    while walk.next(&mut batch) {
        if is_first {
            kept.restart(batch.origin);
            is_first = false;
        }
        let offset = [0, 1, 2].map(|axis| (batch.origin[axis] - kept.origin[axis]) as i32);
        for (axis, by) in offset.into_iter().enumerate() {
            let lift = by << FRACTION_BITS;
            kept.places[axis].extend(batch.places[axis].iter().map(|v| v + lift));
        }
        kept.ids.extend(
            batch
                .ids
                .iter()
                .map(|id| [0, 1, 2].map(|axis| id[axis] + offset[axis])),
        );
    }
    kept
}
