//! The points nearest to a place.

use alloc::{sync::Arc, vec::Vec};

use super::{
    Batch, Region, Volume,
    clearance::AnyWalk,
    lattice::{LATTICE_LIMIT, Lattice, fixed},
    mask::Mask,
    point::{Point, PointId},
    scope::Scope,
};
use crate::{
    error::Error,
    near::{
        Visits,
        limits::{
            BORDER, MAX_CANDIDATES, check_neighbors, check_place, check_radius, check_reach,
            farthest, too_many,
        },
    },
    stop::Stop,
};

/// A point near a place, and its distance.
///
/// ```
/// use strew_core::space::{Neighbor, SpaceSet, Table};
///
/// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
/// let Neighbor { point, distance } = set.nearest([10.0, 3.0, 0.0], 1)?[0];
/// let [dx, dy, dz] = [point.x - 10.0, point.y - 3.0, point.z];
/// assert_eq!(distance, (dx * dx + dy * dy + dz * dz).sqrt());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// The point.
    pub point: Point,
    /// The distance from the place, in world units.
    pub distance: f64,
}

/// The `k` points nearest to a place, within a radius if there is one, nearest first; of equally near ones that with the
/// smaller id.
pub(super) fn nearest(
    lattice: &Lattice,
    mask: &Mask,
    at: [f64; 3],
    k: usize,
    within: Option<f64>,
    visits: &Visits,
) -> Result<Vec<Neighbor>, Error> {
    check_place(at)?;
    check_neighbors(k)?;
    if let Some(radius) = within {
        check_radius(radius)?;
    }
    let share = lattice.placement.shown();
    let spacing = lattice.placement.spacing.get() / libm::cbrt(share);
    // A ball that holds k points on average, and a little more.
    let mut radius = spacing * (libm::cbrt(k as f64 * 0.239) + 0.7);
    loop {
        if let Some(most) = within {
            radius = radius.min(most);
        }
        check(lattice, at, radius)?;
        let mut found = around(lattice, mask, at, radius, visits)?;
        found.sort_unstable_by(|a, b| {
            let by_distance = a.0.total_cmp(&b.0);
            by_distance.then_with(|| a.1.id.cmp(&b.1.id))
        });
        if found.len() >= k || within == Some(radius) {
            let neighbors = found.into_iter().take(k);
            let neighbor = |(squared, point)| Neighbor {
                point,
                distance: libm::sqrt(squared),
            };
            return Ok(neighbors.map(neighbor).collect());
        }
        radius *= 1.4;
    }
}

/// Refuses a search that leaves the lattice's limit or visits too many points.
fn check(lattice: &Lattice, at: [f64; 3], radius: f64) -> Result<(), Error> {
    check_reach(lattice.world(fixed(LATTICE_LIMIT - BORDER)), at, radius)?;
    let spacings = radius / lattice.placement.spacing.get();
    let about = 8.0 * spacings * spacings * spacings;
    if about > MAX_CANDIDATES as f64 {
        return Err(too_many(radius, about, MAX_CANDIDATES));
    }
    Ok(())
}

/// The points within a radius, its end included, with their squared distances.
fn around(
    lattice: &Lattice,
    mask: &Mask,
    at: [f64; 3],
    radius: f64,
    visits: &Visits,
) -> Result<Vec<(f64, Point)>, Error> {
    // Rounded coordinates of the box do not lose points at the radius.
    let wide = radius * (1.0 + 1e-12);
    let [min, max] = [
        at.map(|v| (v - wide).next_down()),
        at.map(|v| (v + wide).next_up().next_up()),
    ];
    let volume = Volume::Region(Region::between(min, max));
    let scope = Arc::new(Scope::new(lattice, mask, &volume, visits.stop().clone())?);
    let mut walk = AnyWalk::new(scope.clone(), &scope.all, None, true);
    let (mut batch, mut found) = (Batch::default(), Vec::new());
    let farthest = farthest(radius);
    while walk.next(&mut batch) {
        if visits.row(batch.len()).is_break() {
            break;
        }
        for (i, id) in batch.ids.iter().enumerate() {
            let origin = batch.origin;
            let place = batch.place(i);
            let [dx, dy, dz] = [0, 1, 2].map(|axis| lattice.world(place[axis]) - at[axis]);
            let squared = dx * dx + dy * dy + dz * dz;
            if squared <= farthest {
                let id = PointId::of([0, 1, 2].map(|axis| origin[axis] + i64::from(id[axis])));
                found.push((squared, lattice.point_at(id, place)));
            }
        }
    }
    // Walks end early, too.
    match visits.is_stopped() {
        true => Err(Stop::error()),
        false => Ok(found),
    }
}
