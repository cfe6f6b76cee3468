//! The number of points of a warped box: inner rows × inner columns in closed form, since their points
//! lie inside wherever the warp moves them, and the margins point by point. So the cost grows with the
//! circumference.

use core::ops::Range;

use super::tally::product;
use crate::{
    pattern::Axis,
    sample::{
        lattice::{BAND_WIDTH, Columns, Lattice, Patch, Span},
        stop::Stop,
    },
};

/// The number of points of a warped box; meaningless once `stop` is raised.
pub(super) fn count(lattice: &Lattice, x: &Span, y: &Span, stop: &Stop) -> u128 {
    let mut margins = Margins {
        lattice,
        x,
        y,
        stop,
        columns: Columns::default(),
    };
    let [left, right] = x.margins();
    let [bottom, top] = y.margins();
    let tested = margins.count(&left, &y.inner)
        + margins.count(&right, &y.inner)
        + margins.count(&x.all, &bottom)
        + margins.count(&x.all, &top);
    product(lattice, &x.inner, &y.inner) + tested
}

struct Margins<'a> {
    lattice: &'a Lattice,
    x: &'a Span,
    y: &'a Span,
    stop: &'a Stop,
    columns: Columns,
}

impl Margins<'_> {
    /// The number of points inside, of those with addresses in some columns and rows.
    fn count(&mut self, columns: &Range<i64>, rows: &Range<i64>) -> u128 {
        let mut count = 0;
        let mut start = columns.start;
        while start < columns.end && !self.stop.is_raised() {
            let band = start.div_euclid(BAND_WIDTH);
            let end = columns.end.min((band + 1) * BAND_WIDTH);
            self.columns.list(self.lattice, start..end);
            let mut row = rows.start;
            while row < rows.end && !self.stop.is_raised() {
                let patch = Patch::new(self.lattice, band, row, self.x, self.y);
                let end = patch.end().min(rows.end);
                count += self.count_in(&patch, row..end);
                row = end;
            }
            start = end;
        }
        count
    }

    fn count_in(&mut self, patch: &Patch, rows: Range<i64>) -> u128 {
        let Some(shears) = patch.shears() else {
            return 0;
        };
        let mut count = 0;
        for y in rows {
            let Some((class, block)) = self.lattice.row(y) else {
                continue;
            };
            let vectors = self.lattice.vectors(block);
            let row = patch.relative(Axis::Y, y);
            let listed = self.columns.of_row(self.lattice, class, block);
            let inside = listed.iter().filter(|column| {
                let [dx, dy] = vectors[column.block as usize];
                patch.holds(shears.apply(patch.relative(Axis::X, column.at) + dx, row + dy))
            });
            count += inside.count() as u128;
        }
        count
    }
}
