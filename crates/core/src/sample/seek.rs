//! Finding a point by its number.
//!
//! Points are ordered by band, row and column, and the number of points before a band or a row is a count
//! of a part of the lattice. These counts grow almost linearly, so a search that interpolates needs a few
//! of them, whatever the size: O(log) in all where counting is closed, O(rows) elsewhere.

use alloc::{sync::Arc, vec};
use core::ops::Range;

use super::{
    count::count,
    kernel::Points,
    lattice::{BAND_WIDTH, Point, PointId},
    scope::Scope,
    walk::{Blocks, Tile, bands},
};

/// The lattice address of point number `k` of a scope that has `total` points, or `None` if there are
/// fewer.
pub(super) fn locate(scope: &Arc<Scope>, total: u128, k: u128) -> Option<PointId> {
    if k >= total {
        return None;
    }
    let rows = &scope.y.all;
    let (band, before) = search(bands(scope), total, k, |band| {
        count(scope, &(scope.x.all.start..band * BAND_WIDTH), rows)
    });
    let columns = band * BAND_WIDTH..(band + 1) * BAND_WIDTH;
    let within = count(scope, &columns, rows);
    let k = k - before;
    let (row, before) = search(rows.clone(), within, k, |row| {
        count(scope, &columns, &(rows.start..row))
    });
    let mut blocks = Blocks::<Points>::of_tile(scope.clone(), &Tile::row(band, row));
    let mut points = vec![Point::default(); BAND_WIDTH as usize];
    let filled = blocks.fill(&mut points);
    let k = usize::try_from(k - before).ok()?;
    points[..filled].get(k).map(|point| point.id)
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
        let share = (k - low.1) as f64 / high.1.saturating_sub(low.1) as f64;
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
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_search_finds_the_place_whatever_the_counts(
            steps in prop::collection::vec(0u128..5, 1..200), start in -1000i64..1000, part in 0.0..1.0f64,
        ) {
            let mut sums: Vec<u128> = vec![0];
            for step in &steps {
                sums.push(sums[sums.len() - 1] + step);
            }
            let total = sums[steps.len()];
            prop_assume!(total > 0);
            let k = ((total as f64 * part) as u128).min(total - 1);
            let range = start..start + steps.len() as i64;
            let (place, count) = search(range, total, k, |at| sums[(at - start) as usize]);
            let at = (place - start) as usize;
            prop_assert_eq!(count, sums[at]);
            prop_assert!(sums[at] <= k && k < sums[at + 1]);
        }
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
