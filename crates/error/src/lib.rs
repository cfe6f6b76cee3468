//! Errors of requests, in words for clients.
//!
//! [`Error`] is why a request has no answer; its [`Kind`] decides the status on each protocol. A query that is not
//! valid has [`Fault`]s, each with the field, its value and what is allowed: [`Checked`] and [`Together`] collect all
//! of them, so that a client needs one round to learn them all. Depends on no other crate of Strew.

#![allow(missing_docs, reason = "internal: names say what items are")]

mod audience;
mod denied;
mod error;
mod fault;
pub mod faults;
pub mod integer;
mod secret;

pub use audience::Audience;
pub use denied::{Denied, Level, Rate, Short};
pub use error::{Error, Kind};
pub use fault::{Fault, number, unknown};
pub use faults::{Checked, Faults, Together, all};
pub use secret::{KEY_PREFIX, without_keys};
