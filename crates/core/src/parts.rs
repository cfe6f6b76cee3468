//! Parts that features of the crate leave out, for programs that must be small.
//!
//! Without its feature a part has no methods, or constructors that return an error. The compiler drops the code behind a
//! constant that is false, and behind a mark that has no values.

use crate::error::Error;
#[cfg(not(all(feature = "kinds", feature = "polygons")))]
use crate::error::ErrorKind;

/// Sets in fields.
pub(crate) const FIELDS: bool = cfg!(feature = "fields");

/// Sets that keep clear of others.
pub(crate) const CLEARANCE: bool = cfg!(feature = "clearance");

/// The mark of what has kinds of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OfKinds {
    #[cfg(feature = "kinds")]
    Built,
}

impl OfKinds {
    pub(crate) fn get() -> Result<Self, Error> {
        #[cfg(feature = "kinds")]
        return Ok(Self::Built);
        #[cfg(not(feature = "kinds"))]
        Err(missing(ErrorKind::Kinds, "kinds"))
    }
}

/// The mark of polygons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum OfPolygons {
    #[cfg(feature = "polygons")]
    Built,
}

impl OfPolygons {
    pub(crate) fn get() -> Result<Self, Error> {
        #[cfg(feature = "polygons")]
        return Ok(Self::Built);
        #[cfg(not(feature = "polygons"))]
        Err(missing(ErrorKind::Area, "polygons"))
    }
}

#[cfg(not(all(feature = "kinds", feature = "polygons")))]
fn missing(kind: ErrorKind, part: &'static str) -> Error {
    let allowed = "built in, by the feature of this name";
    Error::new(kind, part, "left out", allowed)
}
