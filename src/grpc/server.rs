//! What tonic generates for the service of the contract (the test of `crates/proto` writes it).

#![allow(
    clippy::allow_attributes_without_reason,
    clippy::all,
    reason = "generated"
)]

include!("generated/server.rs");
