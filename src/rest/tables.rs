//! `POST /v1/tables`: has a table made that is not loaded.

use std::sync::Arc;

use axum::extract::State;
use http::{HeaderValue, Method, StatusCode, header};
use serde_json::json;
use strew_core::server::Stop;
use strew_error::{Error, Fault, Kind};
use strew_service::{
    Service,
    forging::{JobStatus, Request, Submitted},
};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::Sent,
    document, query,
};
use crate::{body::Response, rest::Refused};

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
        about: "For profiles, alphas and maps that are not loaded. All clients that request a table share one job; the \
                answer to a rejected one is how it ended. The finished table is judged, kept and served. The \
                settings [forge] say which clients may do this: by default none.",
        body: Some(query::body(schemas::of::<Request>, example())),
        problems: vec![
            Kind::Invalid,
            Kind::BodyTooLarge,
            Kind::NotAllowed,
            Kind::TooManyJobs,
            Kind::Busy,
        ],
        example: format!("/v1/tables -d '{}'", example()),
        ..Operation::new(
            Tag::Tables,
            vec![
                job(202, "The job, which waits or runs.", vec![location]),
                job(200, "The table is loaded, or was rejected before.", vec![]),
            ],
        )
    };
    Endpoint::only("/v1/tables", service, operation, post)
}

fn example() -> serde_json::Value {
    json!({ "profile": "blue", "alpha": "sqrt(2)", "map": "s" })
}

async fn post(State(service): State<Arc<Service>>, sent: Sent) -> Result<Response, Refused> {
    let Sent { context, body } = sent;
    service.forging().admit(&context.caller)?;
    let length = body.len();
    let read = move |_: &Service, _: &Stop| serde_json::from_slice::<Request>(&body);
    let request = service.process(length, read).await?.map_err(|error| {
        let allowed = "a JSON object with profile, alpha, map and target, all of them text";
        Fault::new("body", "", error.to_string(), allowed)
    })?;
    match service.forge(&context.caller, request.spec()?).await? {
        Submitted::Loaded(status) => Ok(document::json(&status)?),
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
