//! Sampling: from a table to the points of a region.
//!
//! The floors, each built on those before it:
//!
//! 1. `seed` and `warp`: which piece of the pattern, and how the plane is sheared;
//! 2. `lattice`: which addresses have points, and where in the world these are, within `bounds`;
//! 3. `near`: the points near a place (the parts of the plane in which points are requested are in `shape`);
//! 4. `settle`: where points end that settle; `sieve` and `scope`: what the points of a request satisfy;
//! 5. `count`: how many there are, without making them;
//! 6. `kernel` and `walk`: making them, row by row, in blocks;
//! 7. `attribute` and `member`: the values that points have, one by one; `seek`: places in their order;
//! 8. `plan`: a request made ready; `amount`: one with an exact number of points;
//! 9. `field`: sets whose density varies;
//! 10. `set`: the [`PointSet`](crate::PointSet), whose methods are all of this;
//! 11. `periodic`: one exact period of a set that tiles the plane.

mod amount;
mod attribute;
mod bounds;
mod count;
mod field;
mod kernel;
mod lattice;
mod member;
mod near;
mod periodic;
mod plan;
mod scope;
mod seed;
mod seek;
mod set;
mod settle;
mod sieve;
mod walk;
mod warp;

pub(crate) use amount::{Sought, exactly};
pub(crate) use attribute::hash;
pub(crate) use bounds::{Corner, bounds, check_limit, common, common_box};
pub(crate) use kernel::Exactly;
pub(crate) use lattice::{Grade, Multiple, lattice_of};
pub(crate) use near::limits;
pub(crate) use seed::split_mix;
pub(crate) use settle::{LEAST_IN_SPACE, List, Listed, Moves, Placed, Settler, Settling};
pub(crate) use warp::Waves;

/// The parts of the plane that points in space share.
pub(crate) mod space {
    pub(crate) use super::{
        kernel::{
            Extents, GROUP, PICKS, PLANES, PlainLoop, SpaceShears, add_picked, below, compiled,
            compiled_loop, lift_picked, pick_pairs, pick_triples, retain_parts, warp_all,
            warp_groups, warp_lists, write_triples,
        },
        warp::{PatchShears, Shears, Stretch},
    };
}

pub use crate::stop::Stop;
pub use attribute::{
    Attribute, Attributes, BoundAttributes, Column, Kinds, ScaleRange, UniformNumber,
    VariantScales, Variants,
};
pub use field::{Edges, Field, FieldSpec, Filter, Marks, Noise, Pixels, Raster, Terrain};
pub use kernel::{Backend, Exact, F32, F64, Format, Offsets, Place, Points};
pub use lattice::{Keep, LATTICE_LIMIT, Placement, Point, PointId, Settle, Spacing, VaryingKinds};
pub use member::{Member, Members};
pub use near::{Clearance, Visits};
pub use periodic::{PeriodicBlocks, PeriodicPlan, PeriodicSet};
pub use plan::Plan;
pub use seed::Seed;
pub use set::{Kind, Neighbor, PointSet};
pub use walk::{Blocks, Tile};
pub use warp::Warp;
