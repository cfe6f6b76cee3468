//! One thing that is wrong with a query, in words for the client.

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;

use crate::secret::{names_a_key, without_keys};

/// One thing that is wrong with a query.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Fault {
    /// The parameter or field.
    pub field: String,
    /// Its value; null if it is missing.
    pub value: Option<String>,
    /// A description of the fault.
    pub detail: String,
    /// The allowed values, in words.
    pub allowed: String,
}

impl Fault {
    pub fn new(
        field: &str,
        value: impl fmt::Display,
        detail: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Self {
        let value = value.to_string();
        let value = match names_a_key(field) {
            true => "***".into(),
            false => without_keys(&value),
        };
        Self {
            field: shortened(&without_keys(field)),
            value: Some(shortened(&value)),
            detail: cut(&detail.into(), 3 * SHOWN),
            allowed: allowed.into(),
        }
    }

    /// A fault of something that is not there.
    pub fn missing(field: &str, allowed: impl Into<String>) -> Self {
        Self {
            field: field.into(),
            value: None,
            detail: "missing".into(),
            allowed: allowed.into(),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.field)?;
        if let Some(value) = &self.value {
            write!(f, " = `{value}`")?;
        }
        write!(f, ": {}; allowed: {}", self.detail, self.allowed)
    }
}

const SHOWN: usize = 120;

/// Input is echoed, but not by the kilobyte.
fn shortened(text: &str) -> String {
    cut(text, SHOWN)
}

fn cut(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.into(),
    }
}

/// Words for an unknown name, with the known one that is most like it.
pub fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    // `minDistance` and `min-distance` are `min_distance` in other notations.
    let plain = |name: &str| name.to_lowercase().replace(['_', '-', ' '], "");
    // Longer names are not typing errors, and comparing them costs time.
    let wanted = plain(name.get(..name.len().min(40)).unwrap_or_default());
    let likeness = |known: &str| strsim::jaro_winkler(&plain(known), &wanted);
    let scored = known.map(|known| (likeness(known), known));
    let best = scored.max_by(|a, b| a.0.total_cmp(&b.0));
    match best.filter(|(likeness, _)| *likeness > 0.8) {
        Some((_, known)) => format!("unknown {what}; did you mean `{known}`?"),
        None => format!("unknown {what}"),
    }
}

/// The shortest digits of a number.
pub fn number(value: f64) -> String {
    zmij::Buffer::new().format(value).into()
}
