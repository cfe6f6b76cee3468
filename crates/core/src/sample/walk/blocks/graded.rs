//! The walk in a field: points are found many at a time and then written.

use alloc::{boxed::Box, sync::Arc, vec, vec::Vec};
use core::ops::Range;

use super::{
    Blocks, Place,
    few::{FEW, Few},
};
use crate::sample::{
    field::{Source, constant_until, empty_until},
    kernel::{Format, Points, compiled},
    lattice::{BAND_WIDTH, PATCH_HEIGHT, Point, PointId, clip_to_band},
    scope::Scope,
    sieve::Scale,
    walk::{tile::Tile, window::Window},
};

/// Rows of a band in which a field has the same share everywhere: those of a thinned set.
#[derive(Clone, Debug)]
pub(super) struct Constant<F: Format> {
    share: f64,
    /// The walk's scope at that share.
    scope: Arc<Scope>,
    tile: Tile,
    /// The points that are not written yet.
    blocks: Option<Blocks<F>>,
    /// Whether the walk has yet to find out what comes after.
    is_stale: bool,
}

/// The number of rows of a band whose points take about as long as the vectors of a share.
const WORTH: i64 = 1024;

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
        if let Some(constant) = &mut self.constant {
            (constant.blocks, constant.is_stale) = (None, false);
        }
        let [columns, _] = piece;
        if self.at.from.is_none() {
            self.begin_constant([columns, self.at.y..self.rows.end]);
        }
    }

    /// Begins with the first rows of a piece if the field is constant there and they are worth it.
    fn begin_constant(&mut self, [columns, rows]: [Range<i64>; 2]) {
        let lattice = &self.scope.lattice;
        let Some(grade) = &lattice.grade else {
            return;
        };
        let Some((share, end)) = constant_until(lattice, grade, &[columns, rows], PATCH_HEIGHT)
        else {
            return;
        };
        let known = self.constant.as_ref().filter(|known| known.share == share);
        let scope = match known {
            Some(known) => known.scope.clone(),
            // Making the vectors of a share takes about as long as so many rows.
            None if share < 1.0 && end - self.at.y < WORTH => return,
            None => Arc::new(self.scope.with_lattice(lattice.in_constant(share))),
        };
        let all = &scope.y.all;
        let rows = self.at.y.max(all.start)..end.min(all.end);
        let has_columns = !clip_to_band(self.band, &scope.x.all).is_empty();
        self.at = Place::row(end);
        let tile = Tile::rows(self.band, rows);
        self.constant = Some(Box::new(Constant {
            share,
            blocks: (has_columns && !tile.rows.is_empty())
                .then(|| Self::of_tile(scope.clone(), &tile).with_backend(self.backend)),
            tile,
            scope,
            is_stale: true,
        }));
    }

    /// Whether there are rows of a constant share to be written.
    pub(super) fn has_constant(&self) -> bool {
        let constant = self.constant.as_ref();
        constant.is_some_and(|constant| constant.blocks.is_some())
    }

    /// Whether the patch is not that of the current row.
    pub(super) fn needs_patch(&self) -> bool {
        let is_stale = self.constant.as_ref().is_some_and(|known| known.is_stale);
        is_stale || self.at.y >= self.patch.end()
    }

    /// Writes points of rows in which the field is constant.
    pub(super) fn fill_constant(&mut self, out: &mut [F::Item]) -> usize {
        let Some(constant) = &mut self.constant else {
            return 0;
        };
        let Some(blocks) = &mut constant.blocks else {
            return 0;
        };
        let filled = blocks.fill(out);
        if filled < out.len() {
            constant.blocks = None;
        }
        filled
    }

    /// The place in rows of a constant share after the points written.
    pub(super) fn constant_place(&self) -> Option<PointId> {
        let blocks = self.constant.as_ref()?.blocks.as_ref()?;
        Some(match blocks.at.y == blocks.rows.end {
            true => PointId {
                x: self.band * BAND_WIDTH,
                y: blocks.rows.end,
            },
            false => PointId {
                x: blocks.column(),
                y: blocks.at.y,
            },
        })
    }

    /// Takes the rows of a constant share without writing them, and returns the number of their points.
    fn count_constant(&mut self) -> u128 {
        let Some(constant) = &mut self.constant else {
            return 0;
        };
        constant.blocks = None;
        let (band, scope) = (constant.tile.band, &constant.scope);
        let columns = clip_to_band(band, &scope.x.all);
        crate::sample::count::count(scope, &columns, &constant.tile.rows)
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
        let [left, bottom] = self.patch.origin();
        let next = rows.list(source, self.at.y..end, enough, self.backend);
        if let Some([x, y]) = from {
            rows.retain(|found| {
                let [column, row] = found.address();
                row != y - bottom || column >= x - left
            });
        }
        if let Some(sifting) = self.sieve.as_ref().filter(|sifting| sifting.is_cut) {
            let scale = Scale::new(lattice, &self.patch);
            rows.retain(|found| {
                let [x, y] = found.address();
                let id = PointId {
                    x: left + x,
                    y: bottom + y,
                };
                sifting.patch.permits(id, scale.world(found.place))
            });
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
        if !self.has_constant() && self.needs_patch() {
            self.next_patch();
        }
        if self.has_constant() {
            return Some(0);
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

/// What is known of points once they are counted.
#[derive(Clone, Debug, Default)]
pub(crate) struct Counted {
    pub(crate) count: u128,
    /// In a field: places in their order.
    pub(crate) marks: Arc<[Mark]>,
    /// All of them, if they are few.
    pub(crate) kept: Option<Arc<Few>>,
}

impl Counted {
    /// Points that were all kept.
    pub(crate) fn of_few(few: Few) -> Self {
        Self {
            count: few.len() as u128,
            kept: Some(Arc::new(few)),
            ..Self::default()
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

/// Marks, some of which are left out where there are many.
#[derive(Default)]
struct Marks {
    all: Vec<Mark>,
    /// The number of marks that were noted, and of how many one is kept, less 1.
    number: usize,
    left_out: usize,
}

impl Marks {
    fn note(&mut self, band: i64, y: i64, before: u128) {
        if self.number.is_multiple_of(self.left_out + 1) {
            let at = PointId {
                x: band * BAND_WIDTH,
                y,
            };
            self.all.push(Mark { at, before });
        }
        self.number += 1;
        if self.all.len() == MARKS {
            let mut keeps = false;
            self.all.retain(|_| {
                keeps = !keeps;
                keeps
            });
            self.left_out = 2 * self.left_out + 1;
        }
    }
}

/// The number of points of a scope in a field, and places in their order. Meaningless once the scope's stop
/// flag is raised.
pub(crate) fn count(scope: &Arc<Scope>) -> Counted {
    let mut blocks = Blocks::<Points>::of_window(scope.clone(), all(None));
    let (mut count, mut marks) = (0, Marks::default());
    let mut kept = Some(Few::default());
    let mut patch = None;
    while !scope.stop.is_raised() {
        let Some(found) = blocks.find_next() else {
            break;
        };
        if blocks.has_constant() {
            let constant = blocks.constant.as_ref();
            let y = constant.map_or(0, |known| known.tile.rows.start);
            marks.note(blocks.band, y, count);
            count += blocks.count_constant();
            kept = None;
            continue;
        }
        let origin = blocks.patch.origin();
        if found > 0 && patch != Some(origin) {
            patch = Some(origin);
            let y = origin[1].max(blocks.rows.start);
            marks.note(blocks.band, y, count);
        }
        count += found as u128;
        if count > FEW as u128 {
            kept = None;
        }
        if let (Some(kept), Some(rows)) = (&mut kept, &blocks.graded) {
            kept.add(origin, rows.left().iter().copied());
        }
        blocks.pass(found);
    }
    Counted {
        count,
        marks: marks.all.into(),
        kept: kept.map(Arc::new),
    }
}

/// The address of point number `k` of a scope in a field, from a place on before which `mark.before` points
/// lie; `None` if there are fewer, or if the scope's stop flag is raised.
pub(crate) fn locate(scope: &Arc<Scope>, mark: Option<Mark>, k: u128) -> Option<PointId> {
    let start = mark.map(|mark| mark.at);
    let mut before = mark.map_or(0, |mark| mark.before);
    let mut blocks = Blocks::<Points>::of_window(scope.clone(), all(start));
    while !scope.stop.is_raised() {
        let found = blocks.find_next()? as u128;
        if blocks.has_constant() {
            let mut again = blocks.clone();
            let number = again.count_constant();
            if k >= before + number {
                before += number;
                blocks = again;
                continue;
            }
            let mut points = vec![Point::default(); FEW];
            while k >= before {
                let filled = blocks.fill_constant(&mut points);
                if k < before + filled as u128 {
                    return Some(points[(k - before) as usize].id);
                }
                before += filled as u128;
            }
            return None;
        }
        if k < before + found {
            blocks.pass((k - before) as usize);
            return blocks.next_found();
        }
        before += found;
        blocks.pass(found as usize);
    }
    None
}
