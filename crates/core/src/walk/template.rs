//! Templates: what the rows of one class and block of a band have in common.
//!
//! The columns of a row, with their displacements, depend only on the class and the block of the row. So
//! at most 4·n templates serve all rows of a band. A tall band keeps them; in a short one, where few rows
//! share a template, each row makes its own.

use alloc::{vec, vec::Vec};
use core::{mem::take, ops::Range};

use crate::{
    kernel::{Backend, Extent, Format, Row, WarpedColumns, add_first_shear},
    lattice::{Lattice, Line, Patch, Span},
    pattern::{Axis, Class},
};

/// The columns of a row.
#[derive(Clone, Debug)]
pub(super) struct Template<F: Format> {
    /// The part of its items that each column decides; without warp only.
    columns: Vec<F::Column>,
    /// The lattice columns, where they are needed: with warp, and where rows begin in the middle.
    lattice: Vec<i64>,
    /// The displaced x of each column, relative to the patch's origin; with warp only.
    displaced: Vec<i32>,
    /// The vertical displacement of each column; with warp also the movement of the first shear, which depends
    /// on the column alone.
    displacements: Vec<i32>,
    /// Bounds of these; with warp only.
    range: [i32; 2],
    /// How far columns are displaced, and how far from each other; with warp only.
    extent: Extent,
    is_made: bool,
}

/// Some columns of a template, and what their points must satisfy.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) columns: Range<usize>,
    pub(super) check: Check,
}

/// The test that points must pass.
#[derive(Clone, Copy, Debug)]
pub(super) enum Check {
    /// Nothing: all are requested.
    Nothing,
    /// The bounds of the patch.
    Bounds,
    /// All lie outside.
    Outside,
}

/// The result of one call: the number of items written, and the number of columns that are done with, which is
/// all of them unless the output was full before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    pub(super) written: usize,
    pub(super) done: usize,
}

/// A displaced column of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Displaced {
    lattice: i64,
    /// The x of its point, relative to the patch's origin.
    x: i32,
    /// The vertical displacement of its point.
    dy: i32,
}

/// Columns with the vectors of a row's block.
pub(super) fn displaced(
    patch: &Patch,
    columns: &[Line],
    vectors: &[[i32; 2]],
) -> impl Iterator<Item = Displaced> {
    columns.iter().map(|column| {
        let [dx, dy] = vectors[column.block as usize];
        Displaced {
            lattice: column.at,
            x: patch.relative(Axis::X, column.at) + dx,
            dy,
        }
    })
}

impl<F: Format> Template<F> {
    fn new() -> Self {
        Self {
            columns: Vec::new(),
            lattice: Vec::new(),
            displaced: Vec::new(),
            displacements: Vec::new(),
            range: [0; 2],
            extent: Extent::default(),
            is_made: false,
        }
    }

    /// The number of columns.
    pub(super) fn len(&self) -> usize {
        self.displacements.len()
    }

    /// The number of columns before a lattice column.
    pub(super) fn columns_before(&self, x: i64) -> usize {
        debug_assert_eq!(self.lattice.len(), self.len(), "the template keeps places");
        self.lattice.partition_point(|&v| v < x)
    }

    /// Makes the template of the columns of a class with the vectors of a block. Those in `inner` lie
    /// inside the region along x.
    pub(super) fn make(
        &mut self,
        (format, base): (&F, [f64; 2]),
        patch: &Patch,
        (columns, inner): (&[Line], Range<usize>),
        vectors: &[[i32; 2]],
        kept: Kept,
        backend: Backend,
    ) {
        self.columns.clear();
        self.lattice.clear();
        self.displaced.clear();
        self.displacements.clear();
        let all = kept.has_all(patch);
        if patch.is_warped() {
            let of_all = || displaced(patch, columns, vectors);
            self.displaced.extend(of_all().map(|column| column.x));
            self.displacements.extend(of_all().map(|column| column.dy));
            self.lattice.extend(columns.iter().map(|column| column.at));
            let [origin, _] = patch.origin();
            self.extent = Extent::new(origin, patch.reach(), &self.lattice);
            if let Some(shears) = patch.shears() {
                let columns = (self.extent, &self.lattice[..]);
                let dys = &mut self.displacements;
                add_first_shear(backend, shears, columns, &self.displaced, dys);
            }
            self.range = bounds(&self.displacements);
        } else {
            let inner = if all { 0..columns.len() } else { inner };
            let room = columns.len();
            let mut made = (take(&mut self.columns), take(&mut self.displacements));
            made.0.reserve(room);
            made.1.reserve(room);
            let column = |column: Displaced| {
                let Displaced { lattice, x, dy } = column;
                (format.column(base, x, lattice), dy)
            };
            let holds = |column: &Displaced| patch.holds_along(Axis::X, column.x);
            let [left, middle, right] = [0..inner.start, inner.clone(), inner.end..room]
                .map(|part| displaced(patch, &columns[part], vectors));
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
            if kept != Kept::Columns {
                let of_all = displaced(patch, columns, vectors);
                let held = of_all.filter(|column| all || holds(column));
                self.lattice.extend(held.map(|column| column.lattice));
            }
        }
        self.is_made = true;
    }

    /// The next columns of a warped row that need one kind of check: those left of the inner columns, the
    /// inner ones, those right of them, or those whose points all lie outside.
    pub(super) fn next_part(&self, done: usize, x: &Span) -> Part {
        let before = |v| self.columns_before(v);
        let parts = [
            (before(x.all.start), Check::Outside),
            (before(x.inner.start), Check::Bounds),
            (before(x.inner.end), Check::Nothing),
            (before(x.all.end), Check::Bounds),
        ];
        let next = parts.into_iter().find(|&(end, _)| done < end);
        let (end, check) = next.unwrap_or((self.len(), Check::Outside));
        Part {
            columns: done..end,
            check,
        }
    }

    /// Writes the points of a part of a row.
    pub(super) fn fill(
        &self,
        format: &F,
        patch: &Patch,
        row: Row,
        part: Part,
        backend: Backend,
        out: &mut [F::Item],
    ) -> Progress {
        let Part { columns, check } = part;
        match (check, patch.shears()) {
            (Check::Nothing, shears) => {
                let written = columns.len().min(out.len());
                let columns = columns.start..columns.start + written;
                let out = &mut out[..written];
                if let Some(shears) = shears {
                    let columns = self.warped(columns);
                    format.fill_warped_row(backend, shears, row, columns, out);
                } else {
                    let dys = &self.displacements[columns.clone()];
                    format.fill_row(backend, row, &self.columns[columns], dys, out);
                }
                Progress {
                    written,
                    done: written,
                }
            }
            (Check::Bounds, Some(shears)) => {
                let dys = &self.displacements[columns.clone()];
                let WarpedColumns {
                    displaced, lattice, ..
                } = self.warped(columns);
                let columns = lattice.iter().zip(displaced).zip(dys);
                let columns = columns.map(|((&lattice, &x), &dy)| Displaced { lattice, x, dy });
                let place = |[x, y]: [i32; 2]| shears.apply_others(x, y);
                sift(format, row, columns, (place, |_, p| patch.holds(p)), out)
            }
            (Check::Outside, _) => Progress {
                written: 0,
                done: columns.len(),
            },
            // Columns outside along x are not in the template.
            (Check::Bounds, None) => self.clip(format, patch, row, columns, out),
        }
    }

    fn warped(&self, columns: Range<usize>) -> WarpedColumns<'_> {
        WarpedColumns {
            extent: self.extent,
            displaced: &self.displaced[columns.clone()],
            displacements: &self.displacements[columns.clone()],
            range: self.range,
            lattice: &self.lattice[columns],
        }
    }

    /// Writes the points within the patch's bounds along y.
    fn clip(
        &self,
        format: &F,
        patch: &Patch,
        row: Row,
        part: Range<usize>,
        out: &mut [F::Item],
    ) -> Progress {
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
        Progress { written, done }
    }
}

/// The least and the greatest of some numbers.
fn bounds(all: &[i32]) -> [i32; 2] {
    let all = all.iter().copied();
    [all.clone().min(), all.max()].map(Option::unwrap_or_default)
}

/// Writes those points of some columns of a row whose column and place pass; `place` is the place of a displaced
/// position, both relative to the patch's origin.
pub(super) fn sift<F: Format>(
    format: &F,
    row: Row,
    columns: impl Iterator<Item = Displaced>,
    (place, passes): (
        impl Fn([i32; 2]) -> [i32; 2],
        impl Fn(i64, [i32; 2]) -> bool,
    ),
    out: &mut [F::Item],
) -> Progress {
    let (mut written, mut done) = (0, 0);
    for Displaced { lattice, x, dy } in columns {
        let position = place([x, row.y + dy]);
        if passes(lattice, position) {
            let Some(out) = out.get_mut(written) else {
                break;
            };
            let column = format.column(row.base, position[0], lattice);
            *out = format.item(row.base, column, position[1], row.lattice);
            written += 1;
        }
        done += 1;
    }
    Progress { written, done }
}

/// The parts of their columns that templates keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kept {
    /// The columns inside the box. Whole rows need no more.
    Columns,
    /// Their lattice coordinates as well, for rows that begin in the middle.
    Places,
    /// Columns outside the box as well, where a sieve decides.
    All,
}

impl Kept {
    /// Whether columns are kept whether they lie inside the box or not.
    fn has_all(self, patch: &Patch) -> bool {
        patch.is_warped() || self == Self::All || patch.columns_are_inner
    }
}

/// The templates of a band by class and block, or only the last one.
#[derive(Clone, Debug)]
pub(super) struct Templates<F: Format> {
    slots: Vec<Template<F>>,
    intervals: usize,
    /// Whether there is a slot for every class and block.
    is_tall: bool,
    kept: Kept,
}

impl<F: Format> Templates<F> {
    pub(super) fn new(lattice: &Lattice, is_tall: bool, kept: Kept) -> Self {
        let intervals = lattice.map().intervals();
        let slots = if is_tall { 4 * intervals } else { 1 };
        let mut templates = Self {
            slots: vec![],
            intervals,
            is_tall,
            kept,
        };
        templates.slots.resize_with(slots, Template::new);
        templates
    }

    /// Drops all templates; their memory is kept.
    pub(super) fn clear(&mut self) {
        self.slots.iter_mut().for_each(|slot| slot.is_made = false);
    }

    /// The lattice column of number `n` of the template of some columns.
    pub(super) fn column<'l>(
        &self,
        patch: &Patch,
        columns: impl Iterator<Item = &'l Line>,
        vectors: &[[i32; 2]],
        n: usize,
    ) -> Option<i64> {
        let all = self.kept.has_all(patch);
        let columns = columns.filter(|column| {
            let displaced = patch.relative(Axis::X, column.at) + vectors[column.block as usize][0];
            all || patch.holds_along(Axis::X, displaced)
        });
        columns.map(|column| column.at).nth(n)
    }

    /// Whether each row makes its own template.
    pub(super) const fn are_short(&self) -> bool {
        !self.is_tall
    }

    /// The template of a row, made if it is not there; `is_same` states that the row is the one of the
    /// last call.
    #[inline]
    pub(super) fn get(
        &mut self,
        class: Class,
        block: usize,
        is_same: bool,
        make: impl FnOnce(&mut Template<F>, Kept),
    ) -> &Template<F> {
        let slot = if self.is_tall {
            class.ordinal() * self.intervals + block
        } else {
            0
        };
        let template = &mut self.slots[slot];
        if !template.is_made || !(self.is_tall || is_same) {
            make(template, self.kept);
        }
        template
    }
}
