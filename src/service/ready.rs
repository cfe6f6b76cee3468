//! Tables that are ready to answer.

use std::sync::Arc;

use strew_core::Table;

use super::{Entry, Error, query::Kinds};

/// A table ready to answer.
#[derive(Clone, Debug)]
pub struct Ready {
    /// What is known of the table.
    pub entry: Arc<Entry>,
    /// The table; its least distances have been computed.
    pub table: Table,
    /// The table with its second order, if the set has kinds whose shares vary.
    pub second: Option<Table>,
}

impl Ready {
    /// Reads a table: microseconds to milliseconds, by its size.
    ///
    /// # Errors
    /// [`Error::Internal`] if it cannot be read any more.
    pub fn load(entry: &Arc<Entry>) -> Result<Self, Error> {
        Ok(Self::new(entry.clone(), entry.table()?))
    }

    /// A table, once its least distances are computed.
    pub(super) fn new(entry: Arc<Entry>, table: Table) -> Self {
        let _ = (table.least_distance(), table.least_distance_of(0, 0));
        Self {
            entry,
            table,
            second: None,
        }
    }

    /// This table with the labels or the second order of some kinds.
    pub(super) fn with_made(self, kinds: &Kinds, made: Table) -> Self {
        match kinds.vary_by_place() {
            true => Self {
                second: Some(made),
                ..self
            },
            false => Self {
                table: made,
                ..self
            },
        }
    }
}
