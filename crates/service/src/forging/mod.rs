//! Tables made on demand: jobs and their queue.
//!
//! A client names a table that is not loaded; it becomes a job, one for each table, which all its clients share.
//! Jobs run one after another (or a few at once) on threads of their own, of the lowest priority. A finished table
//! is judged. One that is accepted is written into the folder of tables and served. Jobs, checkpoints and verdicts
//! are kept in a folder beside the tables (`folder`), so that a restart resumes after a stop or a crash.

mod folder;
mod job;
mod request;
mod run;

use std::{
    collections::{BTreeMap, HashMap, VecDeque},
    path::PathBuf,
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use folder::Folder;
use job::Kept;
pub use job::{Job, JobStatus, State};
pub use request::{Request, Spec};
use strew_access::Caller;
use strew_catalog::Catalog;
use strew_config as config;
use strew_error::Denied;
use strew_error::Error;

/// About the largest file of a table that is made, in bytes.
const LARGEST: u64 = 700_000;

/// Serves a finished table; an error states why it cannot.
type Publish = Box<dyn Fn(PathBuf) -> Result<(), String> + Send + Sync>;

/// Makes tables on demand. Cheap to clone.
#[derive(Clone)]
pub struct Forging(Arc<Inner>);

struct Inner {
    settings: config::Forge,
    /// The folder of jobs; `None` if no tables are made.
    folder: Option<Folder>,
    publish: Publish,
    jobs: Mutex<Jobs>,
    /// Notified when a job ends.
    ended: Condvar,
    /// Set when the daemon stops: jobs then write a checkpoint and end.
    is_stopping: AtomicBool,
}

/// All jobs that are known.
#[derive(Default)]
struct Jobs {
    by_id: BTreeMap<String, Arc<Job>>,
    waiting: VecDeque<Arc<Job>>,
    /// By client, the turn in which one of its jobs last began.
    served: HashMap<String, u64>,
    turn: u64,
    running: usize,
    /// Counts jobs, so that the oldest can be forgotten.
    last: u64,
    /// The outcomes of jobs since the start, in the order of [`State::ENDED`].
    outcomes: [u64; State::ENDED.len()],
}

/// The numbers of jobs, for metrics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ForgeState {
    /// Jobs that wait.
    pub queued: usize,
    /// Jobs that run.
    pub running: usize,
    /// Jobs that ended since the start, in the order of [`State::ENDED`].
    pub ended: [u64; State::ENDED.len()],
}

/// The outcome of a request for a table.
#[derive(Clone, Debug)]
pub enum Submitted {
    /// A job: a new one, or the one that makes this table already.
    Job(Arc<Job>),
    /// The table is loaded.
    Loaded(Box<JobStatus>),
}

impl std::fmt::Debug for Forging {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Forging")
            .field("settings", &self.0.settings)
            .finish_non_exhaustive()
    }
}

impl Jobs {
    /// The next job to begin: the first of the client that was served longest ago.
    fn next(&mut self) -> Option<Arc<Job>> {
        let served = |job: &Job| self.served.get(job.client()).copied().unwrap_or(0);
        let all = self.waiting.iter().enumerate();
        let (at, _) = all.min_by_key(|(at, job)| (served(job), *at))?;
        let job = self.waiting.remove(at)?;
        self.turn += 1;
        self.served.insert(job.client().to_owned(), self.turn);
        // The turns of clients without waiting jobs are forgotten.
        let (waiting, last) = (&self.waiting, self.turn);
        let waits = |client: &str| waiting.iter().any(|job| job.is_of(client));
        self.served
            .retain(|client, turn| *turn == last || waits(client));
        Some(job)
    }
}

impl Default for Forging {
    fn default() -> Self {
        Self::new(config::Forge::default(), None, Box::new(|_| Ok(())))
    }
}

impl Forging {
    /// Makes tables as the settings allow, into a folder of tables.
    #[must_use]
    pub(super) fn new(settings: config::Forge, tables: Option<PathBuf>, publish: Publish) -> Self {
        let tables = tables.filter(|_| settings.is_on());
        Self(Arc::new(Inner {
            folder: tables.map(Folder::new),
            settings,
            publish,
            jobs: Mutex::default(),
            ended: Condvar::new(),
            is_stopping: AtomicBool::new(false),
        }))
    }

    /// Reads the jobs in the folder. Interrupted ones are queued again.
    pub fn resume(&self) {
        let Some(folder) = &self.0.folder else { return };
        let kept = folder.read();
        let mut jobs = self.0.jobs();
        for Kept {
            spec,
            status,
            by,
            number,
        } in kept
        {
            let Ok(made) = spec.job() else {
                tracing::warn!(id = status.id, "a job of the forge cannot be read any more");
                continue;
            };
            jobs.last = jobs.last.max(number);
            let job = Arc::new(Job::kept(spec, made, by, number, status));
            if job.status().state.is_over() {
                // A crash may have left it.
                folder.remove_checkpoint(job.id());
            } else {
                tracing::info!(id = job.id(), "a job of the forge is queued again");
                jobs.waiting.push_back(job.clone());
            }
            jobs.by_id.insert(job.id().to_owned(), job);
        }
        drop(jobs);
        Inner::start_next(&self.0);
    }

    /// Whether a caller may have tables made.
    ///
    /// # Errors
    /// [`Error::ForgeOff`], or [`Error::Denied`] for one that is no administrator.
    pub fn admit(&self, caller: &Caller) -> Result<(), Error> {
        match self.0.settings.allow {
            config::Allow::Off => Err(Error::ForgeOff),
            config::Allow::Admin => Ok(caller.must_be_admin()?),
            config::Allow::Anyone => Ok(()),
        }
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &config::Forge {
        &self.0.settings
    }

    /// Queues a job for a table, unless the table is loaded or has a job. `client` is the requester. Waits for the
    /// disk.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a table that cannot be made, [`Error::Denied`] if the client has reached its limit of
    /// jobs, [`Error::TooManyJobs`] if the queue is full, [`Error::Internal`] if the folder cannot be written.
    pub(super) fn submit(
        &self,
        catalog: &Catalog,
        caller: &Caller,
        client: String,
        spec: Spec,
    ) -> Result<Submitted, Error> {
        let made = spec.check(self.0.settings.max_radius)?;
        if let Some(entry) = catalog.entry(&spec.key()?) {
            return Ok(Submitted::Loaded(Box::new(JobStatus::loaded(
                &spec, &made, &entry,
            ))));
        }
        // This takes milliseconds, so it is done before the lock is taken.
        made.check().map_err(|error| spec.fault(&error))?;
        let mut jobs = self.0.jobs();
        let id = spec.id();
        let known = jobs.by_id.get(&id);
        if let Some(known) = known.filter(|job| job.status().state.is_kept()) {
            return Ok(Submitted::Job(known.clone()));
        }
        let open = || {
            jobs.by_id
                .values()
                .filter(|job| !job.status().state.is_over())
        };
        if let Some(other) = open().find(|job| job.spec().has_key_of(&spec)) {
            return Err(spec.taken(other.id()));
        }
        let limit = caller.max_jobs(self.0.settings.max_jobs_per_client);
        if open().filter(|job| job.is_of(&client)).count() >= limit {
            return Err(Denied::TooManyJobs { limit }.into());
        }
        let limit = self.0.settings.max_queued;
        let is_free = jobs.running < self.0.settings.max_running && jobs.waiting.is_empty();
        if !is_free && jobs.waiting.len() >= limit {
            return Err(Error::TooManyJobs { limit });
        }
        let open = open().count();
        self.0.check_room(open)?;
        jobs.last += 1;
        let job = Arc::new(Job::new(spec, made, client, jobs.last));
        self.0.keep(&job, job.status()).map_err(|error| {
            tracing::error!(%error, "the folder of the forge cannot be written");
            Error::Internal("the folder of tables cannot be written")
        })?;
        jobs.by_id.insert(id, job.clone());
        jobs.waiting.push_back(job.clone());
        drop(jobs);
        Inner::start_next(&self.0);
        Ok(Submitted::Job(job))
    }

    /// All jobs, the newest first.
    #[must_use]
    pub fn list(&self) -> Vec<JobStatus> {
        let mut jobs: Vec<Arc<Job>> = self.0.jobs().by_id.values().cloned().collect();
        jobs.sort_by_key(|job| std::cmp::Reverse(job.number()));
        jobs.iter().map(|job| job.status()).collect()
    }

    /// The job of an id.
    #[must_use]
    pub fn get(&self, id: &str) -> Option<Arc<Job>> {
        self.0.jobs().by_id.get(id).cloned()
    }

    /// Cancels a job. A job that has ended stays as it is.
    ///
    /// # Errors
    /// [`Error::Denied`] unless the caller is an administrator or the client that began it.
    pub(super) fn cancel(
        &self,
        caller: &Caller,
        client: &str,
        job: &Arc<Job>,
    ) -> Result<(), Error> {
        if !job.is_of(client) {
            caller.must_be_admin()?;
        }
        job.cancel();
        let mut jobs = self.0.jobs();
        let waits = jobs
            .waiting
            .iter()
            .position(|other| Arc::ptr_eq(other, job));
        if let Some(at) = waits {
            jobs.waiting.remove(at);
            self.0.end(&mut jobs, job, State::Cancelled, |_| {});
        }
        Ok(())
    }

    /// The numbers of jobs.
    #[must_use]
    pub fn state(&self) -> ForgeState {
        let jobs = self.0.jobs();
        ForgeState {
            queued: jobs.waiting.len(),
            running: jobs.running,
            ended: jobs.outcomes,
        }
    }

    /// Ends all jobs with a checkpoint, and waits for at most `patience`.
    pub fn stop(&self, patience: Duration) {
        self.0.is_stopping.store(true, Ordering::Release);
        let jobs = self.0.jobs();
        let is_running = |jobs: &mut Jobs| jobs.running > 0;
        let waited = self.0.ended.wait_timeout_while(jobs, patience, is_running);
        let jobs = waited.map_or_else(|error| error.into_inner().0, |(jobs, _)| jobs);
        if jobs.running > 0 {
            tracing::warn!("the forge did not stop in time: it goes on from its last checkpoint");
        }
    }
}

impl Inner {
    fn jobs(&self) -> MutexGuard<'_, Jobs> {
        self.jobs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the folder has room for one more table than those that are being made.
    fn check_room(&self, open: usize) -> Result<(), Error> {
        let Some(folder) = &self.folder else {
            return Ok(());
        };
        let (tables, bytes) = folder.holds().map_err(|error| {
            tracing::error!(%error, "the folder of tables cannot be read");
            Error::Internal("the folder of tables cannot be read")
        })?;
        let config::Forge {
            max_tables,
            max_bytes,
            ..
        } = self.settings;
        let coming = (open as u64 + 1) * LARGEST;
        if tables + open >= max_tables {
            let (setting, limit) = ("forge.max_tables", max_tables as u64);
            return Err(Error::FolderFull { setting, limit });
        }
        if bytes + coming > max_bytes {
            let (setting, limit) = ("forge.max_bytes", max_bytes);
            return Err(Error::FolderFull { setting, limit });
        }
        Ok(())
    }

    /// Saves a state of a job in the folder.
    fn keep(&self, job: &Job, status: JobStatus) -> std::io::Result<()> {
        match &self.folder {
            Some(folder) => folder.keep(&job.kept_as(status)),
            None => Ok(()),
        }
    }

    /// Records how a job has ended, and forgets the oldest ended ones.
    fn end(
        &self,
        jobs: &mut Jobs,
        job: &Arc<Job>,
        state: State,
        more: impl FnOnce(&mut JobStatus),
    ) {
        let mut status = job.status();
        status.state = state;
        (status.stage, status.seconds_left) = (None, None);
        more(&mut status);
        if let Some(at) = State::ENDED.iter().position(|ended| *ended == state) {
            jobs.outcomes[at] += 1;
        }
        // On the disk before anyone hears of it.
        if let Err(error) = self.keep(job, status.clone()) {
            tracing::warn!(%error, id = job.id(), "the outcome of a job of the forge could not be saved");
        }
        if let Some(folder) = &self.folder {
            folder.remove_checkpoint(job.id());
        }
        job.change(|now| *now = status);
        tracing::info!(id = job.id(), state = state.name(), table = %job.status().name(), "a job of the forge ended");
        let over = |job: &&Arc<Job>| job.status().state.is_over();
        let mut ended: Vec<Arc<Job>> = jobs.by_id.values().filter(over).cloned().collect();
        ended.sort_by_key(|job| job.number());
        let beyond = ended.len().saturating_sub(self.settings.max_ended);
        for old in &ended[..beyond] {
            jobs.by_id.remove(old.id());
            if let Some(folder) = &self.folder {
                folder.forget(old.id());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_are_over_or_not() {
        for state in State::ALL {
            assert_eq!(state.is_over(), State::ENDED.contains(&state), "{state:?}");
        }
        assert_eq!(Error::ForgeOff.kind(), strew_error::Kind::NotAllowed);
    }
}
