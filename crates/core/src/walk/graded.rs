//! The walk in a field: points are found many at a time and then written.
//!
//! # The problem
//!
//! In a field the share of points that are left varies from place to place. A point is left if its rank is
//! below the share at its place. So the field must be looked at once for every point that may be left: with a share
//! of 1 % that is a hundred looks for each point that is written. The walk saves most of them by bounds, which a
//! [`Field`](crate::Field) has for any box.
//!
//! # The idea
//!
//! From the current row upward, a band is cut into three sorts of rows:
//!
//! ```text
//!      │            │
//!      │  patches   │  the share varies: find points one patch at a time
//!      ├────────────┤
//!      │  constant  │  least and greatest share are equal: a thinned set, which needs no field
//!      ├────────────┤
//!      │  patches   │
//!      ├────────────┤
//!      │   empty    │  the greatest share is 0: skip
//!      └────────────┘
//! ```
//!
//! Both ends of empty and constant rows are found by doubling: ever higher pieces are tried while they qualify, then
//! lower ones, so a band of 10⁹ empty rows costs about forty bounds. They end at multiples of the height of
//! a patch, so that a patch is of one sort.
//!
//! *Constant rows* go to a [`RowWalk`] over the same scope thinned to that share, which never asks the field.
//!
//! *Patches* are the work of [`FieldRows`]: tiles of the patch leave out by bounds the blocks that have left anywhere
//! in the tile and accept those that are left everywhere. Only the others are compared with the field. Each stage
//! (place, share, rank) runs over some hundred to two thousand candidates before the next one, so
//! that its loop is in vectors and its memory in the fast cache.
//!
//! # Invariants
//!
//! - The points are those of the definition (`Lattice::place` for each address), in the order of all walks. Bounds
//!   may be loose, which costs time, and never wrong.
//! - `rows` holds points of the current patch alone, and the patch does not change before all are taken.
//! - Where `constant` has a walk, its rows come next, `at` is the row after them, and the patch is an older one.
//!   `is_stale` is kept after that, until the next patch is made.
//! - A walk that begins within a row finds all of it and drops the columns before its start.
//!
//! `counted` drives the same walk without writing, so counting and filling cannot disagree.

use alloc::sync::Arc;
use core::ops::Range;

use super::{
    bands::{Bands, Place, Tile, write_found},
    count::count,
    rows::RowWalk,
    scope::Scope,
};
use crate::{
    field::{FieldRows, Source, constant_until, empty_until},
    kernel::{Backend, Format},
    lattice::{BAND_WIDTH, Found, PATCH_HEIGHT, PointId, Scale, clip_to_band},
};

/// The most candidates that are listed before the points among them are written: about 100 bytes each.
const MOST: usize = 2048;

/// A walk in a field.
#[derive(Clone, Debug)]
pub(super) struct FieldWalk<F: Format> {
    bands: Bands,
    /// The points that were found in the patch.
    rows: FieldRows,
    /// The last rows of a band in which the field is constant.
    constant: Option<Constant<F>>,
}

/// Rows of a band in which a field has the same share everywhere: those of a thinned set.
#[derive(Clone, Debug)]
struct Constant<F: Format> {
    share: f64,
    /// The walk's scope at that share.
    scope: Arc<Scope>,
    tile: Tile,
    /// The points that are not written yet.
    walk: Option<RowWalk<F>>,
    /// Whether the patch is still the one before these rows.
    is_stale: bool,
}

/// The next points of a walk.
pub(super) enum Next {
    /// The rows of a band from this one on, in which the field is constant.
    Constant(PointId),
    /// Some points of a patch, which begins at this address.
    Found(PointId),
}

impl<F: Format> FieldWalk<F> {
    /// A walk over some bands from an address on, or from the first one.
    pub(super) fn new(bands: Bands, start: Option<PointId>) -> Self {
        let mut walk = Self {
            bands,
            rows: FieldRows::default(),
            constant: None,
        };
        if let Some(at) = start
            && walk.next_band()
            && walk.bands.go_to(at)
        {
            walk.next_patch();
        }
        walk
    }

    /// Fills rows by another backend.
    pub(super) const fn set_backend(&mut self, backend: Backend) {
        self.bands.backend = backend;
    }

    /// Fills `out` with the next points, and only a part of it at the end. Returns the number written.
    pub(super) fn fill(&mut self, format: &F, out: &mut [F::Item]) -> usize {
        let mut filled = 0;
        while filled < out.len() {
            let out = &mut out[filled..];
            filled += if !self.found().is_empty() {
                self.write(format, out)
            } else if self.has_constant() {
                self.write_constant(format, out)
            } else if self.next(out.len()).is_some() {
                0
            } else {
                break;
            };
        }
        filled
    }

    /// Finds the next points: some of the next patch, about `room` of them, or rows in which the field
    /// is constant. All that were found before are taken. `None` after the last band, and once the scope's flag is
    /// raised.
    pub(super) fn next(&mut self, room: usize) -> Option<Next> {
        if self.bands.scope.stop.is_raised() {
            return None;
        }
        if self.bands.is_done() && !self.next_band() {
            return None;
        }
        let is_stale = self.constant.as_ref().is_some_and(|known| known.is_stale);
        if !self.has_constant() && (is_stale || self.bands.needs_patch()) {
            self.next_patch();
        }
        if let Some(constant) = self.constant.as_ref().filter(|known| known.walk.is_some()) {
            return Some(Next::Constant(constant.tile.start()));
        }
        self.find(self.bands.patch_end(), room);
        let ([_, bottom], rows) = (self.origin(), &self.bands.rows);
        let at = PointId {
            x: self.bands.band * BAND_WIDTH,
            y: bottom.max(rows.start),
        };
        Some(Next::Found(at))
    }

    /// The address after the points written.
    pub(super) fn place(&self) -> PointId {
        let Bands { band, at, .. } = &self.bands;
        let x = band * BAND_WIDTH;
        if let Some(constant) = &self.constant
            && let Some(walk) = &constant.walk
        {
            let y = constant.tile.rows.end;
            return walk.place().unwrap_or(PointId { x, y });
        }
        if let Some(next) = self.next_found() {
            return next;
        }
        if self.bands.is_done() {
            return self.bands.next_start();
        }
        let x = at.from.unwrap_or(x);
        PointId { x, y: at.y }
    }

    /// The points that were found and not taken.
    pub(super) fn found(&self) -> &[Found] {
        self.rows.left()
    }

    /// The address of the next point that was found.
    pub(super) fn next_found(&self) -> Option<PointId> {
        let [left, bottom] = self.origin();
        let [x, y] = self.found().first()?.address();
        Some(PointId {
            x: left + x,
            y: bottom + y,
        })
    }

    /// The origin of the patch of the points that were found.
    pub(super) const fn origin(&self) -> [i64; 2] {
        self.bands.patch.origin()
    }

    /// Takes points that were found without writing them.
    pub(super) const fn pass(&mut self, number: usize) {
        self.rows.take(number);
    }

    /// Writes points that were found until `out` is full.
    fn write(&mut self, format: &F, out: &mut [F::Item]) -> usize {
        let number = self.found().len().min(out.len());
        let by = (format, self.bands.backend);
        write_found(by, self.origin(), self.found().iter().copied(), out);
        self.pass(number);
        number
    }

    /// Whether there are rows of a constant share to be written.
    fn has_constant(&self) -> bool {
        let constant = self.constant.as_ref();
        constant.is_some_and(|constant| constant.walk.is_some())
    }

    /// Writes points of rows in which the field is constant.
    pub(super) fn write_constant(&mut self, format: &F, out: &mut [F::Item]) -> usize {
        let Some(constant) = &mut self.constant else {
            return 0;
        };
        let walk = constant.walk.as_mut();
        let filled = walk.map_or(0, |walk| walk.fill(format, out));
        if filled < out.len() {
            constant.walk = None;
        }
        filled
    }

    /// The number of points of the rows in which the field is constant, written or not.
    pub(super) fn count_constant(&self) -> u128 {
        self.constant
            .as_ref()
            .map_or(0, |Constant { scope, tile, .. }| {
                let columns = clip_to_band(tile.band, &scope.x.all);
                count(scope, &columns, &tile.rows)
            })
    }

    /// Takes the rows in which the field is constant without writing them.
    pub(super) fn pass_constant(&mut self) {
        if let Some(constant) = &mut self.constant {
            constant.walk = None;
        }
    }

    /// Moves to the first row of the next band that has points, and to its patch.
    fn next_band(&mut self) -> bool {
        let is_some = self.bands.next_band();
        if is_some {
            self.next_patch();
        }
        is_some
    }

    /// Moves to the next row that has points, and to its patch if the field is not constant there.
    fn next_patch(&mut self) {
        self.skip_empty();
        if !self.bands.is_done() && !self.has_constant() {
            self.bands.next_patch();
        }
    }

    /// Leaves out the rows from the current one on in which the field has no points.
    fn skip_empty(&mut self) {
        let (columns, bands) = (self.bands.range(), &mut self.bands);
        let lattice = &bands.scope.lattice;
        let Some(grade) = &lattice.grade else {
            return;
        };
        self.rows.clear();
        let piece = [columns, bands.at.y..bands.rows.end];
        let y = empty_until(lattice, grade, &piece, PATCH_HEIGHT);
        if y > bands.at.y {
            bands.at = Place::row(y);
        }
        if let Some(constant) = &mut self.constant {
            (constant.walk, constant.is_stale) = (None, false);
        }
        let [columns, _] = piece;
        if bands.at.from.is_none() {
            self.begin_constant(columns);
        }
    }

    /// Begins with the rows from the current one on if the field is constant there.
    fn begin_constant(&mut self, columns: Range<i64>) {
        let Bands {
            scope,
            backend,
            band,
            rows,
            at,
            ..
        } = &mut self.bands;
        let lattice = &scope.lattice;
        let Some(grade) = &lattice.grade else {
            return;
        };
        let piece = [columns, at.y..rows.end];
        let Some((share, end)) = constant_until(lattice, grade, &piece, PATCH_HEIGHT) else {
            return;
        };
        let known = self.constant.as_ref().filter(|known| known.share == share);
        let scope = match known {
            Some(known) => known.scope.clone(),
            None => Arc::new(scope.with_lattice(lattice.in_constant(share))),
        };
        let all = &scope.y.all;
        let tile = Tile::rows(*band, at.y.max(all.start)..end.min(all.end));
        let has_columns = !clip_to_band(*band, &scope.x.all).is_empty();
        let walk = (has_columns && !tile.rows.is_empty()).then(|| {
            let mut walk = RowWalk::new(Bands::of_tile(scope.clone(), &tile), None);
            walk.bands.backend = *backend;
            walk
        });
        *at = Place::row(end);
        self.constant = Some(Constant {
            share,
            scope,
            tile,
            walk,
            is_stale: true,
        });
    }

    /// Finds points of the patch's rows up to `end`: all of them, or more than a part of `room`.
    fn find(&mut self, end: i64, room: usize) {
        let (rows, range) = (&mut self.rows, self.bands.range());
        let Bands {
            scope,
            backend,
            at,
            columns,
            sieve,
            patch,
            ..
        } = &mut self.bands;
        let Scope { lattice, x, y, .. } = &**scope;
        let Some(grade) = &lattice.grade else {
            return;
        };
        let source = Source {
            lattice,
            grade,
            patch,
            spans: [x, y],
            columns: (columns, &range),
        };
        let enough = (2 * room).clamp(128, MOST);
        let from = at.from.take().map(|x| [x, at.y]);
        let [left, bottom] = patch.origin();
        let next = rows.list(source, at.y..end, enough, *backend);
        if let Some([x, y]) = from {
            rows.retain(|found| {
                let [column, row] = found.address();
                row != y - bottom || column >= x - left
            });
        }
        if let Some(sifting) = sieve.as_ref().filter(|sifting| sifting.is_cut) {
            let scale = Scale::new(lattice, patch);
            rows.retain(|found| {
                let [x, y] = found.address();
                let id = PointId {
                    x: left + x,
                    y: bottom + y,
                };
                sifting.patch.permits(id, scale.world(found.place))
            });
        }
        *at = Place::row(next);
    }
}
