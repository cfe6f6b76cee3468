//! Commands.
mod config;
mod forge;
mod full_disk;
mod invalid_flags;
mod probe;
mod queries;
