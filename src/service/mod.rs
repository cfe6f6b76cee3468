//! What Strew does, without a wire: checked queries, tables, samplers, points in blocks or columns.
//!
//! A query comes in as raw parameters or typed fields and leaves [`query`] checked. A [`Library`] finds its
//! table in the [`catalog`], plans the region and fills [`Columns`]: it is what the bindings are made on. A
//! daemon has a `Service`, which answers many clients at once: it takes tables from a cache, plans on its
//! workers and hands out a stream of blocks that an encoder makes one at a time, on demand. Encoders
//! ([`encode`]) are plain iterators: a command line can run them without any of the rest.
//!
//! What only a daemon needs is there with the feature `daemon`.

mod attributes;
mod bounded_list;
#[cfg(feature = "daemon")]
pub mod budget;
#[cfg(feature = "daemon")]
pub mod cache;
pub mod catalog;
#[cfg(feature = "daemon")]
mod daemon;
mod effort;
pub mod encode;
pub mod error;
pub mod except;
pub mod field;
#[cfg(feature = "daemon")]
pub mod forging;
pub mod library;
#[cfg(feature = "daemon")]
pub mod mask;
mod mix;
#[cfg(feature = "daemon")]
mod mixes;
pub mod named;
#[cfg(feature = "daemon")]
pub mod pattern;
mod planned;
mod planned_points;
mod planned_set;
mod planner;
#[cfg(feature = "daemon")]
mod portrait;
#[cfg(feature = "daemon")]
mod promise;
pub mod query;
#[cfg(feature = "daemon")]
mod reading;
mod ready;
#[cfg(feature = "daemon")]
pub mod record;
mod resolve;
#[cfg(feature = "daemon")]
pub mod segments;
pub mod sent;
mod single;
#[cfg(feature = "daemon")]
pub mod stream;
#[cfg(feature = "daemon")]
mod tables;
mod terrain;
#[cfg(feature = "daemon")]
pub mod unpack;
pub mod work;
pub mod world;

pub use catalog::{Catalog, Entry, Key, Reload};
pub use effort::{Neighbors, considered};
pub use encode::{Answer, Encoding, Options, Output};
pub use error::{Error, Fault, Kind};
pub use library::{Columns, Library};
pub use planned::{Placed, PlacedPoints, Planned};
pub use planned_points::{PlannedPoints, Walk};
pub use planned_set::PlannedSet;
pub use query::{Draft, Nearest, Query, Set, Token};
pub use ready::Ready;
pub use single::Found;
pub use work::Lane;
pub use world::{World, Worlds};
#[cfg(feature = "daemon")]
pub use {
    budget::{Budget, Held},
    daemon::Service,
    portrait::Portrait,
    promise::PointsInFlight,
    record::{Record, allowance},
    stream::{BlockStream, Interrupted, Permit, Streams},
    work::{Owner, Pulse, Workers},
};

pub use crate::config::Limits;
