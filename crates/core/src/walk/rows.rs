//! The walk outside fields: row by row, as fast as the box, the warp and the sieve allow.
//!
//! A row is a list of columns with displacements, and most of its points need no test. A
//! [`Span`](crate::lattice::Span) decides this for whole ranges. Along its axis it has `all` lines whose points
//! may lie inside the box, and the `inner` ones whose points do, however they are displaced and warped:
//!
//! ```text
//!           all ┌─────────────────────┐
//!               │ test   test   test  │
//!         inner │    ┌───────────┐    │     The frame is as wide as displacements and warp reach, some
//!               │ te │           │ te │     dozen lines. So a large box has few tests for its points, and
//!               │ st │   copy    │ st │     a small chunk is all frame. The warp moves the points of a
//!               │    │           │    │     patch nearly alike, so each patch has a narrower frame.
//!               │    └───────────┘    │
//!               └─────────────────────┘
//! ```
//!
//! Three ways fill rows, each the fastest for its case. All find the same points with the same bits:
//!
//! 1. *Tall bands* keep a template for each class and block. A row is then a copy of its columns plus y, in vectors.
//!    This pays from [`TALL`] rows on, where several rows share each template.
//! 2. *Short bands* have rows too short to fill vectors, and templates that hardly any other row uses. [`Flat`] lists the
//!    points of many rows without gaps, warps them together and leaves out those outside. Where the block ends within
//!    the list, the address of the next point is known, and the rest is found again.
//! 3. *Patches that a sieve cuts* have runs of columns (see `sieve`). A run that passes is filled like 1; in others
//!    each point is tested.
//!
//! The place in a row is a number of columns of its template, not of points, because the columns of one row may lie
//! inside and outside in turn. Templates therefore may not change between two calls that share a row. Where way 2
//! stops within a row, the rest of the row makes a template of its own.

use core::ops::Range;

use super::{
    bands::{Bands, Place, write_found},
    template::{Check, Kept, Part, Templates, displaced, sift},
};
use crate::{
    kernel::{Format, Row},
    lattice::{BAND_WIDTH, Flat, PointId, Scale, places},
    pattern::Axis,
};

/// The number of lattice rows from which a band keeps its templates.
const TALL: i64 = 512;

/// The most points of a warped patch that are listed before some are written: 20 bytes each.
const FLAT: usize = 2048;

/// The scope's flag is looked at every so many sifted rows.
const LOOK: i64 = 8;

/// A walk outside fields.
#[derive(Clone, Debug)]
pub(super) struct RowWalk<F: Format> {
    pub(super) bands: Bands,
    /// The columns that lie inside whatever their displacement, as places in the lists.
    inner: [Range<usize>; 4],
    templates: Templates<F>,
    /// The points of some rows of a patch.
    flat: Flat,
}

impl<F: Format> RowWalk<F> {
    /// A walk over some bands from an address on, or from the first one.
    pub(super) fn new(bands: Bands, start: Option<PointId>) -> Self {
        let is_tall = bands.rows.end - bands.rows.start >= TALL;
        let kept = match &bands.sieve {
            Some(_) => Kept::All,
            None if start.is_some() || !is_tall => Kept::Places,
            None => Kept::Columns,
        };
        let mut walk = Self {
            inner: [const { 0..0 }; 4],
            templates: Templates::new(&bands.scope.lattice, is_tall, kept),
            flat: Flat::default(),
            bands,
        };
        if let Some(at) = start
            && walk.next_band()
            && walk.bands.go_to(at)
        {
            walk.bands.next_patch();
        }
        walk
    }

    /// Fills `out` with the next points, and only a part of it at the end. Returns the number written.
    pub(super) fn fill(&mut self, format: &F, out: &mut [F::Item]) -> usize {
        let mut filled = 0;
        while filled < out.len() {
            let Some(end) = self.advance() else {
                break;
            };
            let Bands { sieve, at, .. } = &self.bands;
            let out = &mut out[filled..];
            filled += if sieve.as_ref().is_some_and(|sieve| sieve.is_cut) {
                self.fill_sifted(format, end, out)
            } else if self.templates.are_short() && at.is_fresh() {
                self.fill_flat(format, end, out)
            } else {
                self.fill_rows(format, end, out)
            };
        }
        filled
    }

    /// The address at which the current row goes on; `None` at the end of a band.
    pub(super) fn place(&self) -> Option<PointId> {
        let Bands { band, at, .. } = &self.bands;
        if self.bands.is_done() {
            return None;
        }
        let start = band * BAND_WIDTH;
        let x = match at.done {
            0 => at.from.unwrap_or(start),
            done => self.column(done).unwrap_or(start + BAND_WIDTH),
        };
        Some(PointId { x, y: at.y })
    }

    /// The lattice column of number `n` of the current row's template.
    fn column(&self, n: usize) -> Option<i64> {
        let Bands {
            scope,
            columns,
            patch,
            at,
            ..
        } = &self.bands;
        let lattice = &scope.lattice;
        let (class, block) = lattice.row(at.y)?;
        let (vectors, keeps) = (lattice.vectors(block), lattice.keeps(block));
        let columns = columns.of(class).iter().filter(|line| keeps(line));
        self.templates.column(patch, columns, vectors, n)
    }

    /// Moves to the next band and patch if the current ones are done. Returns the end of the patch's rows;
    /// `None` after the last band, and once the scope's flag is raised.
    fn advance(&mut self) -> Option<i64> {
        if self.bands.scope.stop.is_raised() {
            return None;
        }
        if self.bands.is_done() && !self.next_band() {
            return None;
        }
        if self.bands.needs_patch() {
            self.bands.next_patch();
        }
        Some(self.bands.patch_end())
    }

    /// Moves to the first row of the next band and its patch.
    fn next_band(&mut self) -> bool {
        if !self.bands.next_band() {
            return false;
        }
        let (columns, scope) = (&self.bands.columns, &self.bands.scope);
        self.inner = columns.places(&scope.x.inner);
        self.templates.clear();
        self.bands.next_patch();
        true
    }

    /// Writes points of a patch in which few rows share a template, until row `end` or until `out` is full.
    fn fill_flat(&mut self, format: &F, end: i64, out: &mut [F::Item]) -> usize {
        let range = self.bands.range();
        let Bands {
            scope,
            backend,
            at,
            patch,
            ..
        } = &mut self.bands;
        // Some two in three points of a small box's patches lie inside.
        let enough = (2 * out.len()).clamp(64, FLAT);
        let next = self.flat.list(
            (&scope.lattice, patch),
            [&range; 2],
            at.y..end,
            enough,
            *backend,
        );
        let found = &self.flat.found;
        write_found(
            (format, *backend),
            patch.origin(),
            found.points(0..found.len()),
            out,
        );
        *at = match found.address(out.len()) {
            // The rest of this row takes a template of its own.
            Some([x, y]) => Place {
                from: Some(x),
                ..Place::row(y)
            },
            None => Place::row(next),
        };
        found.len().min(out.len())
    }

    /// Writes points of the patch's rows until row `end` or until `out` is full.
    fn fill_rows(&mut self, format: &F, end: i64, out: &mut [F::Item]) -> usize {
        let Bands {
            scope,
            backend,
            at,
            columns: listed,
            patch,
            piece: [x, span],
            ..
        } = &mut self.bands;
        let (lattice, patch, by) = (&scope.lattice, &*patch, *backend);
        let base = format.base(patch.origin());
        let is_split = patch.is_warped() && !patch.columns_are_inner;
        let is_flat = self.templates.are_short();
        let mut filled = 0;
        while at.y < end && filled < out.len() {
            if is_flat && at.is_fresh() {
                // Only a row that was begun is finished here.
                break;
            }
            let y = at.y;
            let line = lattice.row(y).filter(|_| span.all.contains(&y));
            let Some((class, block)) = line else {
                at.next_row();
                continue;
            };
            let row = Row {
                base,
                y: patch.relative(Axis::Y, y),
                lattice: y,
            };
            let is_inner = span.inner.contains(&y);
            let columns = listed.of_row(lattice, class, block);
            let vectors = lattice.vectors(block);
            let inner = if lattice.has_all() {
                self.inner[class.ordinal()].clone()
            } else {
                places(columns, &x.inner)
            };
            let out = &mut out[filled..];
            let template = self
                .templates
                .get(class, block, at.done > 0, |template, kept| {
                    template.make((format, base), patch, (columns, inner), vectors, kept, by);
                });
            if let Some(from) = at.from.take() {
                at.done = template.columns_before(from);
            }
            let part = if !is_inner {
                Part {
                    columns: at.done..template.len(),
                    check: Check::Bounds,
                }
            } else if is_split {
                template.next_part(at.done, x)
            } else {
                Part {
                    columns: at.done..template.len(),
                    check: Check::Nothing,
                }
            };
            let progress = template.fill(format, patch, row, part, by, out);
            filled += progress.written;
            at.done += progress.done;
            if at.done == template.len() {
                at.next_row();
            }
        }
        filled
    }

    /// Writes points of a patch that the sieve cuts, until row `end` or until `out` is full.
    fn fill_sifted(&mut self, format: &F, end: i64, out: &mut [F::Item]) -> usize {
        let range = self.bands.range();
        let Bands {
            scope,
            backend,
            at,
            columns: listed,
            sieve: Some(sifting),
            patch,
            ..
        } = &mut self.bands
        else {
            return 0;
        };
        let (lattice, patch, by) = (&scope.lattice, &*patch, *backend);
        let base = format.base(patch.origin());
        let scale = Scale::new(lattice, patch);
        let mut filled = 0;
        while at.y < end && filled < out.len() {
            let y = at.y;
            let Some((class, block)) = lattice.row(y) else {
                at.next_row();
                continue;
            };
            // A point may take long to test.
            if y % LOOK == 0 && scope.stop.is_raised() {
                break;
            }
            if sifting.next_strip(y, end, &range) {
                *at = Place::row(sifting.runs_end);
                continue;
            }
            let columns = listed.of_row(lattice, class, block);
            let vectors = lattice.vectors(block);
            let template = self
                .templates
                .get(class, block, at.done > 0, |template, kept| {
                    let all = 0..columns.len();
                    template.make((format, base), patch, (columns, all), vectors, kept, by);
                });
            if let Some(from) = at.from.take() {
                let from = from.clamp(range.start, range.end);
                at.done = if lattice.has_all() {
                    sifting.prefix.before(class, from)
                } else {
                    columns.partition_point(|line| line.at < from)
                };
            }
            let row = Row {
                base,
                y: patch.relative(Axis::Y, y),
                lattice: y,
            };
            for run in &sifting.runs {
                let places = sifting.prefix.places(lattice, class, columns, &run.columns);
                let part = places.start.max(at.done)..places.end;
                if part.is_empty() {
                    continue;
                }
                let (start, out) = (part.start, &mut out[filled..]);
                let progress = if run.passes {
                    let part = Part {
                        columns: part,
                        check: Check::Nothing,
                    };
                    template.fill(format, patch, row, part, by, out)
                } else {
                    let columns = displaced(patch, &columns[part], vectors);
                    let passes = |x, place| {
                        let id = PointId { x, y };
                        patch.holds(place) && sifting.patch.passes(run, id, scale.world(place))
                    };
                    sift(format, row, columns, (|p| patch.place(p), passes), out)
                };
                filled += progress.written;
                at.done = start + progress.done;
                if at.done < places.end {
                    return filled;
                }
            }
            at.next_row();
        }
        filled
    }
}
