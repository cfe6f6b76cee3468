//! What every error is on the wire, by both protocols, in one place.

use http::StatusCode;
use tonic::Code;

use crate::service::Kind;

/// What a kind of error is on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wire {
    /// The last part of the problem type `urn:strew:problem:…`.
    pub slug: &'static str,
    /// The problem's title: the same for all problems of the type.
    pub title: &'static str,
    /// The status in HTTP.
    pub status: StatusCode,
    /// The code in gRPC.
    pub code: Code,
}

/// Makes the table, and the match from a kind to its row.
macro_rules! kinds {
    ($($kind:ident: $title:literal, $status:ident, $code:ident;)+) => {
        /// What a kind of error is on the wire.
        #[must_use]
        pub const fn wire(kind: Kind) -> Wire {
            match kind {
                $(Kind::$kind => Wire {
                    slug: Kind::$kind.slug(),
                    title: $title,
                    status: StatusCode::$status,
                    code: Code::$code,
                },)+
            }
        }
    };
}

kinds! {
    Invalid: "The query is not valid", BAD_REQUEST, InvalidArgument;
    TooManyPoints: "The answer would have too many points", PAYLOAD_TOO_LARGE, ResourceExhausted;
    TooManyRows: "Counting the points would take too long", PAYLOAD_TOO_LARGE, ResourceExhausted;
    BodyTooLarge: "The query is too long", PAYLOAD_TOO_LARGE, ResourceExhausted;
    OtherTable: "Another table would answer", CONFLICT, FailedPrecondition;
    OtherWorld: "The world has changed", CONFLICT, FailedPrecondition;
    TableUnreadable: "The table cannot be read", SERVICE_UNAVAILABLE, Unavailable;
    NotAcceptable: "No acceptable format", NOT_ACCEPTABLE, InvalidArgument;
    NoSuchPoint: "There is no such point", NOT_FOUND, NotFound;
    NoSuchJob: "There is no such job", NOT_FOUND, NotFound;
    NoSuchPath: "Nothing is here", NOT_FOUND, Unimplemented;
    NoSuchMethod: "The path does not take this method", METHOD_NOT_ALLOWED, Unimplemented;
    Unauthenticated: "A key is needed", UNAUTHORIZED, Unauthenticated;
    NotAllowed: "The caller may not do this", FORBIDDEN, PermissionDenied;
    TooManyStreams: "Too many current streams", TOO_MANY_REQUESTS, ResourceExhausted;
    TooManyJobs: "Too many tables are being made for the client", TOO_MANY_REQUESTS, ResourceExhausted;
    TooManyForAddress: "The client's address uses as much as one address may", TOO_MANY_REQUESTS, ResourceExhausted;
    TooFast: "Points are taken too fast", TOO_MANY_REQUESTS, ResourceExhausted;
    Busy: "The server is busy", SERVICE_UNAVAILABLE, ResourceExhausted;
    UnknownCoding: "The query has a coding that is not read", UNSUPPORTED_MEDIA_TYPE, InvalidArgument;
    BodyTooSlow: "The query arrived too slowly", REQUEST_TIMEOUT, DeadlineExceeded;
    TimeOver: "The answer took too long", SERVICE_UNAVAILABLE, ResourceExhausted;
    ShuttingDown: "The server is shutting down", SERVICE_UNAVAILABLE, Unavailable;
    Internal: "An internal error", INTERNAL_SERVER_ERROR, Internal;
}

/// The problem type of a kind of error.
#[must_use]
pub fn urn(kind: Kind) -> String {
    format!("urn:strew:problem:{}", wire(kind).slug)
}

/// Every problem type, and that of errors that a library makes.
#[must_use]
pub fn types() -> Vec<String> {
    let mut types: Vec<String> = Kind::ALL.map(urn).into();
    types.push("about:blank".into());
    types
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_kind_is_an_error_by_both_protocols_and_has_a_type_of_its_own() {
        let slugs: BTreeSet<_> = Kind::ALL.iter().map(|&kind| wire(kind).slug).collect();
        assert_eq!(slugs.len(), Kind::ALL.len());
        for kind in Kind::ALL {
            let problem = wire(kind);
            let (client, server) = (
                problem.status.is_client_error(),
                problem.status.is_server_error(),
            );
            assert!(client || server, "{kind:?}");
            assert!(!problem.title.is_empty(), "{kind:?}");
            let code = problem.code;
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
