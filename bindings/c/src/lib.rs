//! The C library of Strew: queries come in as text, points leave in buffers of the caller.
//!
//! Queries are the bodies and addresses that REST takes, and the library decides nothing by itself: see
//! `strew_plan::Library`. Every function that can fail returns a [`Code`] and keeps its message for the calling thread
//! (`failure`). Handles are opaque; the caller frees them. A plan holds its library, so the order in which they are
//! freed does not matter. No panic leaves a function.
//!
//! `include/strew.h` is generated from this crate; a test compares both.

mod dimension;
#[cfg(feature = "documents")]
mod documents;
mod failure;
mod handles;
mod memory;
mod plan;
mod single;
#[cfg(target_arch = "wasm32")]
mod wasm;

pub use failure::Code;
pub use handles::{strew_bytes, strew_library, strew_plan};
pub use single::strew_point;
