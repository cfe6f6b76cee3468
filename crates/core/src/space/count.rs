//! Counting points, and finding their places by their numbers.

use alloc::{boxed::Box, sync::Arc, vec, vec::Vec};
use core::ops::Range;

use super::{
    Batch, Volume,
    clearance::{AnyWalk, sift},
    closed,
    columns::{COLUMN_BITS, columns},
    mask::Other,
    scope::{Scope, State},
    walk::{Walk, few},
};
use crate::{near::clear::Clear, settle::Pieces, table::FRACTION_BITS};

/// The number of points of a scope at places of a box of the lattice. It is meaningless once the scope's flag is raised.
pub(super) fn count(scope: &Arc<Scope>, ranges: &[Range<i64>; 3]) -> u128 {
    let ranges = scope.clip(ranges);
    if ranges.iter().any(Range::is_empty) {
        return 0;
    }
    if scope.is_closed() {
        return closed::count(scope, &ranges) - scope.missing(&ranges);
    }
    let mut leaves = match Pieces::new(scope) {
        Some(pieces) => Leaves::Settled(Box::new(pieces)),
        None => Leaves::Still(scope.clearance()),
    };
    divide(scope, &mut leaves, ranges, scope.volume.as_ref())
}

/// The ways to count point by point.
enum Leaves {
    Still(Clear<Other, 3>),
    Settled(Box<Pieces<Scope, 3>>),
}

/// Counts by halves, until all points of a part lie inside or outside, or they are few.
fn divide(
    scope: &Arc<Scope>,
    leaves: &mut Leaves,
    ranges: [Range<i64>; 3],
    volume: Option<&Volume>,
) -> u128 {
    if scope.stop.is_raised() {
        return 0;
    }
    let near = match scope.state(&ranges, volume) {
        State::Out => return 0,
        State::In if scope.clear.is_empty() => {
            return closed::count_all(&scope.lattice, &ranges) - scope.missing(&ranges);
        }
        State::In => None,
        State::Test(near) => near,
    };
    let side = |axis: usize| ranges[axis].end - ranges[axis].start;
    let longest = [1, 2]
        .into_iter()
        .fold(0, |a, b| if side(b) > side(a) { b } else { a });
    let leaf = scope.leaf;
    // A little more than a leaf is not worth two.
    if side(longest) <= leaf + leaf / 2 {
        return leaves.count(scope, &ranges, near.as_ref());
    }
    // Parts that begin at multiples of the side of a leaf.
    let range = &ranges[longest];
    let middle = (range.start + side(longest) / 2) & !(leaf - 1);
    let middle = if middle > range.start {
        middle
    } else {
        range.start + leaf / 2
    };
    let mut halves = [ranges.clone(), ranges.clone()];
    halves[0][longest].end = middle;
    halves[1][longest].start = middle;
    halves
        .map(|half| divide(scope, leaves, half, near.as_ref()))
        .iter()
        .sum()
}

impl Leaves {
    fn count(
        &mut self,
        scope: &Arc<Scope>,
        ranges: &[Range<i64>; 3],
        near: Option<&Volume>,
    ) -> u128 {
        let clear = match self {
            Self::Still(clear) => clear,
            Self::Settled(pieces) => return pieces.count(ranges, near),
        };
        let mut walk = Walk::new(scope.clone(), ranges, None, false);
        let (mut batch, mut count) = (Batch::default(), 0);
        while walk.next(&mut batch) {
            sift(scope, clear, &mut batch);
            count += batch.len() as u128;
        }
        count
    }
}

/// A part of the points, one after another in the order: all of a box of the lattice.
struct Piece<'a> {
    ranges: [Range<i64>; 3],
    /// The axes along which it is cut next, the first one last: columns by x, then by y, then planes.
    cuts: &'static [(usize, u32)],
    /// The number of points before it.
    before: u128,
    /// The numbers that are sought in it.
    numbers: &'a [u128],
}

/// The addresses of points of a scope of some numbers, which ascend; `None` from its end on, and once its flag is raised.
///
/// Parts that have none of them are counted, halves of halves. What is left is walked once, as soon as that takes no longer
/// than counting on.
pub(super) fn locate_all(scope: &Arc<Scope>, numbers: &[u128]) -> Vec<Option<[i64; 3]>> {
    let mut found = Vec::with_capacity(numbers.len());
    let mut open = vec![Piece {
        ranges: scope.all.clone(),
        cuts: &[(2, 0), (1, COLUMN_BITS), (0, COLUMN_BITS)],
        before: 0,
        numbers,
    }];
    while let Some(Piece {
        ranges,
        cuts,
        before,
        numbers,
    }) = open.pop()
    {
        if numbers.is_empty() || scope.stop.is_raised() {
            continue;
        }
        let Some((&(axis, bits), later)) = cuts
            .split_last()
            .filter(|_| !scope.is_worth_walking(&ranges, numbers.len()))
        else {
            walk_to(scope, &ranges, before, numbers, &mut found);
            continue;
        };
        let parts = match bits {
            0 => ranges[axis].clone(),
            _ => columns(&ranges[axis]),
        };
        if parts.end - parts.start <= 1 {
            open.push(Piece {
                ranges,
                cuts: later,
                before,
                numbers,
            });
            continue;
        }
        let middle = (parts.start + (parts.end - parts.start) / 2) << bits;
        let [mut lower, mut upper] = [ranges.clone(), ranges];
        lower[axis].end = middle;
        upper[axis].start = middle;
        let end = before + count(scope, &lower);
        let (below, above) = numbers.split_at(numbers.partition_point(|&k| k < end));
        for (ranges, before, numbers) in [(upper, end, above), (lower, before, below)] {
            open.push(Piece {
                ranges,
                cuts,
                before,
                numbers,
            });
        }
    }
    found.resize(numbers.len(), None);
    found
}

/// Walks over a part of the points until those of some numbers are found.
fn walk_to(
    scope: &Arc<Scope>,
    ranges: &[Range<i64>; 3],
    before: u128,
    numbers: &[u128],
    found: &mut Vec<Option<[i64; 3]>>,
) {
    let mut walk = AnyWalk::new(scope.clone(), ranges, None, true);
    let (mut batch, mut start) = (Batch::default(), before);
    let mut numbers = numbers.iter().peekable();
    while numbers.peek().is_some() && walk.next(&mut batch) {
        let end = start + batch.len() as u128;
        while let Some(&&k) = numbers.peek().filter(|&&&k| k < end) {
            found.push(batch.address((k - start) as usize));
            numbers.next();
        }
        start = end;
    }
    // There are no more points.
    found.extend(numbers.map(|_| None));
}

/// All points of a scope of few, relative to one origin.
pub(super) fn keep(scope: &Arc<Scope>) -> Batch {
    if let Some(few) = few(scope) {
        return few;
    }
    let mut walk = AnyWalk::new(scope.clone(), &scope.all, None, true);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        space::{PointId, Region, SpaceSet, Table, mask::Mask},
        stop::Stop,
    };

    /// Parts of a set that settles, all of which lies inside, are counted by their addresses.
    #[test]
    fn parts_inside_have_the_points_of_their_walk() {
        let alpha = "sqrt(3)".parse().expect("valid");
        let table = Table::undisplaced(alpha, 5, "pattern").expect("small");
        let set = SpaceSet::new(table).seed(7).keep(0.3).expect("a share");
        let region = Region::new([-20.0; 3], [20.0; 3]).expect("a box");
        let all = set.within(region).expect("near").to_vec();
        let felled: Vec<PointId> = all.iter().map(|point| point.id).step_by(5).collect();
        let set = set.lod(0.8).expect("a part").without(felled);
        let volume = Volume::Region(region);
        let scope = Scope::new(&set.lattice, &Mask::default(), &volume, Stop::default());
        let scope = Arc::new(scope.expect("near"));
        let inner = [-20..21, -9..30, -25..7];
        assert!(matches!(scope.state(&inner, None), State::In));
        let mut walk = AnyWalk::new(scope.clone(), &inner, None, false);
        let (mut batch, mut walked) = (Batch::default(), 0);
        while walk.next(&mut batch) {
            walked += batch.len() as u128;
        }
        assert!(walked > 100);
        assert_eq!(count(&scope, &inner), walked);
    }
}
