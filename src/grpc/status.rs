//! Errors as gRPC statuses, with the standard details.

use std::{collections::HashMap, time::Duration};

use http::HeaderMap;
use strew_error::{Denied, Error, Kind};
use strew_service::{Interrupted, Record};
use tonic::{Code, Status};
use tonic_types::{ErrorDetails, StatusExt as _};

/// The time that a client should wait before it resumes a stream that the server broke off.
const RETRY: Duration = Duration::from_secs(1);

pub fn status(error: &Error) -> Status {
    Record::refuse(error.kind());
    let mut details = of_reason(reason(error.kind()), facts(error));
    if let Some(record) = Record::current() {
        details.set_request_info(record.id(), "");
    }
    let (mut room, faults) = (MOST_FAULTS, error.faults());
    for (place, fault) in faults.iter().enumerate() {
        let value = fault.value.as_ref();
        let value = value.map_or_else(String::new, |value| format!("`{value}`: "));
        let description = format!("{value}{}; allowed: {}", fault.detail, fault.allowed);
        let description = cut(&description, MOST_FAULT);
        let bytes = fault.field.len() + description.len();
        if bytes > room {
            let left = format!("{} more faults", faults.len() - place);
            details.add_bad_request_violation("", left);
            break;
        }
        room -= bytes;
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
    if let Some((pinned, _)) = error.digests() {
        let is_table = error.kind() == Kind::OtherTable;
        let subject = if is_table { "TABLE" } else { "WORLD" };
        details.add_precondition_failure_violation(subject, pinned, error.to_string());
    }
    if let Some(seconds) = error.retry_seconds() {
        details.set_retry_info(Some(Duration::from_secs(seconds)));
    }
    let message = cut(&error.to_string(), MOST_MESSAGE);
    Status::with_error_details(code(error.kind()), message, details)
}

/// The most bytes of a status's message, which the head of an answer has twice: percent-encoded, and among the details.
const MOST_MESSAGE: usize = 600;
/// The most bytes of the description of a fault.
const MOST_FAULT: usize = 500;
/// The most bytes of all faults together. So the head of an answer has 4 kB at most, which is what proxies hold.
const MOST_FAULTS: usize = 800;

/// The beginning of a text, with as much of it as takes `most` bytes where every byte that is not plain takes three.
pub(super) fn cut(text: &str, most: usize) -> String {
    let encoded = |byte: u8| match byte.is_ascii_alphanumeric() || b"_-.,:;/".contains(&byte) {
        true => 1,
        false => 3,
    };
    let mut room = 2 * most;
    for (at, char) in text.char_indices() {
        let end = at + char.len_utf8();
        let bytes: usize = text[at..end].bytes().map(encoded).sum();
        if end > most || bytes > room {
            return format!("{}…", &text[..at]);
        }
        room -= bytes;
    }
    text.into()
}

/// An error of a message that is a field of the request.
pub(super) fn within(field: &str, error: Error) -> Error {
    match error {
        Error::Invalid(faults) => faults.rename(|name| format!("{field}.{name}")).into(),
        other => other,
    }
}

pub(super) fn interrupted(why: Interrupted) -> Status {
    let kind = match why {
        Interrupted::Shutdown => Kind::ShuttingDown,
        Interrupted::Failed => Kind::Internal,
        Interrupted::Stalled | Interrupted::TimeOver => Kind::TimeOver,
    };
    let mut details = of_reason(reason(kind), HashMap::new());
    if kind != Kind::Internal {
        details.set_retry_info(Some(RETRY));
    }
    Status::with_error_details(code(kind), why.to_string(), details)
}

/// A fault of the call rather than of its message.
pub(super) fn faulty_metadata(name: &str, value: &str, detail: &str) -> Status {
    let mut details = of_reason(reason(Kind::Invalid), HashMap::new());
    let value = cut(value, MOST_FAULT / 4);
    details.add_bad_request_violation(name, format!("`{value}`: {detail}"));
    let message = format!("`{name}` = `{value}`: {detail}");
    Status::with_error_details(code(Kind::Invalid), message, details)
}

/// A call whose time is over.
pub(super) fn too_late(allowed: Duration) -> Status {
    let details = of_reason("DEADLINE_EXCEEDED".into(), HashMap::new());
    let message = format!("the call's deadline of {allowed:?} is over; it is not complete");
    Status::with_error_details(Code::DeadlineExceeded, message, details)
}

pub(super) fn trailers(status: &Status) -> Option<HeaderMap> {
    let mut trailers = HeaderMap::new();
    let added = status.add_header(&mut trailers);
    added.ok().map(|()| trailers)
}

/// Details with a reason of our domain.
fn of_reason(reason: String, facts: HashMap<String, String>) -> ErrorDetails {
    ErrorDetails::with_error_info(reason, "strew", facts)
}

fn code(kind: Kind) -> Code {
    Code::from_i32(kind.wire().code)
}

/// The name of a kind as gRPC writes it.
fn reason(kind: Kind) -> String {
    kind.slug().replace('-', "_").to_uppercase()
}

/// The facts that a program needs to go on, by name.
fn facts(error: &Error) -> HashMap<String, String> {
    let mut facts = HashMap::new();
    let mut put = |name: &str, value: String| facts.insert(name.to_owned(), value);
    if let Some(limit) = error.limit() {
        put("limit", limit.to_string());
    }
    if let Some((pinned, loaded)) = error.digests() {
        put("pinned", pinned.into());
        put("loaded", loaded.into());
    }
    match error {
        Error::TooManyPoints { count, .. } => {
            put("count", count.to_string());
        }
        Error::TooManyRows { rows, .. } => {
            put("rows", rows.to_string());
        }
        Error::Denied(Denied::TooFast { points, short }) => {
            let rate = short.level.rate;
            put("points", points.to_string());
            put("left", short.level.left.to_string());
            put("points_per_second", rate.points_per_second.to_string());
            put("burst_points", rate.burst_points.to_string());
        }
        _ => {}
    }
    facts
}
