//! Volumes: the parts of space in which points are requested.
//!
//! A volume is a [`Region`], a [`Ball`], a [`Prism`] or a combination of them ([`Volume`]). Membership is decided on
//! the reported `f64` coordinates, half-open wherever two volumes can meet.

mod ball;
mod prism;
mod region;
mod shape;

pub use ball::Ball;
pub use prism::Prism;
pub use region::Region;
pub(super) use region::{CORNERS, Chunk};
pub use shape::Volume;
