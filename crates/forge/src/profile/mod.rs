//! Noise profiles: what a name such as `blue` asks for.
//!
//! A profile says how a table is optimized and what must be measured on it before it is accepted.
//! To add one: a constant here, its name in [`Profile::ALL`], and, for a new kind of energy, a
//! variant of [`Recipe`] with its branch in the forge.

use crate::{
    ForgeError,
    judge::{Bound, Figure},
};

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
}

/// Parameters of [`Recipe::Gaussian`]; lengths in mean spacings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianRecipe {
    /// Width of the Gaussian in the first phase.
    pub sigma: f64,
    /// Its width in the second phase. A wider Gaussian goes on lowering the low frequencies and
    /// leaves the rest as it is; the first phase alone, run until the low frequencies are as low,
    /// also sharpens the set and raises its spectral peak.
    pub polish_sigma: f64,
    /// The second phase's share of the steps.
    pub polish_share: f64,
    /// Pairs closer than this are pushed apart besides: the smallest distance ends a little below.
    pub guard_reach: f64,
    /// How hard.
    pub guard_strength: f64,
    /// Spacings moved per unit of gradient.
    pub rate: f64,
}

/// Gaussian blue noise of σ = 1: the least low-frequency power.
const BLUE: Profile = Profile {
    name: "blue",
    summary: "Gaussian blue noise, sigma 1: least power at low frequencies",
    recipe: Recipe::Gaussian(GaussianRecipe {
        sigma: 1.0,
        polish_sigma: 1.15,
        polish_share: 0.52,
        guard_reach: 0.72,
        guard_strength: 0.3,
        rate: 0.2,
    }),
    jitter: 0.7,
    steps: 250,
    bounds: &[
        Bound::at_most(Figure::LowPower, 2e-5),
        Bound::at_most(Figure::PeakPower, 3.0),
        Bound::at_least(Figure::DeltaMin, 0.6),
    ],
};

impl Profile {
    /// All profiles that can be made.
    pub const ALL: &'static [Self] = &[BLUE];

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
            Self::Gaussian(recipe) => {
                let parameters = [
                    ("sigma", recipe.sigma),
                    ("polish_sigma", recipe.polish_sigma),
                    ("polish_share", recipe.polish_share),
                    ("guard_reach", recipe.guard_reach),
                    ("guard_strength", recipe.guard_strength),
                    ("rate", recipe.rate),
                ];
                let text = parameters.map(|(name, value)| (name.into(), value.to_string()));
                ("gaussian", text.into())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_are_found_by_name_and_others_are_refused_with_the_names_there_are() {
        for profile in Profile::ALL {
            assert_eq!(Profile::named(profile.name).expect("valid"), profile);
            assert!(!profile.bounds.is_empty(), "{}", profile.name);
        }
        let error = Profile::named("mauve").expect_err("refused").to_string();
        assert!(error.contains("mauve") && error.contains("blue"), "{error}");
    }
}
