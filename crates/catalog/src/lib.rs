//! The assets that queries may name: tables, fields, and lists of points.
//!
//! A [`Catalog`] holds all of it: the built-in ones, those of the configuration and of folders, and those that clients
//! have sent. A daemon reads the folders again while it serves ([`Reload`]). [`field`] has the grammar of fields,
//! [`except`] the lists of points that answers leave out, [`mix`] the tables that evenly spread variants need beside
//! their own. Depends on the core, rasters and settings; knows no query.

#![allow(missing_docs, reason = "internal: names say what items are")]

pub mod bounded_list;
mod catalog;
mod entry;
mod error;
pub mod except;
pub mod field;
mod key;
pub mod mix;
pub mod named;
mod offer;
mod patterns;
mod reload;
pub mod sent;

pub use catalog::{Built, Catalog};
pub use entry::{Entry, Ready};
pub use error::CatalogError;
pub use key::{Dimension, Key, MixKey, Source};
pub use offer::Offer;
pub use patterns::{MAX_PATTERN_RADIUS, PATTERN};
pub use reload::{Refusal, Reload, Serving};
