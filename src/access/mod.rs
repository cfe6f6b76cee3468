//! Access: keys and what each allows, rates in points, what each address uses.
//!
//! REST and gRPC pass the key and the address of a request to [`Gate::admit`], which returns the
//! [`Caller`]. It travels with the request and decides what is allowed. Nothing here knows a protocol.

mod address;
mod bucket;
mod caller;
mod clients;
mod denied;
mod keys;
mod secret;
mod usage;

use std::{net::IpAddr, sync::Arc, time::Instant};

use arc_swap::ArcSwap;

use crate::config::{self, Access as Settings, AddressLimits, Networks};

pub use bucket::{Level, Rate, Short};
pub use caller::{Caller, Place};
pub use denied::Denied;
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
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn reload(&self) -> Result<usize, KeysError> {
        let keys = Keys::read(&self.settings, self.rate, Some(&self.keys.load()))?;
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
        address::client(&self.proxies, peer, forwarded)
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
        caller.address = Some(address);
        caller.charge_request()?;
        Ok(caller)
    }
}
