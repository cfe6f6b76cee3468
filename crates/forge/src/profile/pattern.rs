//! The profile `pattern`, without displacement.

use super::{Profile, Recipe};

/// The AA pattern itself. Its figures have no bounds; they are recorded for comparison.
pub(super) const PATTERN: Profile = Profile {
    name: "pattern",
    summary: "the AA pattern itself, without displacement",
    recipe: Recipe::Undisplaced,
    jitter: 0.0,
    steps: 1,
    bounds: &[],
};
