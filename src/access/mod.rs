//! Who may ask, and how much: keys, what each may do, how fast points may be taken.
//!
//! The doors find in a request what its client shows and where it comes from; [`Gate::admit`] says
//! who that is. The [`Caller`] goes along with the request, and whoever answers asks it what is
//! allowed. Nothing here knows a wire.

mod address;
mod bucket;
mod caller;
mod clients;
mod keys;
mod secret;
mod usage;

use std::{
    net::IpAddr,
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, Instant},
};

use arc_swap::ArcSwap;
use serde::{Deserialize, Serialize};

use crate::config::AddressLimits;

pub use address::{NETWORKS, Networks};
pub use bucket::{Level, Rate, Short};
pub use caller::{Caller, Place};
pub use keys::{KeysError, is_name};
pub use secret::{Hashed, new_key};
pub use usage::{InUse, Quota, Usage};

use clients::Clients;
use keys::Keys;
use usage::Usages;

/// Who is let in.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// A file with keys; empty for none.
    pub keys_file: PathBuf,
    /// Keys in the same form as in the file; empty for none.
    pub keys: String,
    /// Whether those without a key are let in as well, where there are keys.
    pub anonymous: bool,
    /// The proxies whose word is taken on where a request comes from.
    pub trusted_proxies: String,
}

impl Settings {
    /// The file with keys, if there is one.
    #[must_use]
    pub fn keys_file(&self) -> Option<&Path> {
        Some(self.keys_file.as_path()).filter(|file| !file.as_os_str().is_empty())
    }

    /// Whether there are keys.
    #[must_use]
    pub fn has_keys(&self) -> bool {
        self.keys_file().is_some() || !self.keys.is_empty()
    }

    /// Whether nobody is let in without a key.
    #[must_use]
    pub fn needs_key(&self) -> bool {
        self.has_keys() && !self.anonymous
    }
}

/// How fast points may be taken, by each client.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RateSettings {
    /// Points per second; 0 for no limit.
    pub points_per_second: f64,
    /// How many may be taken at once after a rest; 0 for those of ten seconds.
    pub burst_points: f64,
    /// How many addresses are remembered.
    pub max_clients: usize,
}

impl RateSettings {
    fn rate(&self) -> Option<Rate> {
        let burst = Some(self.burst_points).filter(|burst| *burst > 0.0);
        (self.points_per_second > 0.0).then(|| Rate::new(self.points_per_second, burst))
    }
}

/// Why someone is not let in, or not now.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Denied {
    /// A key is needed, and there is none.
    #[error("this server needs a key: send `Authorization: Bearer KEY` or `x-api-key: KEY`")]
    NoKey,
    /// The key is not known.
    #[error("the key is not known here: ask the one who runs this server for another")]
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
        "{limit} answers to this key are under way, the most at once: try again when one is over"
    )]
    TooManyStreams {
        /// The limit.
        limit: usize,
    },
    /// The client's address uses as much as one address may.
    #[error("{limit} {what} of this address are in use, the most at once: try again later")]
    Address {
        /// What it uses.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// The caller takes points too fast.
    #[error(
        "{points} points are more than can be taken now: {left} are left, {rate} come back every \
         second, up to {burst}; try again in {wait} s",
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
            Self::TooManyStreams { .. } | Self::Address { .. } => Some(Duration::from_secs(1)),
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

/// Lets callers in.
#[derive(Debug)]
pub struct Gate {
    settings: Settings,
    proxies: Networks,
    /// The rate of all who have none of their own.
    rate: Option<Rate>,
    keys: ArcSwap<Keys>,
    clients: Option<Clients>,
    usages: Usages,
}

impl Gate {
    /// Reads the keys.
    ///
    /// # Errors
    /// [`KeysError`], naming the place and the key.
    pub fn new(
        settings: Settings,
        rate: &RateSettings,
        addresses: AddressLimits,
    ) -> Result<Self, KeysError> {
        let most = rate.max_clients;
        let rate = rate.rate();
        Ok(Self {
            // Settings are checked before.
            proxies: Networks::read(&settings.trusted_proxies).unwrap_or_default(),
            keys: ArcSwap::from_pointee(Keys::read(&settings, rate, &Keys::default())?),
            clients: rate.map(|rate| Clients::new(rate, most)),
            usages: Usages::new(addresses),
            rate,
            settings,
        })
    }

    /// Reads the keys again; gives how many there are. If they cannot be read, those before stay.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn reload(&self) -> Result<usize, KeysError> {
        let keys = Keys::read(&self.settings, self.rate, &self.keys.load())?;
        let count = keys.len();
        self.keys.store(Arc::new(keys));
        Ok(count)
    }

    /// The settings.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Where a request comes from: from `peer`, or from whom trusted proxies name.
    pub fn client<'a>(
        &self,
        peer: IpAddr,
        forwarded: impl DoubleEndedIterator<Item = &'a [u8]>,
    ) -> IpAddr {
        self.proxies.client(peer, forwarded)
    }

    /// What an address uses. Trusted proxies, which speak for many clients, have no limits.
    #[must_use]
    pub fn usage(&self, address: IpAddr) -> Arc<Usage> {
        if self.proxies.contains(address) {
            return Usage::unlimited();
        }
        self.usages.of(address)
    }

    /// Lets someone in who shows a key, or none, from an address, and takes one point from its rate
    /// for the request itself.
    ///
    /// # Errors
    /// [`Denied`], for want of a key, or of points.
    pub fn admit(
        &self,
        key: Option<&[u8]>,
        address: IpAddr,
        usage: Arc<Usage>,
    ) -> Result<Caller, Denied> {
        let mut caller = match key.filter(|_| self.settings.has_keys()) {
            Some(key) => {
                let keys = self.keys.load();
                keys.find(key).cloned().ok_or(Denied::WrongKey)?
            }
            None if self.settings.needs_key() => return Err(Denied::NoKey),
            None => Caller {
                bucket: self
                    .clients
                    .as_ref()
                    .map(|clients| clients.bucket(address, Instant::now())),
                ..Caller::default()
            },
        };
        caller.usage = Some(usage);
        caller.charge_request()?;
        Ok(caller)
    }
}
