//! The current usage of clients by address: connections, requests, streams, bytes.
//!
//! These limits keep one address from taking all that the daemon shares out. They apply with and without keys. An
//! address is remembered only while it uses something, so the table is bounded by the things that it counts. A client
//! with IPv6 commands a whole /64, which therefore counts as one address.

use std::{
    collections::HashMap,
    net::IpAddr,
    sync::{
        Arc, Weak,
        atomic::{AtomicUsize, Ordering},
    },
};

use parking_lot::Mutex;
use strew_config::AddressLimits;
use strew_error::Denied;

use super::clients::client;

/// A number of things that are in use, up to a limit.
#[derive(Debug)]
pub struct Quota {
    used: AtomicUsize,
    limit: usize,
}

impl Quota {
    pub const fn new(limit: usize) -> Self {
        Self {
            used: AtomicUsize::new(0),
            limit,
        }
    }

    pub fn used(&self) -> usize {
        self.used.load(Ordering::Acquire)
    }

    pub const fn limit(&self) -> usize {
        self.limit
    }

    /// Takes `amount` if the limit allows; returns whether it did.
    pub fn take(&self, amount: usize) -> bool {
        let limit = self.limit;
        let more = |used: usize| used.checked_add(amount).filter(|&sum| sum <= limit);
        let taken = self
            .used
            .fetch_update(Ordering::AcqRel, Ordering::Acquire, more);
        taken.is_ok()
    }

    /// Takes one, if the limit allows.
    pub fn one(self: Arc<Self>) -> Option<OneOf> {
        self.take(1).then(|| OneOf(self))
    }

    /// Takes `amount` whatever the limit; returns the amount in use.
    pub fn take_anyway(&self, amount: usize) -> usize {
        self.used.fetch_add(amount, Ordering::AcqRel) + amount
    }

    /// Whether an address may use this share of a quota that all addresses have in common: no more than is left for the
    /// others, so a few addresses together never take all. If the operator allows an address more than half of the
    /// quota, this rule does not apply.
    pub fn is_fair(&self, all: &Self) -> bool {
        let left = all.limit.saturating_sub(all.used());
        self.limit > all.limit / 2 || self.used() <= left
    }

    pub fn give_back(&self, amount: usize) {
        self.used.fetch_sub(amount, Ordering::AcqRel);
    }
}

/// One of what all addresses share, given back when dropped.
#[derive(Debug)]
pub struct OneOf(Arc<Quota>);

impl Drop for OneOf {
    fn drop(&mut self) {
        self.0.give_back(1);
    }
}

/// The usage of one address. Return everything taken before dropping it.
#[derive(Debug)]
pub struct Usage {
    address: Option<(IpAddr, Weak<Table>)>,
    pub connections: Quota,
    /// Requests, from the head to the last byte of the answer.
    pub requests: Quota,
    /// Requests that are worked on, from the end of the body to the head of the answer.
    pub places: Quota,
    /// Health checks, which have places of their own.
    pub probes: Quota,
    pub streams: Quota,
    pub bytes: Quota,
}

/// Health checks of one address that are answered whatever else it uses.
const PROBES: usize = 8;

impl Usage {
    fn new(limits: &AddressLimits, address: Option<(IpAddr, Weak<Table>)>) -> Self {
        Self {
            address,
            connections: Quota::new(limits.max_connections),
            requests: Quota::new(limits.max_requests),
            places: Quota::new(limits.max_requests),
            probes: Quota::new(PROBES),
            streams: Quota::new(limits.max_streams),
            bytes: Quota::new(limits.max_bytes_in_flight),
        }
    }

    /// Usage without limits, of trusted proxies and of programs without sockets.
    pub fn unlimited() -> Arc<Self> {
        let all = usize::MAX;
        let limits = AddressLimits {
            max_connections: all,
            max_requests: all,
            max_streams: all,
            max_bytes_in_flight: all,
        };
        Arc::new(Self::new(&limits, None))
    }

    /// The client that it is of; none for those without limits.
    pub fn client(&self) -> Option<IpAddr> {
        self.address.as_ref().map(|(client, _)| *client)
    }

    /// A place for a connection among `all`, given back when dropped.
    ///
    /// # Errors
    /// [`Denied::Address`] at the limit, [`Denied::Share`] if few are left for others.
    pub fn connection(self: &Arc<Self>, all: &Quota) -> Result<InUse, Denied> {
        self.share(|usage| &usage.connections, "connections", all)
    }

    /// A place for a stream among `all`, given back when dropped.
    ///
    /// # Errors
    /// As [`connection`](Self::connection).
    pub fn stream(self: &Arc<Self>, all: &Quota) -> Result<InUse, Denied> {
        self.share(|usage| &usage.streams, "streams", all)
    }

    /// A place for a request that is worked on among `all`, given back when dropped.
    ///
    /// # Errors
    /// As [`connection`](Self::connection).
    pub fn place(self: &Arc<Self>, all: &Quota) -> Result<InUse, Denied> {
        self.share(|usage| &usage.places, "requests", all)
    }

    /// A place for a health check, if one is free; given back when dropped.
    pub fn probe(self: &Arc<Self>) -> Option<InUse> {
        self.one(|usage| &usage.probes, "probes").ok()
    }

    /// Counts a request, also beyond the limit, since a refusal is an answer, too.
    pub fn request(self: &Arc<Self>) -> InUse {
        self.requests.take_anyway(1);
        InUse {
            usage: self.clone(),
            quota: |usage| &usage.requests,
        }
    }

    fn share(
        self: &Arc<Self>,
        quota: fn(&Self) -> &Quota,
        what: &'static str,
        all: &Quota,
    ) -> Result<InUse, Denied> {
        let one = self.one(quota, what)?;
        if !quota(self).is_fair(all) {
            let limit = all.limit();
            return Err(Denied::Share { what, limit });
        }
        Ok(one)
    }

    fn one(
        self: &Arc<Self>,
        quota: fn(&Self) -> &Quota,
        what: &'static str,
    ) -> Result<InUse, Denied> {
        if !quota(self).take(1) {
            let limit = quota(self).limit();
            return Err(Denied::Address { what, limit });
        }
        Ok(InUse {
            usage: self.clone(),
            quota,
        })
    }
}

impl Drop for Usage {
    fn drop(&mut self) {
        let place = self.address.as_ref();
        if let Some((address, table)) = place.and_then(|(at, table)| Some((at, table.upgrade()?))) {
            // Another may have taken its place since the last handle was gone.
            let mut all = table.lock();
            if all
                .get(address)
                .is_some_and(|usage| usage.strong_count() == 0)
            {
                all.remove(address);
            }
        }
    }
}

/// One of a quota, given back when dropped.
#[derive(Debug)]
pub struct InUse {
    usage: Arc<Usage>,
    quota: fn(&Usage) -> &Quota,
}

impl Drop for InUse {
    fn drop(&mut self) {
        (self.quota)(&self.usage).give_back(1);
    }
}

type Table = Mutex<HashMap<IpAddr, Weak<Usage>>>;

/// The usage of every address that uses something.
#[derive(Debug)]
pub(super) struct Usages {
    limits: AddressLimits,
    table: Arc<Table>,
}

impl Usages {
    pub(super) fn new(limits: AddressLimits) -> Self {
        Self {
            limits,
            table: Arc::default(),
        }
    }

    pub(super) fn of(&self, address: IpAddr) -> Arc<Usage> {
        let address = client(address);
        let mut all = self.table.lock();
        if let Some(usage) = all.get(&address).and_then(Weak::upgrade) {
            return usage;
        }
        let place = Some((address, Arc::downgrade(&self.table)));
        let usage = Arc::new(Usage::new(&self.limits, place));
        all.insert(address, Arc::downgrade(&usage));
        usage
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn usages() -> Usages {
        Usages::new(AddressLimits {
            max_connections: 2,
            max_requests: 1,
            max_streams: 1,
            max_bytes_in_flight: 10,
        })
    }

    fn address(text: &str) -> IpAddr {
        text.parse().expect("valid")
    }

    #[test]
    fn an_address_is_bounded_and_others_are_not_affected() {
        let usages = usages();
        let one = usages.of(address("192.0.2.1"));
        let all = Quota::new(100);
        let connect = |usage: &Arc<Usage>| usage.connection(&all);
        let held = [connect(&one), connect(&one)].map(|held| held.expect("a place"));
        let denied = connect(&one).expect_err("no place");
        assert!(denied.to_string().contains("2 connections"), "{denied}");
        assert!(connect(&usages.of(address("192.0.2.1"))).is_err());
        assert!(connect(&usages.of(address("192.0.2.2"))).is_ok());
        drop(held);
        assert!(connect(&one).is_ok());
        assert!(one.bytes.take(10) && !one.bytes.take(1));
    }

    #[test]
    fn a_few_addresses_never_take_all() {
        let all = Quota::new(256);
        let take = |address: &Quota| {
            let mut taken = 0;
            while address.take(1) && address.is_fair(&all) && all.take(1) {
                taken += 1;
            }
            taken
        };
        let addresses: Vec<Quota> = (0..6).map(|_| Quota::new(64)).collect();
        let taken: Vec<usize> = addresses.iter().map(take).collect();
        assert_eq!(taken, [64, 64, 64, 32, 16, 8]);
        // One that may take everything does.
        let one = Quota::new(8);
        let all = Quota::new(8);
        assert!((0..8).all(|_| one.take(1) && one.is_fair(&all) && all.take(1)));
    }

    #[test]
    fn an_address_that_uses_nothing_is_forgotten() {
        let usages = usages();
        let all = Quota::new(100);
        let stream = |text: &str| usages.of(address(text)).stream(&all);
        let held = stream("2001:db8::1").expect("a place");
        // The whole /64 is one client.
        assert!(stream("2001:db8::2:3").is_err());
        assert_eq!(usages.table.lock().len(), 1);
        drop(held);
        assert_eq!(usages.table.lock().len(), 0);
    }
}
