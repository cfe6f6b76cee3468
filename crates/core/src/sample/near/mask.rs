//! Masks: which points of a lattice a set has, by their places.
//!
//! A mask limits a set to an area and keeps its points clear of other sets. Whether a point stays is
//! decided by the other set's points near it in the unbounded plane, never by the region of a request, so
//! neighboring regions agree.

use alloc::{sync::Arc, vec::Vec};
use core::{cell::RefCell, ops::ControlFlow};

use super::{
    limits::{check_number, check_place, check_radius, check_reach, check_work},
    scan::{Scratch, scan},
};
use crate::{
    error::{Error, ErrorKind, number},
    sample::{
        area::Area,
        lattice::{Lattice, Point},
    },
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
        Guards {
            area: self.area.clone(),
            clear: self.clear_guards(),
        }
    }

    /// The tests of [`clear`](Self::clear) alone.
    pub(crate) fn clear_guards(&self) -> Vec<Guard> {
        self.clear.iter().map(ClearOf::guard).collect()
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

    fn guard(&self) -> Guard {
        let (lattice, distance) = (self.lattice.clone(), self.distance);
        Guard(RefCell::new(Clearance {
            lattice,
            guards: self.mask.guards(),
            distance,
            scratch: Scratch::default(),
        }))
    }
}

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
}

/// Tests whether places are clear of one set.
#[derive(Clone, Debug)]
pub(crate) struct Guard(RefCell<Clearance>);

impl Guard {
    /// Whether a place is far enough from all points of the other set.
    pub(crate) fn permits(&self, p: [f64; 2]) -> bool {
        !self.0.borrow_mut().is_any_near(p, |_| true)
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
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// assert_eq!(PointSet::new(table).clearance(2.0)?.distance(), 2.0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
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
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let trees = PointSet::new(table).spacing(5.0)?.seed(3);
    /// let tree = trees.nearest([0.0, 0.0], 1)?[0].member;
    /// let mut clearance = trees.clearance(0.1)?;
    /// // Is there a tree at the place? One other than this?
    /// assert!(clearance.is_any_near(tree.at(), |_| true));
    /// assert!(!clearance.is_any_near(tree.at(), |other| other.id != tree.id()));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn is_any_near(&mut self, at: [f64; 2], mut accept: impl FnMut(&Point) -> bool) -> bool {
        let Self {
            lattice,
            guards,
            distance,
            scratch,
        } = self;
        if check_place(at).is_err() || check_reach(lattice, at, *distance).is_err() {
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
}
