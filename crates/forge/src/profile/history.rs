//! What a table was made for, from its own history.

use strew_core::table::Provenance;

use super::{Profile, Target};
use crate::judge::{Bound, bounds_of_curve};

/// The parameter that a curve is kept in; further parts are `target_2`, `target_3`, ….
const PARAMETER: &str = "target";
/// Longer parameters are split.
const PARAMETER_BYTES: usize = 800;

/// The target of a table: what it was made to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Aim {
    /// In words.
    pub statement: String,
    /// What must be measured on sets that the table was not made on.
    pub bounds: Vec<Bound>,
    /// The radial power curve to follow, if it is a curve.
    pub curve: Option<Target>,
}

impl Aim {
    /// Of a table with that profile and history; `None` if they do not tell, as for tables that were
    /// made elsewhere.
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
                statement: "A radial power curve that somebody drew".to_owned(),
                bounds: bounds_of_curve(&curve),
                curve: Some(curve),
            }),
            (None, None) => None,
        }
    }
}

/// A curve as parameters of a history: `nu power` separated by semicolons, in parts of moderate
/// length.
pub(crate) fn to_parameters(target: &Target) -> Vec<(String, String)> {
    let mut parts = vec![String::new()];
    for [nu, power] in target.points() {
        let point = format!("{nu} {power}");
        match parts.last_mut() {
            Some(part) if part.is_empty() => part.push_str(&point),
            Some(part) if part.len() + point.len() < PARAMETER_BYTES => {
                part.push_str("; ");
                part.push_str(&point);
            }
            _ => parts.push(point),
        }
    }
    let name = |part: usize| match part {
        0 => PARAMETER.to_owned(),
        more => format!("{PARAMETER}_{}", more + 1),
    };
    let named = parts.into_iter().enumerate();
    named.map(|(part, text)| (name(part), text)).collect()
}

/// The curve of a history, if it has one that can be read.
fn from_parameters(parameters: &[(String, String)]) -> Option<Target> {
    let is_part = |name: &str| {
        let rest = name.strip_prefix(PARAMETER);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
    };
    let parts = parameters.iter().filter(|(name, _)| is_part(name));
    let lines: Vec<String> = parts.map(|(_, text)| text.replace(';', "\n")).collect();
    if lines.is_empty() {
        return None;
    }
    lines.join("\n").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(optimizer: &str, parameters: Vec<(String, String)>) -> Provenance {
        Provenance {
            optimizer: optimizer.into(),
            parameters,
            ..Provenance::default()
        }
    }

    #[test]
    fn a_curve_of_any_length_comes_back() {
        for count in [1, 2, 40, 1000] {
            let nu = |i: u32| f64::from(i) * 0.003;
            let points = (0..count).map(|i| [nu(i), 1.0 / (1.0 + nu(i))]).collect();
            let target = Target::new(points).expect("valid");
            let parameters = to_parameters(&target);
            assert!(parameters.iter().all(|(_, text)| text.len() <= 1000));
            let aim = Aim::of("mine", &history("radial", parameters)).expect("told");
            assert_eq!(aim.curve, Some(target));
            assert_eq!(aim.bounds[0].figure.name(), "target_rms");
        }
    }

    #[test]
    fn known_profiles_state_their_bounds_and_foreign_tables_nothing() {
        let blue = Aim::of("blue", &history("gaussian", vec![])).expect("known");
        assert!(blue.statement.contains("Gaussian") && blue.curve.is_none());
        assert!(!blue.bounds.is_empty());
        assert_eq!(Aim::of("blue", &history("import", vec![])), None);
        let bad = vec![("target".into(), "nonsense".into())];
        assert_eq!(Aim::of("mine", &history("radial", bad)), None);
    }
}
