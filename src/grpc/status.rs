//! Errors as gRPC statuses, with the standard details.

use std::{collections::HashMap, time::Duration};

use http::HeaderMap;
use tonic::{Code, Status};
use tonic_types::{ErrorDetails, StatusExt as _};

use crate::{
    access::Denied,
    error_map,
    service::{Error, Interrupted, Kind, Record},
};

/// How long a client should wait before it goes on with a stream that the server broke off.
const RETRY: Duration = Duration::from_secs(1);

/// An error as a status.
pub(super) fn status(error: &Error) -> Status {
    Record::refuse(error.kind());
    let mut details = ErrorDetails::new();
    details.set_error_info(reason(error.kind()), DOMAIN, facts(error));
    if let Some(record) = Record::current() {
        details.set_request_info(record.id(), "");
    }
    for fault in error.faults() {
        let value = fault.value.as_ref();
        let value = value.map_or_else(String::new, |value| format!("`{value}`: "));
        let description = format!("{value}{}; allowed: {}", fault.detail, fault.allowed);
        details.add_bad_request_violation(&fault.field, description);
    }
    let quota = match error {
        Error::TooManyPoints { .. } => Some("limits.max_points"),
        Error::TooManyRows { .. } => Some("limits.max_rows"),
        Error::Denied(Denied::TooFast { .. }) => Some("rate.points_per_second"),
        _ => None,
    };
    if let Some(subject) = quota {
        details.add_quota_failure_violation(subject, error.to_string());
    }
    if let Error::OtherTable { pinned, .. } = error {
        details.add_precondition_failure_violation("TABLE", pinned, error.to_string());
    }
    if let Error::OtherWorld { pinned, .. } = error {
        details.add_precondition_failure_violation("WORLD", pinned, error.to_string());
    }
    if let Some(seconds) = error.retry_seconds() {
        details.set_retry_info(Some(Duration::from_secs(seconds)));
    }
    Status::with_error_details(
        error_map::wire(error.kind()).code,
        error.to_string(),
        details,
    )
}

/// An error of a message that is a field of the request.
pub(super) fn within(field: &str, error: Error) -> Error {
    match error {
        Error::Invalid(faults) => faults.rename(|name| format!("{field}.{name}")).into(),
        other => other,
    }
}

/// A broken stream as a status.
pub(super) fn interrupted(why: Interrupted) -> Status {
    let kind = match why {
        Interrupted::Shutdown => Kind::ShuttingDown,
        Interrupted::Failed => Kind::Internal,
        Interrupted::Stalled | Interrupted::TimeOver => Kind::TimeOver,
    };
    let mut details = ErrorDetails::new();
    details.set_error_info(reason(kind), DOMAIN, HashMap::new());
    if kind != Kind::Internal {
        details.set_retry_info(Some(RETRY));
    }
    Status::with_error_details(error_map::wire(kind).code, why.to_string(), details)
}

/// A fault of the call rather than of its message.
pub(super) fn faulty_metadata(name: &str, value: &str, detail: &str) -> Status {
    let mut details = ErrorDetails::new();
    details.set_error_info(reason(Kind::Invalid), DOMAIN, HashMap::new());
    details.add_bad_request_violation(name, format!("`{value}`: {detail}"));
    let message = format!("`{name}` = `{value}`: {detail}");
    Status::with_error_details(error_map::wire(Kind::Invalid).code, message, details)
}

/// A call whose time is over.
pub(super) fn too_late(allowed: Duration) -> Status {
    let mut details = ErrorDetails::new();
    details.set_error_info("DEADLINE_EXCEEDED", DOMAIN, HashMap::new());
    let message = format!("the call's deadline of {allowed:?} is over; it is not complete");
    Status::with_error_details(Code::DeadlineExceeded, message, details)
}

/// A status as the trailers of an answer.
pub(super) fn trailers(status: &Status) -> Option<HeaderMap> {
    let mut trailers = HeaderMap::new();
    let added = status.add_header(&mut trailers);
    added.ok().map(|()| trailers)
}

/// Whose reasons they are.
const DOMAIN: &str = "strew";

/// The same name as of the problem type by REST, as gRPC writes it.
fn reason(kind: Kind) -> String {
    error_map::wire(kind).slug.replace('-', "_").to_uppercase()
}

/// What a program needs to go on, by name.
fn facts(error: &Error) -> HashMap<String, String> {
    let pairs: Vec<(&str, String)> = match error {
        Error::TooManyPoints { count, limit } => {
            vec![("count", count.to_string()), ("limit", limit.to_string())]
        }
        Error::TooManyRows { rows, limit } => {
            vec![("rows", rows.to_string()), ("limit", limit.to_string())]
        }
        Error::Busy { limit }
        | Error::TooManyRequests { limit }
        | Error::TooManyMixes { limit }
        | Error::TooManyBytes { limit }
        | Error::NeedsMoreBytes { limit, .. }
        | Error::TooManyJobs { limit }
        | Error::Denied(
            Denied::TooManyStreams { limit }
            | Denied::TooManyJobs { limit }
            | Denied::Address { limit, .. }
            | Denied::Share { limit, .. },
        ) => {
            vec![("limit", limit.to_string())]
        }
        Error::Denied(Denied::TooFast { points, short }) => vec![
            ("points", points.to_string()),
            ("left", short.level.left.to_string()),
            (
                "points_per_second",
                short.level.rate.points_per_second.to_string(),
            ),
            ("burst_points", short.level.rate.burst_points.to_string()),
        ],
        Error::OtherTable { pinned, loaded } | Error::OtherWorld { pinned, loaded, .. } => {
            vec![("pinned", pinned.clone()), ("loaded", loaded.clone())]
        }
        _ => vec![],
    };
    let owned = |(name, value): (&str, String)| (name.to_owned(), value);
    pairs.into_iter().map(owned).collect()
}
