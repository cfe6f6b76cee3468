//! Attributes: values that every point has besides its place.
//!
//! Trees are to be turned, scaled and of some kind, and the same tree must look the same whichever query
//! finds it. So an attribute is a function of the point's id and the seed alone: not of the spacing, the
//! warp, the region or the order. All but ranks and kinds are hashed (`hash`); these follow from
//! the point's place in index space and from the table.
//!
//! `kinds` names the attributes and `variants` their named things, which `named` matches with the kinds of a table's
//! points, and to which `scales` has ranges; `bound` evaluates a list
//! of them for the points of a set.

mod bound;
pub(crate) mod hash;
mod kinds;
mod named;
mod scales;
mod variants;

pub(super) use bound::Indices;
pub use bound::{BoundAttributes, Column};
pub use kinds::{Attribute, Attributes, UniformNumber};
pub use named::Kinds;
pub use scales::{ScaleRange, VariantScales};
pub use variants::Variants;
