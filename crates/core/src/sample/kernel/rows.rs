//! Rows without warp.

use super::{
    Backend,
    backend::run_vectors,
    format::{Emit, Row},
    lanes::{Lanes, VectorLoop},
};

/// The starts of vectors that cover `length` items, or none if there are fewer than fill a vector. The
/// last vector goes back over items that are already written.
#[inline(always)]
pub(super) fn vector_starts<L: Lanes>(length: usize) -> impl Iterator<Item = usize> {
    let last = length.checked_sub(L::WIDTH);
    let ends = last.map_or(0, |_| length);
    (0..ends)
        .step_by(L::WIDTH)
        .map(move |i| i.min(last.unwrap_or(0)))
}

/// Writes one item per column by plain code: the definition.
#[inline(always)]
pub(super) fn emit<F: Emit>(
    format: &F,
    row: Row,
    columns: &[F::Column],
    displacements: &[i32],
    out: &mut [F::Item],
) {
    for ((item, &column), &displacement) in out.iter_mut().zip(columns).zip(displacements) {
        *item = format.item(row.base, column, row.y + displacement, row.lattice);
    }
}

/// Writes one item per column of a row, up to the end of the shortest slice.
#[inline]
pub(crate) fn fill_row<F: Emit>(
    format: &F,
    backend: Backend,
    row: Row,
    columns: &[F::Column],
    displacements: &[i32],
    out: &mut [F::Item],
) {
    let mut plain = PlainRow {
        format,
        row,
        columns,
        displacements,
        out,
    };
    if run_vectors(backend, &mut plain) == 0 {
        emit(format, row, columns, displacements, plain.out);
    }
}

struct PlainRow<'a, F: Emit> {
    format: &'a F,
    row: Row,
    columns: &'a [F::Column],
    displacements: &'a [i32],
    out: &'a mut [F::Item],
}

impl<F: Emit> VectorLoop for PlainRow<'_, F> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let (columns, displacements) = (self.columns, self.displacements);
        // SAFETY: as the caller ensures.
        unsafe {
            self.format
                .vector_row::<L>(self.row, columns, displacements, self.out)
        }
    }
}
