//! The number of points of a warped box: inner rows × inner columns in closed form, since their points
//! lie inside wherever the warp moves them, and the margins piece by piece. In a piece the warp moves all
//! points nearly alike, so most of them are inside or outside whatever their displacement, and only those in
//! between are looked at. So the cost grows with the circumference.

use core::ops::Range;

use super::tally::product;
use crate::{
    sample::{
        kernel::Backend,
        lattice::{BAND_WIDTH, Columns, Flat, Lattice, PATCH_HEIGHT, Patch, Span},
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
        piece: PIECE,
    };
    let [width, height] = [x, y].map(|span| span.all.end - span.all.start);
    if width <= FEW && height <= FEW {
        margins.piece = [BAND_WIDTH, PATCH_HEIGHT];
        return margins.count(&x.all, &y.all);
    }
    let [left, right] = x.margins();
    let [bottom, top] = y.margins();
    let tested = margins.count(&left, &y.inner)
        + margins.count(&right, &y.inner)
        + margins.count(&x.all, &bottom)
        + margins.count(&x.all, &top);
    product(lattice, &x.inner, &y.inner) + tested
}

/// The largest width and height, in lattice units, of boxes that are all margin.
const FEW: i64 = 256;

/// The sides of a piece, in lattice units. The larger it is, the more the movement differs within it.
const PIECE: [i64; 2] = [128, 64];

struct Margins<'a> {
    lattice: &'a Lattice,
    spans: [&'a Span; 2],
    stop: &'a Stop,
    columns: Columns,
    flat: Flat,
    backend: Backend,
    /// The sides of a piece.
    piece: [i64; 2],
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
                while let Some(rows) = next_piece(&mut in_patch, self.piece[1]) {
                    let mut columns = columns.clone();
                    while let Some(columns) = next_piece(&mut columns, self.piece[0]) {
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
        let [left, right] = x.margins().map(|margin| self.columns.part(margin));
        let all = self.columns.part(x.all.clone());
        let (mut count, mut is_first) = (0, true);
        let [below, above] = y.margins();
        let parts = [
            (below, &all),
            (above, &all),
            (y.inner.clone(), &left),
            (y.inner, &right),
        ];
        for (number, (rows, part)) in parts.into_iter().enumerate() {
            let is_inner = number >= 2;
            if rows.is_empty() || part.is_empty() && !(is_inner && is_first) {
                continue;
            }
            if is_inner && is_first {
                count += self.count_inner(&x.inner, rows.clone());
                is_first = false;
            }
            if part.is_empty() {
                continue;
            }
            let columns = (&mut self.columns, part);
            self.flat
                .list(lattice, patch, columns, rows, usize::MAX, backend);
            count += self.flat.count(patch, backend);
        }
        count
    }

    /// The number of points with addresses in some columns and rows.
    fn count_inner(&mut self, columns: &Range<i64>, rows: Range<i64>) -> usize {
        let part = self.columns.part(columns.clone());
        let rows = rows.filter_map(|y| self.lattice.row(y));
        rows.map(|(class, block)| {
            self.columns
                .of_part(self.lattice, class, block, &part)
                .len()
        })
        .sum()
    }
}
