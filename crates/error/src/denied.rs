//! The reasons for which the gate refuses a request, and rates of points.

use std::time::Duration;

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Denied {
    #[error("this server needs a key: send `Authorization: Bearer KEY` or `x-api-key: KEY`")]
    NoKey,
    #[error("this server does not know the key: request another from its administrator")]
    WrongKey,
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

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// Points per second, above 0.
    pub points_per_second: f64,
    /// The burst allowed after a pause, at least 1.
    pub burst_points: f64,
}

impl Rate {
    /// The burst of a rate that names none, in seconds.
    const REST: f64 = 10.0;

    /// A rate with its burst, or with that of ten seconds.
    pub fn new(points_per_second: f64, burst_points: Option<f64>) -> Self {
        let burst = burst_points.unwrap_or(points_per_second * Self::REST);
        Self {
            points_per_second,
            burst_points: burst.max(1.0),
        }
    }
}

/// The points left in a bucket, and when it will be full.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    pub rate: Rate,
    /// The points left; 0 while the bucket owes some.
    pub left: u64,
    /// The time until it is full.
    pub full_in: Duration,
}

/// A bucket holds too little.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Short {
    pub level: Level,
    /// The time until the same request is let through, if no other comes first.
    pub wait: Duration,
}
