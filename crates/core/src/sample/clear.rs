//! Keeping clear: points of one layer that stay away from those of another.
//!
//! Whether a point stays is decided by the other layer's points near it, on the unbounded plane,
//! never by the region that is asked for: so neighboring regions agree.

use alloc::{sync::Arc, vec::Vec};
use core::cell::RefCell;

use super::{Area, Clearance, Placement, Point, Sampler};

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
    pub clear: Arc<[ClearOf]>,
}

/// A distance that points keep from all points of a layer.
#[derive(Clone, Debug)]
pub struct ClearOf {
    layer: Arc<Layer>,
    clearance: Clearance,
}

/// A distance that nothing can keep.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the distance is {distance}; it must be a number above 0 and at most {limit}, {spacings} mean \
     spacings of the layer",
    spacings = ClearOf::MAX_SPACINGS
)]
pub struct ClearOfError {
    /// The distance.
    pub distance: f64,
    /// The largest one allowed.
    pub limit: f64,
}

impl ClearOf {
    /// The largest distance in mean spacings of the layer that is kept clear of. Hardly a place is
    /// farther than one spacing from the next point, so a larger distance leaves nothing within the
    /// layer.
    pub const MAX_SPACINGS: f64 = 16.0;

    /// A distance from all points of a layer, in world units.
    ///
    /// # Errors
    /// [`ClearOfError`] unless it is above 0 and at most [`MAX_SPACINGS`](Self::MAX_SPACINGS).
    pub fn new(layer: Arc<Layer>, distance: f64) -> Result<Self, ClearOfError> {
        let limit = layer.placement.spacing.get() * Self::MAX_SPACINGS;
        let refused = ClearOfError { distance, limit };
        if !(distance > 0.0 && distance <= limit) {
            return Err(refused);
        }
        let finder = layer.sampler.finder(layer.placement);
        let clearance = finder.clearance(distance).map_err(|_| refused)?;
        Ok(Self { layer, clearance })
    }

    /// One to ask.
    pub(super) fn guard(&self) -> Guard {
        Guard {
            layer: self.layer.clone(),
            clearance: RefCell::new(self.clearance.clone()),
            of_layer: self.layer.clear.iter().map(Self::guard).collect(),
        }
    }
}

/// Asks whether places are clear of a layer.
#[derive(Clone, Debug)]
pub(super) struct Guard {
    layer: Arc<Layer>,
    /// It keeps memory from place to place.
    clearance: RefCell<Clearance>,
    /// What the layer's own points keep clear of.
    of_layer: Vec<Self>,
}

impl Guard {
    /// Whether a place is far enough from all points of the layer.
    pub(super) fn leaves(&self, p: [f64; 2]) -> bool {
        let exists = |point: &Point| {
            let q = [point.x, point.y];
            let area = self.layer.area.as_ref();
            area.is_none_or(|area| area.contains(q))
                && self.of_layer.iter().all(|guard| guard.leaves(q))
        };
        !self.clearance.borrow_mut().is_any_near(p, exists)
    }
}
