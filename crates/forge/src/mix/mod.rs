//! Kinds.

mod anneal;
mod near;
mod part;
pub mod together;
pub mod order;
pub mod tune;
