//! The aim of a table, read from its history.

use strew_core::table::Provenance;

use super::Profile;
use crate::{
    curve::{Target, from_parameters},
    judge::{Bound, bounds_of_curve},
};

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
    #[must_use]
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
}
