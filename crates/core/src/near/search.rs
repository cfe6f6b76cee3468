//! Searches: the nearest points of a place, and all points within a radius.
//!
//! Both are exact for the reported coordinates: distances are those of the `f64` numbers, compared as
//! dx·dx + dy·dy (+ dz·dz) in plain `f64`, and their square roots with the radius. Among equals the smaller id comes first.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::limits::{
    Density, MAX_CANDIDATES, Visits, check_neighbors, check_place, check_radius, check_reach,
    farthest, too_many,
};
use crate::{
    attribute::hash::Hashed,
    error::Error,
    lattice::{PointId, seed::Seed},
    plan::member::Member,
    stop::Stop,
};

/// A point of a set near a place, and its distance.
///
/// ```
/// use strew_core::{Neighbor, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let set = PointSet::new(table).seed(7);
/// let Neighbor { member, distance } = set.nearest([10.0, 3.0], 1)?[0];
/// let [dx, dy] = [member.at()[0] - 10.0, member.at()[1] - 3.0];
/// assert_eq!(distance, (dx * dx + dy * dy).sqrt());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor<Id: Hashed = PointId> {
    /// The point.
    pub member: Member<Id>,
    /// The distance from the place, in world units.
    pub distance: f64,
}

/// A set that is searched.
pub(crate) trait Searched<const D: usize> {
    type Id: Hashed;
    fn seed(&self) -> Seed;
    fn density(&self) -> Density<D>;
    /// Calls `found` with the points whose squared distance from a place is at most `farthest`, the square of the radius, and
    /// with that distance, until a flag breaks. The ball lies within the set's limit.
    fn scan(
        &self,
        at: [f64; D],
        radius: f64,
        farthest: f64,
        visits: &Visits,
        found: impl FnMut(f64, <Self::Id as Hashed>::Point),
    ) -> ControlFlow<()>;
}

/// The `k` nearest points, in order, at most those within a radius.
pub(crate) fn nearest<S: Searched<D>, const D: usize>(
    set: &S,
    at: [f64; D],
    k: usize,
    most: Option<f64>,
    visits: &Visits,
) -> Result<Vec<Neighbor<S::Id>>, Error> {
    check_neighbors(k)?;
    if let Some(most) = most {
        check_radius(most)?;
    }
    let most = most.unwrap_or(f64::INFINITY);
    // A ball that holds k + √k + 1 points on average mostly has k.
    let wanted = k as f64 + libm::sqrt(k as f64) + 1.0;
    let mut radius = most.min(set.density().radius_of(wanted));
    loop {
        let mut found = within(set, at, radius, MAX_CANDIDATES, visits)?;
        if found.len() >= k || radius >= most {
            found.truncate(k);
            return Ok(found);
        }
        radius = most.min(radius * 1.5);
    }
}

/// All points within a radius, `limit` at most, in order.
pub(crate) fn within<S: Searched<D>, const D: usize>(
    set: &S,
    at: [f64; D],
    radius: f64,
    limit: usize,
    visits: &Visits,
) -> Result<Vec<Neighbor<S::Id>>, Error> {
    check_place(at)?;
    check_radius(radius)?;
    let density = set.density();
    // Counts come close to their means in balls of many points.
    let generous = limit.saturating_mul(2).max(100);
    density.check_number(radius, density.share, generous)?;
    density.check_work(radius, visits.most())?;
    check_reach(density.limit, at, radius)?;
    let (mut found, mut inside) = (Vec::with_capacity(limit.min(12)), 0usize);
    let scanned = set.scan(at, radius, farthest(radius), visits, |squared, point| {
        inside += 1;
        if inside <= limit {
            found.push((squared, point));
        }
    });
    if scanned.is_break() {
        return Err(Stop::error());
    }
    if inside > limit {
        return Err(too_many(radius, inside as f64, limit));
    }
    found.sort_unstable_by(|(d, p), (e, q)| {
        let by_id = || S::Id::of(p).cmp(&S::Id::of(q));
        d.total_cmp(e).then_with(by_id)
    });
    let neighbor = |(squared, point)| Neighbor {
        member: Member::new(point, set.seed()),
        distance: libm::sqrt(squared),
    };
    Ok(found.into_iter().map(neighbor).collect())
}
