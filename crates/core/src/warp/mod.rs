//! The seeded warp: area-preserving shears that end the pattern's quasi-periodicity.
//!
//! A displaced pattern repeats itself almost exactly, so the spectrum of a large window consists of Bragg peaks. The
//! warp moves points along four directions d by smooth random functions of the coordinate across, p ← p + d·g(d⊥·p),
//! one direction after another, and so decorrelates distant parts. g is a quadratic spline over a random walk of
//! bounded steps, which bounds its slope; for `pink`, over two such walks. Each shear preserves area exactly, so the
//! low-frequency power does not rise, and inverts exactly, so random access remains.
//!
//! Everything is integer arithmetic on fixed-point positions except g, whose quadratic is evaluated in
//! `f32` with plain multiplications and additions: the same bits on every machine and in every lane.
//!
//! `walk` and `shears` are the definition. Two faster forms have the same bits, both in `patch`: for
//! points around a place, and for the points of a patch, on which the kernel builds. `bounds`
//! limits how far points move and distances stretch. `wrapped` is the warp of periodic sets.

mod bounds;
mod patch;
mod shears;
mod walk;
mod wrapped;

pub(crate) use bounds::Stretch;
pub(crate) use patch::{NearShears, PatchShears};
pub(super) use shears::CELL_BITS;
pub use shears::Warp;
pub(crate) use shears::{KNOT_BITS, Shears, Waves};
pub(super) use wrapped::WrappedShears;
