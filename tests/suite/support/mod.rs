//! Support for the tests of several folders, without tests of its own; parts that other test binaries and benches need
//! as well are in `crates/testkit`.

pub mod attack;
pub mod browser;
pub mod clients;
pub mod command;
pub mod csv;
pub mod daemon;
pub mod disk;
pub mod engine;
pub mod fields;
pub mod front;
pub mod grpc;
pub mod keys;
pub mod library;
pub mod messages;
pub mod metrics;
pub mod problem;
pub mod proxy;
pub mod queries;
pub mod sending;
pub mod session;
pub mod table;
pub mod tls;
