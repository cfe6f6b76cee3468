//! Walking a plan: bands of columns, rows within a band, columns within a row.
//!
//! A row's columns with their x and Δy depend only on the row's class and block, so at most 4·n
//! *templates* serve all rows of a band. In a tall band they are kept; in a short one, where few
//! rows share one, each row makes its own.

use alloc::{vec, vec::Vec};
use core::ops::Range;

use super::{
    Frame, Listed, Sampler,
    kernel::{Format, emit},
    plan::Plan,
};
use crate::pattern::{Axis, Class};

/// How many lattice columns a band has. Part of the order of points, so of the algorithm version.
pub(super) const BAND_WIDTH: i64 = 1024;

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
    /// The rows of every band.
    rows: Range<i64>,
    /// The row under way, at the end of `rows` when a new band is due.
    y: i64,
    /// How much of that row's template is done.
    done: usize,
    columns: [Listed; 4],
    templates: Templates<F>,
}

impl<F: Format> Blocks<F> {
    pub(super) fn new(plan: &Plan, tile: Option<&Tile>) -> Self {
        let (bands, rows) = match tile {
            Some(tile) => (tile.band..tile.band + 1, tile.rows.clone()),
            None => (bands(plan), plan.y.all.clone()),
        };
        let kept = rows.end - rows.start >= TALL;
        Self {
            format: F::new(plan),
            plan: plan.clone(),
            bands,
            y: rows.end,
            rows,
            done: 0,
            columns: Default::default(),
            templates: Templates::new(plan.sampler.map().intervals(), kept),
        }
    }

    /// Writes the next points into `out`; gives how many. Fewer than `out` holds, down to 0, only
    /// at the end.
    pub fn fill(&mut self, out: &mut [F::Item]) -> usize {
        let mut filled = 0;
        while filled < out.len() {
            if self.y == self.rows.end && !self.next_band() {
                break;
            }
            filled += self.fill_from_row(&mut out[filled..]);
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
        self.y = self.rows.start;
        self.done = 0;
        true
    }

    /// Writes what is left of the row under way, or as much as there is room for.
    fn fill_from_row(&mut self, out: &mut [F::Item]) -> usize {
        let Plan {
            sampler,
            frame,
            y: span,
            ..
        } = &self.plan;
        let y = self.y;
        let Some((x_parity, index)) = frame.pattern.visit(Axis::Y, y) else {
            self.y += 1;
            return 0;
        };
        let class = Class {
            x: x_parity,
            y: (y & 1) as u8,
        };
        let key = (class, sampler.map().locate(index));
        let template = self.templates.get(key, self.done > 0, |template| {
            template.make(
                &self.plan,
                &self.format,
                &self.columns[class.ordinal()],
                key.1,
            );
        });
        let columns = &template.columns[self.done..];
        let displacements = &template.displacements[self.done..];
        let row = self.format.row(y);
        let (written, done) = if span.inner.contains(&y) {
            let written = columns.len().min(out.len());
            emit(
                &self.format,
                row,
                columns,
                displacements,
                &mut out[..written],
            );
            (written, written)
        } else {
            let (mut written, mut done) = (0, 0);
            for (&column, &displacement) in columns.iter().zip(displacements) {
                if span.holds(y, displacement) {
                    let Some(item) = out.get_mut(written) else {
                        break;
                    };
                    *item = self.format.item(column, row, displacement);
                    written += 1;
                }
                done += 1;
            }
            (written, done)
        };
        self.done += done;
        if self.done == template.columns.len() {
            self.y += 1;
            self.done = 0;
        }
        written
    }
}

/// Lists the columns of a stretch of the lattice by class.
fn list_columns(sampler: &Sampler, frame: &Frame, range: Range<i64>, lists: &mut [Listed; 4]) {
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

/// The columns of a row that lie in the region, with their vertical displacements.
#[derive(Debug)]
struct Template<F: Format> {
    columns: Vec<F::Column>,
    displacements: Vec<i32>,
    made: bool,
}

impl<F: Format> Template<F> {
    const fn new() -> Self {
        Self {
            columns: Vec::new(),
            displacements: Vec::new(),
            made: false,
        }
    }

    fn make(&mut self, plan: &Plan, format: &F, listed: &Listed, block_y: usize) {
        self.columns.clear();
        self.displacements.clear();
        let row = plan.sampler.row(block_y);
        for &(x, block_x) in listed {
            let [dx, dy] = row[block_x as usize];
            if plan.x.holds(x, dx) {
                self.columns.push(format.column(x, dx));
                self.displacements.push(dy);
            }
        }
        self.made = true;
    }
}

/// Templates by class and block of the row: all of a tall band's, or only the last.
#[derive(Debug)]
struct Templates<F: Format> {
    slots: Vec<Template<F>>,
    intervals: usize,
    kept: bool,
}

impl<F: Format> Templates<F> {
    fn new(intervals: usize, kept: bool) -> Self {
        Self {
            slots: vec![],
            intervals,
            kept,
        }
    }

    fn forget(&mut self) {
        self.slots.iter_mut().for_each(|slot| slot.made = false);
    }

    /// The template of a row; `same` says that the row is the one asked for last.
    fn get(
        &mut self,
        (class, block): (Class, usize),
        same: bool,
        make: impl FnOnce(&mut Template<F>),
    ) -> &Template<F> {
        let slot = if self.kept {
            class.ordinal() * self.intervals + block
        } else {
            0
        };
        if self.slots.is_empty() {
            let slots = if self.kept { 4 * self.intervals } else { 1 };
            self.slots.resize_with(slots, Template::new);
        }
        let template = &mut self.slots[slot];
        if !template.made || !(self.kept || same) {
            make(template);
        }
        template
    }
}
