//! Points with ids.

use super::{
    F64, Format,
    format::{Emit, Geometry, Row},
    lanes::{Lanes, stored},
    rows::vector_starts,
};
use crate::sample::lattice::{Point, PointId};

/// Points with ids, in `f64` world coordinates.
///
/// ```
/// use strew_core::{Point, PointSet, Points, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [3, -2])?;
/// let mut block = [Point::default(); 100];
/// let filled = plan.blocks::<Points>().fill(&mut block);
/// assert_eq!(block[..filled], plan.to_vec());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Points(pub(super) F64);

impl Format for Points {}

impl Emit for Points {
    type Item = Point;
    /// The lattice column, and the bits of x.
    type Column = [u64; 2];

    fn new(geometry: &Geometry) -> Self {
        Self(F64::new(geometry))
    }

    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        self.0.base(origin)
    }

    #[inline(always)]
    fn column(&self, base: [f64; 2], x: i32, column: i64) -> [u64; 2] {
        [column as u64, self.0.place(base[0], x).to_bits()]
    }

    #[inline(always)]
    fn item(&self, base: [f64; 2], [column, x]: [u64; 2], y: i32, row: i64) -> Point {
        Point {
            id: PointId {
                x: column as i64,
                y: row,
            },
            x: f64::from_bits(x),
            y: self.0.place(base[1], y),
        }
    }

    #[inline(always)]
    unsafe fn vector_row<L: Lanes>(
        &self,
        row: Row,
        columns: &[[u64; 2]],
        displacements: &[i32],
        out: &mut [Point],
    ) -> usize {
        let length = out.len().min(columns.len()).min(displacements.len());
        if !L::HAS_POINTS || length < L::WIDTH {
            return 0;
        }
        // SAFETY: the machine has the instructions, and WIDTH values from `i` on lie within all slices.
        unsafe {
            for i in vector_starts::<L>(length) {
                let offsets = L::offsets(displacements.as_ptr().add(i), row.y);
                let y = self.0.places::<L>(row.base[1], offsets);
                let (to, columns) = (out.as_mut_ptr().add(i), columns.as_ptr().add(i));
                L::store_points(to, columns, row.lattice, y);
            }
        }
        length
    }

    #[inline(always)]
    unsafe fn vector_items<L: Lanes>(
        &self,
        row: Row,
        [x, y]: [L::Ints; 2],
        lattice: &[i64],
        out: &mut [Point],
    ) {
        // SAFETY: the machine has the instructions.
        let [xs, ys] = [x, y].map(|v| unsafe { stored::<L>(v) });
        let lanes = xs.into_iter().zip(ys).zip(lattice);
        for (out, ((x, y), &column)) in out.iter_mut().zip(lanes) {
            let column = self.column(row.base, x, column);
            *out = self.item(row.base, column, y, row.lattice);
        }
    }
}
