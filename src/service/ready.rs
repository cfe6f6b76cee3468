//! Tables that are ready to answer, with the kinds of the sets they are for.

use std::sync::Arc;

use strew_core::{Table, server::Stop};

use super::{
    Entry, Error,
    mix::{self, Made},
    query::Set,
};

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

/// What the kinds of a set need beside its table.
pub(super) enum Need {
    /// Another table that is loaded.
    Loaded(Arc<Entry>),
    /// A table that is made of it.
    Made(Made),
}

/// Where tables come from.
pub(super) trait Store {
    /// The table of an entry.
    fn load(&self, entry: &Arc<Entry>) -> Result<Ready, Error>;
    /// The mix of a table.
    fn make(&self, plain: &Ready, what: &Made) -> Result<Table, Error>;
}

/// A store that keeps nothing: tables are read and mixes are made each time.
pub(super) struct Anew;

impl Store for Anew {
    fn load(&self, entry: &Arc<Entry>) -> Result<Ready, Error> {
        Ready::load(entry)
    }

    fn make(&self, plain: &Ready, what: &Made) -> Result<Table, Error> {
        mix::make(&plain.table, what, &Stop::default())
    }
}

impl Ready {
    /// Reads a table: microseconds to milliseconds, by its size.
    ///
    /// # Errors
    /// [`Error::Internal`] if it cannot be read any more.
    pub fn load(entry: &Arc<Entry>) -> Result<Self, Error> {
        Ok(Self::new(entry.clone(), entry.table()?))
    }

    /// The table of a set with its kinds, from a store that answers in the calling thread.
    pub(super) fn of(set: &Set, store: &impl Store) -> Result<Self, Error> {
        let plain = store.load(&set.entry)?;
        let made = match plain.needs(set) {
            None => return Ok(plain),
            Some(Need::Loaded(entry)) => store.load(&entry)?.table,
            Some(Need::Made(what)) => store.make(&plain, &what)?,
        };
        Ok(plain.with_made(set, made))
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

    /// What the kinds of a set need beside this table.
    pub(super) fn needs(&self, set: &Set) -> Option<Need> {
        let kinds = set.kinds.as_ref().filter(|_| self.table.mix().is_none())?;
        Some(match &kinds.made {
            Some(entry) => Need::Loaded(entry.clone()),
            None => Need::Made(kinds.made_of()),
        })
    }

    /// This table with what the kinds of a set need beside it.
    pub(super) fn with_made(self, set: &Set, made: Table) -> Self {
        match set.varies() {
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
