//! Plans: the points of a request, counted.

use alloc::{sync::Arc, vec, vec::Vec};

use super::{
    Batch, Region, Volume,
    blocks::{Blocks, Members},
    count,
    format::Format,
    lattice::Lattice,
    mask::Mask,
    point::{Point, PointId},
    scope::Scope,
    table::Table,
};
use crate::{
    F32, F64, Placement, Points, error::Error, methods::planned, stop::Stop, window::Window,
};

/// The points of a volume, counted exactly before the first is made.
///
/// Points come in an order of their own: columns of 1024 × 1024 lattice units by x, then y; in a column planes by z, in a
/// plane rows by y, in a row points by x, all of them by their lattice addresses.
///
/// ```
/// use strew_core::space::{Ball, SpaceSet, Table};
///
/// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
/// let plan = set.within(Ball::new([0.0; 3], 9.0)?)?;
/// assert_eq!(plan.iter().count() as u128, plan.count());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) scope: Arc<Scope>,
    pub(super) window: Window<PointId>,
    /// All points of the request, if they are few.
    pub(super) kept: Option<Arc<Batch>>,
}

impl Plan {
    /// The plan of a volume, which is counted unless its count is known.
    pub(super) fn new(
        lattice: &Lattice,
        mask: &Mask,
        volume: Volume,
        stop: Stop,
        total: Option<u128>,
    ) -> Result<Self, Error> {
        let scope = Arc::new(Scope::new(lattice, mask, &volume, stop)?);
        let mut kept = None;
        let total = match total {
            Some(total) => total,
            None if scope.is_small() => {
                let points = count::keep(&scope);
                let count = points.len() as u128;
                kept = Some(Arc::new(points));
                count
            }
            None => count::count(&scope, &scope.all),
        };
        if scope.stop.is_raised() {
            return Err(Stop::error());
        }
        Ok(Self {
            scope,
            window: Window::whole(total),
            kept,
        })
    }

    /// The points in a format, block by block.
    ///
    /// ```
    /// use strew_core::{F64, space::{SpaceSet, Table}};
    ///
    /// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(4.0, [0, 0, 0])?;
    /// let mut block = [[0.0; 3]; 10];
    /// assert_eq!(plan.blocks::<F64>().fill(&mut block), 10);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn blocks<F: Format>(&self) -> Blocks<F> {
        let Window {
            start,
            offset,
            count,
            total,
        } = self.window;
        let blocks = match &self.kept {
            Some(kept) => {
                let points = offset as usize..(offset + count) as usize;
                Blocks::kept(self.scope.clone(), kept.clone(), points)
            }
            None => Blocks::walk(self.scope.clone(), start.map(PointId::lattice), count),
        };
        blocks.of(offset, total)
    }

    /// The points, one by one.
    #[must_use]
    pub fn iter(&self) -> Members {
        Members::new(self.blocks())
    }

    /// The plan with a flag that stops counting and making points, in place of the one it had. Once it is raised, blocks
    /// end early.
    ///
    /// ```
    /// use strew_core::{server::Stop, space::{SpaceSet, Table}};
    ///
    /// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(99.0, [0, 0, 0])?;
    /// let stop = Stop::new();
    /// stop.raise();
    /// assert!((plan.stopped_by(stop).to_vec().len() as u128) < 99 * 99 * 99);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn stopped_by(mut self, stop: Stop) -> Self {
        self.scope = Arc::new(Scope {
            stop,
            ..(*self.scope).clone()
        });
        self
    }
}

planned!(
    Plan,
    Table,
    3,
    "strew_core::space::SpaceSet::new(strew_core::space::Table::undisplaced(\"sqrt(3)\".parse()?, 5, \"pattern\")?).chunk(20.0, [0, 0, 0])?"
);
