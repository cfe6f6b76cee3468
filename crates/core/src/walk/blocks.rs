//! The points of a plan, block by block.
//!
//! # The order
//!
//! A plan covers a rectangle of lattice addresses, its scope. The rectangle is cut into *bands* of 1024 columns and
//! each band into *patches* of 256 rows. The walk visits bands from left to right, in a band the rows from bottom to
//! top, and in a row the columns from left to right:
//!
//! ```text
//!          band 0         band 1     band 2
//!       ┌──────────────┬──────────────┬─────
//!       │ ⋮            │ ⋮            │ ⋮
//!  512  ├──────────────┼──────────────┼─────
//!       │ 4 → → → → →  │ 9 → → → → →  │
//!       │ 3 → → → → →  │ 8 → → → → →  │       a patch: rows 256 to 511 of band 0
//!  256  ├──────────────┼──────────────┼─────
//!       │ 2 → → → → →  │ 7 → → → → →  │
//!       │ 1 → → → → →  │ 6 → → → → →  │
//!    0  └──────────────┴──────────────┴─────
//!       0            1024           2048
//! ```
//!
//! Bands and patches lie at multiples of their sizes, so the order of two points does not depend on the plan, and
//! the points of a part of an area come in the order that they have in the whole. Two more things follow. Positions
//! relative to the corner of a patch fit 32 bits, which vectors of integers need. And a place in the order is an
//! address: a walk that ends can be resumed at it without counting ([`Cursor`]).
//!
//! # The idea
//!
//! Nothing is searched and few candidates are rejected. The pattern is a union of products of columns and rows: a row
//! has points only if its own index dY lies in the set region, and then its *class* (the parities of row and column)
//! says which columns hold its points. The displacement of a point depends on the interval of its dX and that of its
//! dY. So all rows of a band that share class and interval of dY are the same list of columns with the same vectors,
//! moved up by y. `template` has that list: a band needs at most 4·n of them, and most rows are copies.
//!
//! # The walks
//!
//! - [`RowWalk`] goes row by row. It makes the points of boxes, warped or not, and of areas, and costs time in
//!   proportion to the points and the rows.
//! - [`FieldWalk`] goes patch by patch, since a field decides point by point which of them are left.
//! - [`SettledWalk`] goes by pieces of some rows, since points that settle need those around them.
//! - [`Kept`] has no walk at all: small plans keep the points that counting has found.
//!
//! The scope and the count decide which it is, once. The bits of a point never depend on it.
//!
//! # What holds between calls
//!
//! - The items of a block are those that one large block would have at the same places: `fill` may stop
//!   anywhere, also within a row, and goes on there.
//! - A walk makes points no faster than blocks take them. It holds the columns of one band, the templates of
//!   one band and at most some thousand found points, whatever the size of the plan.
//! - It owns its state, so it can move between threads from block to block.

use alloc::{boxed::Box, sync::Arc};

#[cfg(feature = "fields")]
use super::graded::FieldWalk;
use super::{
    bands::{Bands, Tile, format_of},
    few::{Few, Kept},
    rows::RowWalk,
    scope::Scope,
    settled::{Pieces, SettledWalk},
};
use crate::{
    kernel::{Backend, Format},
    lattice::PointId,
    window::{Cursor, Window},
};

/// The points of a plan, or of one of its tiles, in order, in blocks of any size.
///
/// It owns all it needs, so it can move between threads from block to block.
///
/// ```
/// use strew_core::{PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(10.0, [0, 0])?;
/// let (mut blocks, mut block) = (plan.blocks_f32(), [[0.0; 2]; 512]);
/// assert_eq!(blocks.fill(&mut block) as u128, plan.count());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Blocks<F: Format> {
    scope: Arc<Scope>,
    /// The part of the scope that is walked; `None` for a tile.
    window: Option<Window<PointId>>,
    /// The number of points still to come.
    left: u128,
    format: F,
    walk: Walk<F>,
}

/// The ways to the next points.
#[derive(Clone, Debug)]
enum Walk<F: Format> {
    /// The points were found when they were counted.
    Kept(Kept),
    Rows(Box<RowWalk<F>>),
    #[cfg(feature = "fields")]
    Field(Box<FieldWalk<F>>),
    Settled(Box<SettledWalk>),
}

impl<F: Format> Walk<F> {
    /// A walk over some bands from an address on, or from the first one.
    fn new(bands: Bands, start: Option<PointId>) -> Self {
        match bands.scope.lattice.grade {
            #[cfg(feature = "fields")]
            Some(_) => Self::Field(Box::new(FieldWalk::new(bands, start))),
            _ => Self::Rows(Box::new(RowWalk::new(bands, start))),
        }
    }
}

impl<F: Format> Blocks<F> {
    /// The points of a window.
    pub(crate) fn of_window(scope: Arc<Scope>, window: Window<PointId>) -> Self {
        let walk = match Pieces::new(&scope) {
            Some(pieces) => Walk::Settled(Box::new(SettledWalk::from(pieces, window.start))),
            None => Walk::new(Bands::from(scope.clone(), window.start), window.start),
        };
        Self {
            format: format_of(&scope),
            scope,
            window: Some(window),
            left: window.count,
            walk,
        }
    }

    /// The points of a window, which were kept when they were counted.
    pub(crate) fn of_kept(scope: Arc<Scope>, window: Window<PointId>, kept: Arc<Few>) -> Self {
        Self {
            walk: Walk::Kept(Kept::new(kept, window.offset as usize)),
            format: format_of(&scope),
            scope,
            window: Some(window),
            left: window.count,
        }
    }

    /// The points of a tile.
    pub(crate) fn of_tile(scope: Arc<Scope>, tile: &Tile) -> Self {
        let walk = match Pieces::new(&scope) {
            Some(pieces) => Walk::Settled(Box::new(SettledWalk::of_tile(pieces, tile))),
            None => Walk::new(Bands::of_tile(scope.clone(), tile), None),
        };
        Self {
            walk,
            format: format_of(&scope),
            scope,
            window: None,
            left: u128::MAX,
        }
    }

    /// Fills rows by a backend other than the machine's best. The points have the same bits.
    #[must_use]
    pub fn with_backend(mut self, backend: Backend) -> Self {
        // Points that were kept were found by the best one.
        if let (Walk::Kept(_), Some(window)) = (&self.walk, self.window)
            && self.left == window.count
        {
            self = Self::of_window(self.scope, window);
        }
        match &mut self.walk {
            Walk::Kept(kept) => kept.backend = backend,
            Walk::Rows(walk) => walk.bands.backend = backend,
            #[cfg(feature = "fields")]
            Walk::Field(walk) => walk.set_backend(backend),
            Walk::Settled(walk) => walk.set_backend(backend),
        }
        self
    }

    /// Writes the next points into `out`. Returns the number written; fewer than `out` holds, down to 0,
    /// only at the end.
    pub fn fill(&mut self, out: &mut [F::Item]) -> usize {
        let most = usize::try_from(self.left).map_or(out.len(), |left| left.min(out.len()));
        let out = &mut out[..most];
        let format = &self.format;
        let filled = match &mut self.walk {
            Walk::Kept(kept) => kept.fill(format, out),
            Walk::Rows(walk) => walk.fill(format, out),
            #[cfg(feature = "fields")]
            Walk::Field(walk) => walk.fill(format, out),
            Walk::Settled(walk) => walk.fill(format, out),
        };
        self.left -= filled as u128;
        filled
    }

    /// The place after the points written so far, found without counting. `None` for a tile, whose
    /// place in the order is unknown, and for a plan without points, which has no place to resume from.
    ///
    /// Its lattice address lies after that of the last point written, and may lie before that of the
    /// next.
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        let window = self.window.filter(|window| window.count > 0)?;
        let at = match &self.walk {
            Walk::Kept(kept) => kept.place()?,
            Walk::Rows(walk) => walk.place().unwrap_or_else(|| walk.bands.next_start()),
            #[cfg(feature = "fields")]
            Walk::Field(walk) => walk.place(),
            Walk::Settled(walk) => walk.place(),
        };
        Some(Cursor {
            offset: window.offset + (window.count - self.left),
            total: window.total,
            at,
        })
    }
}
