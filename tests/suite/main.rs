//! The daemon from outside: the real program over real sockets, and the real clients.

mod caching;
mod clients;
mod coding;
mod commands;
mod commands_wrong;
mod contract;
mod daemon;
mod documented;
mod drain;
mod forge;
mod formats;
mod fresh;
mod grpc;
mod grpc_calls;
mod grpc_web;
mod http;
mod limits;
mod openapi;
mod raw;
mod readers;
mod settings;
mod streaming;
mod wrong;
