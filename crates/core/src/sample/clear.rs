//! Keeping clear: points of one layer that stay away from those of another.
//!
//! Whether a point stays is decided by the other layer's points near it, on the unbounded plane,
//! never by the region that is asked for: so neighboring regions agree.

use alloc::sync::Arc;

use super::{Area, Placement, Region, Sampler};

/// The points of a layer: everything that decides whether one exists.
#[derive(Clone, Debug)]
pub struct Layer {
    /// The table.
    pub sampler: Arc<Sampler>,
    /// Spacing, seed and warp.
    pub placement: Placement,
    /// Where the layer is; everywhere if `None`.
    pub area: Option<Area>,
    /// What its points keep clear of.
    pub clear: Arc<[Clearance]>,
}

/// A distance that points keep from all points of a layer.
#[derive(Clone, Debug)]
pub struct Clearance {
    of: Arc<Layer>,
    distance: f64,
}

/// A distance that nothing can keep.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the distance is {distance}; it must be a number above 0 and at most {limit}, {spacings} mean \
     spacings of the layer",
    spacings = Clearance::MAX_SPACINGS
)]
pub struct ClearanceError {
    /// The distance.
    pub distance: f64,
    /// The largest one allowed.
    pub limit: f64,
}

impl Clearance {
    /// The largest distance in mean spacings of the layer that is kept clear of. Hardly a point is
    /// farther than one spacing from the next, so a larger distance leaves nothing within the layer.
    pub const MAX_SPACINGS: f64 = 16.0;

    /// A distance from all points of a layer, in world units.
    ///
    /// # Errors
    /// [`ClearanceError`] unless it is above 0 and at most [`MAX_SPACINGS`](Self::MAX_SPACINGS).
    pub fn new(of: Arc<Layer>, distance: f64) -> Result<Self, ClearanceError> {
        let limit = of.placement.spacing.get() * Self::MAX_SPACINGS;
        if !(distance > 0.0 && distance <= limit) {
            return Err(ClearanceError { distance, limit });
        }
        Ok(Self { of, distance })
    }

    /// Whether a place is far enough from all points of the layer.
    pub(super) fn leaves(&self, p: [f64; 2]) -> bool {
        let Layer {
            sampler,
            placement,
            area,
            clear,
        } = &*self.of;
        let d = self.distance;
        let corner = |sign: f64| p.map(|v| v + sign * d * (1.0 + 1e-9));
        let Ok(region) = Region::new(corner(-1.0), corner(1.0).map(f64::next_up)) else {
            return true;
        };
        let Ok(plan) = sampler.plan(*placement, region) else {
            return true;
        };
        let mut blocks = plan.blocks_points();
        let mut points = [super::Point::default(); 16];
        loop {
            let filled = blocks.fill(&mut points);
            if filled == 0 {
                return true;
            }
            for point in &points[..filled] {
                let [dx, dy] = [point.x - p[0], point.y - p[1]];
                let exists = || {
                    let q = [point.x, point.y];
                    area.as_ref().is_none_or(|area| area.contains(q))
                        && clear.iter().all(|clearance| clearance.leaves(q))
                };
                if dx * dx + dy * dy < d * d && exists() {
                    return false;
                }
            }
        }
    }
}
