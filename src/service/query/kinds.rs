//! Kinds: variants that are evenly spread.

use strew_core::{Variants, table::Shares};

use super::{
    Checked, Together as _, Values,
    parameters::{ONLY, SPREAD, VARIANTS},
};
use crate::service::{Fault, query::unknown};

/// How variants are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// Evenly, each of them and all together; points do not move.
    Even,
    /// More evenly still, on a table whose points were moved for these shares.
    Joint,
}

/// What a spread of neither is called: each point has a variant by chance.
pub(super) const CHANCE: &str = "chance";

impl Spread {
    /// What may be said.
    pub const NAMES: &'static [&'static str] = &[CHANCE, Self::Even.name(), Self::Joint.name()];

    /// What it is called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::Joint => "joint",
        }
    }
}

/// Variants that are evenly spread.
#[derive(Clone, Debug, PartialEq)]
pub struct Kinds {
    /// Their names and weights.
    pub variants: Variants,
    /// Their shares, in the order of the table's kinds.
    pub shares: Shares,
    /// How they are spread.
    pub spread: Spread,
    /// The only one that is wanted, by its place among the variants.
    pub only: Option<u32>,
}

impl Kinds {
    /// Checks the kinds among some values.
    pub(super) fn check(values: &Values) -> Checked<Option<Self>> {
        let (name, only) = (values.get::<String>(&SPREAD), values.get::<String>(&ONLY)).together()?;
        let spread = match name.as_deref() {
            Some("even") => Spread::Even,
            Some("joint") => Spread::Joint,
            _ if only.is_some() => {
                return Err(values.fault(&ONLY, "has no effect with spread chance").into());
            }
            _ => return Ok(None),
        };
        let Some(variants) = super::attributes::variants(values)? else {
            return Err(values.missing(&VARIANTS).into());
        };
        let weights = variants.weights().map(|(_, weight)| weight);
        let shares = Shares::new(weights).map_err(|error| {
            let allowed = format!("{}, with spread {}", error.allowed(), spread.name());
            let field = format!("{}{}", values.path(), VARIANTS.name);
            Fault::new(&field, values.text(&VARIANTS), error.to_string(), allowed)
        })?;
        let only = only.map(|only| {
            let place = variants.names().position(|name| name == only);
            place.and_then(|place| u32::try_from(place).ok()).ok_or_else(|| {
                let detail = unknown("variant", &only, variants.names());
                let field = format!("{}{}", values.path(), ONLY.name);
                let names: Vec<&str> = variants.names().collect();
                Fault::new(&field, only, detail, names.join(", "))
            })
        });
        Ok(Some(Self {
            only: only.transpose()?,
            variants,
            shares,
            spread,
        }))
    }

    /// The name of the only one that is wanted.
    #[must_use]
    pub fn only_name(&self) -> Option<&str> {
        self.variants.name(self.only?)
    }
}

#[cfg(test)]
mod tests {
    use super::{
        super::{groups, parse_pairs},
        *,
    };

    #[test]
    fn faults_say_what_is_missing_or_wrong() {
        for (text, field, part) in [
            ("only=oak", "only", "no effect with spread chance"),
            ("spread=even", "variants", "missing"),
            ("spread=even&variants=oak:1", "variants", "from 2 to"),
            ("spread=even&variants=oak:1,elm:1000000", "variants", "elm"),
            ("spread=even&variants=oak:3,birch:1&only=oka", "only", "did you mean `oak`?"),
            ("spread=evn&variants=oak:3,birch:1", "spread", "did you mean `even`?"),
        ] {
            let faults = Kinds::check(&parse_pairs(text, groups::POINTS)).expect_err(text);
            let fault = &faults.as_slice()[0];
            assert_eq!(fault.field, field, "{text}");
            let words = format!("{} {}", fault.detail, fault.allowed);
            assert!(words.contains(part), "{text}: {words}");
        }
    }

    #[test]
    fn the_order_of_names_does_not_matter() {
        let kinds = |text| Kinds::check(&parse_pairs(text, groups::POINTS)).expect("valid");
        let one = kinds("spread=even&variants=oak:3,birch:1&only=oak");
        assert_eq!(one, kinds("spread=even&variants=birch:1,oak:3&only=oak"));
        let one = one.expect("kinds");
        assert_eq!((one.only_name(), one.shares.to_string()), (Some("oak"), "1:3".into()));
        assert_eq!(kinds("spread=chance&variants=birch:1,oak:3"), None);
    }
}
