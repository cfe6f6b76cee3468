//! Merging settings: defaults < file < environment < flags.
//!
//! The defaults name every key and fix its type; a later layer can change values, never add keys. Only the
//! sections of [`NAMED`] hold tables that a file names.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::{Config, ConfigError, DEFAULTS, validate::validate};
use crate::{bounded_file, lines};

/// Variables of the environment that begin so are settings.
const PREFIX: &str = "STREW_";
/// Variables that begin so are for tests, and no settings.
const TEST_PREFIX: &str = "STREW_TEST_";
/// Variables that are neither settings nor for tests: the name of a configuration file, a key for a server.
const OTHERS: [&str; 2] = ["STREW_CONFIG", "STREW_API_KEY"];

/// The most bytes of a file of settings. Fields and worlds may hold outlines.
const MOST_BYTES: u64 = 16 << 20;

const NAMED: [&str; 3] = ["fields.", "worlds.", "except."];

/// Layers of settings, merged so far, of which a [`Config`] is made.
#[derive(Clone, Debug)]
pub struct Layers {
    merged: Table,
    by_flags: Vec<(String, String)>,
    /// The files that were laid over.
    files: Vec<PathBuf>,
}

impl Layers {
    pub fn new() -> Result<Self, ConfigError> {
        Ok(Self {
            merged: parse("the built-in configuration", DEFAULTS)?,
            by_flags: vec![],
            files: vec![],
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
            self.set_text(&keys[at], &value, &format!("the environment ({name})"))?;
        }
        Ok(self)
    }

    /// Lays a flag over the layers so far: `key=value`. The last one of a key counts.
    pub fn assignment(mut self, text: &str) -> Result<Self, ConfigError> {
        let (key, value) = text
            .split_once('=')
            .ok_or_else(|| ConfigError::Assignment { text: text.into() })?;
        let keys = self.keys();
        if !keys.iter().any(|known| known == key) {
            return Err(ConfigError::UnknownKey {
                source_name: format!("--set {text}"),
                key: key.into(),
                suggestions: closest(key, &keys),
            });
        }
        let flag = format!("--set {text}");
        self.set_text(key, value, &flag)?;
        self.by_flags.push((key.into(), flag));
        Ok(self)
    }

    /// Lays a flag of its own over the layers so far.
    pub fn flag(mut self, flag: &str, key: &str, value: &str) -> Result<Self, ConfigError> {
        if let Some((_, first)) = self.by_flags.iter().find(|(known, _)| known == key) {
            return Err(ConfigError::Twice {
                key: key.into(),
                first: first.clone(),
                second: flag.into(),
            });
        }
        self.set_text(key, value, flag)?;
        self.by_flags.push((key.into(), flag.into()));
        Ok(self)
    }

    /// Checks that flags set only the settings of `used`, each a section with a dot or a key. Files and the environment
    /// may set others, since the daemon shares them.
    pub fn only(self, used: &[&str]) -> Result<Self, ConfigError> {
        let is_used = |key: &str| used.iter().any(|used| key.starts_with(used));
        match self.by_flags.iter().find(|(key, _)| !is_used(key)) {
            None => Ok(self),
            Some((key, flag)) => Err(ConfigError::Unused {
                source_name: flag.clone(),
                key: key.clone(),
                used: self.keys().into_iter().filter(|key| is_used(key)).collect(),
            }),
        }
    }

    pub fn finish(self) -> Result<Config, ConfigError> {
        let config = self.read()?;
        validate(&config)?;
        Ok(config)
    }

    pub(super) fn read(self) -> Result<Config, ConfigError> {
        let mut config: Config = self
            .merged
            .try_into()
            .map_err(|error| ConfigError::Invalid(Box::new(error)))?;
        config.files = self.files;
        Ok(config)
    }

    /// Every key, `section.name`, in the order of the defaults.
    fn keys(&self) -> Vec<String> {
        self.merged
            .iter()
            .filter_map(|(section, value)| Some((section, value.as_table()?)))
            .flat_map(|(section, table)| table.keys().map(move |key| format!("{section}.{key}")))
            .collect()
    }

    /// Sets a key from text, read as the type the key has.
    fn set_text(&mut self, key: &str, text: &str, source_name: &str) -> Result<(), ConfigError> {
        let slot = key.split_once('.').and_then(|(section, name)| {
            self.merged.get_mut(section)?.as_table_mut()?.get_mut(name)
        });
        let Some(slot) = slot else {
            return Err(ConfigError::UnknownKey {
                source_name: source_name.into(),
                key: key.into(),
                suggestions: vec![],
            });
        };
        let plain = text.trim().replace('_', "");
        let value = match slot {
            Value::String(_) => Some(Value::String(text.into())),
            Value::Integer(_) => plain
                .parse()
                .map(Value::Integer)
                .or_else(|_| plain.parse().map(Value::Float))
                .ok(),
            Value::Float(_) => plain.parse().ok().map(Value::Float),
            Value::Boolean(_) => text.trim().parse().ok().map(Value::Boolean),
            _ => None,
        };
        *slot = value
            .filter(|value| fits(slot, value))
            .ok_or_else(|| wrong_type(source_name, key, &format!("{text:?}"), slot))?;
        Ok(())
    }
}

impl Config {
    /// Reads again the fields, lists and worlds that the files name. Other settings stay as they were at the start.
    pub fn read_names(&self) -> Result<Self, ConfigError> {
        let over = |layers: Layers, file: &PathBuf| layers.file(file);
        let now = self.files.iter().try_fold(Layers::new()?, over)?.read()?;
        let mut after = self.clone();
        after.fields.named = now.fields.named;
        after.except.named = now.except.named;
        after.worlds.named = now.worlds.named;
        Ok(after)
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
