//! Masks: the volume that a set is limited to, and the sets that it keeps clear of.

use super::{Prism, lattice::Lattice};

/// The conditions on the places of a set's points.
pub(super) type Mask = crate::near::Mask<Other, 3, Prism>;

/// A set of space that others keep clear of.
#[derive(Clone, Debug)]
pub(crate) struct Other {
    pub(super) lattice: Lattice,
    pub(super) mask: Mask,
}
