//! Masks: which points of a lattice a set has, by their places.
//!
//! A mask limits a set to an area and keeps its points clear of other sets. Whether a point stays is
//! decided by the other set's points near it in the unbounded plane, never by the region of a request, so
//! neighboring regions agree.

use alloc::{sync::Arc, vec::Vec};
use core::{cell::RefCell, ops::ControlFlow};

use super::{
    ground::{Ground, Known, Marked},
    limits::{check_number, check_place, check_radius, check_reach, check_work, limit},
    scan::{Scratch, scan},
};
use crate::{
    error::{Error, ErrorKind, number},
    lattice::{Lattice, Point},
    parts::CLEARANCE,
    shape::{Area, Region},
};

/// The conditions on the places of a set's points.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mask {
    /// The area in which they lie, if not everywhere.
    pub(crate) area: Option<Area>,
    /// The sets that they keep clear of.
    pub(crate) clear: Arc<[ClearOf]>,
}

/// A distance that points keep from all points of another set.
#[derive(Clone, Debug)]
pub(crate) struct ClearOf {
    lattice: Lattice,
    mask: Mask,
    distance: f64,
}

impl Mask {
    /// Tests for many places, with memory of their own.
    pub(crate) fn guards(&self) -> Guards {
        self.guards_holding(MOST_HELD)
    }

    /// The tests of [`clear`](Self::clear) alone.
    pub(crate) fn clear_guards(&self) -> Vec<Guard> {
        self.guards().clear
    }

    /// Tests that together hold up to `most` points of other sets.
    fn guards_holding(&self, most: usize) -> Guards {
        let each = most / self.clear.len().max(1);
        let clear = self.clear.iter().filter(|_| CLEARANCE);
        Guards {
            area: self.area.clone(),
            clear: clear.map(|of| of.guard(each)).collect(),
        }
    }

    /// This mask with another set to keep clear of.
    pub(crate) fn and_clear_of(mut self, other: ClearOf) -> Self {
        self.clear = self.clear.iter().cloned().chain([other]).collect();
        self
    }

    /// This mask limited to an area.
    pub(crate) fn and_within(self, area: Area) -> Self {
        let area = match self.area {
            Some(own) => own.and(area),
            None => area,
        };
        Self {
            area: Some(area),
            clear: self.clear,
        }
    }
}

impl ClearOf {
    /// The largest distance, in mean spacings of the other set. Hardly a place is farther than one
    /// spacing from the next point, so a larger distance would leave nothing.
    const MAX_SPACINGS: f64 = 16.0;

    /// A distance from all points of a set, in world units.
    pub(crate) fn new(lattice: &Lattice, mask: &Mask, distance: f64) -> Result<Self, Error> {
        let limit = lattice.placement.spacing.get() * Self::MAX_SPACINGS;
        let refused = || {
            let allowed = alloc::format!(
                "a number above 0 and at most {}, {} mean spacings of the other set",
                number(limit),
                Self::MAX_SPACINGS
            );
            let error = Error::new(ErrorKind::Clearance, "distance", number(distance), allowed);
            error.with_limit(limit)
        };
        if !(distance > 0.0 && distance <= limit) {
            return Err(refused());
        }
        Clearance::check(lattice, distance).map_err(|_| refused())?;
        Ok(Self {
            lattice: lattice.clone(),
            mask: mask.clone(),
            distance,
        })
    }

    /// A test that holds up to `most` points: half of them of the other set, half of those that this keeps clear of.
    fn guard(&self, most: usize) -> Guard {
        let (lattice, distance) = (self.lattice.clone(), self.distance);
        let spacings = distance / lattice.placement.spacing.get();
        let near = core::f64::consts::PI * spacings * spacings;
        Guard(RefCell::new(Guarded {
            search: SEARCH + near * visit(&lattice),
            ground: Ground::new(most / 2),
            clearance: Clearance {
                lattice,
                guards: self.mask.guards_holding(most / 2),
                distance,
                scratch: Scratch::default(),
            },
        }))
    }
}

/// The most points of other sets that the tests of a piece of work hold: 16 bytes each.
const MOST_HELD: usize = 1 << 17;

/// The cost of a search near a place, in visits of points without a field.
const SEARCH: f64 = 40.0;

/// The cost of a visit of a point.
const fn visit(lattice: &Lattice) -> f64 {
    /// With a look at a field.
    const IN_FIELD: f64 = 4.0;
    if lattice.grade.is_some() {
        IN_FIELD
    } else {
        1.0
    }
}

/// The greatest sides of tiles, in mean spacings of the set whose points are listed, beside twice the distance.
/// Points that settle are found in tiles of their own, which the boxes around these fit.
const TILE: f64 = 32.0;
const TILE_SETTLED: f64 = 24.0;

/// Tests places against a mask. Not shared between threads: it keeps memory from place to place.
#[derive(Clone, Debug)]
pub(crate) struct Guards {
    area: Option<Area>,
    clear: Vec<Guard>,
}

impl Guards {
    /// Whether a point may be at a place.
    pub(crate) fn permit(&self, p: [f64; 2]) -> bool {
        self.area.as_ref().is_none_or(|area| area.contains(p))
            && self.clear.iter().all(|guard| guard.permits(p))
    }

    /// Turns to places within a box.
    fn aim(&self, within: Region) {
        if self.clear.is_empty() {
            return;
        }
        let own = self.area.as_ref().and_then(Area::bounds);
        let within = own.map_or(within, |own| own.and(within));
        for guard in &self.clear {
            guard.aim(within);
        }
    }
}

/// Tests whether places are clear of one set.
#[derive(Clone, Debug)]
pub(crate) struct Guard(RefCell<Guarded>);

#[derive(Clone, Debug)]
struct Guarded {
    clearance: Clearance,
    /// The points around the places that are tested, if it is known where these lie.
    ground: Ground,
    /// The cost of a search.
    search: f64,
}

impl Guard {
    /// Whether a place is far enough from all points of the other set.
    #[inline]
    pub(crate) fn permits(&self, p: [f64; 2]) -> bool {
        !(CLEARANCE && self.0.borrow_mut().is_any_near(p))
    }

    /// Says that many of the next places lie within a box. They are tested faster; the answers are the same for all
    /// places.
    pub(crate) fn aim(&self, within: Region) {
        if CLEARANCE {
            self.0.borrow_mut().aim(within);
        }
    }
}

impl Guarded {
    fn aim(&mut self, within: Region) {
        let Clearance {
            lattice,
            guards,
            distance,
            ..
        } = &self.clearance;
        let tile = match lattice.settle() {
            Some(_) => TILE_SETTLED,
            None => TILE,
        };
        let spacing = lattice.placement.spacing.get();
        let most = tile * spacing + 2.0 * distance;
        let across = (most + 2.0 * distance) / spacing;
        self.ground.aim(within, most, across * across);
        let room = 2.0 * distance;
        let around = Region::between(
            within.min().map(|v| v - room),
            within.max().map(|v| v + room),
        );
        guards.aim(around);
    }

    #[inline]
    fn is_any_near(&mut self, at: [f64; 2]) -> bool {
        match self.ground.at(at) {
            Known::All(marked) => marked.is_any_near(at),
            Known::In(tile) => self.is_any_near_in(tile, at),
            Known::Nothing => self.clearance.is_any_near(at, |_| true),
        }
    }

    /// Tests a place in a tile whose points are not marked, and marks them if that is worth it.
    #[cold]
    fn is_any_near_in(&mut self, tile: usize, at: [f64; 2]) -> bool {
        let (clearance, ground) = (&mut self.clearance, &mut self.ground);
        let distance = clearance.distance;
        if let Some(around) = ground.around(tile, distance)
            && let Some((center, radius)) = clearance.disk(around)
            && ground.is_worth(tile, self.search, clearance.listing(radius))
        {
            let spacing = clearance.lattice.placement.spacing.get();
            let places = clearance.list(around, (center, radius));
            let marked = Marked::new(around, distance, spacing, &places);
            let is_any_near = marked.is_any_near(at);
            ground.mark(tile, marked);
            return is_any_near;
        }
        clearance.is_any_near(at, |_| true)
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
    guards: Guards,
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
            guards: mask.guards(),
            distance,
            scratch: Scratch::default(),
        })
    }

    /// Refuses a distance within which too many points of a lattice lie.
    fn check(lattice: &Lattice, distance: f64) -> Result<(), Error> {
        check_radius(distance)?;
        check_number(lattice, distance, 1.0, Self::MAX_CANDIDATES)?;
        check_work(lattice, distance, 4 * Self::MAX_CANDIDATES)
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
            guards,
            distance,
            scratch,
        } = self;
        if check_place(at).is_err() || check_reach(limit(lattice), at, *distance).is_err() {
            return false;
        }
        let squared = *distance * *distance;
        let scanned = scan(lattice, scratch, at, *distance, None, |d, point| {
            if d < squared && guards.permit(point.at()) && accept(&point) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        scanned.is_break()
    }

    /// The center and radius of a disk around a box, `None` if a search there leaves the limit. Within it every
    /// place of the box is at least the distance from the limit.
    fn disk(&self, around: Region) -> Option<([f64; 2], f64)> {
        let (min, max) = (around.min(), around.max());
        let center = [0, 1].map(|i| min[i] + (max[i] - min[i]) / 2.0);
        let half = [0, 1].map(|i| (max[i] - center[i]).max(center[i] - min[i]));
        let rounding = 4.0 * f64::EPSILON * (center[0].abs().max(center[1].abs()));
        let radius = libm::hypot(half[0], half[1]) * (1.0 + 1e-9) + rounding;
        check_place(center).ok()?;
        check_reach(limit(&self.lattice), center, radius + self.distance).ok()?;
        Some((center, radius))
    }

    /// The cost of [listing](Self::list) the points of a disk.
    fn listing(&self, radius: f64) -> f64 {
        let spacings = radius / self.lattice.placement.spacing.get();
        core::f64::consts::PI * spacings * spacings * visit(&self.lattice)
    }

    /// The places of the points of a box, with the disk around it.
    fn list(&mut self, within: Region, (center, radius): ([f64; 2], f64)) -> Vec<[f64; 2]> {
        let Self {
            lattice,
            guards,
            scratch,
            ..
        } = self;
        let mut places = Vec::new();
        // Nothing breaks this.
        let _ = scan(lattice, scratch, center, radius, None, |_, point| {
            let at = point.at();
            if within.contains(at) && guards.permit(at) {
                places.push(at);
            }
            ControlFlow::Continue(())
        });
        places
    }
}
