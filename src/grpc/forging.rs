//! Tables made on demand, as messages.

use strew_service::forging::{JobStatus, Request, State};

use super::proto::{ForgeTableRequest, ForgeTableResponse, Job, JobState};

/// The table that a request wants made.
pub(super) fn request(request: ForgeTableRequest) -> Request {
    Request {
        profile: request.profile,
        alpha: request.alpha,
        map: request.map,
        target: request.target,
    }
}

/// The state of a job.
pub(super) fn response(status: JobStatus) -> ForgeTableResponse {
    let state = match status.state {
        State::Queued => JobState::Queued,
        State::Running => JobState::Running,
        State::Finished => JobState::Finished,
        State::Rejected => JobState::Rejected,
        State::Cancelled => JobState::Cancelled,
        State::Failed => JobState::Failed,
    };
    let job = Job {
        id: status.id,
        state: state.into(),
        profile: status.profile,
        alpha: status.alpha,
        map: status.map,
        blocks: status.blocks,
        period: status.period,
        warning: status.warning.unwrap_or_default(),
        stage: status.stage.unwrap_or_default(),
        step: status.step,
        steps: status.steps,
        energy: status.energy,
        seconds_left: status.seconds_left,
        digest: status.digest.unwrap_or_default(),
        complaints: status.complaints,
        detail: status.detail.unwrap_or_default(),
    };
    ForgeTableResponse { job: Some(job) }
}
