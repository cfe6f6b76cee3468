//! The buckets of clients without a key, by address, in bounded memory.
//!
//! A full bucket equals a new one, so full buckets are forgotten first. If that is not enough, the fullest of the rest
//! go, since they hold the least debt. A client with IPv6 commands a whole /64, which therefore counts as one.

use std::{
    collections::HashMap,
    net::{IpAddr, Ipv6Addr},
    sync::Arc,
    time::Instant,
};

use parking_lot::Mutex;
use strew_error::Rate;

use super::bucket::Bucket;

#[derive(Debug)]
pub(super) struct Clients {
    rate: Rate,
    most: usize,
    buckets: Mutex<HashMap<IpAddr, Arc<Bucket>>>,
}

impl Clients {
    /// None yet, and never more than `most`.
    pub(super) fn new(rate: Rate, most: usize) -> Self {
        Self {
            rate,
            most,
            buckets: Mutex::default(),
        }
    }

    pub(super) fn bucket(&self, address: IpAddr, now: Instant) -> Arc<Bucket> {
        let client = client(address);
        let mut buckets = self.buckets.lock();
        if let Some(bucket) = buckets.get(&client) {
            return bucket.clone();
        }
        if buckets.len() >= self.most {
            make_room(&mut buckets, self.most, now);
        }
        let bucket = Arc::new(Bucket::full(self.rate, now));
        buckets.insert(client, bucket.clone());
        bucket
    }
}

/// Forgets an eighth at least, so that the next newcomers come in without a search.
fn make_room(buckets: &mut HashMap<IpAddr, Arc<Bucket>>, most: usize, now: Instant) {
    buckets.retain(|_, bucket| !bucket.level(now).full_in.is_zero());
    let stay = most - most.div_ceil(8);
    let Some(leave) = buckets.len().checked_sub(stay).filter(|leave| *leave > 0) else {
        return;
    };
    let mut all: Vec<_> = buckets
        .iter()
        .map(|(&client, bucket)| (bucket.level(now).full_in, client))
        .collect();
    all.select_nth_unstable(leave - 1);
    for (_, client) in &all[..leave] {
        buckets.remove(client);
    }
}

/// The addresses that count as one client.
pub(super) fn client(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V6(v6) => Ipv6Addr::from_bits(v6.to_bits() & (u128::MAX << 64)).into(),
        v4 => v4,
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    const RATE: Rate = Rate {
        points_per_second: 1.0,
        burst_points: 100.0,
    };

    fn address(i: u32) -> IpAddr {
        std::net::Ipv4Addr::from_bits(i).into()
    }

    #[test]
    fn memory_is_bounded_and_the_deepest_in_debt_is_remembered() {
        let now = Instant::now();
        let clients = Clients::new(RATE, 64);
        let debtor = address(7);
        clients
            .bucket(debtor, now)
            .take(5000.0, 0.0, now)
            .expect("full");
        for i in 1000..11_000 {
            let _ = clients.bucket(address(i), now).take(1.0, 0.0, now);
            assert!(clients.buckets.lock().len() <= 64);
        }
        assert!(clients.bucket(debtor, now).take(1.0, 0.0, now).is_err());
        // A bucket that is full again need not be kept.
        let later = now + Duration::from_secs(10_000);
        for i in 0..60 {
            clients.bucket(address(i), later);
        }
        assert!(clients.buckets.lock().len() <= 64);
    }

    #[test]
    fn an_address_has_one_bucket_and_a_network_of_ipv6_as_well() {
        let now = Instant::now();
        let clients = Clients::new(RATE, 64);
        let same = |a: &str, b: &str| {
            let [a, b] = [a, b].map(|text| clients.bucket(text.parse().expect("valid"), now));
            Arc::ptr_eq(&a, &b)
        };
        assert!(same("192.0.2.1", "192.0.2.1"));
        assert!(!same("192.0.2.1", "192.0.2.2"));
        assert!(same("192.0.2.1", "::ffff:192.0.2.1"));
        assert!(same("2001:db8::1", "2001:db8::2:3:4:5"));
        assert!(!same("2001:db8::1", "2001:db8:0:1::1"));
    }
}
