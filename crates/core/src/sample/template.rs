//! Templates: what the rows of one class and block of a band have in common.
//!
//! A row's columns with their displacements depend only on the row's class and block, so at most
//! 4·n templates serve all rows of a band. In a tall band they are kept; in a short one, where few
//! rows share one, each row makes its own.

use alloc::{vec, vec::Vec};
use core::ops::Range;

use super::{
    Listed, Sampler,
    kernel::{Backend, Columns, Format, Row, warped_row},
    patch::Patch,
};
use crate::pattern::{Axis, Class};

/// The columns of a row.
#[derive(Debug)]
pub(super) struct Template<F: Format> {
    /// What a column contributes; without warp only.
    columns: Vec<F::Column>,
    /// The lattice columns, where they are needed: with warp, for their displaced x, and wherever
    /// parts of a row are asked for.
    lattice: Vec<i64>,
    displaced: Vec<i32>,
    /// The vertical displacements, one per column.
    displacements: Vec<i32>,
    made: bool,
}

/// Some columns of a template and what their points must satisfy.
#[derive(Debug)]
pub(super) struct Stretch<'a> {
    pub(super) columns: Range<usize>,
    pub(super) check: Check<'a>,
}

/// What points must satisfy.
#[derive(Clone, Copy)]
pub(super) enum Check<'a> {
    /// Nothing: all of them are asked for.
    Nothing,
    /// The patch's bounds.
    Bounds,
    /// A test of their place, relative to the patch's origin.
    Each(&'a dyn Fn([i32; 2]) -> bool),
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

    /// How many lie before a lattice column.
    pub(super) fn columns_before(&self, x: i64) -> usize {
        debug_assert_eq!(self.lattice.len(), self.len(), "made in part");
        self.lattice.partition_point(|&v| v < x)
    }

    pub(super) fn make(
        &mut self,
        format: &F,
        base: [f64; 2],
        patch: &Patch,
        listed: &Listed,
        vectors: &[[i32; 2]],
        kept: Kept,
    ) {
        self.columns.clear();
        self.lattice.clear();
        self.displaced.clear();
        self.displacements.clear();
        let is_warped = patch.is_warped();
        let all = kept.has_all(patch);
        let detailed = is_warped || kept != Kept::Plain;
        let displaced = |&(x, block): &(i64, u32)| {
            let [dx, dy] = vectors[block as usize];
            (x, patch.relative(Axis::X, x) + dx, dy)
        };
        if all {
            let displaced = || listed.iter().map(displaced);
            if !is_warped {
                let columns = displaced().map(|(x, at, _)| format.column(base, at, x));
                self.columns.extend(columns);
            }
            if detailed {
                self.lattice.extend(listed.iter().map(|&(x, _)| x));
                self.displaced.extend(displaced().map(|(_, at, _)| at));
            }
            self.displacements.extend(displaced().map(|(_, _, dy)| dy));
        } else {
            for (x, at, dy) in listed.iter().map(displaced) {
                if patch.holds_along(Axis::X, at) {
                    self.columns.push(format.column(base, at, x));
                    self.displacements.push(dy);
                    if detailed {
                        self.lattice.push(x);
                        self.displaced.push(at);
                    }
                }
            }
        }
        self.made = true;
    }

    /// Writes points of a row's stretch; gives how many items were written and how many columns are
    /// done with: all of them, unless `out` was full before.
    pub(super) fn fill(
        &self,
        format: &F,
        patch: &Patch,
        row: Row,
        stretch: Stretch<'_>,
        backend: Backend,
        out: &mut [F::Item],
    ) -> (usize, usize) {
        let Stretch { columns, check } = stretch;
        match (check, patch.shears()) {
            (Check::Nothing, shears) => {
                let written = columns.len().min(out.len());
                let part = columns.start..columns.start + written;
                let out = &mut out[..written];
                match shears {
                    Some(shears) => {
                        warped_row(format, backend, shears, row, self.details(part), out);
                    }
                    None => format.fill_row(
                        backend,
                        row,
                        &self.columns[part.clone()],
                        &self.displacements[part],
                        out,
                    ),
                }
                (written, written)
            }
            (Check::Bounds, Some(shears)) => {
                let place = |x, y| shears.apply(x, y);
                self.sift(format, row, columns, place, |p| patch.holds(p), out)
            }
            (Check::Each(passes), Some(shears)) => {
                let place = |x, y| shears.apply(x, y);
                self.sift(format, row, columns, place, passes, out)
            }
            (Check::Each(passes), None) => {
                self.sift(format, row, columns, |x, y| [x, y], passes, out)
            }
            // Columns outside have no place in the template.
            (Check::Bounds, None) => self.clip(format, patch, row, columns, out),
        }
    }

    fn details(&self, part: Range<usize>) -> Columns<'_> {
        Columns {
            displaced: &self.displaced[part.clone()],
            displacements: &self.displacements[part.clone()],
            lattice: &self.lattice[part],
        }
    }

    /// Points within the patch's bounds along y.
    fn clip(
        &self,
        format: &F,
        patch: &Patch,
        row: Row,
        part: Range<usize>,
        out: &mut [F::Item],
    ) -> (usize, usize) {
        let (mut written, mut done) = (0, 0);
        let columns = &self.columns[part.clone()];
        for (&column, &displacement) in columns.iter().zip(&self.displacements[part]) {
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

    /// Points whose place passes.
    fn sift(
        &self,
        format: &F,
        row: Row,
        part: Range<usize>,
        place: impl Fn(i32, i32) -> [i32; 2],
        passes: impl Fn([i32; 2]) -> bool,
        out: &mut [F::Item],
    ) -> (usize, usize) {
        let (mut written, mut done) = (0, 0);
        let columns = self.details(part);
        for (i, &lattice) in columns.lattice.iter().enumerate() {
            let position = place(columns.displaced[i], row.y + columns.displacements[i]);
            if passes(position) {
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

impl core::fmt::Debug for Check<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Nothing => "Nothing",
            Self::Bounds => "Bounds",
            Self::Each(_) => "Each",
        })
    }
}

/// What templates keep of their columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kept {
    /// What whole rows of a box need.
    Plain,
    /// Also where columns are, for rows that begin in the middle.
    Places,
    /// Columns outside the box, too: a sieve decides.
    All,
}

impl Kept {
    /// Whether all columns are kept, whether they are inside the box or not.
    fn has_all(self, patch: &Patch) -> bool {
        patch.is_warped() || self == Self::All || patch.columns_are_inner
    }
}

/// Templates by class and block of the row: all of a tall band's, or only the last.
#[derive(Debug)]
pub(super) struct Templates<F: Format> {
    slots: Vec<Template<F>>,
    intervals: usize,
    /// Whether there is a slot for every class and block.
    tall: bool,
    kept: Kept,
}

impl<F: Format> Templates<F> {
    pub(super) fn new(sampler: &Sampler, tall: bool, kept: Kept) -> Self {
        let intervals = sampler.map().intervals();
        let slots = if tall { 4 * intervals } else { 1 };
        let mut templates = Self {
            slots: vec![],
            intervals,
            tall,
            kept,
        };
        templates.slots.resize_with(slots, Template::new);
        templates
    }

    pub(super) fn forget(&mut self) {
        self.slots.iter_mut().for_each(|slot| slot.made = false);
    }

    /// The lattice column of number `n` of the template that is made of these.
    pub(super) fn column(
        &self,
        patch: &Patch,
        listed: &Listed,
        vectors: &[[i32; 2]],
        n: usize,
    ) -> Option<i64> {
        let all = self.kept.has_all(patch);
        let columns = listed.iter().filter(|&&(x, block)| {
            let displaced = patch.relative(Axis::X, x) + vectors[block as usize][0];
            all || patch.holds_along(Axis::X, displaced)
        });
        columns.map(|column| column.0).nth(n)
    }

    /// The template of a row; `same` says that the row is the one asked for last.
    #[inline]
    pub(super) fn get(
        &mut self,
        class: Class,
        block: usize,
        same: bool,
        make: impl FnOnce(&mut Template<F>, Kept),
    ) -> &Template<F> {
        let slot = if self.tall {
            class.ordinal() * self.intervals + block
        } else {
            0
        };
        let template = &mut self.slots[slot];
        if !template.made || !(self.tall || same) {
            make(template, self.kept);
        }
        template
    }
}
