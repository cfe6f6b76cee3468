//! Noise profiles: what a name such as `blue` asks for.
//!
//! A profile says how a table is optimized and what must be measured on it before it is accepted.
//! To add one: a constant in its family's file, its name in [`Profile::ALL`], and, for a new kind of
//! energy, a file with a variant of [`Recipe`].

mod aim;
mod gaussian;
mod lloyd;
mod pattern;
mod radial;
mod spacing;

pub use aim::Aim;
pub use gaussian::GaussianRecipe;
pub use lloyd::LloydRecipe;
pub use radial::RadialRecipe;
pub use spacing::{Push, SpacingRecipe};

use crate::{
    ForgeError,
    curve::Target,
    ground::Ground,
    judge::Bound,
    optimize::{Descent, Objective},
};
use gaussian::{BLUE, SHARP};
use lloyd::LLOYD;
use pattern::PATTERN;
use radial::{CUSTOM, GREEN, PINK, SINGLE_PEAK, STEP};
use spacing::SPACED;

/// A noise profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// Its name, also in table files.
    pub name: &'static str,
    /// What it is, in a line.
    pub summary: &'static str,
    /// How its tables are optimized.
    pub recipe: Recipe,
    /// Half-width, in mean spacings, of the square of the random start.
    pub jitter: f64,
    /// Steps of the optimizer unless a job says otherwise.
    pub steps: u32,
    /// What every unseen subject must satisfy.
    pub bounds: &'static [Bound],
}

/// How tables of a profile are optimized.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Recipe {
    /// Gaussian repulsion, with a guard against close pairs, in two phases.
    Gaussian(GaussianRecipe),
    /// Pairs in conflict are pushed apart, harder and harder.
    Spacing(SpacingRecipe),
    /// Points go to the centroids of their cells.
    Lloyd(LloydRecipe),
    /// A radial power curve, on the unbounded pattern.
    Radial(RadialRecipe),
    /// Not at all: every vector is zero.
    Undisplaced,
}

/// Some steps with one energy.
pub(crate) struct Phase {
    pub(crate) objective: Box<dyn Objective>,
    pub(crate) descent: Descent,
}

impl Profile {
    /// All profiles that can be made.
    pub const ALL: &'static [Self] = &[
        BLUE,
        SHARP,
        SPACED,
        STEP,
        SINGLE_PEAK,
        GREEN,
        PINK,
        LLOYD,
        PATTERN,
    ];

    /// The radial power curve it follows, if it follows one.
    #[must_use]
    pub fn target(&self) -> Option<Target> {
        match self.recipe {
            Recipe::Radial(recipe) => Some(Target::fixed(recipe.curve)),
            Recipe::Gaussian(_) | Recipe::Spacing(_) | Recipe::Lloyd(_) | Recipe::Undisplaced => {
                None
            }
        }
    }

    /// The profile of a curve that somebody drew, under a name that is not taken.
    ///
    /// # Errors
    /// [`ForgeError::Field`] if `name` is that of a known profile.
    pub fn custom(name: &str) -> Result<&'static Self, ForgeError> {
        match Self::named(name) {
            Err(_) => Ok(&CUSTOM),
            Ok(_) => Err(ForgeError::Field {
                field: "profile",
                value: format!("{name:?}"),
                allowed: "for a curve of your own, a name that no known profile has".into(),
            }),
        }
    }

    /// The profile of that name.
    ///
    /// # Errors
    /// [`ForgeError::Field`] with the names there are.
    pub fn named(name: &str) -> Result<&'static Self, ForgeError> {
        Self::ALL
            .iter()
            .find(|profile| profile.name == name)
            .ok_or_else(|| ForgeError::Field {
                field: "profile",
                value: format!("{name:?}"),
                allowed: Self::ALL
                    .iter()
                    .map(|profile| profile.name)
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }
}

impl Recipe {
    /// The optimizer's name and its parameters, for a table's history.
    #[must_use]
    pub fn describe(&self) -> (&'static str, Vec<(String, String)>) {
        match self {
            Self::Gaussian(recipe) => ("gaussian", recipe.describe()),
            Self::Spacing(recipe) => ("spacing", recipe.describe()),
            Self::Lloyd(recipe) => ("lloyd", recipe.describe()),
            Self::Radial(recipe) => ("radial", recipe.describe()),
            Self::Undisplaced => ("none", Vec::new()),
        }
    }

    /// What is done, in order, with so many steps in all; `target` is for recipes that follow a
    /// curve.
    pub(crate) fn phases(
        &self,
        ground: &Ground,
        target: Option<&Target>,
        steps: u32,
    ) -> Vec<Phase> {
        match self {
            Self::Gaussian(recipe) => recipe.phases(ground, steps),
            Self::Spacing(recipe) => recipe.phases(ground, steps),
            Self::Lloyd(recipe) => recipe.phases(ground, steps),
            Self::Radial(recipe) => target
                .map(|target| recipe.phases(ground, target, steps))
                .unwrap_or_default(),
            Self::Undisplaced => Vec::new(),
        }
    }
}

/// Numbers with their names, as text.
fn named(parameters: &[(&str, f64)]) -> Vec<(String, String)> {
    let text = |&(name, value): &(&str, f64)| (name.into(), value.to_string());
    parameters.iter().map(text).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_are_found_by_name_and_others_are_refused_with_the_names_there_are() {
        for profile in Profile::ALL {
            assert_eq!(Profile::named(profile.name).expect("valid"), profile);
            let optimized = profile.recipe != Recipe::Undisplaced;
            assert_eq!(!profile.bounds.is_empty(), optimized, "{}", profile.name);
        }
        let error = Profile::named("mauve").expect_err("refused").to_string();
        assert!(error.contains("mauve") && error.contains("blue"), "{error}");
    }
}
