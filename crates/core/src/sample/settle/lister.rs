//! The points of a box where their ranks left them, many at a time.

use core::ops::Range;

use super::Box2;
use crate::{
    sample::{
        field::{FieldRows, Source},
        kernel::Backend,
        lattice::{BAND_WIDTH, Columns, Found, Grade, Lattice, Patch, PointId, Span, clip_to_band},
    },
    table::fixed,
};

/// The most candidates that are looked at together.
const TOGETHER: usize = 2048;

/// Lists points, with memory of its own.
#[derive(Clone, Debug)]
pub(super) struct Lister {
    /// The points of all kinds.
    pub(super) lattice: Lattice,
    pub(super) grade: Grade,
    pub(super) backend: Backend,
    columns: Columns,
    rows: FieldRows,
}

/// Some points and their shares.
#[derive(Clone, Copy, Debug)]
pub(super) struct Points<'a> {
    pub(super) found: &'a [Found],
    pub(super) shares: &'a [f64],
    address: [i64; 2],
    origin: [i64; 2],
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
    pub(super) fn new(lattice: Lattice, grade: Grade) -> Self {
        Self {
            lattice,
            grade,
            backend: Backend::best(),
            columns: Columns::default(),
            rows: FieldRows::default(),
        }
    }

    /// Calls `visit` for the points that were placed in a box, some at a time, with places from a corner near it.
    pub(super) fn list(
        &mut self,
        within: &Box2,
        corner: [i128; 2],
        mut visit: impl FnMut(Points<'_>),
    ) {
        let Self {
            lattice,
            grade,
            columns,
            rows,
            backend,
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
                    next = rows.list(source, next..end, TOGETHER, *backend);
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
