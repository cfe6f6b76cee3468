//! Templates: what the rows of one class and block of a band have in common.
//!
//! A row's columns with their displacements depend only on the row's class and block, so at most
//! 4·n templates serve all rows of a band. In a tall band they are kept; in a short one, where few
//! rows share one, each row makes its own.

use alloc::{vec, vec::Vec};
use core::{mem::take, ops::Range};

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
pub(super) struct Stretch {
    pub(super) columns: Range<usize>,
    pub(super) check: Check,
}

/// What points must satisfy.
#[derive(Clone, Copy, Debug)]
pub(super) enum Check {
    /// Nothing: all of them are asked for.
    Nothing,
    /// The patch's bounds.
    Bounds,
}

/// A column of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Displaced {
    /// Where it is in the lattice.
    lattice: i64,
    /// Its point's x, relative to the patch's origin.
    x: i32,
    /// Its point's vertical displacement.
    dy: i32,
}

/// Listed columns with the vectors of a row's block.
pub(super) fn displaced(
    patch: &Patch,
    listed: &[(i64, u32)],
    vectors: &[[i32; 2]],
) -> impl Iterator<Item = Displaced> {
    listed.iter().map(|&(lattice, block)| {
        let [dx, dy] = vectors[block as usize];
        Displaced {
            lattice,
            x: patch.relative(Axis::X, lattice) + dx,
            dy,
        }
    })
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
        (listed, inner): (&[(i64, u32)], Range<usize>),
        vectors: &[[i32; 2]],
        kept: Kept,
    ) {
        self.columns.clear();
        self.lattice.clear();
        self.displaced.clear();
        self.displacements.clear();
        let is_warped = patch.is_warped();
        let all = kept.has_all(patch);
        if is_warped {
            let columns = displaced(patch, listed, vectors);
            self.displaced.extend(columns.map(|column| column.x));
            let columns = displaced(patch, listed, vectors);
            self.displacements.extend(columns.map(|column| column.dy));
            self.lattice.extend(listed.iter().map(|&(x, _)| x));
        } else {
            let inner = if all { 0..listed.len() } else { inner };
            let room = listed.len();
            let mut made = (take(&mut self.columns), take(&mut self.displacements));
            made.0.reserve(room);
            made.1.reserve(room);
            let column = |column: Displaced| {
                let Displaced { lattice, x, dy } = column;
                (format.column(base, x, lattice), dy)
            };
            let holds = |column: &Displaced| patch.holds_along(Axis::X, column.x);
            let [left, middle, right] = [0..inner.start, inner.clone(), inner.end..room]
                .map(|part| displaced(patch, &listed[part], vectors));
            for (x, dy) in left.filter(holds).map(column) {
                made.0.push(x);
                made.1.push(dy);
            }
            made.extend(middle.map(column));
            for (x, dy) in right.filter(holds).map(column) {
                made.0.push(x);
                made.1.push(dy);
            }
            (self.columns, self.displacements) = made;
            if kept != Kept::Plain {
                let columns = displaced(patch, listed, vectors);
                let held = columns.filter(|column| all || holds(column));
                self.lattice.extend(held.map(|column| column.lattice));
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
        stretch: Stretch,
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
            (Check::Bounds, Some(_)) => {
                let (details, dys) = (self.details(columns.clone()), &self.displacements[columns]);
                let columns = details.lattice.iter().zip(details.displaced).zip(dys);
                let columns = columns.map(|((&lattice, &x), &dy)| Displaced { lattice, x, dy });
                sift(format, patch, row, columns, |p| patch.holds(p), out)
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
}

/// Writes a row of a box without a template, for rows that share theirs with few others: there is
/// room for all of its columns. Those within `inner` are inside along x; `is_inner` rows are along y.
/// Gives how many points were written.
#[inline(always)]
pub(super) fn write_row<F: Format>(
    format: &F,
    patch: &Patch,
    row: Row,
    (listed, inner): (&[(i64, u32)], Range<usize>),
    (vectors, is_inner): (&[[i32; 2]], bool),
    out: &mut [F::Item],
) -> usize {
    let item = |Displaced { lattice, x, dy }: Displaced| {
        let column = format.column(row.base, x, lattice);
        format.item(row.base, column, row.y + dy, row.lattice)
    };
    let inner = if is_inner { inner } else { 0..0 };
    let parts = [0..inner.start, inner.clone(), inner.end..listed.len()];
    let [left, middle, right] = parts.map(|part| displaced(patch, &listed[part], vectors));
    let holds = |column: &Displaced| patch.holds([column.x, row.y + column.dy]);
    let mut written = 0;
    for (out, column) in out.iter_mut().zip(left.filter(holds)) {
        *out = item(column);
        written += 1;
    }
    for (out, column) in out[written..].iter_mut().zip(middle) {
        *out = item(column);
    }
    written += inner.len();
    for (out, column) in out[written..].iter_mut().zip(right.filter(holds)) {
        *out = item(column);
        written += 1;
    }
    written
}

/// Writes those points of some columns of a row whose place, relative to the patch's origin, passes;
/// gives how many, and how many columns are done with: all of them, unless `out` was full before.
pub(super) fn sift<F: Format>(
    format: &F,
    patch: &Patch,
    row: Row,
    columns: impl Iterator<Item = Displaced>,
    passes: impl Fn([i32; 2]) -> bool,
    out: &mut [F::Item],
) -> (usize, usize) {
    let (mut written, mut done) = (0, 0);
    for Displaced { lattice, x, dy } in columns {
        let position = patch.place([x, row.y + dy]);
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

    /// Whether each row makes a template of its own, and only for what it writes.
    pub(super) fn are_plain(&self) -> bool {
        !self.tall && self.kept == Kept::Plain
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
