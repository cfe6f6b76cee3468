//! Attributes: values that every point has besides its place.
//!
//! Trees are to be turned, scaled and of some kind, and the same tree must look the same whichever query
//! finds it. So an attribute is a function of the point's id and the seed alone: not of the spacing, the
//! warp, the region or the order. All but the rank are hashed (`hash`); the rank follows from the point's
//! place in index space.
//!
//! `kinds` names the attributes and `variants` their named things; `list` is a list of them, which `bound`
//! evaluates for the points of a set.

mod bound;
pub(super) mod hash;
mod kinds;
mod list;
mod variants;

pub use bound::{BoundAttributes, Column};
pub use kinds::{Attribute, ScaleRange, UniformNumber};
pub use list::Attributes;
pub use variants::Variants;
