//! The exact count of a warped region: inner rows × inner columns in closed form, since their
//! points lie inside wherever the warp moves them; the margins point by point. So the cost grows
//! with the circumference.

use core::ops::Range;

use super::{
    Frame, Listed, Sampler, Stop,
    blocks::list_columns,
    patch::{BAND_WIDTH, Patch},
    plan::Span,
};
use crate::pattern::{Axis, Class};

pub(super) fn count(sampler: &Sampler, frame: &Frame, x: &Span, y: &Span, stop: &Stop) -> u128 {
    let inner = |class: Class| {
        let columns = frame
            .pattern
            .axis_set(Axis::X, class)
            .count(x.inner.clone());
        let rows = frame
            .pattern
            .axis_set(Axis::Y, class)
            .count(y.inner.clone());
        u128::from(columns) * u128::from(rows)
    };
    let mut margins = Margins {
        sampler,
        frame,
        x,
        y,
        stop,
        columns: Default::default(),
    };
    let [left, right] = x.margins();
    let [bottom, top] = y.margins();
    let looked_at = margins.count(&left, &y.inner)
        + margins.count(&right, &y.inner)
        + margins.count(&x.all, &bottom)
        + margins.count(&x.all, &top);
    Class::ALL.into_iter().map(inner).sum::<u128>() + looked_at
}

struct Margins<'a> {
    sampler: &'a Sampler,
    frame: &'a Frame,
    x: &'a Span,
    y: &'a Span,
    stop: &'a Stop,
    columns: [Listed; 4],
}

impl Margins<'_> {
    /// How many points of a stretch of the lattice lie inside.
    fn count(&mut self, columns: &Range<i64>, rows: &Range<i64>) -> u128 {
        let mut count = 0;
        let mut start = columns.start;
        while start < columns.end && !self.stop.is_raised() {
            let band = start.div_euclid(BAND_WIDTH);
            let end = columns.end.min((band + 1) * BAND_WIDTH);
            list_columns(self.sampler, self.frame, start..end, &mut self.columns);
            let mut row = rows.start;
            while row < rows.end && !self.stop.is_raised() {
                let patch = Patch::new(self.frame, band, row, self.x, self.y);
                let end = patch.end().min(rows.end);
                count += self.count_in(&patch, row..end);
                row = end;
            }
            start = end;
        }
        count
    }

    fn count_in(&self, patch: &Patch, rows: Range<i64>) -> u128 {
        let Some(shears) = patch.shears() else {
            return 0;
        };
        let (sampler, pattern) = (self.sampler, self.frame.pattern);
        let mut count = 0;
        for y in rows {
            let Some((x_parity, index)) = pattern.visit(Axis::Y, y) else {
                continue;
            };
            let class = Class {
                x: x_parity,
                y: (y & 1) as u8,
            };
            let vectors = sampler.row(sampler.map().locate(index));
            let row = patch.relative(Axis::Y, y);
            let inside = self.columns[class.ordinal()].iter().filter(|&&(x, block)| {
                let [dx, dy] = vectors[block as usize];
                patch.holds(shears.apply(patch.relative(Axis::X, x) + dx, row + dy))
            });
            count += inside.count() as u128;
        }
        count
    }
}
