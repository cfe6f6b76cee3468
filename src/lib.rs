//! Strew, the daemon and the command line: points of any region, by REST, by gRPC, or to a file.
//!
//! The floors: [`access`] says who asks and how much; [`service`] answers checked queries and knows no wire; [`rest`] and [`grpc`] are
//! thin doors to it that never name each other; [`ops`] runs them on one port; [`cli`] is what a
//! shell sees. [`config`] holds the settings, [`error_map`] what every error is on the wire.

pub mod access;
pub mod cli;
pub mod config;
pub mod error_map;
pub mod grpc;
pub mod ops;
pub mod rest;
pub mod service;
