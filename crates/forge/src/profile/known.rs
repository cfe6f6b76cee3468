//! The list of profiles, and finding them by name.

use super::{
    Profile,
    blue::{BLUE, LLOYD, SHARP, SPACED},
    curves::{CUSTOM, GREEN, PINK, SINGLE_PEAK, STEP},
    pattern::PATTERN,
};
use crate::ForgeError;

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
            Ok(_) => Err(ForgeError::Field {
                field: "profile",
                value: format!("{name:?}"),
                allowed: "for a custom curve, any name that no built-in profile has".into(),
            }),
        }
    }

    /// Returns the profile of this name.
    ///
    /// # Errors
    /// [`ForgeError::Field`] with the allowed names if there is none.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::Recipe;

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
