//! The ways to optimize a table: parameters of an optimizer, and the phases it runs in.
//!
//! Each file holds one family of optimizers. It turns its parameters into [`Phase`]s: objectives of
//! [`optimize`](crate::optimize) on a [`Domain`](crate::domain::Domain), each with a descent.

mod gaussian;
mod lloyd;
mod phase;
mod radial;
mod spacing;

pub use gaussian::GaussianRecipe;
pub use lloyd::LloydRecipe;
pub(crate) use phase::Phase;
pub use radial::RadialRecipe;
pub use spacing::{Push, SpacingRecipe};
