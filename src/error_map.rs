//! The status of every error in both protocols.

use http::StatusCode;
use tonic::Code;

use crate::service::Kind;

/// An error kind in HTTP terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The status.
    pub status: StatusCode,
    /// The last part of the problem type `urn:strew:problem:…`.
    pub slug: &'static str,
    /// The problem's title: the same for all problems of the type.
    pub title: &'static str,
}

/// What a kind of error is in HTTP.
#[must_use]
pub const fn http(kind: Kind) -> Problem {
    let (status, slug, title) = match kind {
        Kind::Invalid => (
            StatusCode::BAD_REQUEST,
            "invalid-query",
            "The query is not valid",
        ),
        Kind::TooManyPoints => (
            StatusCode::PAYLOAD_TOO_LARGE,
            "too-many-points",
            "The answer would have too many points",
        ),
        Kind::TooManyRows => (
            StatusCode::PAYLOAD_TOO_LARGE,
            "too-many-rows",
            "Counting the points would take too long",
        ),
        Kind::BodyTooLarge => (
            StatusCode::PAYLOAD_TOO_LARGE,
            "body-too-large",
            "The query is too long",
        ),
        Kind::OtherTable => (
            StatusCode::CONFLICT,
            "other-table",
            "Another table would answer",
        ),
        Kind::NotAcceptable => (
            StatusCode::NOT_ACCEPTABLE,
            "not-acceptable",
            "No acceptable format",
        ),
        Kind::NoSuchPoint => (
            StatusCode::NOT_FOUND,
            "no-such-point",
            "There is no such point",
        ),
        Kind::NoSuchPath => (StatusCode::NOT_FOUND, "no-such-path", "Nothing is here"),
        Kind::NoSuchMethod => (
            StatusCode::METHOD_NOT_ALLOWED,
            "no-such-method",
            "The path does not take this method",
        ),
        Kind::Unauthenticated => (
            StatusCode::UNAUTHORIZED,
            "unauthenticated",
            "A key is needed",
        ),
        Kind::NotAllowed => (
            StatusCode::FORBIDDEN,
            "not-allowed",
            "The caller may not do this",
        ),
        Kind::TooManyStreams => (
            StatusCode::TOO_MANY_REQUESTS,
            "too-many-streams",
            "Too many answers to this key are under way",
        ),
        Kind::TooManyForAddress => (
            StatusCode::TOO_MANY_REQUESTS,
            "too-many-for-address",
            "The client's address uses as much as one address may",
        ),
        Kind::TooFast => (
            StatusCode::TOO_MANY_REQUESTS,
            "too-fast",
            "Points are taken too fast",
        ),
        Kind::Busy => (
            StatusCode::SERVICE_UNAVAILABLE,
            "busy",
            "The server has as much to do as it takes on",
        ),
        Kind::BodyTooSlow => (
            StatusCode::REQUEST_TIMEOUT,
            "body-too-slow",
            "The query took too long to come",
        ),
        Kind::TimeOver => (
            StatusCode::SERVICE_UNAVAILABLE,
            "time-over",
            "The answer took too long",
        ),
        Kind::ShuttingDown => (
            StatusCode::SERVICE_UNAVAILABLE,
            "shutting-down",
            "The server is shutting down",
        ),
        Kind::Internal => (
            StatusCode::INTERNAL_SERVER_ERROR,
            "internal",
            "Something is wrong in the server",
        ),
    };
    Problem {
        status,
        slug,
        title,
    }
}

/// The problem type of a kind of error.
#[must_use]
pub fn urn(kind: Kind) -> String {
    format!("urn:strew:problem:{}", http(kind).slug)
}

/// What a kind of error is in gRPC.
#[must_use]
pub const fn grpc(kind: Kind) -> Code {
    match kind {
        Kind::Invalid | Kind::NotAcceptable => Code::InvalidArgument,
        Kind::TooManyPoints
        | Kind::TooManyRows
        | Kind::BodyTooLarge
        | Kind::TooManyStreams
        | Kind::TooManyForAddress
        | Kind::TooFast
        | Kind::Busy
        | Kind::TimeOver => Code::ResourceExhausted,
        Kind::BodyTooSlow => Code::DeadlineExceeded,
        Kind::Unauthenticated => Code::Unauthenticated,
        Kind::NotAllowed => Code::PermissionDenied,
        Kind::OtherTable => Code::FailedPrecondition,
        Kind::NoSuchPoint => Code::NotFound,
        Kind::NoSuchPath | Kind::NoSuchMethod => Code::Unimplemented,
        Kind::ShuttingDown => Code::Unavailable,
        Kind::Internal => Code::Internal,
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_kind_is_an_error_by_both_protocols_and_has_a_type_of_its_own() {
        let slugs: BTreeSet<_> = Kind::ALL.iter().map(|&kind| http(kind).slug).collect();
        assert_eq!(slugs.len(), Kind::ALL.len());
        for kind in Kind::ALL {
            let problem = http(kind);
            let (client, server) = (
                problem.status.is_client_error(),
                problem.status.is_server_error(),
            );
            assert!(client || server, "{kind:?}");
            assert!(!problem.title.is_empty(), "{kind:?}");
            let code = grpc(kind);
            assert!(code != Code::Ok && code != Code::Unknown, "{kind:?}");
            // Whose fault it is does not depend on the protocol.
            let ours = matches!(
                code,
                Code::Internal | Code::Unavailable | Code::ResourceExhausted
            );
            assert!(ours || client, "{kind:?}");
        }
    }
}
