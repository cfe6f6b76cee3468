//! Noise profiles: what a name such as `blue` stands for.
//!
//! A [`Profile`] says how a table is optimized and which bounds its figures must satisfy before it
//! is accepted. `blue.rs` and `curves.rs` hold the profiles as constants, `known.rs` lists them and
//! finds them by name. Each has a [`Recipe`], the parameters of an optimizer.
//! An [`Aim`] is read back from a finished table: the statement, bounds and curve it was made for.
//!
//! To add a profile, add a constant in the file of its family and its name to [`Profile::ALL`]. For
//! a new kind of optimizer, also add a variant of [`Recipe`].

mod blue;
mod curves;
mod known;
mod recipe;

pub use known::Aim;
pub use recipe::{Following, Profile, Push, Recipe, Repulsion};
