//! Walking a plan: bands of columns, rows within a band, columns within a row.
//!
//! A row's columns with their x and Δy depend only on the row's class and block, so at most 4·n
//! *templates* serve all rows of a band. In a tall band they are kept; in a short one, where few
//! rows share one, each row makes its own.

use alloc::{boxed::Box, vec, vec::Vec};
use core::ops::Range;

use super::{
    Frame, Listed, PointId, Sampler,
    kernel::{Format, emit},
    plan::Plan,
    warped::WarpedTile,
};
use crate::{
    pattern::{Axis, Class},
    table::FRACTION_BITS,
};

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
    /// With warp: the tile under way.
    tile: Option<Box<WarpedTile>>,
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
            tile: None,
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
        let Plan { sampler, frame, .. } = &self.plan;
        let Some((x_parity, index)) = frame.pattern.visit(Axis::Y, self.y) else {
            self.y += 1;
            return 0;
        };
        let class = Class {
            x: x_parity,
            y: (self.y & 1) as u8,
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
        let (written, done) = match &frame.shears {
            None => template.fill_plain(&self.plan, &self.format, self.y, self.done, out),
            Some(shears) => {
                let Plan { x, y, .. } = &self.plan;
                let band = self.bands.start - 1;
                let tile = match &mut self.tile {
                    Some(tile) if tile.covers(band, self.y) => tile,
                    slot => slot.insert(Box::new(WarpedTile::new(shears, band, self.y, x, y))),
                };
                template.fill_warped(tile, &self.plan, &self.format, self.y, self.done, out)
            }
        };
        self.done += done;
        if self.done == template.displacements.len() {
            self.y += 1;
            self.done = 0;
        }
        written
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

/// The columns of a row that lie in the region, with their vertical displacements.
#[derive(Debug)]
struct Template<F: Format> {
    /// Without warp: what a column contributes, for columns that lie in the region.
    columns: Vec<F::Column>,
    /// With warp: all columns, and their displaced x relative to the band's start.
    lattice: Vec<i64>,
    displaced: Vec<i32>,
    /// The vertical displacements, one per column.
    displacements: Vec<i32>,
    made: bool,
}

impl<F: Format> Template<F> {
    const fn new() -> Self {
        Self {
            columns: Vec::new(),
            lattice: Vec::new(),
            displaced: Vec::new(),
            displacements: Vec::new(),
            made: false,
        }
    }

    fn make(&mut self, plan: &Plan, format: &F, listed: &Listed, block_y: usize) {
        self.columns.clear();
        self.lattice.clear();
        self.displaced.clear();
        self.displacements.clear();
        let row = plan.sampler.row(block_y);
        for &(x, block_x) in listed {
            let [dx, dy] = row[block_x as usize];
            if plan.frame.shears.is_some() {
                self.lattice.push(x);
                self.displaced
                    .push(((x.rem_euclid(BAND_WIDTH) as i32) << FRACTION_BITS) + dx);
            } else if plan.x.holds(x, dx) {
                self.columns.push(format.column(x, dx));
            } else {
                continue;
            }
            self.displacements.push(dy);
        }
        self.made = true;
    }

    /// Writes the row's points from column `done` on; gives how many items were written and how
    /// many columns are done with.
    fn fill_plain(
        &self,
        plan: &Plan,
        format: &F,
        y: i64,
        done: usize,
        out: &mut [F::Item],
    ) -> (usize, usize) {
        let (columns, displacements) = (&self.columns[done..], &self.displacements[done..]);
        let row = format.row(y);
        if plan.y.inner.contains(&y) {
            let written = columns.len().min(out.len());
            emit(format, row, columns, displacements, &mut out[..written]);
            return (written, written);
        }
        let (mut written, mut done) = (0, 0);
        for (&column, &displacement) in columns.iter().zip(displacements) {
            if plan.y.holds(y, displacement) {
                let Some(item) = out.get_mut(written) else {
                    break;
                };
                *item = format.item(column, row, displacement);
                written += 1;
            }
            done += 1;
        }
        (written, done)
    }

    /// The same with warp.
    fn fill_warped(
        &self,
        tile: &WarpedTile,
        plan: &Plan,
        format: &F,
        y: i64,
        done: usize,
        out: &mut [F::Item],
    ) -> (usize, usize) {
        let base = format.base(tile.origin);
        let row = tile.relative(Axis::Y, y);
        let displaced = &self.displaced[done..];
        let (lattice, displacements) = (&self.lattice[done..], &self.displacements[done..]);
        let columns = displaced.iter().zip(displacements).zip(lattice);
        let id = |x| PointId { x, y };
        if plan.y.inner.contains(&y) && tile.is_inside(&plan.x) {
            let written = displaced.len().min(out.len());
            for (item, ((&x, &dy), &column)) in out.iter_mut().zip(columns) {
                *item = format.at(base, tile.apply([x, row + dy]), id(column));
            }
            return (written, written);
        }
        let (mut written, mut done) = (0, 0);
        for ((&x, &dy), &column) in columns {
            let position = tile.apply([x, row + dy]);
            if tile.holds(position) {
                let Some(item) = out.get_mut(written) else {
                    break;
                };
                *item = format.at(base, position, id(column));
                written += 1;
            }
            done += 1;
        }
        (written, done)
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
