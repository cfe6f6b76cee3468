//! What can be wrong with a request, in words for the client.
//!
//! One type for both protocols; `error_map` has the status of each. Text here is for clients; what only operators should see goes
//! to the log where it happens.

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;

use super::query::Faults;
#[cfg(feature = "daemon")]
use crate::access::Denied;

/// One thing that is wrong with a query.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Fault {
    /// The parameter or field.
    pub field: String,
    /// Its value; null if it is missing.
    pub value: Option<String>,
    /// What is wrong with it.
    pub detail: String,
    /// What is allowed.
    pub allowed: String,
}

impl Fault {
    /// A fault of a given value.
    pub fn new(
        field: &str,
        value: impl fmt::Display,
        detail: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Self {
        Self {
            field: shortened(field),
            value: Some(shortened(&value.to_string())),
            detail: cut(&detail.into(), 3 * SHOWN),
            allowed: allowed.into(),
        }
    }

    /// A fault of something that is not there.
    pub fn missing(field: &str, allowed: impl Into<String>) -> Self {
        Self {
            field: field.into(),
            value: None,
            detail: "missing".into(),
            allowed: allowed.into(),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.field)?;
        if let Some(value) = &self.value {
            write!(f, " = `{value}`")?;
        }
        write!(f, ": {}; allowed: {}", self.detail, self.allowed)
    }
}

/// The most characters of input that are echoed.
const SHOWN: usize = 120;

/// Input is echoed, but not by the kilobyte.
fn shortened(text: &str) -> String {
    cut(text, SHOWN)
}

fn cut(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.into(),
    }
}

/// Why a request has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The query is not valid; every fault that was found.
    #[error("{}", joined(.0.as_slice()))]
    Invalid(Faults),
    /// The region holds more points than one answer may have.
    #[error(
        "the region holds {count} points, and this server returns at most {limit} in one answer: \
         request a smaller region, fewer points, or pages with limit and cursor"
    )]
    TooManyPoints {
        /// The exact count.
        count: u128,
        /// The limit.
        limit: u64,
    },
    /// Counting the region's points would take too long.
    #[error(
        "counting takes about {rows} steps (lattice rows, or points that keep clear of others), and \
         this server allows {limit}: request a smaller region, a wider spacing, or a box with warp=off"
    )]
    TooManyRows {
        /// About how many.
        rows: u128,
        /// The limit.
        limit: u64,
    },
    /// The query is longer than queries may be.
    #[error(
        "the body is longer than {limit} bytes, the limit of this server: send fewer vertices or \
         regions"
    )]
    BodyTooLarge {
        /// The limit.
        limit: usize,
    },
    /// Another table would answer than the one that the query pins.
    #[error(
        "the query names the table {pinned}, but {loaded} would answer: leave out `table`, or load \
         that table"
    )]
    OtherTable {
        /// The digest in the query.
        pinned: String,
        /// The digest of the table that is loaded.
        loaded: String,
    },
    /// The world that the query names is another one than the one that it pins.
    #[error(
        "the query names the world {name} of the digest {pinned}, but this server's is {loaded}: leave out \
         `world_digest`, or request what that world has become"
    )]
    OtherWorld {
        /// The name.
        name: String,
        /// The digest in the query.
        pinned: String,
        /// The digest of the world that is loaded.
        loaded: String,
    },
    /// The table is loaded, but its file cannot be read.
    #[error("the table of {table} cannot be read now: its file is gone, has changed or is damaged")]
    TableUnreadable {
        /// What it is found by.
        table: String,
    },
    /// None of the formats the client accepts is made here.
    #[error("`Accept: {accept}` names no available format; available: {available}")]
    NotAcceptable {
        /// What the client accepts.
        accept: String,
        /// What there is.
        available: String,
    },
    /// The set has no point with that id.
    #[error("this set has no point `{id}`")]
    NoSuchPoint {
        /// The id.
        id: String,
    },
    /// Nothing is at that path.
    #[error("nothing is at `{path}`; available: {available}")]
    NoSuchPath {
        /// The path.
        path: String,
        /// What there is.
        available: String,
    },
    /// The path does not take that method.
    #[error("`{path}` does not take the method {method}; allowed: {allowed}")]
    NoSuchMethod {
        /// The path.
        path: String,
        /// The method.
        method: String,
        /// What the path takes.
        allowed: String,
    },
    /// There is no such job.
    #[error("there is no job `{id}`: it was never begun here, or has been forgotten")]
    NoSuchJob {
        /// The id.
        id: String,
    },
    /// No tables are made on demand.
    #[error(
        "this server makes no tables on demand: its operator can set forge.allow, or make them with strew forge"
    )]
    ForgeOff,
    /// As many tables wait to be made as may.
    #[error("{limit} tables wait to be made, the limit of this server: try again later")]
    TooManyJobs {
        /// The limit.
        limit: usize,
    },
    /// The caller is refused, for good or for now.
    #[cfg(feature = "daemon")]
    #[error(transparent)]
    Denied(#[from] Denied),
    /// As many answers are being streamed as the server allows at once.
    #[error("{limit} answers are being streamed, the limit of this server: try again later")]
    Busy {
        /// The limit.
        limit: usize,
    },
    /// As many connections are open as the server takes.
    #[error("{limit} connections are open, the limit of this server: try again later")]
    TooManyConnections {
        /// The limit.
        limit: usize,
    },
    /// As many requests are being answered as the server takes on at once.
    #[error("{limit} requests are being answered, the limit of this server: try again later")]
    TooManyRequests {
        /// The limit.
        limit: usize,
    },
    /// As many labels of kinds are being made, or wait to be made, as the server takes on at once.
    #[error("{limit} kinds are being made, the limit of this server: try again later")]
    TooManyMixes {
        /// The limit.
        limit: usize,
    },
    /// Requests and answers hold as much memory as they may.
    #[error("requests and answers hold {limit} bytes, the limit of this server: try again later")]
    TooManyBytes {
        /// The limit.
        limit: usize,
    },
    /// What is wanted takes more memory at once than this server ever has for it.
    #[error(
        "this takes {needed} bytes at once, and {setting} = {limit} on this server, which its operator can raise"
    )]
    NeedsMoreBytes {
        /// What it takes.
        needed: usize,
        /// The limit.
        limit: usize,
        /// The setting of the limit.
        setting: &'static str,
    },
    /// The folder of tables holds as much as the forge may make.
    #[error(
        "the folder of tables is full: {setting} = {limit} on this server, which its operator can raise"
    )]
    FolderFull {
        /// The setting of the limit.
        setting: &'static str,
        /// The limit.
        limit: u64,
    },
    /// The body has a coding that is not read.
    #[error("`Content-Encoding: {coding}` is not read; allowed: gzip, or none")]
    UnknownCoding {
        /// The coding, as the client names it.
        coding: String,
    },
    /// The body took longer to come than it may.
    #[error("the body did not arrive within {seconds} seconds")]
    BodyTooSlow {
        /// The limit.
        seconds: String,
    },
    /// The answer took longer than it may.
    #[error(
        "there was no answer within {seconds} seconds: try again later, or request a smaller region"
    )]
    TimeOver {
        /// The limit.
        seconds: String,
    },
    /// The kinds of the query were still being made when the time for the answer was over.
    #[error(
        "labels of these kinds are being made, once, which takes longer than the {seconds} seconds of an answer: \
         try again in {} seconds", self.retry_seconds().unwrap_or(1)
    )]
    KindsInTheMaking {
        /// The limit.
        seconds: String,
    },
    /// The server is about to stop.
    #[error("the server is shutting down: try again later, or elsewhere")]
    ShuttingDown,
    /// A fault of the server's own; the log has more.
    #[error("an internal error: {0}")]
    Internal(&'static str),
}

fn joined(faults: &[Fault]) -> String {
    let texts: Vec<String> = faults.iter().map(Fault::to_string).collect();
    texts.join("; ")
}

/// The kinds of [`Error`], without their details.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// [`Error::Invalid`].
    Invalid,
    /// [`Error::TooManyPoints`].
    TooManyPoints,
    /// [`Error::TooManyRows`].
    TooManyRows,
    /// [`Error::BodyTooLarge`].
    BodyTooLarge,
    /// [`Error::OtherTable`].
    OtherTable,
    /// [`Error::OtherWorld`].
    OtherWorld,
    /// [`Error::TableUnreadable`].
    TableUnreadable,
    /// [`Error::NotAcceptable`].
    NotAcceptable,
    /// [`Error::NoSuchPoint`].
    NoSuchPoint,
    /// [`Error::NoSuchJob`].
    NoSuchJob,
    /// [`Error::NoSuchPath`].
    NoSuchPath,
    /// [`Error::NoSuchMethod`].
    NoSuchMethod,
    /// A key is needed, or is not known.
    Unauthenticated,
    /// Only administrators may do that.
    NotAllowed,
    /// The caller has as many streams as it may have.
    TooManyStreams,
    /// The caller has as many tables made as it may have.
    TooManyJobs,
    /// The client's address uses as much as one address may.
    TooManyForAddress,
    /// The caller takes points too fast.
    TooFast,
    /// [`Error::Busy`], [`Error::TooManyConnections`], [`Error::TooManyRequests`],
    /// [`Error::TooManyBytes`], [`Error::NeedsMoreBytes`], [`Error::TooManyJobs`].
    Busy,
    /// [`Error::UnknownCoding`].
    UnknownCoding,
    /// [`Error::BodyTooSlow`].
    BodyTooSlow,
    /// [`Error::TimeOver`], [`Error::KindsInTheMaking`].
    TimeOver,
    /// [`Error::ShuttingDown`].
    ShuttingDown,
    /// [`Error::Internal`].
    Internal,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 24] = [
        Self::Invalid,
        Self::TooManyPoints,
        Self::TooManyRows,
        Self::BodyTooLarge,
        Self::OtherTable,
        Self::OtherWorld,
        Self::TableUnreadable,
        Self::NotAcceptable,
        Self::NoSuchPoint,
        Self::NoSuchJob,
        Self::NoSuchPath,
        Self::NoSuchMethod,
        Self::Unauthenticated,
        Self::NotAllowed,
        Self::TooManyStreams,
        Self::TooManyJobs,
        Self::TooManyForAddress,
        Self::TooFast,
        Self::Busy,
        Self::UnknownCoding,
        Self::BodyTooSlow,
        Self::TimeOver,
        Self::ShuttingDown,
        Self::Internal,
    ];

    /// Its name in answers: the last part of the problem type `urn:strew:problem:…`.
    #[must_use]
    pub const fn slug(self) -> &'static str {
        match self {
            Self::Invalid => "invalid-query",
            Self::TooManyPoints => "too-many-points",
            Self::TooManyRows => "too-many-rows",
            Self::BodyTooLarge => "body-too-large",
            Self::OtherTable => "other-table",
            Self::OtherWorld => "other-world",
            Self::TableUnreadable => "table-unreadable",
            Self::NotAcceptable => "not-acceptable",
            Self::NoSuchPoint => "no-such-point",
            Self::NoSuchJob => "no-such-job",
            Self::NoSuchPath => "no-such-path",
            Self::NoSuchMethod => "no-such-method",
            Self::Unauthenticated => "unauthenticated",
            Self::NotAllowed => "not-allowed",
            Self::TooManyStreams => "too-many-streams",
            Self::TooManyJobs => "too-many-jobs",
            Self::TooManyForAddress => "too-many-for-address",
            Self::TooFast => "too-fast",
            Self::Busy => "busy",
            Self::UnknownCoding => "unknown-coding",
            Self::BodyTooSlow => "body-too-slow",
            Self::TimeOver => "time-over",
            Self::ShuttingDown => "shutting-down",
            Self::Internal => "internal",
        }
    }
}

impl Error {
    /// The kind, on which the mapping to the wire depends.
    #[must_use]
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
            Self::NoSuchJob { .. } => Kind::NoSuchJob,
            Self::NoSuchPath { .. } => Kind::NoSuchPath,
            Self::NoSuchMethod { .. } => Kind::NoSuchMethod,
            Self::ForgeOff => Kind::NotAllowed,
            #[cfg(feature = "daemon")]
            Self::Denied(denied) => match denied {
                Denied::NoKey | Denied::WrongKey => Kind::Unauthenticated,
                Denied::NotAdmin { .. } => Kind::NotAllowed,
                Denied::TooManyStreams { .. } => Kind::TooManyStreams,
                Denied::TooManyJobs { .. } => Kind::TooManyJobs,
                Denied::Address { .. } | Denied::Share { .. } => Kind::TooManyForAddress,
                Denied::TooFast { .. } => Kind::TooFast,
            },
            Self::Busy { .. }
            | Self::TooManyConnections { .. }
            | Self::TooManyRequests { .. }
            | Self::TooManyMixes { .. }
            | Self::FolderFull { .. }
            | Self::TooManyJobs { .. }
            | Self::TooManyBytes { .. }
            | Self::NeedsMoreBytes { .. } => Kind::Busy,
            Self::UnknownCoding { .. } => Kind::UnknownCoding,
            Self::BodyTooSlow { .. } => Kind::BodyTooSlow,
            Self::TimeOver { .. } | Self::KindsInTheMaking { .. } => Kind::TimeOver,
            Self::ShuttingDown => Kind::ShuttingDown,
            Self::Internal(_) => Kind::Internal,
        }
    }

    /// After how many seconds the same request is worth another try, where that helps.
    #[must_use]
    pub fn retry_seconds(&self) -> Option<u64> {
        match self {
            Self::ShuttingDown => Some(1),
            // It was slow because others ask, too: soon it may be fast.
            Self::TimeOver { .. }
            | Self::KindsInTheMaking { .. }
            | Self::TableUnreadable { .. } => Some(5),
            // Never, with these settings.
            Self::NeedsMoreBytes { .. } | Self::FolderFull { .. } => None,
            #[cfg(feature = "daemon")]
            Self::Denied(denied) => denied.wait_seconds(),
            _ => (self.kind() == Kind::Busy).then_some(1),
        }
    }

    /// The faults of an invalid query; none for other errors.
    #[must_use]
    pub fn faults(&self) -> &[Fault] {
        match self {
            Self::Invalid(faults) => faults.as_slice(),
            _ => &[],
        }
    }
}
