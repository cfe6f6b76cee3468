//! The number of points of a box.
//!
//! Without warp, points of inner rows and inner columns are products of axis counts. The points of a margin column
//! depend on the row only through its block, of which there are n, and the rows of each block are counted
//! in closed form; likewise for margin rows. Only margin × margin is tested point by point, so the cost
//! does not grow with the box.
//!
//! In a warped box inner rows × inner columns are counted in closed form, since their points lie inside wherever the
//! warp moves them, and the margins piece by piece. In a piece the warp moves all
//! points nearly alike, so most of them are inside or outside whatever their displacement, and only those in
//! between are looked at. So the cost grows with the circumference.

use alloc::vec::Vec;
use core::ops::Range;

use super::tally::{ColumnTally, product, tally};
use crate::{
    kernel::Backend,
    lattice::{BAND_WIDTH, Flat, Lattice, Line, Patch, Span, lines_of_class},
    pattern::{Axis, Class},
    stop::Stop,
};

/// The number of points of a box.
pub(super) fn count(lattice: &Lattice, x: &Span, y: &Span) -> u128 {
    let columns = tally(lattice, Axis::X, &x.inner);
    let rows = tally(lattice, Axis::Y, &y.inner);
    let count = |class: Class| {
        let inner = [&columns, &rows].map(|tally| tally[class.ordinal()].as_slice());
        count_class(lattice, [x, y], inner, class)
    };
    Class::ALL.into_iter().map(count).sum()
}

/// The count of one class; `columns` and `rows` are the tallies of the inner ones.
fn count_class(
    lattice: &Lattice,
    [x, y]: [&Span; 2],
    [columns, rows]: [&[u64]; 2],
    class: Class,
) -> u128 {
    let margin = |axis: Axis, span: &Span| -> Vec<Line> {
        lines_of_class(lattice, axis, class, span.margins()).collect()
    };
    let (margin_columns, margin_rows) = (margin(Axis::X, x), margin(Axis::Y, y));
    let columns = ColumnTally::new(lattice, class, &x.inner, columns);

    let mut count = columns.times(rows);
    for (block_y, &rows) in rows.iter().enumerate().filter(|&(_, &rows)| rows > 0) {
        let (vectors, keeps) = (lattice.vectors(block_y), lattice.keeps(block_y));
        let inside = margin_columns
            .iter()
            .filter(|column| keeps(column))
            .filter(|column| x.holds(column.at, vectors[column.block as usize][0]))
            .count();
        count += inside as u128 * u128::from(rows);
    }
    for row in &margin_rows {
        let block_y = row.block as usize;
        let (vectors, keeps) = (lattice.vectors(block_y), lattice.keeps(block_y));
        let inside = columns
            .in_row(block_y)
            .zip(vectors)
            .filter(|(_, [_, dy])| y.holds(row.at, *dy));
        count += inside.map(|(columns, _)| u128::from(columns)).sum::<u128>();
        count += margin_columns
            .iter()
            .filter(|column| keeps(column))
            .map(|column| (column.at, vectors[column.block as usize]))
            .filter(|&(at, [dx, dy])| x.holds(at, dx) && y.holds(row.at, dy))
            .count() as u128;
    }
    count
}

/// The number of points of a warped box; meaningless once `stop` is raised.
pub(super) fn count_warped(lattice: &Lattice, [x, y]: [&Span; 2], stop: &Stop) -> u128 {
    let mut margins = Margins {
        lattice,
        spans: [x, y],
        stop,
        flat: Flat::default(),
        backend: Backend::best(),
    };
    let [left, right] = x.margins();
    let [bottom, top] = y.margins();
    let tested = margins.count(&left, &y.inner)
        + margins.count(&right, &y.inner)
        + margins.count(&x.all, &bottom)
        + margins.count(&x.all, &top);
    product(lattice, &x.inner, &y.inner) + tested
}

/// The sides of a piece, in lattice units. The larger it is, the more the movement differs within it.
const PIECE: [i64; 2] = [128, 64];

struct Margins<'a> {
    lattice: &'a Lattice,
    spans: [&'a Span; 2],
    stop: &'a Stop,
    flat: Flat,
    backend: Backend,
}

/// The next range of at most `length`, ending at its multiples.
fn next_piece(range: &mut Range<i64>, length: i64) -> Option<Range<i64>> {
    if range.is_empty() {
        return None;
    }
    let end = range.end.min((range.start.div_euclid(length) + 1) * length);
    let piece = range.start..end;
    range.start = end;
    Some(piece)
}

impl Margins<'_> {
    /// The number of points inside, of those with addresses in some columns and rows.
    fn count(&mut self, columns: &Range<i64>, rows: &Range<i64>) -> u128 {
        let [x, y] = self.spans;
        let (mut count, mut bands) = (0, columns.clone());
        while let Some(columns) = next_piece(&mut bands, BAND_WIDTH) {
            if self.stop.is_raised() {
                break;
            }
            let band = columns.start.div_euclid(BAND_WIDTH);
            let mut rows = rows.clone();
            while !rows.is_empty() && !self.stop.is_raised() {
                let patch = Patch::new(self.lattice, band, rows.start, x, y);
                let mut in_patch = rows.start..rows.end.min(patch.end());
                rows.start = in_patch.end;
                while let Some(rows) = next_piece(&mut in_patch, PIECE[1]) {
                    let mut pieces = columns.clone();
                    while let Some(piece) = next_piece(&mut pieces, PIECE[0]) {
                        let columns = [&columns, &piece];
                        count += self.count_piece(&patch, columns, rows.clone()) as u128;
                    }
                }
            }
        }
        count
    }

    /// The number of points inside in a piece of a patch, whose columns are a part of a range.
    fn count_piece(
        &mut self,
        patch: &Patch,
        [range, columns]: [&Range<i64>; 2],
        rows: Range<i64>,
    ) -> usize {
        let (of, backend) = ((self.lattice, patch), self.backend);
        let [x, y] = Span::of_piece(self.lattice, self.spans, [columns.clone(), rows]);
        let ([left, right], [below, above]) = (x.margins(), y.margins());
        let mut count = self.flat.count(of, [range, &x.inner], y.inner.clone());
        for (columns, rows) in [
            (&x.all, &below),
            (&x.all, &above),
            (&left, &y.inner),
            (&right, &y.inner),
        ] {
            if !columns.is_empty() && !rows.is_empty() {
                let columns = [range, columns];
                self.flat
                    .list(of, columns, rows.clone(), usize::MAX, backend);
                count += self.flat.found.len();
            }
        }
        count
    }
}
