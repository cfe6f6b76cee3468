//! Fields: their grammar, and those that are loaded.
//!
//! [`document`] has the grammar as types: JSON bodies, TOML files and messages become a [`Document`], and
//! [`build`] makes the core's `FieldSpec` of it. Both report what is wrong by its path, such as
//! `field.multiply[1].noise.octaves`. [`loaded`] has the fields of the configuration and of a folder, which
//! queries name.

mod build;
pub mod document;
mod files;
pub mod loaded;
mod named;
mod picture;
mod pixels;
mod read;
mod schema;
mod sources;

#[cfg(test)]
mod tests;

pub use files::{Stamp, stamp, stamp_of};

pub use build::build;
pub use document::Document;
pub use loaded::{Fields, from_document, from_file, heights};
pub use named::NamedField;
pub use picture::SIDE;
pub use read::read_json;
pub use sources::{Allowance, MOST_PIXELS, ReadFile, Sources};

use strew_error::Faults;

fn listed(faults: &Faults) -> String {
    let faults = faults.as_slice().iter().map(ToString::to_string);
    faults.collect::<Vec<_>>().join("; ")
}
