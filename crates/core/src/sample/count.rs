//! The exact number of points of a region without making them.
//!
//! Points of inner rows and inner columns are products of axis counts. A margin column's points
//! depend on the row only through the row's block, of which there are n, and the rows of each
//! block are counted in closed form; likewise margin rows. Only margin × margin is looked at point
//! by point. So the cost does not grow with the region.

use core::ops::Range;

use super::{
    Frame, Listed, Sampler, Stop,
    blocks::{list_columns, locate},
    margins,
    plan::Span,
    tally::tally,
};
use crate::pattern::{Axis, Class};

pub(super) fn count(sampler: &Sampler, frame: &Frame, x: &Span, y: &Span, stop: &Stop) -> u128 {
    if x.bounds.is_empty() || y.bounds.is_empty() {
        return 0;
    }
    if frame.shears.is_some() {
        return margins::count(sampler, frame, x, y, stop);
    }
    let [width, height] = [x, y].map(|span| span.all.end - span.all.start);
    if width <= FEW && height <= FEW {
        return count_rows(sampler, frame, x, y);
    }
    count_blocks(sampler, frame, x, y)
}

/// The count of any region, in closed forms.
fn count_blocks(sampler: &Sampler, frame: &Frame, x: &Span, y: &Span) -> u128 {
    let columns = tally(sampler, frame, Axis::X, &x.inner);
    let rows = tally(sampler, frame, Axis::Y, &y.inner);
    let count = |class: Class| {
        let inner = [&columns, &rows].map(|tally| tally[class.ordinal()].as_slice());
        count_class(sampler, frame, [x, y], inner, class)
    };
    Class::ALL.into_iter().map(count).sum()
}

/// Up to this many lattice units along both axes, looking at each row is faster than closed forms.
const FEW: i64 = 512;

/// The count of a small region, row by row: a row's inner columns need no look.
fn count_rows(sampler: &Sampler, frame: &Frame, x: &Span, y: &Span) -> u128 {
    let mut columns: [Listed; 4] = Default::default();
    list_columns(sampler, frame, x.all.clone(), &mut columns);
    let inner = [0, 1, 2, 3].map(|class: usize| {
        let listed = &columns[class];
        let [start, end] =
            [x.inner.start, x.inner.end].map(|v| listed.partition_point(|&(u, _)| u < v));
        start..end
    });
    let mut count = 0;
    for v in y.all.clone() {
        let Some((class, block)) = locate(sampler, frame, v) else {
            continue;
        };
        let (listed, inner) = (&columns[class.ordinal()], &inner[class.ordinal()]);
        let row = sampler.row(block);
        if y.inner.contains(&v) {
            count += inner.len();
            for &(u, block) in listed[..inner.start].iter().chain(&listed[inner.end..]) {
                count += usize::from(x.holds(u, row[block as usize][0]));
            }
        } else {
            let holds = |&&(u, block): &&(i64, u32)| {
                let [dx, dy] = row[block as usize];
                y.holds(v, dy) && x.holds(u, dx)
            };
            count += listed.iter().filter(holds).count();
        }
    }
    count as u128
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

#[cfg(test)]
mod tests {
    use alloc::{sync::Arc, vec::Vec};

    use super::*;
    use crate::{Placement, Region, Seed, Spacing, Table, map::Map, table::Provenance};

    #[test]
    fn rows_and_closed_forms_count_alike() {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 20).expect("small");
        let blocks = map.intervals() * map.intervals();
        let vector = |i: usize| [7919, 104_729].map(|f| (i * f % 20_000_000) as i32 - 10_000_000);
        let vectors = (0..blocks).map(vector).collect::<Vec<_>>();
        let table = Table::new(map, "test", vectors, Provenance::default()).expect("valid");
        let sampler = Arc::new(Sampler::new(table));
        let placement = Placement::new(Spacing::new(1.0).expect("valid"), Seed(0));
        for (i, size) in [0.5, 3.0, 9.5, 31.6, 64.0, 150.0].into_iter().enumerate() {
            for [width, height] in [[size, size], [size, 2.0], [1.0, size]] {
                let min = [i as f64 * 1e6 - 3e6, 17.3 - i as f64 * 977.0];
                let max = [min[0] + width, min[1] + height];
                let region = Region::new(min, max).expect("ordered");
                let plan = sampler.plan(placement, region).expect("in range");
                let by = |way: fn(&Sampler, &Frame, &Span, &Span) -> u128| {
                    way(&sampler, &plan.frame, &plan.x, &plan.y)
                };
                assert_eq!(by(count_rows), by(count_blocks), "{region:?}");
                assert_eq!(by(count_rows), plan.count());
            }
        }
    }
}
