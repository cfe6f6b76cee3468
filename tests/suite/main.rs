//! The daemon from outside: the real program over real sockets, and the real clients.

mod clients;
mod daemon;
mod drain;
mod forge;
mod formats;
mod fresh;
mod grpc;
mod limits;
mod openapi;
mod raw;
mod readers;
mod settings;
mod streaming;
mod wrong;
