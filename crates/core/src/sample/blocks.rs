//! Walking a plan: bands of columns, rows within a band, columns within a row.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    Frame, Listed, Sampler,
    kernel::{Backend, Format, Row},
    patch::{BAND_WIDTH, Patch},
    plan::Plan,
    template::Templates,
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
fn bands(plan: &Plan) -> Range<i64> {
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
    /// The row under way, at the end of `rows` when a new band is due.
    y: i64,
    /// How much of that row's template is done.
    done: usize,
    columns: [Listed; 4],
    templates: Templates<F>,
    patch: Patch,
    base: [f64; 2],
    backend: Backend,
}

impl<F: Format> Blocks<F> {
    pub(super) fn new(plan: &Plan, tile: Option<&Tile>) -> Self {
        let (bands, rows) = match tile {
            Some(tile) => (tile.band..tile.band + 1, tile.rows.clone()),
            None => (bands(plan), plan.y.all.clone()),
        };
        let kept = rows.end - rows.start >= TALL;
        let format = F::new(plan);
        let patch = Patch::new(&plan.frame, bands.start, rows.start, &plan.x, &plan.y);
        Self {
            base: format.base(patch.origin()),
            format,
            plan: plan.clone(),
            band: bands.start,
            bands,
            y: rows.end,
            rows,
            done: 0,
            columns: Default::default(),
            templates: Templates::new(&plan.sampler, kept),
            patch,
            backend: Backend::best(),
        }
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
        let mut filled = 0;
        while filled < out.len() {
            if self.y == self.rows.end && !self.next_band() {
                break;
            }
            if self.y == self.patch.end() {
                self.next_patch();
            }
            let end = self.rows.end.min(self.patch.end());
            filled += self.fill_rows(end, &mut out[filled..]);
        }
        filled
    }

    /// Moves to the first row of the next band.
    fn next_band(&mut self) -> bool {
        let Some(band) = self.bands.next() else {
            return false;
        };
        let Plan {
            sampler, frame, x, ..
        } = &self.plan;
        list_columns(sampler, frame, clip(band, &x.all), &mut self.columns);
        self.templates.forget();
        self.band = band;
        self.y = self.rows.start;
        self.done = 0;
        self.next_patch();
        true
    }

    /// Moves to the patch of the row under way.
    fn next_patch(&mut self) {
        let Plan { frame, x, y, .. } = &self.plan;
        self.patch = Patch::new(frame, self.band, self.y, x, y);
        self.base = self.format.base(self.patch.origin());
    }

    /// Writes points of the patch's rows up to `end`, or as many as there is room for.
    fn fill_rows(&mut self, end: i64, out: &mut [F::Item]) -> usize {
        let Plan {
            sampler,
            frame,
            y: span,
            ..
        } = &self.plan;
        let (format, patch, base) = (&self.format, &self.patch, self.base);
        let mut filled = 0;
        while self.y < end && filled < out.len() {
            let y = self.y;
            let Some((x_parity, index)) = frame.pattern.visit(Axis::Y, y) else {
                self.y += 1;
                continue;
            };
            let class = Class {
                x: x_parity,
                y: (y & 1) as u8,
            };
            let block = sampler.map().locate(index);
            let template = self.templates.get(class, block, self.done > 0, |template| {
                let listed = &self.columns[class.ordinal()];
                template.make(format, base, patch, listed, sampler.row(block));
            });
            let row = Row {
                base,
                y: patch.relative(Axis::Y, y),
                lattice: y,
                is_inner: span.inner.contains(&y),
            };
            let (written, done) = template.fill(
                format,
                patch,
                row,
                self.done,
                self.backend,
                &mut out[filled..],
            );
            filled += written;
            self.done += done;
            if self.done == template.len() {
                self.y += 1;
                self.done = 0;
            }
        }
        filled
    }
}

/// Lists the columns of a stretch of the lattice by class.
pub(super) fn list_columns(
    sampler: &Sampler,
    frame: &Frame,
    range: Range<i64>,
    lists: &mut [Listed; 4],
) {
    lists.iter_mut().for_each(Vec::clear);
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
