//! `/v1/jobs`: the jobs of the forge, their states, their events, and their end.

use std::{convert::Infallible, sync::Arc};

use axum::extract::State;
use bytes::Bytes;
use futures_util::{StreamExt as _, stream};
use http::{HeaderMap, Method, header};
use schemars::JsonSchema;
use serde::Serialize;
use strew_error::Kind;
use strew_query::{Parameter, groups};
use strew_service::{Record, Service, forging::JobStatus};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::Context,
    document,
};
use crate::{
    body::{Body, Response},
    rest::Refused,
};

/// The content type of server-sent events.
const EVENTS: &str = "text/event-stream";

const ID: Parameter = Parameter {
    name: "id",
    about: "The id of a job, as `POST /v1/tables` returns it.",
    allowed: Some("the id of a job"),
    is_required: true,
    example: "0123456789abcdef",
    ..Parameter::PLAIN
};

/// The path of the list.
pub(super) fn list(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "listJobs",
        summary: "The jobs of the forge",
        about: "Jobs that wait or run, and those that ended last.",
        path_parameters: &[],
        example: "/v1/jobs".into(),
        ..operation(api::Answer::json::<Jobs>("The jobs, the newest first."))
    };
    Endpoint::only("/v1/jobs", service, operation, all)
}

/// The path of one job.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let mut answer = api::Answer::json::<JobStatus>("The job.");
    answer.contents.push((EVENTS, schemas::text));
    let get = Operation {
        id: "getJob",
        summary: "The state of a job of the forge",
        about: "With `Accept: text/event-stream` as server-sent events: an event `job` with the document whenever it \
                changes, at most five times a second, until the job is over.",
        problems: vec![Kind::NotAllowed, Kind::NoSuchJob, Kind::Invalid, Kind::Busy],
        example: "/v1/jobs/0123456789abcdef".into(),
        ..operation(answer)
    };
    let cancel = Operation {
        method: Method::DELETE,
        id: "cancelJob",
        summary: "Cancels a job of the forge",
        about: "For the client that began it and for administrators. A job that is over stays as it is.",
        problems: vec![Kind::NotAllowed, Kind::NoSuchJob, Kind::Invalid],
        example: "/v1/jobs/0123456789abcdef -X DELETE".into(),
        ..operation(api::Answer::json::<JobStatus>(
            "The job, which ends with its current step.",
        ))
    };
    Endpoint::new("/v1/jobs/{id}")
        .with(service.clone(), get, one)
        .with(service, cancel, delete)
}

/// The parts that the operations share.
fn operation(answer: api::Answer) -> Operation {
    Operation {
        path_parameters: &[&ID],
        problems: vec![Kind::NotAllowed, Kind::Invalid],
        ..Operation::new(Tag::Tables, vec![answer])
    }
}

/// The jobs of the forge.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Jobs")]
struct Jobs {
    /// The newest first.
    jobs: Vec<JobStatus>,
}

async fn all(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    context.values(groups::NONE).read()?;
    let jobs = service.jobs(&context.caller)?;
    Ok(document::momentary(document::json(&Jobs { jobs })?))
}

async fn one(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let [id] = context.path();
    context.values(groups::NONE).read()?;
    let job = service.job(&context.caller, id)?;
    if !wants_events(&context.headers) {
        return Ok(document::momentary(document::json(&job.status())?));
    }
    Record::in_format("events");
    let states = service.follow_job(&context.caller, &job)?;
    let events = states.map(|status| {
        let text = serde_json::to_string(&status).unwrap_or_default();
        Ok::<_, Infallible>(Bytes::from(format!("event: job\ndata: {text}\n\n")))
    });
    // Clients that receive nothing for long would try again.
    let first = stream::once(async { Ok(Bytes::from_static(b"retry: 2000\n\n")) });
    let events = Body::from_stream(first.chain(events));
    Ok(document::momentary(document::file(events, EVENTS)))
}

async fn delete(
    State(service): State<Arc<Service>>,
    context: Context,
) -> Result<Response, Refused> {
    let [id] = context.path();
    context.values(groups::NONE).read()?;
    Ok(document::json(
        &service.cancel_job(&context.caller, id).await?,
    )?)
}

fn wants_events(headers: &HeaderMap) -> bool {
    let accept = headers.get_all(header::ACCEPT).iter();
    let texts = accept.filter_map(|value| value.to_str().ok());
    texts.flat_map(|text| text.split(',')).any(|part| {
        let name = part.split(';').next().unwrap_or_default();
        name.trim().eq_ignore_ascii_case(EVENTS)
    })
}
