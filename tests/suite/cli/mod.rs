//! The commands: `sample`, `count`, `point`, `nearest` and `split` against the answers of REST, `export` beside the
//! daemon, `figure` and `arrangement`, `forge` with interruptions, `config` and its layers, `probe` as health checks
//! run it, what wrong flags and full disks lead to.

mod completions;
mod config;
mod export;
mod fields;
mod forge;
mod full_disk;
mod invalid_flags;
mod mix;
mod outputs;
mod patterns;
mod probe;
mod queries;
mod remote;
mod worlds;
