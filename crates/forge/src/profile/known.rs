//! The list of profiles, and finding them by name.

use super::{
    Profile, Recipe,
    blue::{BLUE, LLOYD, SHARP, SPACED},
    curves::{CUSTOM, GREEN, PINK, SINGLE_PEAK, STEP},
};
use crate::ForgeError;

/// The AA pattern itself. Its figures have no bounds; they are recorded for comparison.
const PATTERN: Profile = Profile {
    name: "pattern",
    summary: "the AA pattern itself, without displacement",
    recipe: Recipe::Undisplaced,
    jitter: 0.0,
    steps: 1,
    bounds: &[],
};

impl Profile {
    /// All named profiles.
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

    /// Returns the profile for custom curves, under the name `name`.
    ///
    /// # Errors
    /// [`ForgeError::Field`] if `name` is that of a profile in [`ALL`](Self::ALL).
    pub fn custom(name: &str) -> Result<&'static Self, ForgeError> {
        match Self::named(name) {
            Err(_) => Ok(&CUSTOM),
            Ok(_) => Err(ForgeError::field(
                "profile",
                format!("{name:?}"),
                "for a custom curve, any name that no built-in profile has",
            )),
        }
    }

    /// Returns the profile of this name.
    ///
    /// # Errors
    /// [`ForgeError::Field`] with the allowed names if there is none.
    pub fn named(name: &str) -> Result<&'static Self, ForgeError> {
        let found = Self::ALL.iter().find(|profile| profile.name == name);
        found.ok_or_else(|| {
            let names: Vec<&str> = Self::ALL.iter().map(|profile| profile.name).collect();
            ForgeError::field("profile", format!("{name:?}"), names.join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_name_is_refused_with_the_list_of_names() {
        for profile in Profile::ALL {
            assert_eq!(Profile::named(profile.name).expect("valid"), profile);
            let optimized = profile.recipe != Recipe::Undisplaced;
            assert_eq!(!profile.bounds.is_empty(), optimized, "{}", profile.name);
        }
        let error = Profile::named("mauve").expect_err("refused").to_string();
        assert!(error.contains("mauve") && error.contains("blue"), "{error}");
    }
}
