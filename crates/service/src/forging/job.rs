//! A job of the forge, and how it stands.

use std::{
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strew_catalog::Entry;
use strew_forge::{Progress, Prospect, Stage};
use tokio::sync::watch;

use super::Spec;

/// Where a job is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "JobState")]
pub enum State {
    /// It waits for others.
    Queued,
    /// It is being made.
    Running,
    /// The table is accepted and served.
    Finished,
    /// The table missed a bound of its profile. It is not kept.
    Rejected,
    /// A client cancelled it.
    Cancelled,
    /// It could not be made.
    Failed,
}

impl State {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Queued,
        Self::Running,
        Self::Finished,
        Self::Rejected,
        Self::Cancelled,
        Self::Failed,
    ];
    /// Those that are over.
    pub const ENDED: [Self; 4] = [
        Self::Finished,
        Self::Rejected,
        Self::Cancelled,
        Self::Failed,
    ];

    /// The name, as clients read it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Queued => "queued",
            Self::Running => "running",
            Self::Finished => "finished",
            Self::Rejected => "rejected",
            Self::Cancelled => "cancelled",
            Self::Failed => "failed",
        }
    }

    /// Whether nothing follows.
    #[must_use]
    pub const fn is_over(self) -> bool {
        !matches!(self, Self::Queued | Self::Running)
    }

    /// Whether the same request leads to the same job: unless it ended without a verdict.
    pub(super) const fn is_kept(self) -> bool {
        matches!(self, Self::Queued | Self::Running | Self::Rejected)
    }
}

/// How a job of the forge stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Job")]
pub struct JobStatus {
    /// The id of the job; the same for the same table.
    pub id: String,
    /// Where it is.
    pub state: State,
    /// The noise profile of the table.
    pub profile: String,
    /// The number α of its pattern, in its canonical form.
    pub alpha: String,
    /// The size of its map.
    pub map: String,
    /// The blocks of its map: how many vectors are to be found.
    pub blocks: u64,
    /// The period of the pattern in grid units, if α is a fraction.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(default)]
    pub period: Option<u64>,
    /// Why the table will probably be rejected, if it will.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(default)]
    pub warning: Option<String>,
    /// The stage of a running job: `optimizing` or `measuring`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(default)]
    pub stage: Option<String>,
    /// The steps of the stage that are done.
    pub step: u32,
    /// The steps of the stage.
    pub steps: u32,
    /// The energy per point after the last step of the optimizer. It falls within a phase and jumps between phases.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(default)]
    pub energy: Option<f64>,
    /// The time until the stage ends, in seconds, at the speed so far.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(default)]
    pub seconds_left: Option<f64>,
    /// The digest of the finished table, which queries may pin.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(default)]
    pub digest: Option<String>,
    /// The bounds that a rejected table missed, with figures.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub complaints: Vec<String>,
    /// Why a job failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(default)]
    pub detail: Option<String>,
}

impl JobStatus {
    fn new(spec: &Spec, prospect: &Prospect) -> Self {
        Self {
            id: spec.id(),
            state: State::Queued,
            profile: spec.profile.clone(),
            alpha: spec.alpha.clone(),
            map: spec.map.clone(),
            blocks: prospect.blocks() as u64,
            period: prospect.period,
            warning: prospect.doubt(),
            stage: None,
            step: 0,
            steps: 0,
            energy: None,
            seconds_left: None,
            digest: None,
            complaints: vec![],
            detail: None,
        }
    }

    /// The status of a table that is loaded.
    pub(super) fn loaded(spec: &Spec, job: &strew_forge::Job, entry: &Entry) -> Self {
        Self {
            state: State::Finished,
            digest: Some(entry.digest.clone()),
            warning: None,
            ..Self::new(spec, &job.prospect())
        }
    }

    /// The table in words.
    pub(super) fn name(&self) -> String {
        format!("{} {} {}", self.profile, self.alpha, self.map)
    }
}

/// A job as it is kept.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Kept {
    pub(super) spec: Spec,
    pub(super) status: JobStatus,
    /// The client that requested it.
    pub(super) by: String,
    pub(super) number: u64,
}

/// A job: which table, for whom, and how it stands.
#[derive(Debug)]
pub struct Job {
    id: String,
    spec: Spec,
    made: strew_forge::Job,
    /// The client that requested it first.
    by: String,
    number: u64,
    is_cancelled: AtomicBool,
    /// The stage that runs, with its first step and when that was.
    began: Mutex<Option<(Stage, u32, Instant)>>,
    status: watch::Sender<JobStatus>,
}

impl Job {
    pub(super) fn new(spec: Spec, made: strew_forge::Job, by: String, number: u64) -> Self {
        let status = JobStatus::new(&spec, &made.prospect());
        Self::kept(spec, made, by, number, status)
    }

    /// A job that was kept on disk. If it ran, it waits again.
    pub(super) fn kept(
        spec: Spec,
        made: strew_forge::Job,
        by: String,
        number: u64,
        mut status: JobStatus,
    ) -> Self {
        if !status.state.is_over() {
            status.state = State::Queued;
        }
        Self {
            id: spec.id(),
            spec,
            made,
            by,
            number,
            is_cancelled: AtomicBool::new(false),
            began: Mutex::default(),
            status: watch::Sender::new(status),
        }
    }

    /// The job with a state, as it is kept.
    pub(super) fn kept_as(&self, status: JobStatus) -> Kept {
        Kept {
            spec: self.spec.clone(),
            status,
            by: self.by.clone(),
            number: self.number,
        }
    }

    /// Its id.
    #[must_use]
    pub fn id(&self) -> &str {
        &self.id
    }

    /// The state of the job.
    #[must_use]
    pub fn status(&self) -> JobStatus {
        self.status.borrow().clone()
    }

    /// The state of the job, now and after each change.
    #[must_use]
    pub fn follow(&self) -> watch::Receiver<JobStatus> {
        self.status.subscribe()
    }

    pub(super) const fn spec(&self) -> &Spec {
        &self.spec
    }

    pub(super) const fn made(&self) -> &strew_forge::Job {
        &self.made
    }

    pub(super) const fn number(&self) -> u64 {
        self.number
    }

    pub(super) fn client(&self) -> &str {
        &self.by
    }

    /// Whether it is done for a client.
    pub(super) fn is_of(&self, client: &str) -> bool {
        self.by == client
    }

    pub(super) fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::Release);
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Acquire)
    }

    pub(super) fn change(&self, change: impl FnOnce(&mut JobStatus)) {
        self.status.send_modify(change);
    }

    /// Notes how far the work is.
    pub(super) fn progress(&self, now: &Progress) {
        self.change(|status| {
            let stage = match now.stage {
                Stage::Optimizing => "optimizing",
                Stage::Measuring => "measuring",
            };
            status.state = State::Running;
            status.stage = Some(stage.into());
            (status.step, status.steps) = (now.step, now.steps);
            status.energy = now.energy.or(status.energy);
            status.seconds_left = Some((self.seconds_left(now) * 10.0).round() / 10.0);
        });
    }

    /// The time until a stage ends, at its average speed so far.
    fn seconds_left(&self, now: &Progress) -> f64 {
        let mut began = self.began.lock().unwrap_or_else(PoisonError::into_inner);
        let stage = began.filter(|(stage, ..)| *stage == now.stage);
        let (_, first, since) =
            *began.insert(stage.unwrap_or((now.stage, now.step, Instant::now())));
        let left = now.steps.saturating_sub(now.step);
        since.elapsed().as_secs_f64() * f64::from(left)
            / f64::from(now.step.saturating_sub(first).max(1))
    }
}

/// Jobs are shared.
pub(super) type Shared = Arc<Job>;
