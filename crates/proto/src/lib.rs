//! The contract of `proto/strew/v1/` in Rust: its messages, its client and its descriptors.
//!
//! Everything is generated and kept in the repository, so that a build needs no compiler of contracts. After a change of
//! a `.proto` file, `UPDATE_GOLDEN=1 cargo test -p strew-proto` writes it anew; without the variable the test compares.

#![allow(missing_docs, reason = "the contract documents everything")]
#![allow(clippy::all, reason = "generated code")]
#![allow(clippy::allow_attributes_without_reason, reason = "generated code")]

include!("generated/strew.v1.rs");

/// The contract as reflection serves it.
pub const DESCRIPTORS: &[u8] = include_bytes!("generated/descriptors.bin");
