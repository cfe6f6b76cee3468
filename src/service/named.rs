//! What queries name: documents of the configuration and of folders, such as fields and worlds.

use std::{collections::BTreeMap, fmt, path::PathBuf, sync::Arc};

use schemars::JsonSchema;
use serde::Serialize;

/// What names may be.
pub const NAME: &str = "1 to 64 ASCII letters, digits, _, - and .";

/// Whether a text may be a name.
#[must_use]
pub fn is_name(text: &str) -> bool {
    let is_allowed = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
    (1..=64).contains(&text.len()) && text.chars().all(is_allowed)
}

/// Where a document comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// The program.
    Embedded,
    /// The configuration: the section, and the name in it.
    Config(&'static str, String),
    /// A file of the folder.
    File(PathBuf),
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Embedded => f.write_str("built in"),
            Self::Config(section, name) => write!(f, "[{section}.{name}] of the configuration"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// A document that was not taken, and the digest of the one that stays in its place.
pub type Refused<E> = (E, Option<String>);

/// What reading the documents of a kind again changed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "ReloadedNames")]
pub struct Changes {
    /// Names that were not there before, or not with this content.
    pub loaded: Vec<String>,
    /// Names of what is as before.
    pub kept: Vec<String>,
    /// Names of what is gone.
    pub removed: Vec<String>,
}

impl Changes {
    /// From one state to another; `digest` says what a document is.
    pub fn between<T>(
        before: &BTreeMap<String, Arc<T>>,
        after: &BTreeMap<String, Arc<T>>,
        digest: impl Fn(&T) -> String,
    ) -> Self {
        let mut changes = Self::default();
        for (name, new) in after {
            let is_same = (before.get(name)).is_some_and(|old| digest(old) == digest(new));
            let list = match is_same {
                true => &mut changes.kept,
                false => &mut changes.loaded,
            };
            list.push(name.clone());
        }
        let gone = before.keys().filter(|name| !after.contains_key(*name));
        changes.removed = gone.cloned().collect();
        changes
    }

    /// Whether anything is other than before.
    #[must_use]
    pub const fn is_any(&self) -> bool {
        !self.loaded.is_empty() || !self.removed.is_empty()
    }
}

/// Names for faults: not all of a long list. `what` is what they are of.
pub fn listed<'a>(what: &str, names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 16;
    let more = names.len().saturating_sub(SHOWN);
    let names: Vec<&str> = names.take(SHOWN).collect();
    match (names.as_slice(), more) {
        ([], _) => format!("nothing: no {what} is loaded"),
        (names, 0) => names.join(", "),
        (names, more) => format!(
            "{}, and {more} more (see the list of {what}s)",
            names.join(", ")
        ),
    }
}
