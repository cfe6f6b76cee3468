//! The memory that limits allow, and limits lowered to the memory that there is.
//!
//! The kernel kills a process that takes more memory than its container has. So what clients can make the daemon hold
//! must fit, whatever the settings say: they are the most, and a small container has less.

use super::Config;

/// The memory of the program with its tables, and of everything that no limit counts, in bytes. The pages of its file
/// are not in it: the kernel takes them back rather than end a process.
const BASE: u64 = 24 << 20;
/// The memory of an open connection, in bytes.
const CONNECTION: u64 = 32 << 10;
/// The allocator's share on top of what requests and caches hold, in percent.
const OVERHEAD: u64 = 15;
/// Less memory for tables than this would have every query make its table.
const LEAST_CACHE: u64 = 4 << 20;
/// Fewer connections than this would not serve a proxy.
const LEAST_CONNECTIONS: u64 = 128;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lowered {
    /// The name of the setting, such as `limits.cache_bytes`.
    pub key: &'static str,
    pub value: u64,
}

impl Config {
    /// The most memory, in bytes, that clients can make the daemon take.
    pub fn memory_bound(&self) -> u64 {
        let held = self.limits.max_bytes_in_flight as u64 + self.kept();
        let connections = self.server.max_connections as u64 * CONNECTION;
        BASE + with_overhead(held) + connections
    }

    /// Lowers the limits that bound memory, all by one share of what they have above the least useful values, so that
    /// [`Self::memory_bound`] is at most `memory` bytes. If even the least values take more, these are set. Returns the
    /// settings that have other values now.
    pub fn fit(&mut self, memory: u64) -> Vec<Lowered> {
        let before = self.clone();
        self.lower(0.0);
        let least = self.memory_bound();
        let room = memory.saturating_sub(least) as f64;
        let wanted = before.memory_bound() - least;
        self.clone_from(&before);
        self.lower((room / wanted as f64).min(1.0));
        self.lowered_from(&before)
    }

    /// Lowers each limit to its least value and a share of the rest.
    fn lower(&mut self, share: f64) {
        let scale = |value: u64, least: u64| {
            let least = least.min(value);
            least + ((value - least) as f64 * share) as u64
        };
        let number = |value: &mut usize, least: u64| {
            *value = usize::try_from(scale(*value as u64, least)).unwrap_or(*value);
        };
        let query = self.limits.least_bytes() as u64;
        number(&mut self.limits.max_bytes_in_flight, query);
        number(&mut self.per_address.max_bytes_in_flight, query);
        self.limits.cache_bytes = scale(self.limits.cache_bytes, LEAST_CACHE);
        number(&mut self.fields.max_sent_bytes, 0);
        number(&mut self.except.max_sent_bytes, 0);
        number(&mut self.server.max_connections, LEAST_CONNECTIONS);
        number(&mut self.per_address.max_connections, LEAST_CONNECTIONS / 4);
    }

    /// The memory of what clients send to be kept, and of tables that are ready, in bytes.
    fn kept(&self) -> u64 {
        let sent = self.fields.max_sent_bytes + self.except.max_sent_bytes;
        self.limits.cache_bytes + sent as u64
    }

    fn lowered_from(&self, before: &Self) -> Vec<Lowered> {
        let values = |config: &Self| {
            [
                (
                    "limits.max_bytes_in_flight",
                    config.limits.max_bytes_in_flight as u64,
                ),
                (
                    "per_address.max_bytes_in_flight",
                    config.per_address.max_bytes_in_flight as u64,
                ),
                ("limits.cache_bytes", config.limits.cache_bytes),
                ("fields.max_sent_bytes", config.fields.max_sent_bytes as u64),
                ("except.max_sent_bytes", config.except.max_sent_bytes as u64),
                (
                    "server.max_connections",
                    config.server.max_connections as u64,
                ),
                (
                    "per_address.max_connections",
                    config.per_address.max_connections as u64,
                ),
            ]
        };
        let pairs = values(before).into_iter().zip(values(self));
        let changed = pairs.filter(|((_, old), (_, new))| old != new);
        changed
            .map(|(_, (key, value))| Lowered { key, value })
            .collect()
    }
}

/// The memory of `bytes` with the overhead of the allocator.
const fn with_overhead(bytes: u64) -> u64 {
    bytes + bytes / 100 * OVERHEAD
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Layers;

    const MIB: u64 = 1 << 20;

    fn defaults() -> Config {
        Layers::new().and_then(Layers::finish).expect("valid")
    }

    #[test]
    fn limits_fit_the_memory_and_stay_valid() {
        for mebibytes in [64, 80, 128, 200, 256, 512, 1024, 1600] {
            let mut config = defaults();
            let memory = mebibytes * MIB;
            let lowered = config.fit(memory);
            let bound = config.memory_bound();
            assert!(
                bound <= memory && bound + MIB >= memory,
                "{memory}: {bound}"
            );
            assert_eq!(lowered.len(), 7, "{lowered:?}");
            crate::validate::validate(&config).expect("valid");
            // Addresses have the same share of a small daemon as of a large one.
            let all = config.limits.max_bytes_in_flight;
            assert!(config.per_address.max_bytes_in_flight >= all / 4 - 1);
            assert!(config.fit(memory).iter().all(|one| one.value > 0));
        }
    }

    #[test]
    fn large_memory_and_limits_that_fit_change_nothing() {
        let mut config = defaults();
        assert_eq!(config.fit(2048 * MIB), []);
        assert_eq!(config, defaults());
        let small = [
            "limits.max_bytes_in_flight=33554432",
            "server.max_connections=100",
            "fields.max_sent_bytes=0",
        ];
        let layers = small
            .iter()
            .try_fold(Layers::new().expect("valid"), |layers, text| {
                layers.assignment(text)
            });
        let mut config = layers.and_then(Layers::finish).expect("valid");
        assert_eq!(config.fit(256 * MIB), []);
    }

    #[test]
    fn the_least_memory_has_the_least_limits() {
        let mut config = defaults();
        config.fit(0);
        assert_eq!(
            config.limits.max_bytes_in_flight,
            config.limits.least_bytes()
        );
        assert_eq!(
            (config.limits.cache_bytes, config.server.max_connections),
            (4 * MIB, 128)
        );
        assert!(
            config.memory_bound() <= 64 * MIB,
            "{}",
            config.memory_bound()
        );
        crate::validate::validate(&config).expect("valid");
    }
}
