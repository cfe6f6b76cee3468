//! The tables of a set, with those that its kinds need: found in one way for daemons, libraries and command lines.

use std::sync::Arc;

use strew_catalog::{
    Entry, Ready,
    mix::{self, Made},
};
use strew_core::{Table, server::Stop};
use strew_error::Error;
use strew_query::Set;

/// A table that the kinds of a set need beside their own.
pub enum Need {
    Loaded(Arc<Entry>),
    Made(Made),
}

pub trait Store {
    fn load(&self, entry: &Arc<Entry>) -> Result<Ready, Error>;
    fn make(&self, plain: &Ready, what: &Made) -> Result<Table, Error>;
}

/// A store that keeps nothing: tables are read and mixes are made each time.
pub struct Anew;

impl Store for Anew {
    fn load(&self, entry: &Arc<Entry>) -> Result<Ready, Error> {
        Ready::load(entry)
    }

    fn make(&self, plain: &Ready, what: &Made) -> Result<Table, Error> {
        mix::make(&plain.table, what, &Stop::default())
    }
}

/// The table of a set with its kinds, from a store that answers in the calling thread.
pub fn ready(set: &Set, store: &impl Store) -> Result<Ready, Error> {
    let plain = store.load(&set.entry)?;
    let made = match needs(&plain, set) {
        None => return Ok(plain),
        Some(Need::Loaded(entry)) => store.load(&entry)?.table,
        Some(Need::Made(what)) => store.make(&plain, &what)?,
    };
    Ok(with_made(plain, set, made))
}

pub fn needs(plain: &Ready, set: &Set) -> Option<Need> {
    let kinds = set.kinds.as_ref().filter(|_| plain.table.mix().is_none())?;
    Some(match &kinds.made {
        Some(entry) => Need::Loaded(entry.clone()),
        None => Need::Made(kinds.made_of()),
    })
}

/// A table with the one that the kinds of a set need beside it.
pub fn with_made(plain: Ready, set: &Set, made: Table) -> Ready {
    match set.varies() {
        true => Ready {
            second: Some(made),
            ..plain
        },
        false => Ready {
            table: made,
            ..plain
        },
    }
}
