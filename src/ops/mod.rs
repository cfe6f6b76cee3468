//! Running the daemon: one port for both protocols, connections and their limits, TLS, health,
//! a bounded stop, the log, tables read again.

mod admin;
mod app;
mod calls;
pub mod connections;
mod dialect;
mod exchange;
pub mod exposure;
pub mod files;
mod gate;
mod guarded;
pub mod health;
mod identity;
pub mod memory;
mod metrics;
mod panics;
mod peer;
pub mod reload;
pub mod serve;
pub mod shutdown;
pub mod spans;
mod step;
pub mod telemetry;
mod throttle;
pub mod tls;
mod trim;

pub use peer::Peer;
pub use serve::{App, ServeError};
