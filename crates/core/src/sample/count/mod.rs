//! Exact counts without making points.
//!
//! `choose` picks the way: `boxes` counts a box without warp in closed form (`tally` counts its columns
//! and rows by block), `margins` a warped box, `sifted` everything that has a sieve.

mod boxes;
mod choose;
mod margins;
mod sifted;
mod tally;

pub(super) use choose::count;
