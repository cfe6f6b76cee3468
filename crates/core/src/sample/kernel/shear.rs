//! Rows of a warped plane: each point is moved by itself.

use super::{Backend, Format, Row};
use crate::sample::warp::PatchShears;

/// The columns of a row, all three of the same length.
#[derive(Clone, Copy, Debug)]
pub struct Columns<'a> {
    /// Their displaced x, relative to the patch's origin.
    pub(in crate::sample) displaced: &'a [i32],
    /// Their vertical displacements.
    pub(in crate::sample) displacements: &'a [i32],
    /// Where they are in the lattice.
    pub(in crate::sample) lattice: &'a [i64],
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
impl Columns<'_> {
    /// How many there are, at most `most`.
    pub(super) fn least(&self, most: usize) -> usize {
        let all = self.displaced.len().min(self.displacements.len());
        all.min(self.lattice.len()).min(most)
    }
}

/// Writes one item per column, as many as `out` has room for.
pub(in crate::sample) fn warped_row<F: Format>(
    format: &F,
    backend: Backend,
    shears: &PatchShears,
    row: Row,
    columns: Columns<'_>,
    out: &mut [F::Item],
) {
    let done = format.warp_row(backend, shears, row, columns, out);
    for (i, out) in out.iter_mut().enumerate().skip(done) {
        let y = row.y + columns.displacements[i];
        let [x, y] = shears.apply(columns.displaced[i], y);
        let column = format.column(row.base, x, columns.lattice[i]);
        *out = format.item(row.base, column, y, row.lattice);
    }
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[expect(
    unsafe_code,
    reason = "a backend is only ever made where the machine has it"
)]
pub(super) fn whole_vectors<F: Format>(
    format: &F,
    backend: Backend,
    shears: &PatchShears,
    row: Row,
    columns: Columns<'_>,
    out: &mut [F::Item],
) -> usize {
    match backend {
        Backend::Scalar => 0,
        // SAFETY: `Backend::available` has found the instructions.
        Backend::Avx2 => unsafe { super::avx2::warped_row(format, shears, row, columns, out) },
        // SAFETY: `Backend::available` has found the instructions.
        Backend::Avx512 => unsafe { super::avx512::warped_row(format, shears, row, columns, out) },
    }
}

#[cfg(not(all(feature = "std", target_arch = "x86_64")))]
pub(super) fn whole_vectors<F: Format>(
    _: &F,
    _: Backend,
    _: &PatchShears,
    _: Row,
    _: Columns<'_>,
    _: &mut [F::Item],
) -> usize {
    0
}
