//! Finding a point by its number.
//!
//! Points are ordered by band, row and column, and the number of points before a band or a row is a count
//! of a part of the lattice. These counts grow almost linearly, so a search that interpolates needs a few
//! of them, whatever the size: O(log) in all where counting is closed, O(rows) elsewhere.

use alloc::{sync::Arc, vec, vec::Vec};
use core::ops::Range;

use crate::{
    kernel::Points,
    lattice::{BAND_WIDTH, Point, PointId},
    walk::{Blocks, Tile, count::count, scope::Scope},
};

/// The lattice addresses of points of some numbers, which ascend, in a scope that has `total` points; `None` for those
/// beyond. Where counting takes time in proportion to the rows,
/// many take little more than one.
pub(crate) fn locate_all(
    scope: &Arc<Scope>,
    total: u128,
    numbers: &[u128],
) -> Vec<Option<PointId>> {
    let inside = &numbers[..numbers.partition_point(|&k| k < total)];
    let rows = &scope.y.all;
    let in_bands = places(scope.bands(), total, inside, &mut |bands| {
        let columns = bands.start * BAND_WIDTH..bands.end * BAND_WIDTH;
        count(scope, &columns, rows)
    });
    let mut found = Vec::with_capacity(numbers.len());
    while let Some(&(band, before)) = in_bands.get(found.len()) {
        let rest = &in_bands[found.len()..];
        let same = rest.partition_point(|(other, _)| *other == band);
        let own = inside[found.len()..][..same].iter();
        let own: Vec<u128> = own.map(|k| k.saturating_sub(before)).collect();
        let columns = band * BAND_WIDTH..(band + 1) * BAND_WIDTH;
        let within = count(scope, &columns, rows);
        let in_rows = places(rows.clone(), within, &own, &mut |rows| {
            count(scope, &columns, &rows)
        });
        for (k, (row, before)) in own.iter().zip(in_rows) {
            let mut blocks = Blocks::<Points>::of_tile(scope.clone(), &Tile::row(band, row));
            let mut points = vec![Point::default(); BAND_WIDTH as usize];
            let filled = blocks.fill(&mut points);
            let at = usize::try_from(k.saturating_sub(before)).unwrap_or(usize::MAX);
            found.push(points[..filled].get(at).map(|point| point.id));
        }
    }
    found.resize(numbers.len(), None);
    found
}

/// For each number `k`, which ascend, the last place in `range` before which at most `k` points lie, and their
/// number. `count` counts the points of a part of the range, which has `total`.
fn places(
    range: Range<i64>,
    total: u128,
    numbers: &[u128],
    count: &mut impl FnMut(Range<i64>) -> u128,
) -> Vec<(i64, u128)> {
    let mut found = Vec::with_capacity(numbers.len());
    // Parts whose numbers are not found yet, the first one last: where they lie, the points before and within.
    let mut open = vec![(range, 0, total, numbers)];
    while let Some((range, before, total, numbers)) = open.pop() {
        match numbers {
            [] => {}
            _ if range.end - range.start <= 1 => {
                found.extend(numbers.iter().map(|_| (range.start, before)));
            }
            &[k] => {
                let start = range.start;
                let k = k.saturating_sub(before);
                let (place, more) = search(range, total, k, |at| count(start..at));
                found.push((place, before + more));
            }
            _ => {
                let middle = range.start + (range.end - range.start) / 2;
                let lower = count(range.start..middle);
                let (below, above) =
                    numbers.split_at(numbers.partition_point(|&k| k < before + lower));
                let upper = total.saturating_sub(lower);
                open.push((middle..range.end, before + lower, upper, above));
                open.push((range.start..middle, before, lower, below));
            }
        }
    }
    found
}

/// The last place in `range` before which at most `k` points lie, and their number. `before` grows from 0
/// at the start of the range to `total`, more than `k`, at its end.
fn search(
    range: Range<i64>,
    total: u128,
    k: u128,
    mut before: impl FnMut(i64) -> u128,
) -> (i64, u128) {
    let (mut low, mut high) = ((range.start, 0), (range.end, total));
    while high.0 - low.0 > 1 {
        // Counts that were stopped may fall.
        let share = k.saturating_sub(low.1) as f64 / high.1.saturating_sub(low.1) as f64;
        let guess = low
            .0
            .saturating_add((share * (high.0 - low.0) as f64) as i64);
        let mut probe = guess.clamp(low.0 + 1, high.0 - 1);
        let mut stride = 1;
        // From a good guess the other end is near: stride toward it, farther each time.
        let mut went_up = None;
        loop {
            let count = before(probe);
            let up = count <= k;
            if up {
                low = (probe, count);
            } else {
                high = (probe, count);
            }
            if high.0 - low.0 <= 1 || went_up.is_some_and(|went| went != up) {
                break;
            }
            went_up = Some(up);
            let next = if up { low.0 + stride } else { high.0 - stride };
            if next <= low.0 || next >= high.0 {
                break;
            }
            probe = next;
            stride *= 8;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn searches_find_places_whatever_the_counts(
            steps in prop::collection::vec(0u128..5, 1..200), start in -1000i64..1000,
            parts in prop::collection::vec(0.0..1.0f64, 0..40),
        ) {
            let sum = |range: Range<i64>| {
                let [from, to] = [range.start, range.end].map(|at| (at - start) as usize);
                steps[from..to].iter().sum::<u128>()
            };
            let range = start..start + steps.len() as i64;
            let total = sum(range.clone());
            prop_assume!(total > 0);
            let number = |part: &f64| ((total as f64 * part) as u128).min(total - 1);
            let mut numbers: Vec<u128> = parts.iter().map(number).collect();
            numbers.sort_unstable();
            let found = places(range.clone(), total, &numbers, &mut |part| sum(part));
            prop_assert_eq!(found.len(), numbers.len());
            for (&k, &(place, count)) in numbers.iter().zip(&found) {
                prop_assert_eq!(count, sum(start..place));
                prop_assert!(count <= k && k < sum(start..place + 1));
                prop_assert_eq!(search(range.clone(), total, k, |at| sum(start..at)), (place, count));
            }
        }
    }

    #[test]
    fn many_places_take_little_more_than_one() {
        let rows = 1 << 20;
        let mut looked = 0;
        let mut count = |part: Range<i64>| {
            looked += part.end - part.start;
            3 * (part.end - part.start) as u128
        };
        let numbers: Vec<u128> = (0..1000).map(|i| i * 3 * (1 << 10)).collect();
        assert_eq!(places(0..rows, 3 << 20, &numbers, &mut count).len(), 1000);
        assert!(looked < 12 * rows, "{looked}");
    }

    #[test]
    fn a_search_needs_few_counts() {
        let mut looked = 0;
        let (place, _) = search(0..1 << 50, 3u128 << 50, 1u128 << 51, |at| {
            looked += 1;
            3 * at as u128 + u128::from(at % 7 == 3)
        });
        assert_eq!(place, ((1i64 << 51) / 3));
        assert!(looked < 20, "{looked}");
    }
}
