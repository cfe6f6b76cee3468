//! Points of regions, areas and chunks against brute force, and the laws: partitions, order, blocks, windows. Those of
//! both dimensions are in `both.rs`.

#![allow(clippy::duplicate_mod, reason = "both dimensions have the same laws")]

mod plane;
mod space;
