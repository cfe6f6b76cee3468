//! Neighbors: which points near a place are asked for.

use super::{
    faults::Faults,
    number,
    parameters::{MOST_NEAREST, NEAREST, PLACE, RADIUS},
    region::listed,
};
use crate::service::Fault;

/// Which neighbors are asked for, not checked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AroundDraft {
    /// The place; it must be there.
    pub at: Option<[f64; 2]>,
    /// How many at most; by default 1, or all within the radius.
    pub k: Option<u64>,
    /// How far away at most; however far by default.
    pub radius: Option<f64>,
}

/// Which neighbors are asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around {
    /// The place.
    pub at: [f64; 2],
    /// How many at most.
    pub k: Option<usize>,
    /// How far away at most.
    pub radius: Option<f64>,
}

impl AroundDraft {
    /// Checks it. `found` are the faults found on the way here; a field that one of them names is
    /// not faulted again.
    ///
    /// # Errors
    /// Every fault.
    pub fn check(self, found: Vec<Fault>) -> Result<Around, Vec<Fault>> {
        const DETAIL: &str = "it is out of range";
        let mut faults = Faults::new(found);
        match self.at {
            Some(at) if at.iter().all(|v| v.is_finite()) => {}
            Some(at) => faults.add(Fault::new("at", listed(&at), DETAIL, PLACE)),
            None => faults.add(Fault::missing("at", PLACE)),
        }
        if let Some(k) = self.k.filter(|k| !(1..=MOST_NEAREST).contains(k)) {
            faults.add(Fault::new("k", k, DETAIL, NEAREST));
        }
        let is_distance = |radius: f64| radius.is_finite() && radius >= 0.0;
        if let Some(radius) = self.radius.filter(|radius| !is_distance(*radius)) {
            faults.add(Fault::new("radius", number(radius), DETAIL, RADIUS));
        }
        match self.at {
            Some(at) if faults.is_empty() => Ok(Around {
                at,
                k: self.k.and_then(|k| k.try_into().ok()),
                radius: self.radius,
            }),
            _ => Err(faults.into_inner()),
        }
    }
}
