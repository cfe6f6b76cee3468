//! Shapes: the parts of the plane and of space in which points are requested.
//!
//! A shape is a [`Region`], a [`Ball`] (in the plane a [`Circle`]), a [`Polygon`] or in space a [`Prism`] over one, or a
//! combination of them: [`Area`] and [`Volume`], in `shape`. Membership is decided on the reported `f64` coordinates by
//! exact predicates, and half-open wherever two shapes can meet: boxes and polygons that
//! share an edge share no point and lose none.
//!
//! For speed an area also answers for whole strips of the plane at once: between which x all points are
//! inside, all are outside, or each must be tested (`steps`). `outline` estimates what counting costs. `holes`
//! are those of polygons from files.

mod ball;
mod holes;
mod outline;
mod polygon;
mod prism;
mod region;
#[expect(
    clippy::module_inception,
    reason = "the shape that combines the others"
)]
mod shape;
mod steps;

pub use ball::{Ball, Circle};
pub use polygon::Polygon;
pub use prism::{Prism, Volume};
pub(crate) use region::Chunk;
pub use region::Region;
pub(crate) use shape::Outlined;
pub use shape::{Area, Shape};
pub(crate) use steps::{Near, State, Stepper};
