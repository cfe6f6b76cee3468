//! The innermost loops: a row is a template of its columns plus the place of the row.
//!
//! `format` defines, in plain code, how a position becomes an item of each output format (`points`,
//! `offsets`). That code is the definition; every faster path has the same bits. Positions are
//! 32-bit fixed-point offsets from the origin of a patch. Their sum with the origin is exact in `f64`
//! while lattice coordinates stay below 2⁵³, so it rounds once, as the conversion of the whole integer
//! would.
//!
//! `listing` writes plain rows and lists the points of many short ones, `warped` writes warped ones, whose coefficients
//! `quadratics` looks up; `triples` writes points in space, and `groups` warps them and leaves out those outside. Their
//! vector loops are written once over the trait of `lanes`, and each instruction set is a thin file of `arch`. `backend`
//! finds out which sets the machine has, and runs a loop by one of them. `tests` compares every backend with plain code.

#![expect(
    unsafe_code,
    reason = "vector loops: intrinsics, and loads and stores whose bounds are checked before"
)]
#![cfg_attr(
    not(any(
        target_arch = "x86_64",
        all(target_arch = "aarch64", target_feature = "neon"),
        all(target_arch = "wasm32", target_feature = "simd128"),
    )),
    allow(
        dead_code,
        unused_imports,
        reason = "without vectors the plain code does all"
    )
)]

mod arch;
mod backend;
mod format;
mod formats;
mod groups;
mod lanes;
mod listing;
mod offsets;
mod points;
mod quadratics;
#[cfg(test)]
mod tests;
mod triples;
mod warped;

pub use backend::Backend;
pub(super) use backend::write_numbers;
pub(crate) use backend::{compiled, compiled_loop};
pub(super) use format::{Geometry, Row};
pub use formats::Format;
pub(crate) use groups::{Extents, GROUP, PLANES, SpaceShears, retain_parts, warp_groups};
pub(crate) use lanes::PlainLoop;
pub(crate) use listing::{Listing, WHOLE};
pub(crate) use offsets::Exactly;
pub use offsets::{Exact, Offsets, Place};
pub(crate) use points::below;
pub use points::{F32, F64, Points};
pub(crate) use triples::{PICKS, add_picked, lift_picked, pick_pairs, pick_triples, write_triples};
pub(super) use warped::{Extent, WarpedColumns, add_first_shear};
pub(crate) use warped::{warp_all, warp_lists};
