//! The history of a table: its making and its measurements.

use alloc::{format, string::String, vec::Vec};

use crate::{
    error::{Error, ErrorKind, number},
    map::Twin,
};

/// The history of a table, sufficient to make it again.
///
/// ```
/// use strew_core::{Map, Table, table::{Provenance, Figures}};
///
/// let map = Map::new("sqrt(3)".parse()?, 5)?;
/// let vectors = vec![[0, 0]; map.intervals() * map.intervals()];
/// let history = Provenance {
///     optimizer: "by-hand".into(),
///     parameters: vec![("steps".into(), "3".into())],
///     ..Provenance::default()
/// };
/// let table = Table::new(map, "mine", vectors, history.clone())?;
/// assert_eq!(Table::from_bytes(&table.to_bytes())?.provenance(), &history);
/// # Ok::<(), strew_core::Error>(())
/// ```
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
    /// The measurements, subject by subject.
    pub figures: Vec<Figures>,
}

/// Figures measured on one point set of a table.
///
/// ```
/// use strew_core::table::Figures;
///
/// let figures = Figures {
///     subject: "twin 683/418".into(),
///     seen: false,
///     points: 70_225,
///     values: vec![("delta_min".into(), 0.66)],
/// };
/// assert_eq!(figures.value("delta_min"), Some(0.66));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures {
    /// The subject of the measurement: `twin 683/418`, `window seed 7`.
    pub subject: String,
    /// Whether the table was optimized on this subject.
    pub seen: bool,
    /// The number of points of the subject.
    pub points: u64,
    /// The figures by name: `low_power`, `peak_power`, `delta_min`, …
    pub values: Vec<(String, f64)>,
}

/// The longest list of a history.
const MAX_ITEMS: usize = 1000;
/// The longest name or value, in bytes.
const MAX_TEXT: usize = 1000;

impl Figures {
    /// The figure with a name, or `None` if it was not measured.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<f64> {
        self.values
            .iter()
            .find(|(n, _)| n == name)
            .map(|&(_, value)| value)
    }
}

impl Provenance {
    /// Refuses what exceeds the format's limits.
    pub(super) fn check(&self) -> Result<(), Error> {
        let refused = |value: String, allowed: String| {
            Error::new(ErrorKind::Table, "provenance", value, allowed)
        };
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
                return Err(refused(
                    format!("a text of {} bytes", text.len()),
                    format!("texts of at most {MAX_TEXT} bytes"),
                ));
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
            return Err(refused(
                format!("a list of {longest} items"),
                format!("lists of at most {MAX_ITEMS} items"),
            ));
        }
        let not_finite = self
            .figures
            .iter()
            .flat_map(|f| &f.values)
            .find(|(_, v)| !v.is_finite());
        if let Some((name, value)) = not_finite {
            return Err(refused(
                format!("{name} = {}", number(*value)),
                "finite".into(),
            ));
        }
        Ok(())
    }
}
