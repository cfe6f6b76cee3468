//! The exact number of points of a region without making them.
//!
//! Points of inner rows and inner columns are products of axis counts. A margin column's points
//! depend on the row only through the row's block, of which there are n, and the rows of each
//! block are counted in closed form; likewise margin rows. Only margin × margin is looked at point
//! by point. So the cost does not grow with the region.

use core::ops::Range;

use super::{Frame, Listed, Sampler, margins, plan::Span, tally::tally};
use crate::pattern::{Axis, Class};

pub(super) fn count(sampler: &Sampler, frame: &Frame, x: &Span, y: &Span) -> u128 {
    if x.bounds.is_empty() || y.bounds.is_empty() {
        return 0;
    }
    if frame.shears.is_some() {
        return margins::count(sampler, frame, x, y);
    }
    let columns = tally(sampler, frame, Axis::X, &x.inner);
    let rows = tally(sampler, frame, Axis::Y, &y.inner);
    let count = |class: Class| {
        let inner = [&columns, &rows].map(|tally| tally[class.ordinal()].as_slice());
        count_class(sampler, frame, [x, y], inner, class)
    };
    Class::ALL.into_iter().map(count).sum()
}

fn count_class(
    sampler: &Sampler,
    frame: &Frame,
    [x, y]: [&Span; 2],
    [columns, rows]: [&[u64]; 2],
    class: Class,
) -> u128 {
    let margin_columns = listed(sampler, frame, Axis::X, class, x.margins());
    let margin_rows = listed(sampler, frame, Axis::Y, class, y.margins());
    let total = |counts: &[u64]| counts.iter().map(|&c| u128::from(c)).sum::<u128>();

    let mut count = total(columns) * total(rows);
    for (block_y, &rows) in rows.iter().enumerate().filter(|&(_, &rows)| rows > 0) {
        let row = sampler.row(block_y);
        let inside = margin_columns
            .iter()
            .filter(|&&(v, block)| x.holds(v, row[block as usize][0]))
            .count();
        count += inside as u128 * u128::from(rows);
    }
    for &(v, block_y) in &margin_rows {
        let row = sampler.row(block_y as usize);
        let inside = columns
            .iter()
            .zip(row)
            .filter(|(_, [_, dy])| y.holds(v, *dy));
        count += inside
            .map(|(&columns, _)| u128::from(columns))
            .sum::<u128>();
        count += margin_columns
            .iter()
            .map(|&(u, block)| (u, row[block as usize]))
            .filter(|&(u, [dx, dy])| x.holds(u, dx) && y.holds(v, dy))
            .count() as u128;
    }
    count
}

/// The coordinates of a class in two stretches, with their blocks.
pub(super) fn listed(
    sampler: &Sampler,
    frame: &Frame,
    axis: Axis,
    class: Class,
    ranges: [Range<i64>; 2],
) -> Listed {
    let other_parity = match axis {
        Axis::X => class.y,
        Axis::Y => class.x,
    };
    let set = frame.pattern.axis_set(axis, class);
    ranges
        .into_iter()
        .flat_map(|range| set.iter(range))
        .map(|v| {
            let index = frame.pattern.axis_index(axis, v, other_parity);
            (v, sampler.map().locate(index) as u32)
        })
        .collect()
}
