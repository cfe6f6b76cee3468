//! Running the daemon: one port for both doors, health, a bounded stop, the log, tables read
//! again.

mod calls;
pub mod health;
pub mod reload;
pub mod serve;
pub mod shutdown;
pub mod telemetry;

pub use serve::{App, ServeError};
