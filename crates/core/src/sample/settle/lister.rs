//! Sets that settle: the points of a box where their ranks left them, many at a time.

use core::ops::Range;

use super::Box2;
use crate::{
    sample::{
        field::{FieldRows, Source},
        kernel::Backend,
        lattice::{BAND_WIDTH, Columns, Found, Grade, Lattice, Patch, PointId, Span, clip_to_band},
    },
    table::{Table, fixed},
};

/// The most candidates that are looked at together.
const TOGETHER: usize = 2048;

/// A set of all kinds whose points settle: one of the plane, or of a torus, by addresses that do not wrap.
pub(crate) trait Settling: Clone {
    fn table(&self) -> &Table;

    /// The kind of a point in the table.
    fn kind_of(&self, id: PointId) -> Option<u8>;

    /// The inverse of the mean spacing at full density, in grid units.
    fn side(&self) -> f64;

    /// The same spacing in world units.
    fn spacing(&self) -> f64;

    /// A fixed-point unit in world units.
    fn step(&self) -> f64;

    /// The least distance of all points at full density, in fixed-point units.
    fn certified(&self) -> f64;

    /// The world coordinates at which the field is looked at for a fixed-point place.
    fn looked_at(&self, place: [i128; 2]) -> [f64; 2];

    /// Calls `visit` for the points of a grade that were placed in a box, some at a time, with places from a corner
    /// near it.
    fn list(
        &mut self,
        within: &Box2,
        corner: [i128; 2],
        by: (&Grade, Backend),
        visit: impl FnMut(Points<'_>),
    );
}

/// Lists points of the plane, with memory of its own.
#[derive(Clone, Debug)]
pub(crate) struct Lister {
    lattice: Lattice,
    columns: Columns,
    rows: FieldRows,
}

/// Some points and their shares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points<'a> {
    pub(crate) found: &'a [Found],
    pub(crate) shares: &'a [f64],
    /// The address of the origin, and its place from the corner in fixed-point units.
    pub(crate) address: [i64; 2],
    pub(crate) origin: [i64; 2],
}

impl Points<'_> {
    #[inline(always)]
    pub(super) fn id(&self, found: &Found) -> PointId {
        let [column, row] = found.address();
        PointId {
            x: self.address[0] + column,
            y: self.address[1] + row,
        }
    }

    /// The place from the corner, in fixed-point units.
    #[inline(always)]
    pub(super) fn offset(&self, found: &Found) -> [i64; 2] {
        let [x, y] = found.place.map(i64::from);
        [self.origin[0] + x, self.origin[1] + y]
    }
}

impl Lister {
    pub(super) fn new(lattice: &Lattice) -> Self {
        Self {
            lattice: lattice.of_all_kinds(),
            columns: Columns::default(),
            rows: FieldRows::default(),
        }
    }
}

impl Settling for Lister {
    fn table(&self) -> &Table {
        &self.lattice.table
    }

    fn kind_of(&self, id: PointId) -> Option<u8> {
        self.lattice.kind_of(id)
    }

    fn side(&self) -> f64 {
        self.lattice.table.alpha().set_side_f64()
    }

    fn spacing(&self) -> f64 {
        self.lattice.placement.spacing.get()
    }

    fn step(&self) -> f64 {
        self.lattice.step
    }

    fn certified(&self) -> f64 {
        self.lattice.certified()
    }

    fn looked_at(&self, place: [i128; 2]) -> [f64; 2] {
        place.map(|k| self.lattice.world(k))
    }

    fn list(
        &mut self,
        within: &Box2,
        corner: [i128; 2],
        (grade, backend): (&Grade, Backend),
        mut visit: impl FnMut(Points<'_>),
    ) {
        let Self {
            lattice,
            columns,
            rows,
        } = self;
        if within.iter().any(Range::is_empty) {
            return;
        }
        let [x, y] = Span::of_box(lattice, within.clone());
        if x.all.is_empty() || y.all.is_empty() {
            return;
        }
        let bands = x.all.start.div_euclid(BAND_WIDTH)..=(x.all.end - 1).div_euclid(BAND_WIDTH);
        for band in bands {
            let range = clip_to_band(band, &x.all);
            columns.list(lattice, range.clone());
            let mut next = y.all.start;
            while next < y.all.end {
                let patch = Patch::new(lattice, band, next, &x, &y);
                let end = y.all.end.min(patch.end());
                rows.clear();
                let address = patch.origin();
                let origin = [0, 1].map(|i| (fixed(address[i]) - corner[i]) as i64);
                while next < end {
                    let source = Source {
                        lattice,
                        grade,
                        patch: &patch,
                        spans: [&x, &y],
                        columns: (columns, &range),
                    };
                    next = rows.list(source, next..end, TOGETHER, backend);
                    let (found, shares) = rows.with_shares();
                    visit(Points {
                        found,
                        shares,
                        address,
                        origin,
                    });
                }
            }
        }
    }
}
