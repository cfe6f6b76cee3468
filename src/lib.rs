//! Strew, the daemon and the command line: points of any region, over REST, over gRPC, or into a file.
//!
//! - `cli` is the command line.
//! - `ops` runs the daemon: one port, its connections, limits, metrics and shutdown.
//! - `rest` and `grpc` translate requests and responses; neither uses the other.
//!
//! Everything else is in the crates beside it: `strew-service` answers queries, `strew-plan` is what programs embed.

#![allow(
    missing_docs,
    reason = "a program: a name that says enough needs no sentence"
)]

pub mod body;
pub mod cli;
pub mod grpc;
pub mod ops;
#[cfg(test)]
mod recipe;
pub mod rest;

/// Compiles and runs the Rust example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;

/// Compiles and runs the Rust example of the page on fields.
#[cfg(doctest)]
#[doc = include_str!("../docs/fields.md")]
struct FieldExamples;

/// Compiles and runs the Rust example of the page for games.
#[cfg(doctest)]
#[doc = include_str!("../docs/games.md")]
struct GamesExamples;
