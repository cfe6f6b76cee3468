//! The state of a walk: the band and the row that it has reached, and the patch of that row; of points that settle, rows
//! of bands piece by piece. Tiles are parts of a plan that can be filled independently.

use alloc::sync::Arc;
use core::ops::Range;

use super::{
    scope::{Corner, Scope},
    sieve::Sieve,
    sifting::{Halves, Sifting},
};
use crate::{
    kernel::{Backend, Format, Geometry, compiled},
    lattice::{BAND_WIDTH, Columns, Found, Patch, PointId, Span, clip_to_band},
    pattern::{Axis, Class},
};

/// The place of the next point in a band.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The current row; the end of the rows when a new band is due.
    pub(super) y: i64,
    /// The number of columns of the row's template that are done.
    pub(super) done: usize,
    /// The lattice column where the current row begins, if it is the first of a window.
    pub(super) from: Option<i64>,
}

impl Place {
    pub(super) const fn row(y: i64) -> Self {
        Self {
            y,
            done: 0,
            from: None,
        }
    }

    /// Whether nothing of the row is done.
    pub(super) const fn is_fresh(&self) -> bool {
        self.done == 0 && self.from.is_none()
    }

    pub(super) const fn next_row(&mut self) {
        *self = Self::row(self.y + 1);
    }
}

/// The bands of a scope or a tile, from left to right, and in the current band the patch of the current
/// row.
#[derive(Clone, Debug)]
pub(super) struct Bands {
    pub(super) scope: Arc<Scope>,
    pub(super) backend: Backend,
    /// The bands still to come.
    ahead: Range<i64>,
    /// The current band.
    pub(super) band: i64,
    /// The rows of every band.
    pub(super) rows: Range<i64>,
    pub(super) at: Place,
    /// All columns of the band.
    pub(super) columns: Columns,
    pub(super) sieve: Option<Sifting>,
    halves: Halves,
    pub(super) patch: Patch,
    /// The scope's spans in the patch.
    pub(super) piece: [Span; 2],
}

impl Bands {
    /// Some bands and rows of a scope, before the first band.
    fn new(scope: Arc<Scope>, bands: Range<i64>, rows: Range<i64>) -> Self {
        let Scope { lattice, x, y, .. } = &*scope;
        let patch = Patch::new(lattice, bands.start, rows.start, x, y);
        Self {
            backend: Backend::best(),
            band: bands.start,
            ahead: bands,
            at: Place::row(rows.end),
            rows,
            columns: Columns::default(),
            sieve: scope.sieve.as_ref().map(Sifting::new),
            halves: Halves::default(),
            piece: [x.clone(), y.clone()],
            patch,
            scope,
        }
    }

    /// The band and the rows of a tile.
    pub(super) fn of_tile(scope: Arc<Scope>, tile: &Tile) -> Self {
        Self::new(scope, tile.band..tile.band + 1, tile.rows.clone())
    }

    /// All bands and rows of a scope from the band of an address on, or from the first.
    pub(super) fn from(scope: Arc<Scope>, start: Option<PointId>) -> Self {
        let (mut bands, rows) = (scope.bands(), scope.y.all.clone());
        if let Some(at) = start {
            bands.start = at.x.div_euclid(BAND_WIDTH);
        }
        Self::new(scope, bands, rows)
    }

    /// Continues at an address if it is in the current band. Returns whether it is.
    pub(super) fn go_to(&mut self, at: PointId) -> bool {
        let is_inside = self.rows.contains(&at.y) && at.x.div_euclid(BAND_WIDTH) == self.band;
        if is_inside {
            self.at = Place {
                from: Some(at.x),
                ..Place::row(at.y)
            };
        }
        is_inside
    }

    /// Whether the current band is done.
    pub(super) const fn is_done(&self) -> bool {
        self.at.y >= self.rows.end
    }

    /// The first address of the bands still to come.
    pub(super) const fn next_start(&self) -> PointId {
        PointId {
            x: self.ahead.start * BAND_WIDTH,
            y: self.rows.start,
        }
    }

    /// The columns of the scope in the current band.
    pub(super) fn range(&self) -> Range<i64> {
        clip_to_band(self.band, &self.scope.x.all)
    }

    /// Lists the columns of the next band that may have points and moves to its first row, whose patch is not made yet.
    /// Returns `false` after the last band.
    pub(super) fn next_band(&mut self) -> bool {
        let whole = self.scope.sieve.as_ref().and_then(Sieve::area);
        let mut near = None;
        if let (Some(whole), Some(sifting)) = (whole, &self.sieve) {
            let (x, rows) = (&self.scope.x.all, &self.rows);
            near = self.halves.next(whole, &mut self.ahead, |area, bands| {
                let columns =
                    x.start.max(bands.start * BAND_WIDTH)..x.end.min(bands.end * BAND_WIDTH);
                area.focus(&sifting.band.world([&columns, rows]))
            });
        }
        let Some(band) = self.ahead.next() else {
            return false;
        };
        self.band = band;
        self.at = Place::row(self.rows.start);
        let columns = clip_to_band(band, &self.scope.x.all);
        self.columns.list(&self.scope.lattice, columns.clone());
        if let Some(sifting) = &mut self.sieve {
            sifting.band.aim(near, &self.rows, &columns);
            sifting.prefix.update(&columns, &self.columns);
        }
        true
    }

    /// Whether the patch ends before the current row.
    pub(super) const fn needs_patch(&self) -> bool {
        self.at.y >= self.patch.end()
    }

    /// The end of the rows of the patch.
    pub(super) fn patch_end(&self) -> i64 {
        self.rows.end.min(self.patch.end())
    }

    /// Makes the patch of the current row. Moves past its rows if none of its points pass the sieve.
    pub(super) fn next_patch(&mut self) {
        let Scope { lattice, x, y, .. } = &*self.scope;
        self.patch = Patch::new(lattice, self.band, self.at.y, x, y);
        let (columns, rows) = (self.range(), self.at.y..self.patch_end());
        if self.patch.is_warped() {
            self.piece = Span::of_piece(lattice, [x, y], [columns.clone(), rows.clone()]);
        }
        if let Some(sifting) = &mut self.sieve {
            if self.patch.is_warped() {
                sifting
                    .patch
                    .set_reach([0, 1].map(|axis| self.piece[axis].reach));
            }
            if sifting.next_patch(&rows, &columns) {
                self.at = Place::row(rows.end);
            }
        }
    }
}

/// The format of a scope's points.
pub(crate) fn format_of<F: Format>(scope: &Scope) -> F {
    let Corner {
        first, gap, extent, ..
    } = scope.corner;
    F::new(&Geometry {
        step: scope.lattice.step,
        first,
        gap,
        extent,
    })
}

/// Writes points of the patch at an origin until `out` is full.
pub(super) fn write_found<F: Format>(
    (format, backend): (&F, Backend),
    origin: [i64; 2],
    found: impl Iterator<Item = Found>,
    out: &mut [F::Item],
) {
    let (base, [left, bottom]) = (format.base(origin), origin);
    compiled(backend, || {
        for (out, found) in out.iter_mut().zip(found) {
            let (place, [x, y]) = (found.place, found.address());
            let column = format.column(base, place[0], left + x);
            *out = format.item(base, column, place[1], bottom + y);
        }
    });
}

/// The rows of a piece: enough that the margins around it cost less than the piece.
pub(super) const PIECE: i64 = 512;

/// A part of a scope in its order: rows of a band.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    pub(super) ahead: Range<i64>,
    pub(super) band: i64,
    pub(super) all: Range<i64>,
    pub(super) next: i64,
}

impl Rows {
    pub(super) fn new(bands: Range<i64>, all: Range<i64>) -> Self {
        Self {
            band: bands.start,
            next: all.end,
            ahead: bands,
            all,
        }
    }

    /// Moves to the next rows: the end of the piece that holds the next row.
    pub(super) fn take(&mut self) -> Option<(i64, Range<i64>)> {
        if self.is_new_band() {
            self.band = self.ahead.next()?;
            self.next = self.all.start;
            if self.all.is_empty() {
                return None;
            }
        }
        let start = self.next;
        let end = (start.div_euclid(PIECE) + 1) * PIECE;
        self.next = end.min(self.all.end);
        Some((self.band, start..self.next))
    }

    /// Whether the next rows are the first of a band.
    pub(super) const fn is_new_band(&self) -> bool {
        self.next >= self.all.end
    }

    /// The address of the next row.
    pub(super) const fn place(&self) -> PointId {
        if self.next < self.all.end {
            PointId {
                x: self.band * BAND_WIDTH,
                y: self.next,
            }
        } else {
            PointId {
                x: self.ahead.start * BAND_WIDTH,
                y: self.all.start,
            }
        }
    }
}

/// Some rows of one band of a plan; see [`Plan::tiles`](crate::Plan::tiles).
///
/// ```
/// use strew_core::{F64, PointSet, Region, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).within(Region::new([0.0, 0.0], [90.0, 90.0])?)?;
/// let mut points = [[0.0; 2]; 1000];
/// let fill = |tile| plan.tile_blocks::<F64>(&tile).fill(&mut points);
/// assert_eq!(plan.tiles(1000).map(fill).sum::<usize>() as u128, plan.count());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    pub(super) band: i64,
    pub(super) rows: Range<i64>,
}

impl Tile {
    /// Some rows of a band.
    pub(super) const fn rows(band: i64, rows: Range<i64>) -> Self {
        Self { band, rows }
    }

    /// A row of a band.
    pub(crate) const fn row(band: i64, row: i64) -> Self {
        let rows = row..row + 1;
        Self { band, rows }
    }

    /// The first address.
    pub(super) const fn start(&self) -> PointId {
        PointId {
            x: self.band * BAND_WIDTH,
            y: self.rows.start,
        }
    }
}

/// The tiles of a scope, in order, of at most `max_points` points each, or one row if that has more.
pub(crate) fn tiles(scope: &Scope, max_points: usize) -> impl Iterator<Item = Tile> + use<> {
    let (rows, columns) = (scope.y.all.clone(), scope.x.all.clone());
    let pattern = scope.lattice.pattern;
    scope.bands().flat_map(move |band| {
        let columns = clip_to_band(band, &columns);
        let longest = Class::ALL
            .map(|class| pattern.axis_set(Axis::X, class).count(columns.clone()))
            .into_iter()
            .fold(1, u64::max);
        let height = (max_points as u64 / longest).clamp(1, 1 << 40) as i64;
        let end = rows.end;
        let mut start = rows.start;
        core::iter::from_fn(move || {
            let rows = start..end.min(start + height);
            start = rows.end;
            (!rows.is_empty()).then_some(Tile { band, rows })
        })
    })
}
