//! Masks: which points of a lattice a set has, by their places.
//!
//! A mask limits a set to an area and keeps its points clear of other sets. Whether a point stays is
//! decided by the other set's points near it in the unbounded plane, never by the region of a request, so
//! neighboring regions agree.

use alloc::sync::Arc;
use core::{cell::RefCell, ops::ControlFlow};

use super::{
    clear::{Clear, ClearOf, OtherSet, refused},
    limits::{Density, check_place, check_radius, check_reach},
    scan::{Scratch, scan},
};
use crate::{
    error::Error,
    lattice::{Keep, Lattice, Point, alike},
    parts::CLEARANCE,
    shape::{Area, Outlined, Polygon, Region, Shape},
    stop::Stop,
};

/// The conditions on the places of a set's points, beside its share, where `O` is a set that it keeps clear of.
#[derive(Clone, Debug)]
pub(crate) struct Mask<O = Other, const D: usize = 2, P = Polygon> {
    /// The area in which they lie, if not everywhere.
    pub(crate) area: Option<Arc<Shape<D, P>>>,
    /// The sets that they keep clear of.
    pub(crate) clear: Arc<[ClearOf<O>]>,
}

impl<O, const D: usize, P> Default for Mask<O, D, P> {
    fn default() -> Self {
        Self {
            area: None,
            clear: Arc::default(),
        }
    }
}

impl<O: Clone, const D: usize, P: Outlined<D>> Mask<O, D, P> {
    /// This mask with another set to keep clear of.
    pub(crate) fn and_clear_of(mut self, other: ClearOf<O>) -> Self {
        self.clear = self.clear.iter().cloned().chain([other]).collect();
        self
    }

    /// This mask limited to an area.
    pub(crate) fn and_within(mut self, area: Shape<D, P>) -> Self {
        self.area = Some(Arc::new(self.narrowed(&area)));
        self
    }

    /// The part of an area in which points may be.
    pub(crate) fn narrowed(&self, area: &Shape<D, P>) -> Shape<D, P> {
        match &self.area {
            Some(own) => (**own).clone().and(area.clone()),
            None => area.clone(),
        }
    }

    /// Whether this and another mask are made of the same parts.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let is_within = alike(&self.area, &other.area, Arc::ptr_eq);
        let is_alone = self.clear.is_empty() && other.clear.is_empty();
        is_within && (is_alone || Arc::ptr_eq(&self.clear, &other.clear))
    }

    /// Whether it leaves all points.
    pub(crate) fn is_none(&self) -> bool {
        self.area.is_none() && self.clear.is_empty()
    }
}

impl Mask {
    /// A test for many places, with memory of its own; most of them in a box, if one is known.
    pub(crate) fn guard(&self, within: Option<&Region>) -> Guard {
        let clear: &[ClearOf<Other>] = if CLEARANCE { &self.clear } else { &[] };
        Guard {
            area: self.area.clone(),
            clear: RefCell::new(Clear::new(clear, within, Stop::default())),
        }
    }
}

/// A set of the plane that others keep clear of.
#[derive(Clone, Debug)]
pub(crate) struct Other {
    lattice: Lattice,
    mask: Mask,
    scratch: Scratch,
}

impl Other {
    /// A distance from all points that a lattice and a mask leave, in world units.
    pub(crate) fn kept(
        lattice: &Lattice,
        mask: &Mask,
        distance: f64,
    ) -> Result<ClearOf<Self>, Error> {
        let placement = lattice.placement;
        let set = Self {
            lattice: match placement.lod {
                Keep::ALL => lattice.clone(),
                _ => lattice.replaced(placement.with_lod(Keep::ALL)),
            },
            mask: mask.clone(),
            scratch: Scratch::default(),
        };
        let refused = |_| refused(distance, placement.spacing.get());
        Clearance::check(lattice, distance).map_err(refused)?;
        ClearOf::new(set, distance)
    }
}

impl OtherSet<2> for Other {
    fn spacing(&self) -> f64 {
        self.lattice.placement.spacing.get()
    }

    fn spacing_kept(&self) -> f64 {
        self.spacing()
    }

    fn sides(&self) -> [f64; 2] {
        /// In mean spacings at full density.
        const TILE: f64 = 32.0;
        /// Points that settle are found in tiles of their own, which these fit.
        const TILE_SETTLED: f64 = 24.0;
        let tile = match self.lattice.settle() {
            Some(_) => TILE_SETTLED,
            None => TILE,
        };
        [tile * self.spacing(); 2]
    }

    fn searches(&self, sides: [f64; 2], distance: f64) -> u32 {
        /// The cost of a search beside its visits, in visits of points.
        const SEARCH: f64 = 40.0;
        /// The cost of a visit of a point with a look at a field.
        const IN_FIELD: f64 = 4.0;
        let visit = match &self.lattice.grade {
            Some(_) => IN_FIELD,
            None => 1.0,
        };
        let cost = |[x, y]: [f64; 2]| visit * (x / self.spacing()) * (y / self.spacing());
        (cost(sides) / (SEARCH + cost([2.0 * distance; 2]))) as u32
    }

    fn is_same(&self, other: &Self) -> bool {
        self.mask.is_same(&other.mask) && self.lattice.is_same(&other.lattice)
    }

    fn clear(&self) -> &[ClearOf<Self>] {
        &self.mask.clear
    }

    fn limit(&self) -> f64 {
        Density::of(&self.lattice).limit
    }

    fn visit(&mut self, within: &Region, _: &Stop, mut each: impl FnMut([f64; 2]) -> bool) {
        let (min, max) = (within.min(), within.max());
        let center = [0, 1].map(|i| min[i] + (max[i] - min[i]) / 2.0);
        let half = [0, 1].map(|i| (max[i] - center[i]).max(center[i] - min[i]));
        let rounding = 4.0 * f64::EPSILON * (center[0].abs().max(center[1].abs()));
        let radius = libm::hypot(half[0], half[1]) * (1.0 + 1e-9) + rounding;
        let area = self.mask.area.as_ref();
        let (lattice, scratch) = (&self.lattice, &mut self.scratch);
        // It breaks where `each` refuses a point.
        let _ = scan(lattice, scratch, center, radius, None, |_, point| {
            let at = point.at();
            let is_own = within.contains(at) && area.is_none_or(|area| area.contains(at));
            match is_own && !each(at) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
    }
}

/// Tests places against a mask. Not shared between threads: it keeps memory from place to place.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    area: Option<Arc<Area>>,
    clear: RefCell<Clear<Other, 2>>,
}

impl Guard {
    /// Whether there is no other set.
    pub(crate) fn is_empty(&self) -> bool {
        !CLEARANCE || self.clear.borrow().is_empty()
    }

    /// Whether a place is far enough from all points of the other sets, in the area or not.
    #[inline]
    pub(crate) fn is_clear(&self, p: [f64; 2]) -> bool {
        !CLEARANCE || self.clear.borrow_mut().permits(p)
    }

    /// Whether a point may be at a place.
    pub(crate) fn permits(&self, p: [f64; 2]) -> bool {
        self.area.as_ref().is_none_or(|area| area.contains(p)) && self.is_clear(p)
    }
}

/// Tests whether a point of a set lies near a place, for many places. It keeps memory from one place to
/// the next, so each thread has its own; see [`PointSet::clearance`](crate::PointSet::clearance).
///
/// ```
/// use strew_core::{PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let rocks = PointSet::new(table).spacing(5.0)?.seed(3);
/// let mut clearance = rocks.clearance(2.0)?;
/// for rock in rocks.chunk(20.0, [0, 0])? {
///     let [x, y] = rock.at();
///     assert!(clearance.is_any_near([x + 1.9, y], |_| true));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Clearance {
    lattice: Lattice,
    guard: Guard,
    distance: f64,
    scratch: Scratch,
}

impl Clearance {
    /// The largest number of points within the distance, on average.
    pub const MAX_CANDIDATES: usize = 100_000;

    pub(crate) fn new(lattice: Lattice, mask: &Mask, distance: f64) -> Result<Self, Error> {
        Self::check(&lattice, distance)?;
        Ok(Self {
            lattice,
            guard: mask.guard(None),
            distance,
            scratch: Scratch::default(),
        })
    }

    /// Refuses a distance within which too many points of a lattice lie.
    fn check(lattice: &Lattice, distance: f64) -> Result<(), Error> {
        check_radius(distance)?;
        let density = Density::of(lattice);
        density.check_number(distance, 1.0, Self::MAX_CANDIDATES)?;
        density.check_work(distance, 4 * Self::MAX_CANDIDATES)
    }

    /// The distance that is tested, in world units.
    #[must_use]
    pub const fn distance(&self) -> f64 {
        self.distance
    }

    /// Whether any point that `accept` takes lies nearer than the distance (dx·dx + dy·dy <
    /// distance·distance in `f64`). `accept` sees only such points, in no particular order, until it
    /// takes one.
    ///
    /// Nothing is near a place that is not finite, or whose surroundings leave the
    /// [limit](crate::PointSet::search_limit) of searches.
    pub fn is_any_near(&mut self, at: [f64; 2], mut accept: impl FnMut(&Point) -> bool) -> bool {
        let Self {
            lattice,
            guard,
            distance,
            scratch,
        } = self;
        if check_place(at).is_err()
            || check_reach(Density::of(lattice).limit, at, *distance).is_err()
        {
            return false;
        }
        let squared = *distance * *distance;
        let scanned = scan(lattice, scratch, at, *distance, None, |d, point| {
            if d < squared && guard.permits(point.at()) && accept(&point) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        scanned.is_break()
    }
}
