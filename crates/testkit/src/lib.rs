//! Code that several of Strew's tests and benches share.
//!
//! | module | provides |
//! |---|---|
//! | [`certificates`] | a certificate authority for TLS tests |
//! | [`daemon`] | starts the program, waits until it listens, kills it on drop |
//! | [`http1`] | an HTTP/1.1 client over raw sockets |
//! | [`process`] | programs as child processes, and signals to them |
//! | [`random`] | reproducible pseudo-random numbers |
//! | [`tables`] | tables with random displacements |
//! | [`wait`] | waiting for a condition |
//!
//! The crate knows `strew-core` and nothing else of the workspace: the root crate depends on it for
//! its tests, so callers that start the daemon pass the path of the program
//! (`env!("CARGO_BIN_EXE_strew")`). Functions that return no `Result` panic when something fails,
//! which is what a test wants.

#![allow(missing_docs, reason = "internal: names say what items are")]

pub mod certificates;
pub mod daemon;
pub mod http1;
pub mod process;
pub mod random;
pub mod tables;
pub mod wait;
