//! Which points are near a place: the nearest ones, all within a radius, whether there is any.
//!
//! All three are exact for the coordinates that are reported: distances are those of the `f64`
//! pairs, compared as dx·dx + dy·dy in plain `f64`; among equals the smaller id comes first.

use alloc::{sync::Arc, vec::Vec};
use core::ops::ControlFlow;

use super::{
    Frame, LATTICE_LIMIT, Placement, Point, Sampler, fixed,
    scan::{Field, Scratch},
    stretch::Stretch,
};
use crate::pattern::Axis;

/// A point and how far it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// The point.
    pub point: Point,
    /// Its distance in world units.
    pub distance: f64,
}

/// Why a search is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FindError {
    /// A coordinate of the place is NaN or infinite.
    #[error("{axis:?} of the place is {value}; it must be a finite number")]
    NotFinite {
        /// Which coordinate.
        axis: Axis,
        /// Its value.
        value: f64,
    },
    /// The search would reach where points cannot be told apart in `f64`.
    #[error(
        "the search around {axis:?} = {value:e} leaves ±{limit:e}, where f64 coordinates with this \
         spacing still tell neighbors apart"
    )]
    TooFar {
        /// Which coordinate.
        axis: Axis,
        /// Its value.
        value: f64,
        /// The largest absolute value that a search may reach.
        limit: f64,
    },
    /// The radius is not a number from 0 on.
    #[error("the radius is {0}; it must be a finite number, 0 or greater")]
    Radius(f64),
    /// More neighbors are asked for than one search gives.
    #[error("{0} nearest points are asked for; at most {max} are given", max = Finder::MAX_NEAREST)]
    TooManyNearest(usize),
    /// More points lie within the radius than the caller allows, or a search has to look at more
    /// than [`Finder::MAX_CANDIDATES`].
    #[error("about {about:.0} points lie within the radius searched; at most {limit} are allowed")]
    TooMany {
        /// Roughly how many there are.
        about: f64,
        /// How many are allowed.
        limit: usize,
    },
}

/// Finds the points near places, for one sampler and placement. Cheap to make and to clone.
///
/// ```
/// use std::sync::Arc;
/// use strew_core::{Placement, Sampler, Seed, Spacing, Table};
///
/// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let finder = Arc::new(Sampler::new(table)).finder(Placement::new(Spacing::new(2.0)?, Seed(7)));
/// let near = finder.nearest([1000.5, -3.25], 8)?;
/// assert_eq!(near.len(), 8);
/// assert!(near.is_sorted_by_key(|neighbor| neighbor.distance));
/// let all = finder.within([1000.5, -3.25], near[7].distance, 100)?;
/// assert_eq!(all[..8], near);
/// assert!(finder.clearance(4.0)?.is_any_near([1000.5, -3.25], |_| true));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Finder {
    sampler: Arc<Sampler>,
    frame: Frame,
    stretch: Stretch,
}

impl Sampler {
    /// A finder of the points near places.
    #[must_use]
    pub fn finder(self: &Arc<Self>, placement: Placement) -> Finder {
        let frame = Frame::new(self, placement);
        Finder {
            sampler: self.clone(),
            stretch: Stretch::of(frame.shears.as_ref()),
            frame,
        }
    }
}

impl Finder {
    /// The most neighbors one search for the nearest gives.
    pub const MAX_NEAREST: usize = 10_000;
    /// The most points any search may have to look at: a few hundred milliseconds of work.
    pub const MAX_CANDIDATES: usize = 4_000_000;
    /// Lattice units left free at the limit: more than the longest displacement and warp.
    const BORDER: i64 = 1 << 20;

    /// The largest absolute coordinate a search may reach.
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.frame.world(fixed(LATTICE_LIMIT - Self::BORDER))
    }

    /// The `k` nearest points, nearest first, of equally near ones the smaller id first.
    ///
    /// Takes microseconds for small `k`.
    ///
    /// # Errors
    /// [`FindError`] if the place is not finite, the search leaves the [`limit`](Self::limit), `k`
    /// is greater than [`MAX_NEAREST`](Self::MAX_NEAREST), or so few points are kept that more than
    /// [`MAX_CANDIDATES`](Self::MAX_CANDIDATES) would have to be looked at.
    pub fn nearest(&self, at: [f64; 2], k: usize) -> Result<Vec<Neighbor>, FindError> {
        if k > Self::MAX_NEAREST {
            return Err(FindError::TooManyNearest(k));
        }
        let spacing = self.frame.placement.spacing.get();
        // A disc that holds k + 2√k + 2 points on average mostly has k.
        let wanted = k as f64 + 2.0 * libm::sqrt(k as f64) + 2.0;
        let mut radius = spacing * libm::sqrt(wanted / (core::f64::consts::PI * self.kept()));
        loop {
            let found = self.search(at, radius, Self::MAX_CANDIDATES)?;
            if found.len() >= k {
                return Ok(in_order(found, k));
            }
            radius *= 1.5;
        }
    }

    /// All points within `radius` of a place (dx·dx + dy·dy ≤ radius·radius in `f64`), nearest
    /// first, of equally near ones the smaller id first.
    ///
    /// # Errors
    /// [`FindError`] if the place is not finite, the search leaves the [`limit`](Self::limit), the
    /// radius is not a finite number from 0 on, or more than `limit` points lie within it; that
    /// limit is [`MAX_CANDIDATES`](Self::MAX_CANDIDATES) at most.
    pub fn within(
        &self,
        at: [f64; 2],
        radius: f64,
        limit: usize,
    ) -> Result<Vec<Neighbor>, FindError> {
        let found = self.search(at, radius, limit.min(Self::MAX_CANDIDATES))?;
        Ok(in_order(found, usize::MAX))
    }

    /// A test whether any point lies nearer than `distance` to a place, for many places: what keeps
    /// one layer of points clear of another.
    ///
    /// # Errors
    /// [`FindError::Radius`] or [`FindError::TooMany`] unless the distance is a finite number from
    /// 0 on within which lie at most [`Clearance::MAX_CANDIDATES`] points on average.
    pub fn clearance(&self, distance: f64) -> Result<Clearance, FindError> {
        check_radius(distance)?;
        self.check_number(distance, 1.0, Clearance::MAX_CANDIDATES)?;
        self.check_work(distance, 4 * Clearance::MAX_CANDIDATES)?;
        Ok(Clearance {
            finder: self.clone(),
            distance,
            scratch: Scratch::default(),
        })
    }

    /// The points within a radius, in no order, with their squared distances.
    fn search(
        &self,
        at: [f64; 2],
        radius: f64,
        limit: usize,
    ) -> Result<Vec<(f64, Point)>, FindError> {
        self.check_place(at)?;
        check_radius(radius)?;
        // Counts come close to their means in discs of many points.
        self.check_number(radius, self.kept(), limit.saturating_mul(2).max(100))?;
        self.check_work(radius, 2 * Self::MAX_CANDIDATES)?;
        self.check_reach(at, radius)?;
        let squared = radius * radius;
        let (mut found, mut inside) = (Vec::new(), 0usize);
        let _ = self
            .field()
            .scan(&mut Scratch::default(), at, radius, |d, point| {
                if d <= squared {
                    inside += 1;
                    if inside <= limit {
                        found.push((d, point));
                    }
                }
                ControlFlow::Continue(())
            });
        if inside > limit {
            let about = inside as f64;
            return Err(FindError::TooMany { about, limit });
        }
        Ok(found)
    }

    fn field(&self) -> Field<'_> {
        Field {
            sampler: &self.sampler,
            frame: &self.frame,
            stretch: self.stretch,
        }
    }

    /// The part of the points that is kept.
    const fn kept(&self) -> f64 {
        self.frame.placement.keep.get()
    }

    fn check_place(&self, at: [f64; 2]) -> Result<(), FindError> {
        for (axis, value) in [(Axis::X, at[0]), (Axis::Y, at[1])] {
            if !value.is_finite() {
                return Err(FindError::NotFinite { axis, value });
            }
        }
        Ok(())
    }

    fn check_reach(&self, at: [f64; 2], radius: f64) -> Result<(), FindError> {
        let limit = self.limit();
        for (axis, value) in [(Axis::X, at[0]), (Axis::Y, at[1])] {
            if value.abs() + radius > limit {
                return Err(FindError::TooFar { axis, value, limit });
            }
        }
        Ok(())
    }

    /// Refuses a radius that takes looking at more than `limit` points, kept or not, or at as many
    /// lattice lines as only α next to 1 or 2 can need.
    fn check_work(&self, radius: f64, limit: usize) -> Result<(), FindError> {
        const MAX_LINES: f64 = 1e7;
        let stretched = radius * self.stretch.factor;
        self.check_number(stretched, 1.0, limit)?;
        let about = stretched / self.frame.world(fixed(1));
        if about <= MAX_LINES {
            Ok(())
        } else {
            Err(FindError::TooMany { about, limit })
        }
    }

    /// Refuses a radius within which lie more than `limit` of a part `kept` of all points.
    fn check_number(&self, radius: f64, kept: f64, limit: usize) -> Result<(), FindError> {
        let spacings = radius / self.frame.placement.spacing.get();
        let about = core::f64::consts::PI * spacings * spacings * kept;
        if about <= limit as f64 {
            Ok(())
        } else {
            Err(FindError::TooMany { about, limit })
        }
    }
}

fn check_radius(radius: f64) -> Result<(), FindError> {
    if radius.is_finite() && radius >= 0.0 {
        Ok(())
    } else {
        Err(FindError::Radius(radius))
    }
}

/// The `k` nearest in order.
fn in_order(mut found: Vec<(f64, Point)>, k: usize) -> Vec<Neighbor> {
    found.sort_unstable_by(|(d, p), (e, q)| d.total_cmp(e).then(p.id.cmp(&q.id)));
    found.truncate(k);
    let neighbor = |(squared, point)| Neighbor {
        point,
        distance: libm::sqrt(squared),
    };
    found.into_iter().map(neighbor).collect()
}

/// Tells whether a point lies near. Keeps its memory from one place to the next, so each thread
/// has its own.
#[derive(Clone, Debug)]
pub struct Clearance {
    finder: Finder,
    distance: f64,
    scratch: Scratch,
}

impl Clearance {
    /// The most points that may lie within the distance on average.
    pub const MAX_CANDIDATES: usize = 100_000;

    /// The distance in world units.
    #[must_use]
    pub const fn distance(&self) -> f64 {
        self.distance
    }

    /// Whether any point that `accept` takes lies nearer than the distance (dx·dx + dy·dy <
    /// distance·distance in `f64`). `accept` sees only such points, in no particular order, until
    /// it takes one.
    ///
    /// Nothing is near a place that is not finite or whose surroundings leave the
    /// [`limit`](Finder::limit).
    pub fn is_any_near(&mut self, at: [f64; 2], mut accept: impl FnMut(&Point) -> bool) -> bool {
        let Self {
            finder,
            distance,
            scratch,
        } = self;
        let placed = finder.check_place(at);
        if placed
            .and_then(|()| finder.check_reach(at, *distance))
            .is_err()
        {
            return false;
        }
        let squared = *distance * *distance;
        let scanned = finder.field().scan(scratch, at, *distance, |d, point| {
            if d < squared && accept(&point) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        scanned.is_break()
    }
}
