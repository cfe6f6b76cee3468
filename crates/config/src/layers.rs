//! Merging settings: defaults < file < environment < flags.
//!
//! The defaults name every key and fix its type; a later layer can change values, never add keys. Only the
//! sections of [`NAMED`] hold tables that a file names.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use crate::{bounded_file, error::ConfigError, lines};

/// Variables of the environment that begin so are settings.
const PREFIX: &str = "STREW_";
/// Variables that begin so are for tests, and no settings.
const TEST_PREFIX: &str = "STREW_TEST_";
/// Variables that are neither settings nor for tests: the name of a configuration file, a key for a server.
const OTHERS: [&str; 2] = ["STREW_CONFIG", "STREW_API_KEY"];

pub const DEFAULTS: &str = include_str!("../strew.toml");
/// The most bytes of a file of settings. Fields and worlds may hold outlines.
const MOST_BYTES: u64 = 16 << 20;

const NAMED: [&str; 3] = ["fields.", "worlds.", "except."];

/// Layers of settings, merged so far, of which a [`Config`](crate::Config) is made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    pub(crate) merged: Table,
    /// What the environment and flags set: the key, the text and the source of each.
    pub(crate) set: Vec<[String; 3]>,
    /// The files that were laid over.
    pub files: Vec<PathBuf>,
}

impl Layers {
    pub fn new() -> Result<Self, ConfigError> {
        Ok(Self {
            merged: parse("the built-in configuration", DEFAULTS)?,
            ..Self::default()
        })
    }

    /// Lays a file over the layers so far.
    pub fn file(mut self, path: &Path) -> Result<Self, ConfigError> {
        let text =
            bounded_file::read_text(path, MOST_BYTES).map_err(|error| ConfigError::Unreadable {
                path: path.into(),
                error,
            })?;
        let name = path.display().to_string();
        let over = parse(&name, &text)?;
        let sections = self.merged.keys().cloned();
        let keys: Vec<String> = self.keys().into_iter().chain(sections).collect();
        let mut faults = Faults {
            at: &|key| format!("{name}{}", lines::suffix(&text, key)),
            keys: &keys,
            found: vec![],
        };
        merge(&mut self.merged, over, "", &mut faults);
        self.files.push(path.into());
        match faults.found.len() {
            0 => Ok(self),
            1 => Err(faults.found.remove(0)),
            _ => Err(ConfigError::Several(faults.found)),
        }
    }

    /// Lays the environment over the layers so far: `STREW_LIMITS_MAX_POINTS` is `limits.max_points`. Variables that
    /// begin with `STREW_TEST_` belong to the tests.
    pub fn environment(
        mut self,
        variables: impl IntoIterator<Item = (String, String)>,
    ) -> Result<Self, ConfigError> {
        let keys = self.keys();
        let variable = |key: &str| format!("{PREFIX}{}", key.replace('.', "_").to_uppercase());
        let names: Vec<String> = keys.iter().map(|key| variable(key)).collect();
        for (name, value) in variables {
            let is_setting = name.starts_with(PREFIX) && !name.starts_with(TEST_PREFIX);
            if !is_setting || OTHERS.contains(&name.as_str()) {
                continue;
            }
            let Some(at) = names.iter().position(|known| *known == name) else {
                return Err(ConfigError::UnknownKey {
                    source_name: "the environment".into(),
                    suggestions: closest(&name, &names),
                    key: name,
                });
            };
            self = self.set_text(&keys[at], &value, &format!("the environment ({name})"))?;
        }
        Ok(self)
    }

    /// Lays a flag over the layers so far: `key=value`. The last one of a key counts.
    pub fn assignment(self, text: &str) -> Result<Self, ConfigError> {
        let no_value = || ConfigError::Assignment { text: text.into() };
        let (key, value) = text.split_once('=').ok_or_else(no_value)?;
        self.set_text(key, value, &format!("--set {text}"))
    }

    /// Lays a flag of its own over the layers so far.
    pub fn flag(self, flag: &str, key: &str, value: &str) -> Result<Self, ConfigError> {
        if let Some([_, _, first]) = self.by_flags().find(|[known, ..]| known == key) {
            return Err(ConfigError::Twice {
                key: key.into(),
                first: first.clone(),
                second: flag.into(),
            });
        }
        self.set_text(key, value, flag)
    }

    fn by_flags(&self) -> impl Iterator<Item = &[String; 3]> {
        self.set.iter().filter(|[_, _, by]| by.starts_with("--"))
    }

    /// Checks that flags set only the settings of `used`, each a section with a dot or a key. Files and the environment
    /// may set others, since the daemon shares them.
    pub fn only(self, used: &[&str]) -> Result<Self, ConfigError> {
        let is_used = |key: &str| used.iter().any(|used| key.starts_with(used));
        let Some([key, _, source_name]) = self.by_flags().find(|[key, ..]| !is_used(key)).cloned()
        else {
            return Ok(self);
        };
        let used = self.keys().into_iter().filter(|key| is_used(key)).collect();
        Err(ConfigError::Unused {
            source_name,
            key,
            used,
        })
    }

    /// Every key, `section.name`, in the order of the defaults.
    pub(crate) fn keys(&self) -> Vec<String> {
        self.merged
            .iter()
            .filter_map(|(section, value)| Some((section, value.as_table()?)))
            .flat_map(|(section, table)| table.keys().map(move |key| format!("{section}.{key}")))
            .collect()
    }

    /// The value of a key, unless it is a table; 5 and 5.0 are the same.
    pub(crate) fn value(&self, key: &str) -> Option<Value> {
        let (section, name) = key.split_once('.')?;
        match self.merged.get(section)?.get(name)? {
            Value::Integer(value) => Some(Value::Float(*value as f64)),
            value => Some(value.clone()).filter(|value| !value.is_table()),
        }
    }

    /// Sets a key from text, read as the type the key has.
    pub(crate) fn set_text(
        mut self,
        key: &str,
        text: &str,
        source_name: &str,
    ) -> Result<Self, ConfigError> {
        let slot = key.split_once('.').and_then(|(section, name)| {
            self.merged.get_mut(section)?.as_table_mut()?.get_mut(name)
        });
        let Some(slot) = slot else {
            return Err(ConfigError::UnknownKey {
                source_name: source_name.into(),
                key: key.into(),
                suggestions: closest(key, &self.keys()),
            });
        };
        let plain = text.trim().replace('_', "");
        let float = || plain.parse().ok().map(Value::Float);
        let integer = plain.parse().ok().map(Value::Integer);
        let value = match slot {
            Value::String(_) => Some(Value::String(text.into())),
            Value::Integer(_) => integer.or_else(float),
            Value::Float(_) => float(),
            Value::Boolean(_) => text.trim().parse().ok().map(Value::Boolean),
            _ => None,
        };
        *slot = value
            .filter(|value| fits(slot, value))
            .ok_or_else(|| wrong_type(source_name, key, &format!("{text:?}"), slot))?;
        self.set.push([key, text, source_name].map(Into::into));
        Ok(self)
    }
}

fn parse(source_name: &str, text: &str) -> Result<Table, ConfigError> {
    text.parse().map_err(|error| ConfigError::Syntax {
        source_name: source_name.into(),
        error: Box::new(error),
    })
}

struct Faults<'a> {
    at: &'a dyn Fn(&str) -> String,
    keys: &'a [String],
    found: Vec<ConfigError>,
}

/// Lays `over` on `under`; every key must exist there.
fn merge(under: &mut Table, over: Table, prefix: &str, faults: &mut Faults<'_>) {
    for (name, value) in over {
        let key = format!("{prefix}{name}");
        // Fields, worlds and lists have free names; their contents are read when they are loaded.
        if NAMED.contains(&prefix) && value.is_table() {
            under.insert(name, value);
            continue;
        }
        let fault = match (under.get_mut(&name), value) {
            (None, _) => ConfigError::UnknownKey {
                source_name: (faults.at)(&key),
                suggestions: closest(&key, faults.keys),
                key,
            },
            (Some(Value::Table(under)), Value::Table(over)) => {
                merge(under, over, &format!("{key}."), faults);
                continue;
            }
            (Some(slot), value) if fits(slot, &value) => {
                *slot = value;
                continue;
            }
            (Some(slot), value) => wrong_type(&(faults.at)(&key), &key, &value.to_string(), slot),
        };
        faults.found.push(fault);
    }
}

/// Whether a value has the type of a default. Seconds may have a fraction whatever the default
/// looks like; whether a fraction is right for another number shows when it is read.
fn fits(default: &Value, value: &Value) -> bool {
    let number = |value: &Value| value.is_integer() || value.is_float();
    default.same_type(value) || number(default) && number(value)
}

fn wrong_type(source_name: &str, key: &str, value: &str, default: &Value) -> ConfigError {
    ConfigError::WrongType {
        source_name: source_name.into(),
        key: key.into(),
        value: value.into(),
        allowed: match default {
            Value::String(_) => "a text",
            Value::Integer(_) | Value::Float(_) => "a number",
            Value::Boolean(_) => "true or false",
            _ => "a section",
        },
    }
}

/// The known keys most like an unknown one: the one that is nearly it, or three.
fn closest(key: &str, known: &[String]) -> Vec<String> {
    let like = |other: &String| strsim::normalized_damerau_levenshtein(key, other);
    let mut known = known.to_vec();
    known.sort_by(|a, b| like(b).total_cmp(&like(a)));
    let is_near = known.first().is_some_and(|best| like(best) > 0.8);
    known.truncate(if is_near { 1 } else { 3 });
    known
}
