//! Mixes: tables whose variants are evenly spread, made when they are first asked for.
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
use moka::future::Cache;
use strew_core::{
    Table,
    table::{MAX_FILE_BYTES, Shares},
};

use super::{Error, Fault, Lane, Workers, cache::Ready};
use crate::bounded_file;

/// The mixes that were made.
#[derive(Clone)]
pub(super) struct Mixes {
    ready: Cache<String, Table>,
    making: Arc<Mutex<HashMap<String, Making>>>,
    folder: Option<Arc<Path>>,
}

type Making = Shared<BoxFuture<'static, Result<Table, Error>>>;

/// The most mixes that are kept in a folder.
const MOST_KEPT: usize = 256;

impl std::fmt::Debug for Mixes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Mixes")
            .field("folder", &self.folder)
            .finish_non_exhaustive()
    }
}

impl Mixes {
    /// No mixes yet: at most this many bytes of them, and those of a folder.
    pub(super) fn new(bytes: u64, folder: Option<PathBuf>) -> Self {
        let weight =
            |_: &String, table: &Table| u32::try_from(table.memory_bytes()).unwrap_or(u32::MAX);
        Self {
            ready: Cache::builder()
                .name("mixes")
                .max_capacity(bytes)
                .weigher(weight)
                .build(),
            making: Arc::default(),
            folder: folder.map(Into::into),
        }
    }

    /// A table with kinds of these shares, if it is in memory.
    pub(super) async fn known(&self, plain: &Ready, shares: &Shares) -> Option<Ready> {
        let table = self.ready.get(&name(plain, shares)).await?;
        Some(Ready {
            entry: plain.entry.clone(),
            table,
        })
    }

    /// A table with kinds of these shares.
    pub(super) async fn get(
        &self,
        plain: &Ready,
        shares: &Shares,
        workers: &Workers,
    ) -> Result<Ready, Error> {
        let table = match self.known(plain, shares).await {
            Some(ready) => return Ok(ready),
            None => self.begin(plain, shares, workers).await?,
        };
        Ok(Ready {
            entry: plain.entry.clone(),
            table,
        })
    }

    /// Begins to make a mix, unless somebody has.
    fn begin(&self, plain: &Ready, shares: &Shares, workers: &Workers) -> Making {
        let name = name(plain, shares);
        let mut making = self.making.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(begun) = making.get(&name) {
            return begun.clone();
        }
        let (mixes, key, workers) = (self.clone(), name.clone(), workers.clone());
        let (table, shares) = (plain.table.clone(), shares.clone());
        let work = async move {
            let path = mixes
                .folder
                .as_deref()
                .map(|folder| folder.join(format!("{key}.strew")));
            let made = workers.take_turn(Lane::Long, move |_| match path {
                Some(path) => read_or_make(&path, &table, &shares),
                None => make(&table, &shares),
            });
            let made = made.await.and_then(|made| made);
            if let Ok(table) = &made {
                mixes.ready.insert(key.clone(), table.clone()).await;
            }
            mixes
                .making
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .remove(&key);
            made
        };
        // It goes on when nobody waits any more: the next one will ask again.
        let work = tokio::spawn(work);
        let work = work.map(|ended| ended.unwrap_or(Err(Error::Internal("a computation failed"))));
        let begun = work.boxed().shared();
        making.insert(name, begun.clone());
        begun
    }
}

/// What a mix is known by.
fn name(plain: &Ready, shares: &Shares) -> String {
    format!(
        "{}-{}",
        plain.entry.digest,
        shares.to_string().replace(':', "-")
    )
}

/// Labels the blocks of a table. Takes seconds.
///
/// # Errors
/// [`Error::Invalid`] if the table has too few blocks for the shares.
pub(super) fn make(table: &Table, shares: &Shares) -> Result<Table, Error> {
    let began = std::time::Instant::now();
    let made = strew_forge::labels(table, shares, &()).map_err(|error| {
        let allowed =
            "weights nearer to each other, fewer variants, a larger map, or spread chance";
        Fault::new("variants", shares, error.to_string(), allowed)
    })?;
    tracing::info!(%shares, seconds = began.elapsed().as_secs_f32(), "made a mix");
    made.ok_or(Error::Internal("a mix was stopped that is still wanted"))
}

/// Reads a mix that was made earlier, or makes it and keeps it.
fn read_or_make(path: &Path, plain: &Table, shares: &Shares) -> Result<Table, Error> {
    let is_of = |table: &Table| {
        table.mix().is_some_and(|mix| mix.shares() == shares)
            && table.displacements() == plain.displacements()
            && table.map() == plain.map()
    };
    let known = bounded_file::read(path, MAX_FILE_BYTES).ok();
    let known = known.and_then(|bytes| Table::from_bytes(&bytes).ok());
    if let Some(known) = known.filter(is_of) {
        return Ok(known);
    }
    let made = make(plain, shares)?;
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
