//! The number of points of a warped box: inner rows × inner columns in closed form, since their points
//! lie inside wherever the warp moves them, and the margins piece by piece. In a piece the warp moves all
//! points nearly alike, so most of them are inside or outside whatever their displacement, and only those in
//! between are looked at. So the cost grows with the circumference.

use core::ops::Range;

use super::tally::product;
use crate::{
    sample::{
        kernel::Backend,
        lattice::{BAND_WIDTH, Columns, Flat, Lattice, Patch, Span, places},
    },
    stop::Stop,
};

/// The number of points of a warped box; meaningless once `stop` is raised.
pub(super) fn count(lattice: &Lattice, [x, y]: [&Span; 2], stop: &Stop) -> u128 {
    let mut margins = Margins {
        lattice,
        spans: [x, y],
        stop,
        columns: Columns::default(),
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
    columns: Columns,
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
            self.columns.list(self.lattice, columns.clone());
            let mut rows = rows.clone();
            while !rows.is_empty() && !self.stop.is_raised() {
                let patch = Patch::new(self.lattice, band, rows.start, x, y);
                let mut in_patch = rows.start..rows.end.min(patch.end());
                rows.start = in_patch.end;
                while let Some(rows) = next_piece(&mut in_patch, PIECE[1]) {
                    let mut columns = columns.clone();
                    while let Some(columns) = next_piece(&mut columns, PIECE[0]) {
                        count += self.count_piece(&patch, columns, rows.clone()) as u128;
                    }
                }
            }
        }
        count
    }

    fn count_piece(&mut self, patch: &Patch, columns: Range<i64>, rows: Range<i64>) -> usize {
        let (lattice, backend) = (self.lattice, self.backend);
        let [x, y] = Span::of_piece(lattice, self.spans, [columns, rows]);
        let ([left, right], [below, above]) = (x.margins(), y.margins());
        let mut count = self.count_inner(&x.inner, y.inner.clone());
        let inner = &y.inner;
        for (columns, rows) in [
            (&x.all, &below),
            (&x.all, &above),
            (&left, inner),
            (&right, inner),
        ] {
            self.flat
                .list((lattice, patch), columns, rows.clone(), usize::MAX, backend);
            count += self.flat.found.len();
        }
        count
    }

    /// The number of points with addresses in some columns and rows.
    fn count_inner(&mut self, columns: &Range<i64>, rows: Range<i64>) -> usize {
        let rows = rows.filter_map(|y| self.lattice.row(y));
        rows.map(|(class, block)| {
            let all = self.columns.of_row(self.lattice, class, block);
            places(all, columns).len()
        })
        .sum()
    }
}
