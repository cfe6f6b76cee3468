//! The formats, and their rows: compiled here, once for each, and not in every crate that fills blocks of it.

use super::{
    Backend, Exact, F32, F64, Offsets, Points,
    format::{Emit, Row},
    listing::fill_row,
    warped::{WarpedColumns, fill_warped_row},
};
use crate::warp::PatchShears;

/// A format of points: [`F32`](super::F32), [`F64`](super::F64) or [`Points`](super::Points).
///
/// `F::Item` is what a block holds: `[f32; 2]`, `[f64; 2]` or [`Point`](crate::Point). The trait is
/// sealed.
///
/// ```
/// use strew_core::{F32, F64, Format, Plan, PointSet, Points, Table};
///
/// fn first<F: Format>(plan: &Plan) -> F::Item {
///     let mut block = [F::Item::default()];
///     plan.blocks::<F>().fill(&mut block);
///     block[0]
/// }
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [0, 0])?;
/// let [x, y] = first::<F64>(&plan);
/// assert_eq!(first::<F32>(&plan), [x as f32, y as f32]);
/// assert_eq!(first::<Points>(&plan).at(), [x, y]);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub trait Format: Emit {
    /// Writes one item per column of a row, up to the end of the shortest slice.
    #[doc(hidden)]
    fn fill_row(
        &self,
        by: Backend,
        row: Row,
        columns: &[Self::Column],
        displacements: &[i32],
        out: &mut [Self::Item],
    );

    /// Writes one item for each column of a warped row until `out` is full.
    #[doc(hidden)]
    fn fill_warped_row(
        &self,
        by: Backend,
        shears: &PatchShears,
        row: Row,
        columns: WarpedColumns<'_>,
        out: &mut [Self::Item],
    );
}

macro_rules! formats {
    ($($format:ty),*) => {$(
        impl Format for $format {
            fn fill_row(
                &self,
                by: Backend,
                row: Row,
                columns: &[Self::Column],
                displacements: &[i32],
                out: &mut [Self::Item],
            ) {
                fill_row(self, by, row, columns, displacements, out);
            }

            fn fill_warped_row(
                &self,
                by: Backend,
                shears: &PatchShears,
                row: Row,
                columns: WarpedColumns<'_>,
                out: &mut [Self::Item],
            ) {
                fill_warped_row(self, by, shears, row, columns, out);
            }
        }
    )*};
}

formats!(F32, F64, Points, Offsets, Exact);
