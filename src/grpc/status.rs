//! Errors as gRPC statuses, with the standard details.

use std::time::Duration;

use tonic::Status;
use tonic_types::{ErrorDetails, StatusExt as _};

use crate::{
    error_map,
    service::{Error, Interrupted, Kind},
};

/// An error as a status.
pub(super) fn status(error: &Error) -> Status {
    let mut details = ErrorDetails::new();
    for fault in error.faults() {
        let value = fault.value.as_ref();
        let value = value.map_or_else(String::new, |value| format!("`{value}`: "));
        let description = format!("{value}{}; allowed: {}", fault.detail, fault.allowed);
        details.add_bad_request_violation(&fault.field, description);
    }
    if let Error::TooManyPoints { .. } = error {
        details.add_quota_failure_violation("limits.max_points", error.to_string());
    }
    if matches!(error.kind(), Kind::Busy | Kind::ShuttingDown) {
        details.set_retry_info(Some(Duration::from_secs(1)));
    }
    Status::with_error_details(error_map::grpc(error.kind()), error.to_string(), details)
}

/// A broken stream as a status.
pub(super) fn interrupted(why: Interrupted) -> Status {
    let kind = match why {
        Interrupted::Shutdown => Kind::ShuttingDown,
        Interrupted::Failed => Kind::Internal,
    };
    Status::new(error_map::grpc(kind), why.to_string())
}
