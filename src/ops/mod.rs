//! Running the daemon: one port for both protocols, connections and their limits, TLS, health,
//! a bounded stop, the log, tables read again.

mod app;
mod calls;
pub mod connections;
mod dialect;
mod exchange;
mod gate;
mod guarded;
pub mod health;
mod identity;
pub mod memory;
mod metrics;
pub mod reload;
pub mod serve;
pub mod shutdown;
pub mod spans;
pub mod startup;
mod step;
pub mod telemetry;
pub mod tls;
mod trim;

pub use serve::App;
