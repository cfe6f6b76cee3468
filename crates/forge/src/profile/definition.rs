//! The definition of a noise profile.

use super::Recipe;
use crate::{curve::Target, judge::Bound};

/// A noise profile: how its tables are optimized, and what they must satisfy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// The name, which table files record.
    pub name: &'static str,
    /// A description in one line.
    pub summary: &'static str,
    /// The way in which the tables are optimized.
    pub recipe: Recipe,
    /// The half-width, in mean spacings, of the square that the vectors of the random start fill.
    pub jitter: f64,
    /// The default number of optimizer steps.
    pub steps: u32,
    /// The bounds that the figures of every unseen point set must satisfy.
    pub bounds: &'static [Bound],
}

impl Profile {
    /// The radial power curve that the profile follows, if any.
    #[must_use]
    pub fn target(&self) -> Option<Target> {
        match self.recipe {
            Recipe::Radial { curve, .. } => Some(Target::fixed(curve)),
            _ => None,
        }
    }
}
