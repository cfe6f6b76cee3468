//! Why a request is refused by the gate, and when it may be tried again.

use std::time::Duration;

use super::bucket::Short;

/// Why a request is refused, for good or for now.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Denied {
    /// A key is needed, and there is none.
    #[error("this server needs a key: send `Authorization: Bearer KEY` or `x-api-key: KEY`")]
    NoKey,
    /// The key is not known.
    #[error("this server does not know the key: request another from its administrator")]
    WrongKey,
    /// Only administrators may do that.
    #[error(
        "{} may not do this: it takes a key with `admin = true`, or the address of `admin.listen`, \
         if the daemon has one",
        name.as_ref().map_or("a client without a key".into(), |name| format!("the key `{name}`"))
    )]
    NotAdmin {
        /// Whose key it is.
        name: Option<String>,
    },
    /// The caller has as many streams as it may have.
    #[error(
        "{limit} answers are being streamed to this key, the limit: try again when one has ended"
    )]
    TooManyStreams {
        /// The limit.
        limit: usize,
    },
    /// The caller has as many tables made as it may.
    #[error(
        "{limit} tables are being made for this client, the limit: try again when one is finished"
    )]
    TooManyJobs {
        /// The limit.
        limit: usize,
    },
    /// The client's address uses as much as one address may.
    #[error("{limit} {what} of this address are in use, the limit: try again later")]
    Address {
        /// What it uses.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// The client's address uses as much as is left for all others.
    #[error(
        "this server has {limit} {what} for all clients, and an address uses no more of them than are left: \
         try again later"
    )]
    Share {
        /// What it uses.
        what: &'static str,
        /// The limit for all addresses.
        limit: usize,
    },
    /// The caller takes points too fast.
    #[error(
        "{points} points exceed the rate: {left} are left, and {rate} return every second, up to {burst}; \
         try again in {wait} s",
        left = short.level.left,
        rate = short.level.rate.points_per_second,
        burst = short.level.rate.burst_points,
        wait = self.wait_seconds().unwrap_or_default()
    )]
    TooFast {
        /// What was asked for.
        points: u128,
        /// What there is.
        short: Short,
    },
}

impl Denied {
    /// After how long the same request is worth another try, if it ever is.
    #[must_use]
    pub const fn wait(&self) -> Option<Duration> {
        match self {
            Self::TooManyStreams { .. }
            | Self::TooManyJobs { .. }
            | Self::Address { .. }
            | Self::Share { .. } => Some(Duration::from_secs(1)),
            Self::TooFast { short, .. } => Some(short.wait),
            _ => None,
        }
    }

    /// The same in whole seconds, rounded up, 1 at least.
    #[must_use]
    pub fn wait_seconds(&self) -> Option<u64> {
        let whole = |wait: Duration| wait.as_secs() + u64::from(wait.subsec_nanos() > 0);
        self.wait().map(|wait| whole(wait).max(1))
    }
}
