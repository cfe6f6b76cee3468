//! Running the daemon: starting, reloading and stopping it; who may use it and how much (keys,
//! administrators, rates, limits, timeouts, TLS); what it withstands (connections, hostile clients,
//! panics, long streams, a replica that fails); and what it reports (logs, metrics, spans).

mod admin;
mod attacks;
mod bad_calls;
mod caches;
mod connections;
mod fairness;
mod files;
mod hostile_clients;
mod keys;
mod limits;
mod logs;
mod messages;
mod metrics;
mod panics;
mod pictures;
mod prices;
mod rates;
mod reload;
mod replicas;
mod rollout;
mod shutdown;
#[cfg(feature = "otlp")]
mod spans;
mod startup;
mod streaming;
mod table_cache;
mod timeouts;
mod tls;
