//! Places as they are before any format rounds them.

use super::format::{Emit, Geometry};
use crate::sample::lattice::PointId;

/// Exact places with their ids, which [`Plan::converted`](crate::Plan::converted) turns into items of any other format.
///
/// The compiler copies the walks for each format that a program uses. A program that must be small uses this one alone.
///
/// ```
/// use strew_core::{Exact, F32, Place, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [3, -2])?;
/// let (mut places, mut offsets) = ([Place::default(); 20], [[0.0; 2]; 20]);
/// plan.blocks::<Exact>().fill(&mut places);
/// plan.blocks_f32().fill(&mut offsets);
/// assert!(plan.converted::<F32>(&places).eq(offsets));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Exact;

/// The exact place of a point of a plan.
///
/// ```
/// use strew_core::{Exact, F64, Place, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(8.0, [3, -2])?;
/// let mut first = [Place::default()];
/// plan.blocks::<Exact>().fill(&mut first);
/// let at = plan.converted::<F64>(&first).next();
/// assert_eq!(at, plan.iter().next().map(|member| member.at()));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Place {
    id: PointId,
    /// The lattice address that `offset` is relative to.
    origin: [i64; 2],
    /// In fixed-point units.
    offset: [i32; 2],
}

impl Place {
    /// The id of the point.
    #[must_use]
    pub const fn id(&self) -> PointId {
        self.id
    }

    /// The item of a format.
    pub(crate) fn item<F: Emit>(&self, format: &F) -> F::Item {
        let base = format.base(self.origin);
        let [x, y] = self.offset;
        format.item(base, format.column(base, x, self.id.x), y, self.id.y)
    }
}

impl Emit for Exact {
    type Item = Place;
    /// The offset along x and the lattice column.
    type Column = (i32, i64);

    fn new(_: &Geometry) -> Self {
        Self
    }

    /// Lattice coordinates are exact in `f64`.
    fn base(&self, origin: [i64; 2]) -> [f64; 2] {
        origin.map(|v| v as f64)
    }

    #[inline]
    fn column(&self, _: [f64; 2], x: i32, column: i64) -> (i32, i64) {
        (x, column)
    }

    #[inline]
    fn item(&self, base: [f64; 2], (x, column): (i32, i64), y: i32, row: i64) -> Place {
        Place {
            id: PointId { x: column, y: row },
            origin: base.map(|v| v as i64),
            offset: [x, y],
        }
    }
}
