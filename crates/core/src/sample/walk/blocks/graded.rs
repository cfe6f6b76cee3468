//! The walk in a field: points are found many at a time and then written.

use alloc::{sync::Arc, vec::Vec};

use super::{Blocks, Place};
use crate::sample::{
    field::{Source, empty_until},
    kernel::{Format, Points, compiled},
    lattice::{BAND_WIDTH, PATCH_HEIGHT, PointId, clip_to_band},
    scope::Scope,
    sieve::Scale,
    walk::window::Window,
};

/// The most candidates that are listed before the points among them are written: about 100 bytes each.
const MOST: usize = 2048;

/// The most marks of a count. Where there would be more, every other one is left out.
const MARKS: usize = 1 << 14;

/// A place in the order of a field's points, and the number of points before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    pub(crate) at: PointId,
    pub(crate) before: u128,
}

impl<F: Format> Blocks<F> {
    /// Whether points were found that are not written yet.
    pub(super) fn has_found(&self) -> bool {
        let rows = self.graded.as_ref();
        rows.is_some_and(|rows| !rows.left().is_empty())
    }

    /// The address of the next point that was found.
    pub(super) fn next_found(&self) -> Option<PointId> {
        let found = self.graded.as_ref()?.left().first()?;
        let [left, bottom] = self.patch.origin();
        let [x, y] = found.address();
        Some(PointId {
            x: left + x,
            y: bottom + y,
        })
    }

    /// Leaves out the rows from the current one on in which a field has no points.
    pub(super) fn skip_empty(&mut self) {
        let Scope { lattice, x, .. } = &*self.scope;
        let (Some(rows), Some(grade)) = (&mut self.graded, &lattice.grade) else {
            return;
        };
        rows.clear();
        let piece = [clip_to_band(self.band, &x.all), self.at.y..self.rows.end];
        let y = empty_until(lattice, grade, &piece, PATCH_HEIGHT);
        if y > self.at.y {
            self.at = Place::row(y);
        }
    }

    /// Finds points of the patch's rows up to `end`: all of them, or more than a part of `room`.
    pub(super) fn find(&mut self, end: i64, room: usize) {
        let Scope { lattice, x, y, .. } = &*self.scope;
        let (Some(rows), Some(grade)) = (&mut self.graded, &lattice.grade) else {
            return;
        };
        let range = clip_to_band(self.band, &x.all);
        let source = Source {
            lattice,
            grade,
            patch: &self.patch,
            spans: [x, y],
            columns: (&self.columns, &range),
        };
        let enough = (2 * room).clamp(128, MOST);
        let from = self.at.from.take().map(|x| [x, self.at.y]);
        let next = rows.list(source, self.at.y..end, enough, self.backend);
        if let Some([x, y]) = from {
            let [left, bottom] = self.patch.origin();
            rows.retain(|found| {
                let [column, row] = found.address();
                row != y - bottom || column >= x - left
            });
        }
        if let Some(sifting) = self.sieve.as_ref().filter(|sifting| sifting.is_cut) {
            let scale = Scale::new(lattice, &self.patch);
            rows.retain(|found| sifting.patch.permits(scale.world(found.place)));
        }
        self.at = Place::row(next);
    }

    /// Writes points that were found, as many as there is room for.
    pub(super) fn write_found(&mut self, out: &mut [F::Item]) -> usize {
        let Some(rows) = &mut self.graded else {
            return 0;
        };
        let [left, bottom] = self.patch.origin();
        let (format, base) = (&self.format, self.base);
        let number = rows.left().len().min(out.len());
        let found = &rows.left()[..number];
        compiled(self.backend, || {
            for (out, found) in out.iter_mut().zip(found) {
                let [x, y] = found.address();
                let column = format.column(base, found.place[0], left + x);
                *out = format.item(base, column, found.place[1], bottom + y);
            }
        });
        rows.take(number);
        number
    }

    /// Finds the next points, and returns their number; `None` at the end. They are taken by
    /// [`pass`](Self::pass).
    fn find_next(&mut self) -> Option<usize> {
        if self.at.y >= self.rows.end && !self.next_band() {
            return None;
        }
        if self.at.y >= self.patch.end() {
            self.next_patch();
        }
        self.find(self.rows.end.min(self.patch.end()), MOST);
        Some(self.graded.as_ref().map_or(0, |rows| rows.left().len()))
    }

    /// Takes points without writing them.
    fn pass(&mut self, number: usize) {
        if let Some(rows) = &mut self.graded {
            rows.take(number);
        }
    }
}

/// The whole scope.
const fn all(start: Option<PointId>) -> Window {
    Window {
        start,
        offset: 0,
        count: u128::MAX,
        total: u128::MAX,
    }
}

/// The number of points of a scope in a field, and places in their order. Meaningless once the scope's stop
/// flag is raised.
pub(crate) fn count(scope: &Arc<Scope>) -> (u128, Vec<Mark>) {
    let mut blocks = Blocks::<Points>::of_window(scope.clone(), all(None));
    let (mut count, mut marks) = (0, Vec::new());
    let (mut number, mut stride) = (0usize, 1);
    let mut patch = None;
    while !scope.stop.is_raised() {
        let Some(found) = blocks.find_next() else {
            break;
        };
        let origin = blocks.patch.origin();
        if found > 0 && patch != Some(origin) {
            patch = Some(origin);
            if number.is_multiple_of(stride) {
                let before = count;
                let at = PointId {
                    x: blocks.band * BAND_WIDTH,
                    y: origin[1].max(blocks.rows.start),
                };
                marks.push(Mark { at, before });
            }
            number += 1;
            if marks.len() == MARKS {
                let mut keeps = false;
                marks.retain(|_| {
                    keeps = !keeps;
                    keeps
                });
                stride *= 2;
            }
        }
        count += found as u128;
        blocks.pass(found);
    }
    (count, marks)
}

/// The address of point number `k` of a scope in a field, from a place on before which `mark.before` points
/// lie; `None` if there are fewer, or if the scope's stop flag is raised.
pub(crate) fn locate(scope: &Arc<Scope>, mark: Option<Mark>, k: u128) -> Option<PointId> {
    let start = mark.map(|mark| mark.at);
    let mut before = mark.map_or(0, |mark| mark.before);
    let mut blocks = Blocks::<Points>::of_window(scope.clone(), all(start));
    while !scope.stop.is_raised() {
        let found = blocks.find_next()? as u128;
        if k < before + found {
            blocks.pass((k - before) as usize);
            return blocks.next_found();
        }
        before += found;
        blocks.pass(found as usize);
    }
    None
}
