//! Noise profiles: what a name such as `blue` stands for.
//!
//! A [`Profile`] says how a table is optimized and which bounds its figures must satisfy before it
//! is accepted. `named.rs` holds the profiles as constants. Each has a [`Recipe`], the parameters of an optimizer.
//! An [`Aim`] is read back from a finished table: the statement, bounds and curve it was made for.
//!
//! To add a profile, add a constant there and its name to [`Profile::ALL`]. For
//! a new kind of optimizer, also add a variant of [`Recipe`].

use strew_core::table::Provenance;

use self::named::{BLUE, CUSTOM, GREEN, LLOYD, PINK, SHARP, SINGLE_PEAK, SPACED, STEP};
use crate::{
    ForgeError,
    curve::{Target, from_parameters},
    judge::{Bound, bounds_of_curve},
};

mod named;
mod recipe;

pub use recipe::{Following, Profile, Push, Recipe, Repulsion};

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
    pub fn named(name: &str) -> Result<&'static Self, ForgeError> {
        let found = Self::ALL.iter().find(|profile| profile.name == name);
        found.ok_or_else(|| {
            let names: Vec<&str> = Self::ALL.iter().map(|profile| profile.name).collect();
            ForgeError::field("profile", format!("{name:?}"), names.join(", "))
        })
    }
}

/// The aim of a table in words, bounds and, for some, a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Aim {
    /// The aim in words: the summary of the table's profile.
    pub statement: String,
    /// The bounds on figures of point sets that the table was not optimized on.
    pub bounds: Vec<Bound>,
    /// The radial power curve to follow, if any.
    pub curve: Option<Target>,
}

impl Aim {
    /// Returns the aim of a table with this profile and history, or `None` if they do not identify
    /// it, as for imported tables.
    pub fn of(profile: &str, history: &Provenance) -> Option<Self> {
        let curve = from_parameters(&history.parameters);
        let known = Profile::ALL.iter().find(|known| {
            let (optimizer, _) = known.recipe.describe();
            known.name == profile && optimizer == history.optimizer
        });
        match (known, curve) {
            (Some(known), curve) => Some(Self {
                statement: known.summary.to_owned(),
                bounds: known.bounds.to_vec(),
                curve,
            }),
            (None, Some(curve)) => Some(Self {
                statement: "A custom radial power curve".to_owned(),
                bounds: bounds_of_curve(&curve),
                curve: Some(curve),
            }),
            (None, None) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::to_parameters;

    fn history(optimizer: &str, parameters: Vec<(String, String)>) -> Provenance {
        Provenance {
            optimizer: optimizer.into(),
            parameters,
            ..Provenance::default()
        }
    }

    #[test]
    fn a_curve_of_any_length_is_read_back() {
        for count in [1, 2, 40, 1000] {
            let nu = |i: u32| f64::from(i) * 0.003;
            let points = (0..count).map(|i| [nu(i), 1.0 / (1.0 + nu(i))]).collect();
            let target = Target::new(points).expect("valid");
            let parameters = to_parameters(&target);
            assert!(parameters.iter().all(|(_, text)| text.len() <= 1000));
            let aim = Aim::of("mine", &history("radial", parameters)).expect("identified");
            assert_eq!(aim.curve, Some(target));
            assert_eq!(aim.bounds[0].figure.name(), "target_rms");
        }
    }

    #[test]
    fn known_profiles_have_an_aim_and_imported_tables_none() {
        let blue = Aim::of("blue", &history("gaussian", vec![])).expect("known");
        assert!(blue.statement.contains("Gaussian") && blue.curve.is_none());
        assert!(!blue.bounds.is_empty());
        assert_eq!(Aim::of("blue", &history("import", vec![])), None);
        let bad = vec![("target".into(), "nonsense".into())];
        assert_eq!(Aim::of("mine", &history("radial", bad)), None);
    }

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
