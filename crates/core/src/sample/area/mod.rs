//! Areas: the parts of the plane in which points are requested.
//!
//! An area is a [`Region`], a [`Circle`], a [`Polygon`] or a combination of them ([`Area`], in `shape`).
//! Membership is decided on the reported `f64` coordinates by exact predicates (`edge` has the one of
//! polygons), and half-open wherever two areas can meet: boxes and polygons that share an edge share no
//! point and lose none.
//!
//! For speed an area also answers for whole strips of the plane at once: between which x all points are
//! inside, all are outside, or each must be tested (`steps`). `outline` estimates what counting costs. `holes`
//! are those of polygons from files.

mod circle;
mod edge;
mod holes;
mod outline;
mod polygon;
mod region;
mod shape;
mod steps;

pub use circle::Circle;
pub use polygon::Polygon;
pub use region::Region;
pub(super) use region::{CORNERS, Chunk};
pub use shape::Area;
pub(super) use steps::{Near, State, Stepper};
