//! `POST /v1/tables`: has a table made that is not loaded.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::{HeaderValue, Method, StatusCode, header};
use serde_json::json;
use strew_core::server::Stop;

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    body::Whole,
    context::Context,
    document, query,
};
use crate::service::{
    Error, Fault, Kind, Service,
    forging::{JobStatus, Request, Submitted},
    query::groups,
};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let job = |status, about, headers| api::Answer {
        status,
        headers,
        ..api::Answer::json::<JobStatus>(about)
    };
    let location = ("location", "The address of the job.");
    let operation = Operation {
        method: Method::POST,
        id: "forgeTable",
        summary: "Has a table made",
        about: "For profiles, alphas and maps that are not loaded. There is one job for a table, for all who send the \
                request; a job that was rejected is answered as it ended. The finished table is judged, kept and \
                served. The settings [forge] say who may do this: by default nobody.",
        tag: Tag::Tables,
        path_parameters: &[],
        parameters: groups::NONE,
        body: Some(query::body(schemas::of::<Request>, example())),
        answers: vec![
            job(202, "The job, which waits or runs.", vec![location]),
            job(200, "The table is loaded, or was rejected before.", vec![]),
        ],
        problems: vec![
            Kind::Invalid,
            Kind::BodyTooLarge,
            Kind::NotAllowed,
            Kind::TooManyJobs,
            Kind::Busy,
        ],
        example: format!("/v1/tables -d '{}'", example()),
    };
    Endpoint::new(
        "/v1/tables",
        service,
        vec![(operation, routing::post(post))],
    )
}

fn example() -> serde_json::Value {
    json!({ "profile": "blue", "alpha": "sqrt(2)", "map": "s" })
}

async fn post(
    State(service): State<Arc<Service>>,
    context: Context,
    Whole(body): Whole,
) -> Result<Response, Error> {
    context.no_parameters()?;
    service.forging().admit(&context.caller)?;
    let length = body.len();
    let read = move |_: &Service, _: &Stop| serde_json::from_slice::<Request>(&body);
    let request = service.process(length, read).await?.map_err(|error| {
        let allowed = "a JSON object with profile, alpha, map and target, all of them text";
        Fault::new("body", "", error.to_string(), allowed)
    })?;
    match service.forge(&context.caller, request.spec()?).await? {
        Submitted::Loaded(status) => document::json(&status),
        Submitted::Job(job) => {
            let status = job.status();
            let mut response = document::json(&status)?;
            if !status.state.is_over() {
                *response.status_mut() = StatusCode::ACCEPTED;
                let location = format!("/v1/jobs/{}", status.id);
                let location = HeaderValue::from_str(&location);
                let location = location.map_err(|_| Error::Internal("an id is no header"))?;
                response.headers_mut().insert(header::LOCATION, location);
            }
            Ok(response)
        }
    }
}
