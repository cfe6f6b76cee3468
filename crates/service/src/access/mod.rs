//! Access: keys and their rights, rates in points, the usage of each address.
//!
//! REST and gRPC pass the key and the address of a request to [`Gate::admit`], which returns the
//! [`Caller`]. It travels with the request and decides what is allowed. Nothing here knows a protocol.
//!
//! Depends on the settings and the words of refusals alone.

mod address;
mod bucket;
mod caller;
mod clients;
mod keys;
mod secret;
mod usage;

use std::{net::IpAddr, sync::Arc, time::Instant};

use arc_swap::ArcSwap;
use strew_config::{self as config, Access as Settings, AddressLimits, Networks};
use strew_error::{Denied, Rate};

pub use caller::{Caller, Place};
pub use keys::KeysError;
pub use secret::{Hashed, new_key};
pub use usage::{InUse, OneOf, Quota, Usage};

use clients::Clients;
use keys::Keys;
use usage::Usages;

/// The rate that the settings name, if they name one.
fn rate_of(settings: &config::Rate) -> Option<Rate> {
    let burst = Some(settings.burst_points).filter(|burst| *burst > 0.0);
    let per_second = settings.points_per_second;
    (per_second > 0.0).then(|| Rate::new(per_second, burst))
}

#[derive(Debug)]
pub struct Gate {
    settings: Settings,
    proxies: Networks,
    /// The rate of clients without one of their own.
    rate: Option<Rate>,
    keys: ArcSwap<Keys>,
    clients: Option<Clients>,
    usages: Usages,
}

impl Gate {
    pub fn new(
        settings: Settings,
        rate: &config::Rate,
        addresses: AddressLimits,
    ) -> Result<Self, KeysError> {
        let most = rate.max_clients;
        let rate = rate_of(rate);
        Ok(Self {
            // Settings are checked before.
            proxies: Networks::read(&settings.trusted_proxies).unwrap_or_default(),
            keys: ArcSwap::from_pointee(Keys::read(&settings, rate, None)?),
            clients: rate.map(|rate| Clients::new(rate, most)),
            usages: Usages::new(addresses),
            rate,
            settings,
        })
    }

    /// Reads the keys again, and returns how many there are. If they cannot be read, those before stay; if there
    /// are none any more, none is valid.
    pub fn reload(&self) -> Result<usize, KeysError> {
        let keys = Keys::read(&self.settings, self.rate, Some(&self.keys.load()))?;
        let count = keys.len();
        self.keys.store(Arc::new(keys));
        Ok(count)
    }

    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Where a request comes from: from `peer`, or from whom trusted proxies name.
    pub fn client<'a>(
        &self,
        peer: IpAddr,
        forwarded: impl DoubleEndedIterator<Item = &'a [u8]>,
    ) -> IpAddr {
        address::client(&self.proxies, peer, forwarded)
    }

    /// The usage of an address. Trusted proxies, which speak for many clients, have no limits.
    pub fn usage(&self, address: IpAddr) -> Arc<Usage> {
        if self.proxies.contains(address) {
            return Usage::unlimited();
        }
        self.usages.of(address)
    }

    /// Admits a client with a key, or without one, from an address, and takes one point from its rate
    /// for the request itself.
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
        caller.begin()?;
        Ok(caller)
    }
}
