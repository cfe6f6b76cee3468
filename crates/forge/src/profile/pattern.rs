//! The profile `pattern`: no displacement.

use super::{Profile, Recipe};

/// The AA pattern itself: points of a lattice. It is what it is, so nothing bounds its figures;
/// they stand in its history for comparison.
pub(super) const PATTERN: Profile = Profile {
    name: "pattern",
    summary: "the AA pattern itself, without displacement",
    recipe: Recipe::Undisplaced,
    jitter: 0.0,
    steps: 1,
    bounds: &[],
};
