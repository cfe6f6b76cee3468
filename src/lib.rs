//! Strew, the daemon and the command line: points of any region, over REST, over gRPC, or into a file.
//!
//! Without the feature `daemon` the crate is the [`service`] alone: checked queries become points in columns, in
//! the process that asks, through a [`service::Library`]. It needs no async runtime and no HTTP.
//!
//! - `cli` is the command line.
//! - `ops` runs the daemon: one port, its connections, limits, metrics and shutdown.
//! - `rest` and `grpc` translate requests and responses; neither uses the other.
//! - [`service`] answers checked queries and knows no protocol.
//! - [`raster`] reads rasters and pictures from files.
//! - `access` identifies clients and limits how much each may take.
//! - [`config`] holds the settings, `error_map` maps each error to its status on both protocols.

#![cfg_attr(
    not(feature = "daemon"),
    allow(dead_code, reason = "what a daemon charges, reloads and logs")
)]

#[cfg(feature = "daemon")]
pub mod access;
mod bounded_file;
#[cfg(feature = "daemon")]
pub mod cli;
pub mod config;
#[cfg(feature = "daemon")]
pub mod error_map;
#[cfg(feature = "daemon")]
pub mod grpc;
mod name;
#[cfg(feature = "daemon")]
pub mod ops;
pub mod raster;
#[cfg(feature = "daemon")]
pub mod rest;
pub mod service;

/// Compiles and runs the Rust example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;

/// Compiles and runs the Rust example of the page on fields.
#[cfg(doctest)]
#[doc = include_str!("../docs/fields.md")]
struct FieldExamples;
