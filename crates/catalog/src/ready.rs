//! Tables that are ready to answer.

use std::sync::Arc;

use strew_core::Table;
use strew_error::Error;

use crate::entry::Entry;

#[derive(Clone, Debug)]
pub struct Ready {
    pub entry: Arc<Entry>,
    /// The table; its least distances have been computed.
    pub table: Table,
    /// The table with its second order, if the set has kinds whose shares vary.
    pub second: Option<Table>,
}

impl Ready {
    /// Reads a table: microseconds to milliseconds, by its size.
    pub fn load(entry: &Arc<Entry>) -> Result<Self, Error> {
        Ok(Self::new(entry.clone(), entry.table()?))
    }

    /// A table, once its least distances are computed.
    pub fn new(entry: Arc<Entry>, table: Table) -> Self {
        let _ = (table.least_distance(), table.least_distance_of(0, 0));
        Self {
            entry,
            table,
            second: None,
        }
    }
}
