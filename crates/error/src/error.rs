//! Errors of requests, in words for the client.
//!
//! One type for both protocols; its [`Kind`] has the status on each. Text here is for clients; what only operators
//! should see goes to the log where it happens.

use crate::{
    audience::Audience, denied::Denied, fault::Fault, faults::Faults, secret::without_keys,
};

/// Why a request has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    #[error("{}", joined(.0.as_slice()))]
    Invalid(Faults),
    #[error("{}", self.message_for(&Audience::DAEMON))]
    TooManyPoints { count: u128, limit: u64 },
    #[error("{}", self.message_for(&Audience::DAEMON))]
    TooManyRows { rows: u128, limit: u64 },
    #[error(
        "the body is longer than {limit} bytes, the limit of this server: send fewer vertices or \
         regions"
    )]
    BodyTooLarge { limit: usize },
    #[error(
        "the query names the table {pinned}, but {loaded} would answer: leave out `table`, or load \
         that table"
    )]
    OtherTable { pinned: String, loaded: String },
    #[error(
        "the query names the world {name} of the digest {pinned}, but this server's is {loaded}: leave out \
         `world_digest`, or request what that world has become"
    )]
    OtherWorld {
        name: String,
        pinned: String,
        loaded: String,
    },
    #[error("the table of {table} cannot be read now: its file is gone, has changed or is damaged")]
    TableUnreadable { table: String },
    #[error("`Accept: {accept}` names no available format; available: {available}")]
    NotAcceptable { accept: String, available: String },
    #[error("this set has no point `{}`", without_keys(id))]
    NoSuchPoint { id: String },
    #[error("nothing is at `{}`; available: {available}", without_keys(path))]
    NoSuchPath { path: String, available: String },
    #[error(
        "`{}` does not take the method {method}; allowed: {allowed}",
        without_keys(path)
    )]
    NoSuchMethod {
        path: String,
        method: String,
        allowed: String,
    },
    #[error(transparent)]
    Denied(#[from] Denied),
    #[error("{limit} answers are being streamed, the limit of this server: try again later")]
    Busy { limit: usize },
    #[error("{limit} connections are open, the limit of this server: try again later")]
    TooManyConnections { limit: usize },
    #[error("{limit} requests are being answered, the limit of this server: try again later")]
    TooManyRequests { limit: usize },
    #[error("{limit} kinds are being made, the limit of this server: try again later")]
    TooManyMixes { limit: usize },
    #[error("requests and answers hold {limit} bytes, the limit of this server: try again later")]
    TooManyBytes { limit: usize },
    #[error(
        "this takes {needed} bytes at once, and {setting} = {limit} on this server, which its operator can raise"
    )]
    NeedsMoreBytes {
        /// The bytes that the request needs.
        needed: usize,
        limit: usize,
        setting: &'static str,
    },
    #[error("`Content-Encoding: {coding}` is not read; allowed: gzip, or none")]
    UnknownCoding { coding: String },
    #[error("the body did not arrive within {seconds} seconds")]
    BodyTooSlow { seconds: String },
    #[error(
        "there was no answer within {seconds} seconds: try again later, or request a smaller region"
    )]
    TimeOver { seconds: String },
    #[error(
        "labels of these kinds are being made, once, which takes longer than the {seconds} seconds of an answer: \
         try again in {} seconds", self.retry_seconds().unwrap_or(1)
    )]
    KindsInTheMaking { seconds: String },
    #[error("the server is shutting down: try again later, or elsewhere")]
    ShuttingDown,
    #[error("an internal error: {0}")]
    Internal(&'static str),
}

fn joined(faults: &[Fault]) -> String {
    let texts: Vec<String> = faults.iter().map(Fault::to_string).collect();
    texts.join("; ")
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wire {
    /// The kind's name: the last part of the problem type `urn:strew:problem:…`.
    pub slug: &'static str,
    pub title: &'static str,
    pub status: u16,
    pub code: i32,
    /// The number of seconds after which the same request is worth another try, where that helps.
    pub retry: Option<u64>,
}

/// Makes [`Kind`] and its list from the one table of kinds.
macro_rules! kinds {
    ($($kind:ident: $slug:literal, $title:literal, $status:literal, $code:ident, $retry:expr;)+) => {
        /// The kinds of [`Error`], without their details.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Kind {
            $(#[doc = $title] $kind,)+
        }

        impl Kind {
            pub const ALL: [Self; [$($slug),+].len()] = [$(Self::$kind),+];

            pub const fn slug(self) -> &'static str {
                self.wire().slug
            }

            pub const fn wire(self) -> Wire {
                match self {
                    $(Self::$kind => Wire {
                        slug: $slug,
                        title: $title,
                        status: $status,
                        code: $code,
                        retry: $retry,
                    },)+
                }
            }
        }
    };
}

const INVALID_ARGUMENT: i32 = 3;
const DEADLINE_EXCEEDED: i32 = 4;
const NOT_FOUND: i32 = 5;
const PERMISSION_DENIED: i32 = 7;
const RESOURCE_EXHAUSTED: i32 = 8;
const FAILED_PRECONDITION: i32 = 9;
const UNIMPLEMENTED: i32 = 12;
const INTERNAL: i32 = 13;
const UNAVAILABLE: i32 = 14;
const UNAUTHENTICATED: i32 = 16;

kinds! {
    Invalid: "invalid-query", "The query is not valid", 400, INVALID_ARGUMENT, None;
    TooManyPoints: "too-many-points", "The answer would have too many points", 413, RESOURCE_EXHAUSTED, None;
    TooManyRows: "too-many-rows", "Counting the points would take too long", 413, RESOURCE_EXHAUSTED, None;
    BodyTooLarge: "body-too-large", "The query is too long", 413, RESOURCE_EXHAUSTED, None;
    OtherTable: "other-table", "Another table would answer", 409, FAILED_PRECONDITION, None;
    OtherWorld: "other-world", "The world has changed", 409, FAILED_PRECONDITION, None;
    TableUnreadable: "table-unreadable", "The table cannot be read", 503, UNAVAILABLE, Some(5);
    NotAcceptable: "not-acceptable", "No acceptable format", 406, INVALID_ARGUMENT, None;
    NoSuchPoint: "no-such-point", "There is no such point", 404, NOT_FOUND, None;
    NoSuchPath: "no-such-path", "Nothing is here", 404, UNIMPLEMENTED, None;
    NoSuchMethod: "no-such-method", "The path does not take this method", 405, UNIMPLEMENTED, None;
    Unauthenticated: "unauthenticated", "A key is needed", 401, UNAUTHENTICATED, None;
    NotAllowed: "not-allowed", "The caller may not do this", 403, PERMISSION_DENIED, None;
    Misdirected: "misdirected", "The request is for another host", 421, PERMISSION_DENIED, None;
    TooManyStreams: "too-many-streams", "Too many current streams", 429, RESOURCE_EXHAUSTED, Some(1);
    TooManyForAddress: "too-many-for-address", "The client's address uses as much as one address may", 429, RESOURCE_EXHAUSTED, Some(1);
    TooFast: "too-fast", "Points are taken too fast", 429, RESOURCE_EXHAUSTED, None;
    Busy: "busy", "The server is busy", 503, RESOURCE_EXHAUSTED, Some(1);
    UnknownCoding: "unknown-coding", "The query has a coding that is not read", 415, INVALID_ARGUMENT, None;
    BodyTooSlow: "body-too-slow", "The query arrived too slowly", 408, DEADLINE_EXCEEDED, None;
    TimeOver: "time-over", "The answer took too long", 503, RESOURCE_EXHAUSTED, Some(5);
    ShuttingDown: "shutting-down", "The server is shutting down", 503, UNAVAILABLE, Some(1);
    Internal: "internal", "An internal error", 500, INTERNAL, None;
}

impl Error {
    /// The message for an audience; `Display` has that for a daemon's.
    pub fn message_for(&self, Audience { here, .. }: &Audience) -> String {
        match self {
            Self::TooManyPoints { count, limit } => format!(
                "the region holds {count} points, and {here} returns at most {limit} in one answer: \
                 request a smaller region, fewer points, or pages with limit and cursor"
            ),
            Self::TooManyRows { rows, limit } => format!(
                "counting takes about {rows} steps (lattice rows, or points that keep clear of others), and \
                 {here} allows {limit}: request a smaller region, a wider spacing, or a box with warp=off"
            ),
            _ => self.to_string(),
        }
    }

    pub const fn kind(&self) -> Kind {
        match self {
            Self::Invalid(_) => Kind::Invalid,
            Self::TooManyPoints { .. } => Kind::TooManyPoints,
            Self::TooManyRows { .. } => Kind::TooManyRows,
            Self::BodyTooLarge { .. } => Kind::BodyTooLarge,
            Self::OtherTable { .. } => Kind::OtherTable,
            Self::OtherWorld { .. } => Kind::OtherWorld,
            Self::TableUnreadable { .. } => Kind::TableUnreadable,
            Self::NotAcceptable { .. } => Kind::NotAcceptable,
            Self::NoSuchPoint { .. } => Kind::NoSuchPoint,
            Self::NoSuchPath { .. } => Kind::NoSuchPath,
            Self::NoSuchMethod { .. } => Kind::NoSuchMethod,
            Self::Denied(denied) => match denied {
                Denied::NoKey | Denied::WrongKey => Kind::Unauthenticated,
                Denied::NotAdmin { .. } => Kind::NotAllowed,
                Denied::ForeignHost { .. } => Kind::Misdirected,
                Denied::TooManyStreams { .. } => Kind::TooManyStreams,
                Denied::Address { .. } | Denied::Share { .. } => Kind::TooManyForAddress,
                Denied::TooFast { .. } => Kind::TooFast,
            },
            Self::Busy { .. }
            | Self::TooManyConnections { .. }
            | Self::TooManyRequests { .. }
            | Self::TooManyMixes { .. }
            | Self::TooManyBytes { .. }
            | Self::NeedsMoreBytes { .. } => Kind::Busy,
            Self::UnknownCoding { .. } => Kind::UnknownCoding,
            Self::BodyTooSlow { .. } => Kind::BodyTooSlow,
            Self::TimeOver { .. } | Self::KindsInTheMaking { .. } => Kind::TimeOver,
            Self::ShuttingDown => Kind::ShuttingDown,
            Self::Internal(_) => Kind::Internal,
        }
    }

    /// The number of seconds after which the same request is worth another try, where that helps.
    pub fn retry_seconds(&self) -> Option<u64> {
        match self {
            // The setting never allows it.
            Self::NeedsMoreBytes { .. } => None,
            Self::Denied(denied) => denied.wait_seconds().or(self.kind().wire().retry),
            _ => self.kind().wire().retry,
        }
    }

    /// The limit that the request exceeds, if there is one.
    pub fn limit(&self) -> Option<u64> {
        let limit = match self {
            Self::TooManyPoints { limit, .. } | Self::TooManyRows { limit, .. } => {
                return Some(*limit);
            }
            Self::BodyTooLarge { limit }
            | Self::Busy { limit }
            | Self::TooManyConnections { limit }
            | Self::TooManyRequests { limit }
            | Self::TooManyMixes { limit }
            | Self::TooManyBytes { limit }
            | Self::NeedsMoreBytes { limit, .. } => *limit,
            Self::Denied(denied) => denied.limit()?,
            _ => return None,
        };
        u64::try_from(limit).ok()
    }

    /// The digest that the query pins and the digest of what would answer, if they differ.
    pub fn digests(&self) -> Option<(&str, &str)> {
        match self {
            Self::OtherTable { pinned, loaded } | Self::OtherWorld { pinned, loaded, .. } => {
                Some((pinned, loaded))
            }
            _ => None,
        }
    }

    /// The faults of an invalid query; none for other errors.
    pub fn faults(&self) -> &[Fault] {
        match self {
            Self::Invalid(faults) => faults.as_slice(),
            _ => &[],
        }
    }
}

impl From<Faults> for Error {
    fn from(faults: Faults) -> Self {
        Self::Invalid(faults)
    }
}

impl From<Fault> for Error {
    fn from(fault: Fault) -> Self {
        Self::Invalid(fault.into())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_kind_is_an_error_by_both_protocols_and_has_a_type_of_its_own() {
        let slugs: BTreeSet<_> = Kind::ALL.map(Kind::slug).into();
        assert_eq!(slugs.len(), Kind::ALL.len());
        for kind in Kind::ALL {
            let wire = kind.wire();
            assert!((400..600).contains(&wire.status), "{kind:?}");
            // Both protocols agree on whether the client or the server is at fault.
            let is_ours = [RESOURCE_EXHAUSTED, INTERNAL, UNAVAILABLE].contains(&wire.code);
            assert!(is_ours || wire.status < 500, "{kind:?}");
        }
    }
}
