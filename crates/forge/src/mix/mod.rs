//! Kinds.

mod anneal;
mod near;
pub mod order;
pub mod tune;
