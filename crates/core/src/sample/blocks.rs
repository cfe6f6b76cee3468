//! Walking a plan: bands of columns, rows within a band, columns within a row.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    Cursor, Frame, Listed, PointId, Sampler,
    before::Before,
    kernel::{Backend, Format, Row, compiled},
    patch::{BAND_WIDTH, Patch},
    plan::Plan,
    sieve::{Focus, Run, TOGETHER, World},
    template::{Check, Kept, Stretch, Templates, displaced, sift, write_row},
};
use crate::pattern::{Axis, Class};

/// From this many lattice rows on a band keeps its templates.
const TALL: i64 = 512;

/// A part of a plan that can be filled by itself: some rows of one band.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    band: i64,
    rows: Range<i64>,
}

impl Tile {
    pub(super) const fn new(band: i64, rows: Range<i64>) -> Self {
        Self { band, rows }
    }

    pub(super) fn of(plan: &Plan, max_points: usize) -> impl Iterator<Item = Self> + use<> {
        let (rows, columns, pattern) = (plan.y.all.clone(), plan.x.all.clone(), plan.frame.pattern);
        bands(plan).flat_map(move |band| {
            let columns = clip(band, &columns);
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
                (!rows.is_empty()).then_some(Self { band, rows })
            })
        })
    }
}

/// The bands that a plan touches.
pub(super) fn bands(plan: &Plan) -> Range<i64> {
    let columns = &plan.x.all;
    if columns.is_empty() || plan.y.all.is_empty() {
        return 0..0;
    }
    columns.start.div_euclid(BAND_WIDTH)..(columns.end - 1).div_euclid(BAND_WIDTH) + 1
}

/// The columns of a band that a plan touches.
fn clip(band: i64, columns: &Range<i64>) -> Range<i64> {
    let start = band * BAND_WIDTH;
    columns.start.max(start)..columns.end.min(start + BAND_WIDTH)
}

/// The points of a plan, or of one of its tiles, in order, in blocks of any size.
///
/// Owns all it needs: it can move between threads from block to block.
#[derive(Debug)]
pub struct Blocks<F: Format> {
    plan: Plan,
    format: F,
    /// Bands still to come.
    bands: Range<i64>,
    /// The band under way.
    band: i64,
    /// The rows of every band.
    rows: Range<i64>,
    at: Place,
    /// How many points are still to come.
    left: u128,
    /// The plan's sieve, for the band and for the patch under way.
    sieve: Option<[Focus; 2]>,
    /// Whether the patch under way is cut by what the sieve leaves out.
    is_sifted: bool,
    /// What the sieve says of the row under way and those after it, up to `runs_end`.
    runs: Vec<Run>,
    runs_end: i64,
    columns: [Listed; 4],
    /// Which of them lie inside whatever their displacement.
    inner: [Range<usize>; 4],
    /// Where they are, if there is a sieve.
    before: Before,
    templates: Templates<F>,
    patch: Patch,
    base: [f64; 2],
    backend: Backend,
}

/// Where in a band the next point is.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// The row under way, at the end of the rows when a new band is due.
    y: i64,
    /// How much of that row's template is done.
    done: usize,
    /// The lattice column where the row under way begins, if the plan is a window and this is its
    /// first row.
    from: Option<i64>,
}

impl Place {
    const fn row(y: i64) -> Self {
        Self {
            y,
            done: 0,
            from: None,
        }
    }

    const fn next_row(&mut self) {
        *self = Self::row(self.y + 1);
    }
}

impl<F: Format> Blocks<F> {
    pub(super) fn new(plan: &Plan, tile: Option<&Tile>) -> Self {
        let (bands, rows) = match tile {
            Some(tile) => (tile.band..tile.band + 1, tile.rows.clone()),
            None => (bands(plan), plan.y.all.clone()),
        };
        let start = plan.start.filter(|_| tile.is_none());
        let bands = start.map_or(bands.start, |at| at.x.div_euclid(BAND_WIDTH))..bands.end;
        let tall = rows.end - rows.start >= TALL;
        let kept = match (&plan.sieve, start) {
            (Some(_), _) => Kept::All,
            (None, Some(_)) => Kept::Places,
            (None, None) => Kept::Plain,
        };
        let format = F::new(plan);
        let patch = Patch::new(&plan.frame, bands.start, rows.start, &plan.x, &plan.y);
        let mut blocks = Self {
            base: format.base(patch.origin()),
            format,
            plan: plan.clone(),
            band: bands.start,
            bands,
            at: Place::row(rows.end),
            rows,
            left: if tile.is_some() {
                u128::MAX
            } else {
                plan.count()
            },
            sieve: plan.sieve.as_ref().map(|s| [s.focus(), s.focus()]),
            is_sifted: false,
            runs: Vec::new(),
            runs_end: i64::MIN,
            columns: Default::default(),
            inner: [const { 0..0 }; 4],
            before: Before::default(),
            templates: Templates::new(&plan.sampler, tall, kept),
            patch,
            backend: Backend::best(),
        };
        if let Some(at) = start
            && blocks.next_band()
            && blocks.rows.contains(&at.y)
        {
            blocks.at = Place {
                from: Some(at.x),
                ..Place::row(at.y)
            };
            blocks.next_patch();
        }
        blocks
    }

    /// The same points by another instruction set than the machine's best.
    #[must_use]
    pub const fn with_backend(mut self, backend: Backend) -> Self {
        self.backend = backend;
        self
    }

    /// Writes the next points into `out`; gives how many. Fewer than `out` holds, down to 0, only
    /// at the end.
    pub fn fill(&mut self, out: &mut [F::Item]) -> usize {
        let most = usize::try_from(self.left).map_or(out.len(), |left| left.min(out.len()));
        let out = &mut out[..most];
        let mut filled = 0;
        while filled < out.len() {
            if self.at.y == self.rows.end && !self.next_band() {
                break;
            }
            if self.at.y == self.patch.end() {
                self.next_patch();
            }
            let end = self.rows.end.min(self.patch.end());
            let out = &mut out[filled..];
            filled += if self.is_sifted {
                self.fill_sifted(end, out)
            } else {
                self.fill_rows(end, out)
            };
        }
        self.left -= filled as u128;
        filled
    }

    /// The place after the points given so far, found without counting. `None` for a tile, which
    /// does not know how many points come before it, and for a plan without points, which is
    /// nowhere.
    ///
    /// Its lattice address may lie before that of the next point, but after that of the last one.
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        if self.plan.count() == 0 {
            return None;
        }
        let given = self.plan.count().checked_sub(self.left)?;
        let at = if self.at.y == self.rows.end {
            PointId {
                x: self.bands.start * BAND_WIDTH,
                y: self.rows.start,
            }
        } else {
            PointId {
                x: self.column(),
                y: self.at.y,
            }
        };
        Some(Cursor {
            offset: self.plan.offset() + given,
            total: self.plan.total(),
            at,
        })
    }

    /// The lattice column at which the row under way goes on.
    fn column(&self) -> i64 {
        let start = self.band * BAND_WIDTH;
        if self.at.done == 0 {
            return self.at.from.unwrap_or(start);
        }
        let Plan { sampler, frame, .. } = &self.plan;
        let column = locate(sampler, frame, self.at.y).and_then(|(class, block)| {
            let listed = &self.columns[class.ordinal()];
            let vectors = sampler.row(block);
            self.templates
                .column(&self.patch, listed, vectors, self.at.done)
        });
        column.unwrap_or(start + BAND_WIDTH)
    }

    /// Moves to the first row of the next band.
    fn next_band(&mut self) -> bool {
        let Some(band) = self.bands.next() else {
            return false;
        };
        let Plan {
            sampler, frame, x, ..
        } = &self.plan;
        let columns = clip(band, &x.all);
        list_columns(sampler, frame, columns.clone(), &mut self.columns);
        for (inner, listed) in self.inner.iter_mut().zip(&self.columns) {
            let before = |v: i64| listed.partition_point(|&(u, _)| u < v);
            *inner = before(x.inner.start)..before(x.inner.end);
        }
        if let (Some(sieve), Some([focus, _])) = (&self.plan.sieve, &mut self.sieve) {
            focus.aim(sieve.area(), &self.rows, &columns);
            self.before.note(&columns, &self.columns);
        }
        self.templates.forget();
        self.band = band;
        self.at = Place::row(self.rows.start);
        self.next_patch();
        true
    }

    /// Moves to the patch of the row under way.
    fn next_patch(&mut self) {
        let Plan { frame, x, y, .. } = &self.plan;
        self.patch = Patch::new(frame, self.band, self.at.y, x, y);
        self.base = self.format.base(self.patch.origin());
        let rows = self.at.y..self.patch.end().min(self.rows.end);
        self.is_sifted = false;
        self.runs_end = rows.start;
        if let Some([band, patch]) = &mut self.sieve {
            let columns = clip(self.band, &x.all);
            patch.aim(band.area(), &rows, &columns);
            patch.runs(rows.clone(), &columns, &mut self.runs);
            match self.runs.as_slice() {
                [] => self.at = Place::row(rows.end),
                // Such a patch lies inside the plan's box, too: it is filled like one.
                [run] if run.passes && run.columns == columns => {}
                _ => self.is_sifted = true,
            }
        }
    }

    /// Writes points of the patch's rows up to `end`, or as many as there is room for.
    fn fill_rows(&mut self, end: i64, out: &mut [F::Item]) -> usize {
        let Plan {
            sampler,
            frame,
            x,
            y: span,
            ..
        } = &self.plan;
        let (format, patch, base) = (&self.format, &self.patch, self.base);
        let is_split = patch.is_warped() && !patch.columns_are_inner;
        let is_direct = self.templates.are_plain() && !patch.is_warped();
        let mut filled = 0;
        while self.at.y < end && filled < out.len() {
            let y = self.at.y;
            let Some((class, block)) = locate(sampler, frame, y) else {
                self.at.next_row();
                continue;
            };
            let row = Row {
                base,
                y: patch.relative(Axis::Y, y),
                lattice: y,
            };
            let is_inner = span.inner.contains(&y);
            let (listed, vectors) = (&self.columns[class.ordinal()], sampler.row(block));
            let inner = self.inner[class.ordinal()].clone();
            let out = &mut out[filled..];
            if is_direct && self.at.done == 0 && listed.len() <= out.len() {
                let columns = (listed.as_slice(), inner);
                filled += compiled::run(self.backend, || {
                    write_row(format, patch, row, columns, (vectors, is_inner), out)
                });
                self.at.next_row();
                continue;
            }
            let template = self
                .templates
                .get(class, block, self.at.done > 0, |template, kept| {
                    template.make(format, base, patch, (listed, inner), vectors, kept);
                });
            if let Some(from) = self.at.from.take() {
                self.at.done = template.columns_before(from);
            }
            let done = self.at.done;
            // Where columns are not all inner ones, those that are need no checks.
            let (end, check) = if !is_inner {
                (template.len(), Check::Bounds)
            } else if !is_split {
                (template.len(), Check::Nothing)
            } else {
                let inner = [x.inner.start, x.inner.end].map(|v| template.columns_before(v));
                if done < inner[0] {
                    (inner[0], Check::Bounds)
                } else if done < inner[1] {
                    (inner[1], Check::Nothing)
                } else {
                    (template.len(), Check::Bounds)
                }
            };
            let stretch = Stretch {
                columns: done..end,
                check,
            };
            let (written, done) = template.fill(format, patch, row, stretch, self.backend, out);
            filled += written;
            self.at.done += done;
            if self.at.done == template.len() {
                self.at.next_row();
            }
        }
        filled
    }

    /// The same through a sieve.
    fn fill_sifted(&mut self, end: i64, out: &mut [F::Item]) -> usize {
        let Plan {
            sampler, frame, x, ..
        } = &self.plan;
        let Some([_, sieve]) = &mut self.sieve else {
            return 0;
        };
        let (format, patch, base) = (&self.format, &self.patch, self.base);
        let columns = clip(self.band, &x.all);
        let world = World::new(frame, patch);
        let mut filled = 0;
        while self.at.y < end && filled < out.len() {
            let y = self.at.y;
            let Some((class, block)) = locate(sampler, frame, y) else {
                self.at.next_row();
                continue;
            };
            if y >= self.runs_end {
                self.runs_end = end.min(y + TOGETHER);
                sieve.runs(y..self.runs_end, &columns, &mut self.runs);
            }
            if self.runs.is_empty() {
                self.at = Place::row(self.runs_end);
                continue;
            }
            let (listed, vectors) = (&self.columns[class.ordinal()], sampler.row(block));
            let is_under_way = self.at.done > 0;
            let template = self
                .templates
                .get(class, block, is_under_way, |template, kept| {
                    let all = 0..listed.len();
                    template.make(format, base, patch, (listed, all), vectors, kept);
                });
            if let Some(from) = self.at.from.take() {
                self.at.done = self
                    .before
                    .count(class, from.clamp(columns.start, columns.end));
            }
            let row = Row {
                base,
                y: patch.relative(Axis::Y, y),
                lattice: y,
            };
            for run in &self.runs {
                let ends = [run.columns.start, run.columns.end];
                let ends = ends.map(|v| self.before.count(class, v));
                let columns = ends[0].max(self.at.done)..ends[1];
                if columns.is_empty() {
                    continue;
                }
                let (start, out) = (columns.start, &mut out[filled..]);
                let (written, done) = if run.passes {
                    let check = Check::Nothing;
                    let stretch = Stretch { columns, check };
                    template.fill(format, patch, row, stretch, self.backend, out)
                } else {
                    let columns = displaced(patch, &listed[columns], vectors);
                    let passes = |position| sieve.passes(run, world.place(position));
                    sift(format, patch, row, columns, passes, out)
                };
                filled += written;
                self.at.done = start + done;
                if self.at.done < ends[1] {
                    return filled;
                }
            }
            self.at.next_row();
        }
        filled
    }
}

/// The class and the block of a row, if it has points.
pub(super) fn locate(sampler: &Sampler, frame: &Frame, y: i64) -> Option<(Class, usize)> {
    let (x_parity, index) = frame.pattern.visit(Axis::Y, y)?;
    let class = Class {
        x: x_parity,
        y: (y & 1) as u8,
    };
    Some((class, sampler.map().locate(index)))
}

/// Lists the columns of a stretch of the lattice by class.
pub(super) fn list_columns(
    sampler: &Sampler,
    frame: &Frame,
    range: Range<i64>,
    lists: &mut [Listed; 4],
) {
    for list in &mut *lists {
        list.clear();
        // A quarter of all columns at most, where α is largest.
        list.reserve(usize::try_from(range.end.saturating_sub(range.start)).unwrap_or(0) / 4 + 4);
    }
    for x in range {
        if let Some((y_parity, index)) = frame.pattern.visit(Axis::X, x) {
            let class = Class {
                x: (x & 1) as u8,
                y: y_parity,
            };
            lists[class.ordinal()].push((x, sampler.map().locate(index) as u32));
        }
    }
}
