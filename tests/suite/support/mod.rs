//! What the tests of several folders share. There are no tests here.

pub mod browser;
pub mod command;
pub mod csv;
pub mod daemon;
pub mod grpc;
pub mod keys;
pub mod library;
pub mod metrics;
pub mod problem;
pub mod queries;
