//! The set in a field.

use super::Field;
use crate::{
    sample::{
        lattice::{Keep, Lattice, Placement, Point, PointId},
        member::Member,
        near::Mask,
    },
    table::{Displacement, Ladder},
};

/// The relative change of the share across a local spacing at which half of a move is left. On the table
/// `blue` with 129 intervals, in a Gaussian of 67 spacings, δ_min is 0.05 without damping, 0.10 at 0.1, 0.21 at
/// 0.05, 0.33 at 0.03 and 0.34 at 0.02, where the mean distance falls.
const STEEP: f64 = 0.03;

/// The part of a move that is left at a squared relative change of the share across a local spacing.
fn damping(squared: f64) -> f64 {
    1.0 / (1.0 + squared / (STEEP * STEEP))
}

/// A point set in a field; see [`PointSet::in_field`](crate::PointSet::in_field).
///
/// A point is a pure function of the set, the field and its lattice address. It belongs to the set if its
/// rank is below the field's share at the place where it is at full density. Sets of one seed share their
/// points: in a larger share a point stays, and with a [ladder](crate::table::Ladder) it moves a little. Where
/// the field is steep it moves less: by 1/(1 + (g/0.03)²) of the ladder's move, where g is the relative change
/// of the share across a local spacing, from four more looks at the field around the place.
///
/// ```
/// use strew_core::{PointSet, Region, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let set = PointSet::new(table).seed(7);
/// let glade = set.in_field(|[x, y]: [f64; 2]| ((x - 20.0).hypot(y - 20.0) / 20.0).min(1.0));
/// let region = Region::new([0.0, 0.0], [40.0, 40.0])?;
/// for member in glade.within(region)? {
///     assert_eq!(glade.point(member.id()), Some(member));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Graded<F> {
    /// At full density.
    pub(super) lattice: Lattice,
    pub(super) mask: Mask,
    pub(super) field: F,
    /// What the field is multiplied by: the share of the set.
    pub(super) factor: f64,
}

impl<F: Field> Graded<F> {
    pub(crate) fn new(lattice: &Lattice, mask: &Mask, field: F) -> Self {
        let factor = lattice.placement.keep.get();
        Self {
            lattice: lattice.replaced(lattice.placement.with_keep(Keep::ALL)),
            mask: mask.clone(),
            field,
            factor,
        }
    }

    /// The share at a place, within [0, 1].
    #[inline]
    pub(super) fn share(&self, at: [f64; 2]) -> f64 {
        self.limited(self.field.share(at))
    }

    /// The displacement of a point at a share: the ladder's, less where the field is steep. Where the
    /// share changes much within a local spacing, a point's neighbors have other shares, and have not moved
    /// as the ladder expects.
    #[inline]
    pub(super) fn displacement(
        &self,
        ladder: &Ladder,
        position: usize,
        full: Displacement,
        at: [f64; 2],
        share: f64,
    ) -> Displacement {
        let moved = self
            .lattice
            .turned
            .moved(ladder, ladder.stage(share), position);
        if moved == full {
            return full;
        }
        let part = damping(self.steepness(at, share));
        [0, 1].map(|axis| {
            let by = f64::from(moved[axis]) - f64::from(full[axis]);
            full[axis] + (by * part) as i32
        })
    }

    /// The squared relative change of the share across a local spacing.
    fn steepness(&self, at: [f64; 2], share: f64) -> f64 {
        let half = 0.5 * self.lattice.placement.spacing.get() / libm::sqrt(share);
        let along = |axis: usize| {
            let ends = [-half, half].map(|by| {
                let mut there = at;
                there[axis] += by;
                self.share(there)
            });
            2.0 * (ends[1] - ends[0]) / (ends[0] + ends[1])
        };
        let [x, y] = [along(0), along(1)];
        x * x + y * y
    }

    /// A share of the field within [0, 1], times the factor. NaN becomes 0.
    #[inline]
    pub(super) fn limited(&self, share: f64) -> f64 {
        if share > 0.0 {
            share.min(1.0) * self.factor
        } else {
            0.0
        }
    }

    /// The field.
    ///
    /// ```
    /// use strew_core::{Field, PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).in_field(|_: [f64; 2]| 0.5);
    /// assert_eq!(set.field().share([0.0, 0.0]), 0.5);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn field(&self) -> &F {
        &self.field
    }

    /// The point of an id, or `None` if the set has none there.
    ///
    /// This is the definition of the set, point by point.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let all = PointSet::new(table).seed(7);
    /// let left = all.in_field(|[x, _]: [f64; 2]| if x < 0.0 { 1.0 } else { 0.0 });
    /// for point in all.chunk(8.0, [-1, 0])? {
    ///     assert_eq!(left.point(point.id()), Some(point));
    /// }
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn point(&self, id: PointId) -> Option<Member> {
        let lattice = &self.lattice;
        let [block_x, block_y] = lattice.block(id)?;
        let at = lattice.point(id)?.at();
        let share = self.share(at);
        if lattice.rank(id) >= share {
            return None;
        }
        let full = lattice.vectors(block_y)[block_x];
        let block = block_y * lattice.map().intervals() + block_x;
        let position = lattice.order().position(block);
        let vector = match lattice.table.ladder() {
            Some(ladder) => self.displacement(ladder, position, full, at, share),
            None => full,
        };
        let point = lattice.displaced_point(id, vector);
        let member = Member::new(point, lattice.placement.seed);
        self.has(point).then_some(member)
    }

    /// Whether a point lies in the set's area and clear of other sets.
    pub(super) fn has(&self, point: Point) -> bool {
        let is_plain = self.mask.area.is_none() && self.mask.clear.is_empty();
        is_plain || self.mask.guards().permit(point.at())
    }

    /// Spacing, seed and warp.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).spacing(4.0)?.in_field(|_: [f64; 2]| 0.5);
    /// assert_eq!(set.placement().spacing.get(), 4.0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn placement(&self) -> Placement {
        self.lattice.placement
    }
}
