//! Sets that settle: the points of a box where their ranks left them, many at a time.

use core::{array::from_fn, fmt::Debug, ops::Range};

use super::Box2;
use crate::{
    field::{FieldRows, Source},
    kernel::Backend,
    lattice::{BAND_WIDTH, Columns, Found, Grade, Lattice, Patch, PointId, Span, clip_to_band},
    table::{Mix, fixed},
};

/// The most candidates that are looked at together.
const TOGETHER: usize = 2048;

/// A set of all kinds whose points settle: one of the plane or of space, or of a torus, by addresses that do not wrap.
pub(crate) trait Settling<const D: usize>: Clone + Debug {
    /// A point of a list.
    type Found: Listed<D>;

    /// The kinds of its table, if it has some.
    fn mix(&self) -> Option<&Mix>;

    /// The kind of a point in the table.
    fn kind_of(&self, address: [i64; D]) -> Option<u8>;

    /// The inverse of the mean spacing at full density, in grid units.
    fn side(&self) -> f64;

    /// The same spacing in world units.
    fn spacing(&self) -> f64;

    /// A fixed-point unit in world units.
    fn step(&self) -> f64;

    /// The least distance of all points at full density, in fixed-point units.
    fn certified(&self) -> f64;

    /// The world coordinates at which the field is looked at for a fixed-point place.
    fn looked_at(&self, place: [i128; D]) -> [f64; D];

    /// Calls `visit` for the points of a grade that were placed in a box, some at a time, with places from a corner
    /// near it.
    fn list(
        &mut self,
        within: &[Range<i128>; D],
        corner: [i128; D],
        by: (&Grade<D>, Backend),
        visit: &mut dyn FnMut(List<'_, Self::Found, D>),
    );
}

/// A point by its offsets from those of a list.
pub(crate) trait Listed<const D: usize> {
    /// The lattice coordinates.
    fn address(&self) -> [i64; D];

    /// The place in fixed-point units.
    fn place(&self) -> [i32; D];
}

impl Listed<2> for Found {
    #[inline(always)]
    fn address(&self) -> [i64; 2] {
        Found::address(*self)
    }

    #[inline(always)]
    fn place(&self) -> [i32; 2] {
        self.place
    }
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
pub(crate) struct List<'a, F, const D: usize> {
    pub(crate) found: &'a [F],
    pub(crate) shares: &'a [f64],
    /// The address of the origin, and its place from the corner in fixed-point units.
    pub(crate) address: [i64; D],
    pub(crate) origin: [i64; D],
}

impl<F: Listed<D>, const D: usize> List<'_, F, D> {
    #[inline(always)]
    pub(super) fn address(&self, found: &F) -> [i64; D] {
        let offset = found.address();
        from_fn(|i| self.address[i] + offset[i])
    }

    /// The place from the corner, in fixed-point units.
    #[inline(always)]
    pub(super) fn offset(&self, found: &F) -> [i64; D] {
        let place = found.place();
        from_fn(|i| self.origin[i] + i64::from(place[i]))
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

impl Settling<2> for Lister {
    type Found = Found;

    fn mix(&self) -> Option<&Mix> {
        self.lattice.table.mix()
    }

    fn kind_of(&self, [x, y]: [i64; 2]) -> Option<u8> {
        self.lattice.kind_of(PointId { x, y })
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
        visit: &mut dyn FnMut(List<'_, Found, 2>),
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
                    visit(List {
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
