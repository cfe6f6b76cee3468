//! Running the daemon: one port for both doors, health, a bounded stop, the log.

mod calls;
pub mod health;
mod identity;
mod metrics;
mod observe;
pub mod serve;
pub mod shutdown;
pub mod telemetry;

pub use serve::{App, ServeError};
