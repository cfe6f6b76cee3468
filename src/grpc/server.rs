//! What tonic generates for the service of the contract (the test of `crates/proto` writes it).

include!("generated/server.rs");
