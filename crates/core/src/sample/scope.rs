//! Scopes: the part of a lattice that a plan covers.

use super::{
    area::{Area, CORNERS, Region},
    lattice::{LATTICE_LIMIT, Lattice, Span},
    near::Mask,
    sieve::Sieve,
    stop::Stop,
};
use crate::error::{Error, ErrorKind, number};

/// The columns and rows around an area, and what their points must satisfy.
#[derive(Clone, Debug)]
pub(crate) struct Scope {
    pub(crate) lattice: Lattice,
    pub(crate) x: Span,
    pub(crate) y: Span,
    /// `None` if all points of the box are requested.
    pub(crate) sieve: Option<Sieve>,
    /// Ends counting early.
    pub(crate) stop: Stop,
    /// The box around the area.
    pub(crate) region: Region,
}

impl Scope {
    /// The part of a set, given by its lattice and mask, that lies in an area.
    pub(crate) fn new(
        lattice: &Lattice,
        mask: &Mask,
        area: Area,
        stop: Stop,
    ) -> Result<Self, Error> {
        let mask = mask.clone().and_within(area);
        let area = mask.area.as_ref();
        let region = area.and_then(Area::bounds).ok_or_else(|| {
            let (field, value) = ("area", "unbounded");
            Error::new(ErrorKind::Unbounded, field, value, "within a box")
        })?;
        let limit = lattice.limit();
        let ([min_x, min_y], [max_x, max_y]) = (region.min(), region.max());
        for (name, value) in CORNERS.into_iter().zip([min_x, min_y, max_x, max_y]) {
            if value.abs() > limit {
                let allowed = alloc::format!(
                    "within ±{limit:e} with this spacing, where f64 coordinates still tell neighbors \
                     apart"
                );
                let error = Error::new(ErrorKind::TooFar, name, number(value), allowed);
                return Err(error.because("too far from the origin").with_limit(limit));
            }
        }
        let [x, y] = Span::of_box(lattice, region.min(), region.max());
        debug_assert!(x.all.end < 2 * LATTICE_LIMIT && y.all.end < 2 * LATTICE_LIMIT);
        // Integers decide membership of a box, so it needs no sieve, except together with one.
        let is_box = matches!(area, Some(Area::Region(_)));
        let sieve = if is_box && mask.clear.is_empty() {
            None
        } else {
            Sieve::new(lattice, mask, [x.reach, y.reach])
        };
        Ok(Self {
            lattice: lattice.clone(),
            x,
            y,
            sieve,
            stop,
            region,
        })
    }
}
