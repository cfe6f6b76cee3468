//! Mixes: tables whose variants are evenly spread, made for the first query that needs them.
//!
//! Making one takes seconds, so it is done once, at low priority, whoever asks, and to the end even if nobody
//! waits any more. Those that were used last stay in memory; all are kept in a folder beside the tables, if
//! there is one, so that a restart finds them.

use std::{
    collections::HashMap,
    fs,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
};

use futures_util::{
    FutureExt as _,
    future::{BoxFuture, Shared},
};
use strew_core::{Table, server::Stop, table::MAX_FILE_BYTES};

use super::{
    Budget, Error, Lane, Ready, Workers,
    cache::Samplers,
    mix::{Made, make},
};
use crate::bounded_file;

/// The mixes that were made.
#[derive(Clone)]
pub(super) struct Mixes {
    samplers: Samplers,
    budget: Budget,
    making: Arc<Mutex<HashMap<String, Making>>>,
    folder: Option<Arc<Path>>,
}

/// A table that is being read or made.
pub(super) type Making = Shared<BoxFuture<'static, Result<Ready, Error>>>;

/// The most mixes that are kept in a folder.
const MOST_KEPT: usize = 256;
/// What making one takes, in bytes: the neighbors of blocks most of all.
const ROOM: usize = 8 << 20;
const ROOM_BY_BLOCK: usize = 6 << 10;

impl std::fmt::Debug for Mixes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Mixes")
            .field("folder", &self.folder)
            .finish_non_exhaustive()
    }
}

impl Mixes {
    /// Mixes that are kept beside the tables they are of, and in a folder.
    pub(super) fn new(samplers: Samplers, budget: Budget, folder: Option<PathBuf>) -> Self {
        Self {
            samplers,
            budget,
            making: Arc::default(),
            folder: folder.map(Into::into),
        }
    }

    /// The labels or the second order of a table, if they are in memory.
    pub(super) async fn known(&self, plain: &Ready, what: &Made) -> Option<Ready> {
        self.samplers.known(&name(plain, what)).await
    }

    /// Makes the labels or the second order of a table, unless that has begun.
    pub(super) fn get(&self, plain: &Ready, what: &Made, workers: &Workers) -> Making {
        let name = name(plain, what);
        let mut making = self.making.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(begun) = making.get(&name) {
            return begun.clone();
        }
        let work = tokio::spawn(self.clone().work(
            name.clone(),
            plain.clone(),
            what.clone(),
            workers.clone(),
        ));
        // It goes on when nobody waits any more: the next one will ask again.
        let work = work.map(|ended| ended.unwrap_or(Err(Error::Internal("a computation failed"))));
        let begun = work.boxed().shared();
        making.insert(name, begun.clone());
        begun
    }

    /// Reads or makes a mix.
    async fn work(
        self,
        name: String,
        plain: Ready,
        what: Made,
        workers: Workers,
    ) -> Result<Ready, Error> {
        let made = self.make(&name, &plain, what, &workers).await;
        if let Ok(ready) = &made {
            self.samplers.keep(name.clone(), ready.clone()).await;
        }
        let mut making = self.making.lock().unwrap_or_else(PoisonError::into_inner);
        making.remove(&name);
        made
    }

    async fn make(
        &self,
        name: &str,
        plain: &Ready,
        what: Made,
        workers: &Workers,
    ) -> Result<Ready, Error> {
        // It may have been made since it was looked for.
        if let Some(known) = self.samplers.known(name).await {
            return Ok(known);
        }
        let held = self
            .budget
            .hold(ROOM + ROOM_BY_BLOCK * plain.entry.blocks())?;
        let path = self.folder.as_deref();
        let path = path.map(|folder| folder.join(format!("{name}.strew")));
        let Ready { entry, table, .. } = plain.clone();
        let work = move |_: &Stop| {
            let _held = held;
            let made = match path {
                Some(path) => read_or_make(&path, &table, &what),
                None => make(&table, &what),
            };
            Ok(Ready::new(entry, made?))
        };
        workers.take_turn(Lane::Long, work).await?
    }
}

/// What a mix is known by.
fn name(plain: &Ready, what: &Made) -> String {
    format!(
        "{}-{}",
        plain.entry.digest,
        what.to_string().replace([':', ' '], "-")
    )
}

/// Reads a mix that was made earlier, or makes it and keeps it.
fn read_or_make(path: &Path, plain: &Table, what: &Made) -> Result<Table, Error> {
    let known = bounded_file::read(path, MAX_FILE_BYTES).ok();
    let known = known.and_then(|bytes| Table::from_bytes(&bytes).ok());
    if let Some(known) = known.filter(|made| what.is(made, plain)) {
        return Ok(known);
    }
    let made = make(plain, what)?;
    if let Err(error) = keep(path, &made) {
        tracing::warn!(path = %path.display(), %error, "a mix could not be kept, and a restart will make it again");
    }
    Ok(made)
}

/// Writes a mix. The oldest make room.
fn keep(path: &Path, table: &Table) -> anyhow::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    strew_forge::write_table(path, table)?;
    let mut kept = vec![];
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry
            .path()
            .extension()
            .is_some_and(|extension| extension == "strew")
        {
            kept.push((entry.metadata()?.modified()?, entry.path()));
        }
    }
    kept.sort();
    let beyond = kept.len().saturating_sub(MOST_KEPT);
    for (_, old) in kept.drain(..beyond) {
        fs::remove_file(old)?;
    }
    Ok(())
}
