//! How a table was made and what was measured on it.

use alloc::{format, string::String, vec::Vec};

use super::TableError;
use crate::map::Twin;

/// The history of a table, enough to make it again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    /// The name of the optimizer (`gaussian`, …), or `none`.
    pub optimizer: String,
    /// Its parameters by name, as text.
    pub parameters: Vec<(String, String)>,
    /// The seed of its random start.
    pub seed: u64,
    /// The periodic twins it was optimized on.
    pub twins: Vec<Twin>,
    /// What was measured, subject by subject.
    pub figures: Vec<Figures>,
}

/// Figures measured on one point set made with a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures {
    /// What was measured: `twin 683/418`, `window seed 7`.
    pub subject: String,
    /// Whether the table was optimized on this subject.
    pub seen: bool,
    /// How many points it has.
    pub points: u64,
    /// The figures by name: `low_power`, `peak_power`, `delta_min`, …
    pub values: Vec<(String, f64)>,
}

/// No list of a history is longer.
const MAX_ITEMS: usize = 1000;
/// No name or value is longer, in bytes.
const MAX_TEXT: usize = 1000;

impl Figures {
    /// The figure of that name.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<f64> {
        self.values
            .iter()
            .find(|(n, _)| n == name)
            .map(|&(_, value)| value)
    }
}

impl Provenance {
    /// Whether everything is within the format's limits.
    pub(super) fn check(&self) -> Result<(), TableError> {
        let texts = self
            .parameters
            .iter()
            .flat_map(|(name, value)| [name, value])
            .chain([&self.optimizer])
            .chain(self.figures.iter().map(|f| &f.subject))
            .chain(
                self.figures
                    .iter()
                    .flat_map(|f| f.values.iter().map(|(name, _)| name)),
            );
        for text in texts {
            if text.len() > MAX_TEXT {
                return Err(TableError::Field {
                    field: "provenance",
                    value: format!("a text of {} bytes", text.len()),
                    allowed: format!("texts of at most {MAX_TEXT} bytes"),
                });
            }
        }
        let longest = self
            .figures
            .iter()
            .map(|f| f.values.len())
            .chain([self.parameters.len(), self.twins.len(), self.figures.len()])
            .max()
            .unwrap_or(0);
        if longest > MAX_ITEMS {
            return Err(TableError::Field {
                field: "provenance",
                value: format!("a list of {longest} items"),
                allowed: format!("lists of at most {MAX_ITEMS} items"),
            });
        }
        let not_finite = self
            .figures
            .iter()
            .flat_map(|f| &f.values)
            .find(|(_, v)| !v.is_finite());
        if let Some((name, value)) = not_finite {
            return Err(TableError::Field {
                field: "provenance",
                value: format!("{name} = {value}"),
                allowed: "finite figures".into(),
            });
        }
        Ok(())
    }
}
