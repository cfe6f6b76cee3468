//! The reasons for which the gate refuses a request.

use crate::rate::Short;

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Denied {
    /// A key is needed, and there is none.
    #[error("this server needs a key: send `Authorization: Bearer KEY` or `x-api-key: KEY`")]
    NoKey,
    /// The key is not known.
    #[error("this server does not know the key: request another from its administrator")]
    WrongKey,
    /// The request is for a host that is not this daemon's: a page may have turned its name to this machine.
    #[error(
        "the request is for the host `{host}`, and a daemon on loopback answers for addresses, names without a \
         dot and the host of http.public_url alone"
    )]
    ForeignHost { host: String },
    #[error(
        "{} may not do this: it takes a key with `admin = true`, or the address of `admin.listen`, \
         if the daemon has one",
        name.as_ref().map_or("a client without a key".into(), |name| format!("the key `{name}`"))
    )]
    NotAdmin {
        /// The name of the key, if there is one.
        name: Option<String>,
    },
    #[error(
        "{limit} answers are being streamed to this key, the limit: try again when one has ended"
    )]
    TooManyStreams { limit: usize },
    #[error("{limit} {what} of this address are in use, the limit: try again later")]
    Address { what: &'static str, limit: usize },
    /// The client's address uses all that it may use without leaving others less than itself.
    #[error(
        "this server has {limit} {what} for all clients, and an address uses no more of them than are left: \
         try again later"
    )]
    Share { what: &'static str, limit: usize },
    #[error(
        "{points} points exceed the rate: {left} are left, and {rate} return every second, up to {burst}; \
         try again in {wait} s",
        left = short.level.left,
        rate = short.level.rate.points_per_second,
        burst = short.level.rate.burst_points,
        wait = self.wait_seconds().unwrap_or_default()
    )]
    TooFast { points: u128, short: Short },
}

impl Denied {
    /// The number of seconds, rounded up, after which a caller that is too fast may try again.
    pub fn wait_seconds(&self) -> Option<u64> {
        let Self::TooFast { short, .. } = self else {
            return None;
        };
        let whole = short.wait.as_secs() + u64::from(short.wait.subsec_nanos() > 0);
        Some(whole.max(1))
    }

    pub const fn limit(&self) -> Option<usize> {
        match self {
            Self::TooManyStreams { limit }
            | Self::Address { limit, .. }
            | Self::Share { limit, .. } => Some(*limit),
            _ => None,
        }
    }
}
