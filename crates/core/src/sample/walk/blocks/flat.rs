//! The walk over warped patches in which few rows share a template: points are listed and then written.

use super::{Blocks, Place};
use crate::sample::kernel::{Format, compiled};

/// The most points of a warped patch that are listed before some are written: 20 bytes each.
const FLAT: usize = 2048;

impl<F: Format> Blocks<F> {
    /// Lists the points of the warped patch's rows up to `end` that lie inside, or `enough` of its points. Returns
    /// the first row that is not listed.
    pub(super) fn list_flat(&mut self, end: i64, enough: usize) -> i64 {
        let (lattice, patch) = (&self.scope.lattice, &self.patch);
        let (flat, inside) = &mut self.flat;
        let rows = self.at.y..end;
        let columns = (&mut self.columns, &self.listed);
        let next = flat.list(lattice, patch, columns, rows, enough, self.backend);
        flat.sift(patch, self.backend, inside);
        next
    }

    /// Writes points of a warped patch in which few rows share a template, up to row `end` or as many as
    /// there is room for. Rows are warped several at a time.
    pub(super) fn fill_flat(&mut self, end: i64, out: &mut [F::Item]) -> usize {
        // Some two in three points of a small box's patches lie inside.
        let enough = (2 * out.len()).clamp(64, FLAT);
        let next = self.list_flat(end, enough);
        let (patch, base, (flat, inside)) = (&self.patch, self.base, &self.flat);
        let [left, bottom] = patch.origin();
        compiled(self.backend, || {
            for (out, found) in out.iter_mut().zip(inside.points()) {
                let (place, address) = (found.place, found.address());
                let column = self.format.column(base, place[0], left + address[0]);
                *out = self
                    .format
                    .item(base, column, place[1], bottom + address[1]);
            }
        });
        self.at = Place::row(next);
        if inside.len() > out.len()
            && let Some((y, done)) = flat.locate(patch, out.len())
        {
            self.at = Place {
                done,
                ..Place::row(y)
            };
            // The rest of this row takes a template of its own.
            self.templates.clear();
        }
        inside.len().min(out.len())
    }
}
