//! Mixes: tables whose variants are evenly spread, made for the first query that needs them.
//!
//! Making a mix takes seconds, so it is made once, at low priority, for the request that wants it first; later requests
//! wait for the same work. Addresses take turns, and work ends when no request waits for it any more. The mixes that
//! were used last stay in memory. All are kept in a folder beside the tables, if there is one, so that a restart finds
//! them.

use std::{
    collections::HashMap,
    fs,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use futures_util::{
    FutureExt as _,
    future::{BoxFuture, Shared, WeakShared},
};
use parking_lot::Mutex;
use strew_catalog::{
    Ready,
    mix::{Made, make},
};
use strew_config::bounded_file;
use strew_core::{Table, server::Stop, table::MAX_FILE_BYTES};
use strew_error::{Denied, Error};
use strew_plan::Lane;
use tokio::runtime::Handle;

use crate::{Budget, Owner, Record, Workers, cache::Samplers};

#[derive(Clone)]
pub(super) struct Mixes {
    samplers: Samplers,
    budget: Budget,
    making: Arc<Mutex<HashMap<String, Begun>>>,
    folder: Option<Arc<Path>>,
}

/// A table that is being read or made, while any request waits for it.
type Making = Shared<BoxFuture<'static, Result<Ready, Error>>>;

struct Begun {
    making: WeakShared<BoxFuture<'static, Result<Ready, Error>>>,
    owner: Owner,
}

/// A waiting request. When its time is over, its answer is to retry, and the mix goes on for a while.
struct Waiter(Option<(Making, Option<Arc<Record>>)>);

/// The time for which a mix goes on for clients that are to retry.
const UNTIL_THEY_COME: Duration = Duration::from_secs(60);

impl Drop for Waiter {
    fn drop(&mut self) {
        let Some((making, Some(record))) = self.0.take() else {
            return;
        };
        if let (true, Ok(runtime)) = (record.is_expected(), Handle::try_current()) {
            runtime.spawn(tokio::time::timeout(UNTIL_THEY_COME, making));
        }
    }
}

/// The most mixes that are made or wait to be made at once, of one address and in all.
const MOST_OF_ADDRESS: usize = 4;
const MOST: usize = 16;

const MOST_KEPT: usize = 256;
/// The bytes for making one, most of them for the neighbors of blocks.
const ROOM: usize = 8 << 20;
const ROOM_BY_BLOCK: usize = 6 << 10;

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

    /// The labels or the second order of a table, if they are in memory or built in.
    ///
    /// # Errors
    /// Those of [`Workers::take_turn`].
    pub(super) async fn known(
        &self,
        plain: &Ready,
        what: &Made,
        workers: &Workers,
    ) -> Result<Option<Ready>, Error> {
        let name = name(plain, what);
        if let Some(known) = self.samplers.known(&name).await {
            return Ok(Some(known));
        }
        let (Ready { entry, table, .. }, what) = (plain.clone(), what.clone());
        let read = move |_: &Stop| Some(Ready::new(entry, what.built_in(&table)?));
        let built_in = workers.take_turn(Lane::Short, read).await?;
        if let Some(ready) = &built_in {
            self.samplers.keep(name, ready.clone()).await;
        }
        Ok(built_in)
    }

    /// Makes the labels or the second order of a table for the request that is being answered, or joins those
    /// that wait for it. Ends when none of them waits any more.
    ///
    /// # Errors
    /// [`Denied::Address`] and [`Error::TooManyMixes`] if too many are made or wait to be made,
    /// [`Error::NeedsMoreBytes`] and others of [`Budget::hold`] for want of memory; [`Error::Invalid`] if the table
    /// has too few blocks.
    pub(super) async fn get(
        &self,
        plain: &Ready,
        what: &Made,
        workers: &Workers,
    ) -> Result<Ready, Error> {
        let making = self.begin(plain, what, workers)?;
        let mut waiter = Waiter(Some((making.clone(), Record::current())));
        let made = making.await;
        waiter.0 = None;
        made
    }

    fn begin(&self, plain: &Ready, what: &Made, workers: &Workers) -> Result<Making, Error> {
        let name = name(plain, what);
        let mut making = self.making.lock();
        making.retain(|_, begun| begun.making.upgrade().is_some());
        if let Some(begun) = making.get(&name).and_then(|begun| begun.making.upgrade()) {
            return Ok(begun);
        }
        let owner = Owner::current();
        let of_address = making.values().filter(|begun| begun.owner.is_of(&owner));
        if of_address.count() >= MOST_OF_ADDRESS {
            let (what, limit) = ("kinds to be made", MOST_OF_ADDRESS);
            return Err(Denied::Address { what, limit }.into());
        }
        if making.len() >= MOST {
            return Err(Error::TooManyMixes { limit: MOST });
        }
        let work = self
            .clone()
            .make(name.clone(), plain.clone(), what.clone(), workers.clone());
        // The work belongs to the first request that wants it, whichever request polls it.
        let begun = owner.clone().scope(work).boxed().shared();
        if let Some(weak) = begun.downgrade() {
            let begun_now = Begun {
                making: weak,
                owner,
            };
            making.insert(name, begun_now);
        }
        Ok(begun)
    }

    async fn make(
        self,
        name: String,
        plain: Ready,
        what: Made,
        workers: Workers,
    ) -> Result<Ready, Error> {
        // It may have been made since it was looked for.
        if let Some(known) = self.samplers.known(&name).await {
            return Ok(known);
        }
        let bytes = ROOM + ROOM_BY_BLOCK * plain.entry.blocks();
        // Of all addresses: it is more than one may hold, and one mix is made at a time.
        let budget = self.budget;
        let path = self.folder.as_deref();
        let path = path.map(|folder| folder.join(format!("{name}.strew")));
        let Ready { entry, table, .. } = plain;
        let work = move |stop: &Stop| -> Result<Ready, Error> {
            // Held while it is made, not while it waits for its turn.
            let _held = budget.hold(bytes)?;
            let made = match path {
                Some(path) => read_or_make(&path, &table, &what, stop),
                None => make(&table, &what, stop),
            };
            Ok(Ready::new(entry, made?))
        };
        let ready = workers.take_turn(Lane::Making, work).await??;
        self.samplers.keep(name, ready.clone()).await;
        Ok(ready)
    }
}

fn name(plain: &Ready, what: &Made) -> String {
    format!(
        "{}-{}",
        plain.entry.digest,
        what.to_string().replace([':', ' '], "-")
    )
}

/// Reads a mix that was made earlier, or makes it and keeps it.
fn read_or_make(path: &Path, plain: &Table, what: &Made, stop: &Stop) -> Result<Table, Error> {
    let known = bounded_file::read(path, MAX_FILE_BYTES).ok();
    let known = known.and_then(|bytes| Table::from_bytes(&bytes).ok());
    if let Some(known) = known.filter(|made| what.is(made, plain)) {
        return Ok(known);
    }
    let made = make(plain, what, stop)?;
    if let Err(error) = keep(path, &made) {
        tracing::warn!(path = %path.display(), %error, "a mix could not be saved; a restart will make it again");
    }
    Ok(made)
}

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
