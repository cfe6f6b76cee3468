//! Running the daemon: one port for both doors, connections and their limits, TLS, health,
//! a bounded stop, the log, tables read again.

mod activity;
mod admin;
mod calls;
pub mod connections;
pub mod exposure;
pub mod files;
mod gate;
mod guarded;
pub mod health;
mod identity;
mod load;
mod metrics;
mod observe;
mod often;
mod panics;
pub mod reload;
pub mod serve;
pub mod shutdown;
pub mod spans;
pub mod telemetry;
mod timed;
pub mod tls;

pub use connections::Peer;
pub use serve::{App, ServeError};
