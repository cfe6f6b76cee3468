//! The daemon from outside: the real program over real sockets, and real clients.
//!
//! One binary, so that it links once. `cargo test --test suite NAME` runs the tests whose path
//! contains `NAME`, such as `rest::paging` or `keys`. Clients that are not installed are skipped
//! with a message.

mod agree;
mod cli;
mod containers;
mod docs;
mod grpc;
mod ops;
mod page;
mod rest;
mod space;
mod support;
