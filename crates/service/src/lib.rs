//! The service below every protocol: a daemon's work for many clients at once.
//!
//! A [`Service`] answers checked queries: it takes tables from a cache, plans on its workers, in turns by address, and
//! hands out a stream of blocks that an encoder makes one at a time, on demand. [`Budget`] bounds the memory of all
//! requests and answers, [`Streams`] the streams, and every work has an owner and an end. It draws
//! figures of patterns, masks and portraits.
//!
//! Depends on plans and all below them. The only library with an async runtime; knows no protocol.

#![allow(missing_docs, reason = "internal: names say what items are")]

pub mod access;
pub mod budget;
pub mod cache;
mod daemon;
pub mod mask;
mod mixes;
pub mod pattern;
mod portrait;
mod promise;
mod reading;
pub mod record;
pub mod segments;
pub mod stream;
pub mod unpack;
pub mod work;

pub use budget::{Budget, Held};
pub use daemon::Service;
pub use portrait::Portrait;
pub use promise::PointsInFlight;
pub use reading::charge_reading;
pub use record::{Record, allowance};
pub use stream::{BlockStream, Interrupted, Permit, Streams};
pub use work::{Owner, Pulse, Workers};
