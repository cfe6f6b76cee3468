//! The recipe of a profile: one of the ways to optimize a table.

use super::recipes::{GaussianRecipe, LloydRecipe, Phase, RadialRecipe, SpacingRecipe};
use crate::{curve::Target, domain::Domain};

/// The way in which the tables of a profile are optimized.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Recipe {
    /// Gaussian repulsion with a guard against close pairs, in two phases.
    Gaussian(GaussianRecipe),
    /// Pairs in conflict are pushed apart, harder from stage to stage.
    Spacing(SpacingRecipe),
    /// Points move to the centroids of their Voronoi cells.
    Lloyd(LloydRecipe),
    /// A radial power curve is followed.
    Radial(RadialRecipe),
    /// No optimization: every vector is zero.
    Undisplaced,
}

impl Recipe {
    /// The optimizer's name and its parameters (name, value), as a table's history records them.
    #[must_use]
    pub fn describe(&self) -> (&'static str, Vec<(String, String)>) {
        match self {
            Self::Gaussian(recipe) => ("gaussian", as_text(recipe.parameters())),
            Self::Spacing(recipe) => ("spacing", as_text(recipe.parameters())),
            Self::Lloyd(recipe) => ("lloyd", as_text(recipe.parameters())),
            Self::Radial(recipe) => ("radial", as_text(recipe.parameters())),
            Self::Undisplaced => ("none", Vec::new()),
        }
    }

    /// The phases in order, with `steps` steps in all. `target` is the curve for
    /// [`Recipe::Radial`], which has no phases without one; the others ignore it.
    pub(crate) fn phases(
        &self,
        domain: &Domain,
        target: Option<&Target>,
        steps: u32,
    ) -> Vec<Phase> {
        match self {
            Self::Gaussian(recipe) => recipe.phases(domain, steps),
            Self::Spacing(recipe) => recipe.phases(domain, steps),
            Self::Lloyd(recipe) => recipe.phases(domain, steps),
            Self::Radial(recipe) => target
                .map(|target| recipe.phases(domain, target, steps))
                .unwrap_or_default(),
            Self::Undisplaced => Vec::new(),
        }
    }
}

fn as_text<V: ToString>(parameters: Vec<(&str, V)>) -> Vec<(String, String)> {
    let text = |(name, value): (&str, V)| (name.to_owned(), value.to_string());
    parameters.into_iter().map(text).collect()
}
