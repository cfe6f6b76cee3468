//! Strew, the daemon and the command line: points of any region, over REST, over gRPC, or into a file.
//!
//! - [`cli`] is the command line.
//! - [`ops`] runs the daemon: one port, its connections, limits, metrics and shutdown.
//! - [`rest`] and [`grpc`] translate requests and responses; neither uses the other.
//! - [`service`] answers checked queries and knows no protocol.
//! - [`raster`] reads rasters and pictures from files.
//! - [`access`] identifies clients and limits how much each may take.
//! - [`config`] holds the settings, [`error_map`] maps each error to its status on both protocols.

pub mod access;
mod bounded_file;
pub mod cli;
pub mod config;
pub mod error_map;
pub mod grpc;
pub mod ops;
pub mod raster;
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
