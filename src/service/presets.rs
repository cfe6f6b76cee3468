//! Presets: parts of queries that the settings name, so that an address can be short.

use std::{borrow::Cow, collections::BTreeMap, sync::Arc};

use toml::Table;

use super::{
    Catalog, Draft, Error, Fault,
    query::{Checked, Faults, groups, parameters::PRESET, read_body, unknown},
};

/// The presets of the settings, by their names.
#[derive(Clone, Debug, Default)]
pub struct Presets(BTreeMap<String, Preset>);

/// A part of a query.
#[derive(Clone, Debug)]
struct Preset {
    draft: Draft,
    /// As JSON.
    json: Arc<str>,
}

/// A preset that cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("presets.{name}: {error}")]
pub struct PresetError {
    name: String,
    error: Error,
}

/// What names of presets may be.
const NAME: &str = "a name of 1 to 64 ASCII letters, digits, _, - and .";
/// What a preset may be.
const ALLOWED: &str =
    "a section with members of a query: a set of points or layers, limit and the form of answers";

impl Presets {
    /// Reads a section of settings for each preset, and checks them against what is loaded.
    ///
    /// # Errors
    /// For the first that cannot be used.
    pub fn read(
        sections: &Table,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<Self, PresetError> {
        let preset = |(name, section): (&String, &toml::Value)| {
            let read = Preset::read(name, section, catalog, most_vertices);
            let wrong = |error| PresetError {
                name: name.clone(),
                error,
            };
            Ok((name.clone(), read.map_err(wrong)?))
        };
        Ok(Self(sections.iter().map(preset).collect::<Result<_, _>>()?))
    }

    /// The presets as JSON, in the order of their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        let pairs = self.0.iter();
        pairs.map(|(name, preset)| (name.as_str(), &*preset.json))
    }

    /// A draft with what it lacks taken from the preset that it names, and that preset as JSON.
    ///
    /// # Errors
    /// A fault of `preset` if there is none of that name.
    pub fn fill<'a>(&self, draft: &'a Draft) -> Checked<(Cow<'a, Draft>, Option<Arc<str>>)> {
        let named = draft.values.get::<String>(&PRESET);
        let Ok(Some(name)) = named else {
            // A name that could not be read is a fault of the draft.
            return Ok((Cow::Borrowed(draft), None));
        };
        let Some(preset) = self.0.get(&name) else {
            return Err(self.no_preset(draft));
        };
        let mut draft = draft.clone();
        draft.fill_from(&preset.draft);
        Ok((Cow::Owned(draft), Some(preset.json.clone())))
    }

    fn no_preset(&self, draft: &Draft) -> Faults {
        let name = draft.values.text(&PRESET);
        let names = self.0.keys().map(String::as_str);
        let fault = Fault {
            allowed: match self.0.len() {
                0 => "none: the settings of this server have no presets".into(),
                _ => names.clone().collect::<Vec<_>>().join(", "),
            },
            ..draft.values.fault(&PRESET, unknown("preset", &name, names))
        };
        fault.into()
    }
}

impl Preset {
    fn read(
        name: &str,
        section: &toml::Value,
        catalog: &Catalog,
        most_vertices: usize,
    ) -> Result<Self, Error> {
        let is_allowed = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
        if !(1..=64).contains(&name.len()) || !name.chars().all(is_allowed) {
            return Err(Fault::new("presets", name, "not a name of presets", NAME).into());
        }
        let fault = |detail: &str| Fault::new("presets", section, detail, ALLOWED);
        if !section.is_table() {
            return Err(fault("not a section").into());
        }
        let json = serde_json::to_string(section).map_err(|error| fault(&error.to_string()))?;
        let draft = read_body(json.as_bytes(), groups::QUERY)?;
        for (member, is_given) in [
            ("region", !matches!(draft.region, Ok(None))),
            (PRESET.name, draft.values.has(&PRESET)),
        ] {
            if is_given {
                return Err(Fault::new(member, &json, "not allowed in a preset", ALLOWED).into());
            }
        }
        draft.try_out(catalog, most_vertices)?;
        Ok(Self {
            draft,
            json: json.into(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::service::query::parse_pairs;

    fn presets(text: &str) -> Result<Presets, PresetError> {
        let catalog = Catalog::load(true, None).expect("built in");
        Presets::read(&text.parse().expect("TOML"), &catalog, 100)
    }

    fn body(presets: &Presets, address: &str) -> serde_json::Value {
        let draft = Draft::of(parse_pairs(address, groups::POINTS));
        let (filled, json) = presets.fill(&draft).expect("known");
        assert!(json.is_some());
        filled.to_body().into()
    }

    #[test]
    fn what_a_query_lacks_comes_from_the_preset() {
        let presets = presets(
            "[meadow]\nspacing = 2\nseed = 7\nformat = 'csv'\n\
             [[forest.layers]]\nname = 'trees'\nspacing = 3.5\n\
             [[forest.layers]]\nname = 'rocks'\nspacing = 5\nclear_of = { trees = 1.5 }\n",
        );
        let presets = presets.expect("valid");
        let meadow = body(&presets, "bbox=0,0,1,1&preset=meadow&density=4&seed=8");
        assert_eq!(meadow["density"], 4.0, "an amount replaces the preset's");
        assert_eq!(meadow.get("spacing"), None);
        assert_eq!(
            (&meadow["seed"], &meadow["format"]),
            (&8.into(), &"csv".into())
        );
        let forest = body(&presets, "bbox=0,0,1,1&preset=forest");
        assert_eq!(forest["layers"][1]["clear_of"]["trees"], 1.5);
        assert_eq!(
            presets.iter().map(|(name, _)| name).collect::<Vec<_>>(),
            ["forest", "meadow"]
        );
    }

    #[test]
    fn names_that_are_not_there_are_refused_with_those_that_are() {
        let presets = presets("[forest]\nspacing = 2").expect("valid");
        let draft = Draft::of(parse_pairs("bbox=0,0,1,1&preset=forrest", groups::POINTS));
        let faults = presets.fill(&draft).expect_err("unknown");
        let fault = &faults.as_slice()[0];
        assert_eq!(
            (fault.field.as_str(), fault.allowed.as_str()),
            ("preset", "forest")
        );
        assert_eq!(fault.detail, "unknown preset; did you mean `forest`?");
    }

    #[test]
    fn broken_presets_are_refused_at_the_start() {
        for (text, expected) in [
            (
                "forest = 3",
                "presets.forest: `presets` = `3`: not a section",
            ),
            (
                "[forest]\nspacin = 2",
                "presets.forest: `spacin` = `2`: unknown member",
            ),
            (
                "[forest]\nspacing = -2",
                "presets.forest: `spacing` = `-2`: out of range",
            ),
            (
                "[forest]\nregion = { bbox = [0, 0, 1, 1] }",
                "presets.forest: `region`",
            ),
            ("[forest]\npreset = 'a'", "presets.forest: `preset`"),
            (
                "[forest]\nprofile = 'plaid'",
                "presets.forest: `profile` = `plaid`",
            ),
            (
                "['a b']\nspacing = 1",
                "presets.a b: `presets` = `a b`: not a name of presets",
            ),
        ] {
            let error = presets(text).expect_err(text).to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
