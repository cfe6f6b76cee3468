//! Plans: requests made ready, before any point is made, and windows of them.

pub(crate) mod amount;
#[cfg(test)]
mod chunks;
pub(crate) mod member;
pub(crate) mod seek;

use alloc::{sync::Arc, vec, vec::Vec};

use crate::{
    attribute::{Attributes, BoundAttributes},
    error::Error,
    kernel::{F32, F64, Format, Place, Points},
    lattice::{Keep, Lattice, Placement, Point, PointId, Spacing},
    methods::{planned, windows},
    near::Mask,
    shape::{Area, Region},
    stop::Stop,
    table::Table,
    walk::{Blocks, Counted, Mark, Tile, format_of, locate_graded, scope::Scope, tiles},
    window::{Cursor, Window, Windowed},
};
use member::Members;
use seek::locate_all;

/// The points of a set in an area: their exact number is known, the points come on demand, in a fixed
/// order.
///
/// The order: bands of 1024 lattice columns at multiples of 1024, ascending; in a band rows ascending; in
/// a row columns ascending. It is the same whatever the area, so the points of a part of an area come in
/// the order they have in the whole.
///
/// A plan may be a [window](Self::window) of the requested points: those from a place in the order on, up
/// to a number. Plans are cheap to clone and can be sent between threads.
///
/// ```
/// use strew_core::{PointSet, Region, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).within(Region::new([0.0, 0.0], [20.0, 10.0])?)?;
/// assert_eq!(plan.iter().len() as u128, plan.count());
/// for member in &plan {
///     let [x, y] = member.at();
///     assert!((0.0..20.0).contains(&x) && (0.0..10.0).contains(&y));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Plan {
    scope: Arc<Scope>,
    window: Window<PointId>,
    /// The results of counting.
    counted: Counted,
}

impl Plan {
    /// The points of a set, given by its lattice and mask, in an area. They are counted unless their
    /// number is known.
    pub(crate) fn new(
        lattice: &Lattice,
        mask: &Mask,
        area: Area,
        stop: Stop,
        known: Option<u128>,
    ) -> Result<Self, Error> {
        let scope = Arc::new(Scope::new(lattice, mask, area, stop)?);
        let counted = match known {
            Some(count) => Counted::known(count),
            None => Counted::new(&scope),
        };
        if scope.stop.is_raised() {
            return Err(Stop::error());
        }
        Ok(Self {
            scope,
            window: Window::whole(counted.count),
            counted,
        })
    }

    /// The points, one by one.
    #[must_use]
    pub fn iter(&self) -> Members {
        Members::new(self.blocks(), self.window.count, self.placement().seed)
    }

    /// The points in one of the formats [`F32`], [`F64`], [`Offsets`](crate::Offsets) and [`Points`], block by block:
    /// the fastest way to make many.
    #[must_use]
    pub fn blocks<F: Format>(&self) -> Blocks<F> {
        match &self.counted.kept {
            Some(kept) => Blocks::of_kept(self.scope.clone(), self.window, kept.clone()),
            None => Blocks::of_window(self.scope.clone(), self.window),
        }
    }

    /// Exact places of points of this plan, in another format.
    pub fn converted<F: Format>(&self, places: &[Place]) -> impl Iterator<Item = F::Item> {
        let format: F = format_of(&self.scope);
        places.iter().map(move |place| place.item(&format))
    }

    /// The whole request cut into tiles of at most `max_points` points each, or one lattice row of a band
    /// if that has more. The points of the tiles, one tile after another, come in order. Tiles can be
    /// filled [independently](crate::cookbook#parallel-filling): [`tile_blocks`](Self::tile_blocks).
    pub fn tiles(&self, max_points: usize) -> impl Iterator<Item = Tile> + use<> {
        tiles(&self.scope, max_points)
    }

    /// The points of a tile of this plan, block by block.
    #[must_use]
    pub fn tile_blocks<F: Format>(&self, tile: &Tile) -> Blocks<F> {
        Blocks::of_tile(self.scope.clone(), tile)
    }

    /// Attributes of the plan's points; see [`PointSet::attributes`](crate::PointSet::attributes).
    ///
    /// # Errors
    /// As [`PointSet::attributes`](crate::PointSet::attributes).
    pub fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        self.scope.lattice.attributes(attributes)
    }

    /// A sparser or denser set of the same table and seed in the same area, whatever the window and the share, clear of
    /// the same other sets. Its points are not counted: [`count`](Self::count) is only a bound.
    ///
    /// A picture whose pixels are larger than the spacing can show it in place of this plan.
    ///
    /// # Errors
    /// As [`Spacing::new`] and [`PointSet::within`](crate::PointSet::within).
    pub fn preview(&self, spacing: f64) -> Result<Self, Error> {
        let spacing = Spacing::new(spacing)?;
        let Scope {
            lattice,
            sieve,
            stop,
            region,
            ..
        } = &*self.scope;
        let mut placement = Placement {
            spacing,
            ..lattice.placement
        };
        let whole = self.scope.whole_lattice();
        if !whole.is_in_field() {
            placement.keep = Keep::ALL;
        }
        let lattice = whole.replaced(placement);
        let mut mask = sieve
            .as_ref()
            .map_or_else(Mask::default, |sieve| sieve.mask().clone());
        let area = mask
            .area
            .take()
            .map_or(Area::Region(*region), Arc::unwrap_or_clone);
        Self::new(&lattice, &mask, area, stop.clone(), Some(u64::MAX.into()))
    }

    /// The bytes of the points and places that counting has kept, beside the area.
    #[must_use]
    pub fn kept(&self) -> usize {
        self.counted.bytes()
    }

    /// This plan without the points and places that counting has kept. It finds them again, which takes time.
    #[must_use]
    pub fn forgetting(self) -> Self {
        Self {
            counted: Counted::known(self.counted.count),
            ..self
        }
    }

    /// The plan with another flag. Once that is raised, blocks end early, and windows and cursors, which may have to
    /// count, are meaningless.
    #[must_use]
    pub fn stopped_by(self, stop: Stop) -> Self {
        let mut scope = Arc::unwrap_or_clone(self.scope);
        scope.stop = stop;
        Self {
            scope: Arc::new(scope),
            window: self.window,
            counted: self.counted,
        }
    }
}

planned!(
    Plan,
    Table,
    2,
    "strew_core::PointSet::new(strew_core::Table::undisplaced(\"sqrt(3)\".parse()?, 20, \"pattern\")?).chunk(30.0, [0, 0])?"
);

impl Windowed for Plan {
    type Id = PointId;

    fn part(&self) -> Window<PointId> {
        self.window
    }

    fn part_mut(&mut self) -> &mut Window<PointId> {
        &mut self.window
    }

    fn locate(&self, numbers: &[u128]) -> Vec<Option<PointId>> {
        let Window {
            start,
            offset,
            total,
            ..
        } = self.window;
        if let Some(kept) = &self.counted.kept {
            let id = |&k: &u128| kept.id(usize::try_from(k).ok()?);
            return numbers.iter().map(id).collect();
        }
        if self.scope.lattice.grade.is_none() {
            return locate_all(&self.scope, total, numbers);
        }
        let marks = &self.counted.marks;
        // The window may begin nearer than a mark, and the point that was found last may lie nearer still.
        let mut last = start.map(|at| Mark { at, before: offset });
        let mut locate = |k: u128| {
            let after = marks.partition_point(|mark| mark.before <= k);
            let mark = after.checked_sub(1).map(|last| marks[last]);
            let own = last.filter(|own| own.before <= k);
            let nearest = [mark, own].into_iter().flatten();
            let at = locate_graded(&self.scope, nearest.max_by_key(|mark| mark.before), k)?;
            last = Some(Mark { at, before: k });
            Some(at)
        };
        numbers.iter().map(|&k| locate(k)).collect()
    }
}

windows!(
    Plan,
    Cursor,
    "strew_core::PointSet::new(strew_core::Table::undisplaced(\"sqrt(3)\".parse()?, 20, \"pattern\")?).chunk(30.0, [0, 0])?"
);
