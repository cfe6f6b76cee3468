//! Templates: what the rows of one class and block of a band have in common.
//!
//! A row's columns with their displacements depend only on the row's class and block, so at most
//! 4·n templates serve all rows of a band. In a tall band they are kept; in a short one, where few
//! rows share one, each row makes its own.

use alloc::{vec, vec::Vec};

use super::{
    Listed, Sampler,
    kernel::{Backend, Columns, Format, Row, warped_row},
    patch::Patch,
};
use crate::pattern::{Axis, Class};

/// The columns of a row.
#[derive(Debug)]
pub(super) struct Template<F: Format> {
    /// Without warp: what a column contributes, for columns that lie in the region.
    columns: Vec<F::Column>,
    /// With warp: all columns, and their displaced x.
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

    /// How many columns there are.
    pub(super) fn len(&self) -> usize {
        self.displacements.len()
    }

    pub(super) fn make(
        &mut self,
        format: &F,
        base: [f64; 2],
        patch: &Patch,
        listed: &Listed,
        vectors: &[[i32; 2]],
    ) {
        self.columns.clear();
        self.lattice.clear();
        self.displaced.clear();
        self.displacements.clear();
        let displaced = listed.iter().map(|&(x, block)| {
            let [dx, dy] = vectors[block as usize];
            (x, patch.relative(Axis::X, x) + dx, dy)
        });
        if patch.shears().is_some() {
            for (x, displaced, dy) in displaced {
                self.lattice.push(x);
                self.displaced.push(displaced);
                self.displacements.push(dy);
            }
        } else {
            for (x, displaced, dy) in displaced {
                if patch.columns_are_inner || patch.holds_along(Axis::X, displaced) {
                    self.columns.push(format.column(base, displaced, x));
                    self.displacements.push(dy);
                }
            }
        }
        self.made = true;
    }

    /// Writes a row's points from column `done` on; gives how many items were written and how many
    /// columns are done with.
    pub(super) fn fill(
        &self,
        format: &F,
        patch: &Patch,
        row: Row,
        done: usize,
        backend: Backend,
        out: &mut [F::Item],
    ) -> (usize, usize) {
        if patch.shears().is_some() {
            return self.fill_warped(format, patch, row, done, backend, out);
        }
        let (columns, displacements) = (&self.columns[done..], &self.displacements[done..]);
        if row.is_inner {
            let written = columns.len().min(out.len());
            format.fill_row(
                backend,
                row,
                &columns[..written],
                &displacements[..written],
                &mut out[..written],
            );
            return (written, written);
        }
        let (mut written, mut done) = (0, 0);
        for (&column, &displacement) in columns.iter().zip(displacements) {
            let y = row.y + displacement;
            if patch.holds_along(Axis::Y, y) {
                let Some(item) = out.get_mut(written) else {
                    break;
                };
                *item = format.item(row.base, column, y, row.lattice);
                written += 1;
            }
            done += 1;
        }
        (written, done)
    }

    fn fill_warped(
        &self,
        format: &F,
        patch: &Patch,
        row: Row,
        done: usize,
        backend: Backend,
        out: &mut [F::Item],
    ) -> (usize, usize) {
        let Some(shears) = patch.shears() else {
            return (0, 0);
        };
        let columns = Columns {
            displaced: &self.displaced[done..],
            displacements: &self.displacements[done..],
            lattice: &self.lattice[done..],
        };
        if row.is_inner && patch.columns_are_inner {
            let written = columns.lattice.len().min(out.len());
            warped_row(format, backend, shears, row, columns, &mut out[..written]);
            return (written, written);
        }
        let (mut written, mut done) = (0, 0);
        for (i, &lattice) in columns.lattice.iter().enumerate() {
            let y = row.y + columns.displacements[i];
            let position = shears.apply(columns.displaced[i], y);
            if patch.holds(position) {
                let Some(out) = out.get_mut(written) else {
                    break;
                };
                let column = format.column(row.base, position[0], lattice);
                *out = format.item(row.base, column, position[1], row.lattice);
                written += 1;
            }
            done += 1;
        }
        (written, done)
    }
}

/// Templates by class and block of the row: all of a tall band's, or only the last.
#[derive(Debug)]
pub(super) struct Templates<F: Format> {
    slots: Vec<Template<F>>,
    intervals: usize,
    kept: bool,
}

impl<F: Format> Templates<F> {
    pub(super) fn new(sampler: &Sampler, kept: bool) -> Self {
        let intervals = sampler.map().intervals();
        let slots = if kept { 4 * intervals } else { 1 };
        let mut templates = Self {
            slots: vec![],
            intervals,
            kept,
        };
        templates.slots.resize_with(slots, Template::new);
        templates
    }

    pub(super) fn forget(&mut self) {
        self.slots.iter_mut().for_each(|slot| slot.made = false);
    }

    /// The template of a row; `same` says that the row is the one asked for last.
    #[inline]
    pub(super) fn get(
        &mut self,
        class: Class,
        block: usize,
        same: bool,
        make: impl FnOnce(&mut Template<F>),
    ) -> &Template<F> {
        let slot = if self.kept {
            class.ordinal() * self.intervals + block
        } else {
            0
        };
        let template = &mut self.slots[slot];
        if !template.made || !(self.kept || same) {
            make(template);
        }
        template
    }
}
