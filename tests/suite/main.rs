//! The daemon from outside: the real program over real sockets, and the real clients.

mod cli;
mod docs;
mod grpc;
mod ops;
mod page;
mod rest;
mod support;
