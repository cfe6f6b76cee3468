//! Making tables on demand, as front ends use it: requests, jobs to follow, a finished table served.

use std::{path::PathBuf, sync::Arc};

use futures_util::{Stream, StreamExt as _, stream};
use strew_access::Caller;
use strew_catalog::{Entry, Offer};
use strew_config as config;
use strew_core::server::Stop;
use strew_error::Error;
use strew_plan::Lane;
use strew_query::Assets;
use tokio::time::Duration;

use crate::{
    Permit, Service,
    forging::{ForgeState, Forging, Job, JobStatus, Spec, Submitted},
};

/// How often a job that is followed is reported at most.
const PACE: Duration = Duration::from_millis(200);

impl Service {
    /// The service with a forge: finished tables come into a folder and are served.
    #[must_use]
    pub fn with_forge(mut self, settings: config::Forge, tables: Option<PathBuf>) -> Self {
        let assets = self.assets.clone();
        let offer = Offer {
            max_radius: settings.is_on().then_some(settings.max_radius),
            ..Offer::default()
        };
        assets.rcu(|now| Assets {
            catalog: now.catalog.clone().offering(offer),
            worlds: now.worlds.clone(),
        });
        let publish = move |path: PathBuf| {
            let entry = Entry::from_file(path).map_err(|error| error.to_string())?;
            let entry = Arc::new(entry);
            assets.rcu(|now| now.with_entry(entry.clone()));
            Ok(())
        };
        self.forging = Forging::new(settings, tables, Box::new(publish));
        self
    }

    /// The forge.
    #[must_use]
    pub const fn forging(&self) -> &Forging {
        &self.forging
    }

    /// Begins to make a table, unless that has begun or it is loaded.
    ///
    /// # Errors
    /// As [`Forging::admit`]; [`Error::Invalid`] for a table that cannot be made, [`Error::Denied`] if the client has
    /// reached its limit of jobs, [`Error::TooManyJobs`] if the queue is full.
    pub async fn forge(&self, caller: &Caller, spec: Spec) -> Result<Submitted, Error> {
        self.forging.admit(caller)?;
        let (forging, catalog, caller) = (self.forging.clone(), self.catalog(), caller.clone());
        let submit = move |_: &Stop| forging.submit(&catalog, &caller, caller.client(), spec);
        self.workers.take_turn(Lane::Long, submit).await?
    }

    /// All jobs, the newest first; none where no tables are made.
    ///
    /// # Errors
    /// As [`Forging::admit`].
    pub fn jobs(&self, caller: &Caller) -> Result<Vec<JobStatus>, Error> {
        if !self.forging.settings().is_on() {
            return Ok(vec![]);
        }
        self.forging.admit(caller)?;
        Ok(self.forging.list())
    }

    /// A job.
    ///
    /// # Errors
    /// As [`Forging::admit`], and [`Error::NoSuchJob`].
    pub fn job(&self, caller: &Caller, id: &str) -> Result<Arc<Job>, Error> {
        self.forging.admit(caller)?;
        let job = self.forging.get(id);
        job.ok_or_else(|| Error::NoSuchJob { id: id.into() })
    }

    /// Cancels a job, and returns its state then.
    ///
    /// # Errors
    /// As [`job`](Self::job), and [`Error::Denied`] unless the caller is an administrator or the client that began it.
    pub async fn cancel_job(&self, caller: &Caller, id: &str) -> Result<JobStatus, Error> {
        let job = self.job(caller, id)?;
        let (forging, caller) = (self.forging.clone(), caller.clone());
        let cancel = move |_: &Stop| {
            forging.cancel(&caller, &caller.client(), &job)?;
            Ok(job.status())
        };
        self.workers.take_turn(Lane::Long, cancel).await?
    }

    /// Streams the state of a job, now and after each change, until it ends. Takes the place of an answer with points.
    ///
    /// # Errors
    /// As [`open`](Self::open) for want of a place.
    pub fn follow_job(
        &self,
        caller: &Caller,
        job: &Job,
    ) -> Result<impl Stream<Item = JobStatus> + Send + use<>, Error> {
        let permit = self.place_for_events(caller)?;
        let followed = Followed {
            states: job.follow(),
            is_first: true,
            permit,
        };
        Ok(stream::unfold(Some(followed), Followed::next).boxed())
    }

    /// The numbers of jobs.
    #[must_use]
    pub fn forge_state(&self) -> ForgeState {
        self.forging.state()
    }
}

/// A job that is followed.
struct Followed {
    states: tokio::sync::watch::Receiver<JobStatus>,
    is_first: bool,
    permit: Permit,
}

impl Followed {
    /// The next state; none after the last one, or when the daemon stops.
    async fn next(followed: Option<Self>) -> Option<(JobStatus, Option<Self>)> {
        let mut followed = followed?;
        if !followed.is_first {
            tokio::time::sleep(PACE).await;
            tokio::select! {
                changed = followed.states.changed() => changed.ok()?,
                () = followed.permit.stopped() => return None,
            }
        }
        followed.is_first = false;
        let status = followed.states.borrow_and_update().clone();
        let next = (!status.state.is_over()).then_some(followed);
        Some((status, next))
    }
}
