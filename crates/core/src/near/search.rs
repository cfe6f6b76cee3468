//! Searches: the nearest points of a place, and all points within a radius.
//!
//! Both are exact for the reported coordinates: distances are those of the `f64` pairs, compared as
//! dx·dx + dy·dy in plain `f64`, and their square roots with the radius. Among equals the smaller id comes first.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::{
    limits::{
        MAX_CANDIDATES, Visits, check_neighbors, check_number, check_place, check_radius,
        check_reach, check_work, farthest, limit as limit_of, too_many,
    },
    mask::Mask,
    scan::{Scratch, scan},
};
use crate::{
    error::Error,
    lattice::{Lattice, Point},
    shape::Region,
    stop::Stop,
};

/// A point found, with its squared distance.
pub(crate) type Found = (f64, Point);

/// The `k` nearest points, in order, at most those within a radius.
pub(crate) fn nearest(
    lattice: &Lattice,
    mask: &Mask,
    at: [f64; 2],
    k: usize,
    most: Option<f64>,
    visits: &Visits,
) -> Result<Vec<Found>, Error> {
    check_neighbors(k)?;
    if let Some(most) = most {
        check_radius(most)?;
    }
    let most = most.unwrap_or(f64::INFINITY);
    let placement = lattice.placement;
    // A disk that holds k + √k + 1 points on average mostly has k.
    let wanted = k as f64 + libm::sqrt(k as f64) + 1.0;
    let area = wanted / (core::f64::consts::PI * lattice.share());
    let mut radius = most.min(placement.spacing.get() * libm::sqrt(area));
    loop {
        let mut found = within(lattice, mask, at, radius, MAX_CANDIDATES, visits)?;
        if found.len() >= k || radius >= most {
            found.truncate(k);
            return Ok(found);
        }
        radius = most.min(radius * 1.5);
    }
}

/// All points within a radius, `limit` at most, in order.
pub(crate) fn within(
    lattice: &Lattice,
    mask: &Mask,
    at: [f64; 2],
    radius: f64,
    limit: usize,
    visits: &Visits,
) -> Result<Vec<Found>, Error> {
    check_place(at)?;
    check_radius(radius)?;
    // Counts come close to their means in disks of many points.
    let generous = limit.saturating_mul(2).max(100);
    check_number(lattice, radius, lattice.share(), generous)?;
    check_work(lattice, radius, visits.most())?;
    check_reach(limit_of(lattice), at, radius)?;
    let farthest = farthest(radius);
    let around = Region::between(at.map(|v| v - radius), at.map(|v| v + radius));
    let guard = mask.guard(Some(&around));
    let (mut found, mut inside) = (Vec::with_capacity(limit.min(12)), 0usize);
    let mut scratch = Scratch::default();
    let scanned = scan(
        lattice,
        &mut scratch,
        at,
        radius,
        Some(visits),
        |d, point| {
            if d <= farthest && guard.permits(point.at()) {
                inside += 1;
                if inside <= limit {
                    found.push((d, point));
                }
            }
            ControlFlow::Continue(())
        },
    );
    if scanned.is_break() {
        return Err(Stop::error());
    }
    if inside > limit {
        return Err(too_many(radius, inside as f64, limit));
    }
    found.sort_unstable_by(|(d, p), (e, q)| d.total_cmp(e).then(p.id.cmp(&q.id)));
    Ok(found)
}
