//! The sampler: region × spacing × seed → a plan with the exact count → blocks of points.
//!
//! Positions are integers in fixed point, 2⁻²⁰ grid units, until the last conversion: one
//! multiplication by the step, the world size of a unit. That conversion is monotone, so the
//! bounds of a region become integer bounds once, and integers decide membership: what is reported
//! is inside the region on the very coordinates reported, and any partition of a region gives
//! every point exactly once.

mod amount;
mod area;
mod attribute;
mod before;
mod blocks;
mod clear;
mod count;
mod cursor;
mod distance;
mod id;
pub(crate) mod kernel;
mod margins;
mod nearest;
mod patch;
mod placement;
mod plan;
mod rank;
mod region;
mod scan;
mod seed;
mod seek;
mod sieve;
mod spacing;
mod stop;
mod stretch;
mod tally;
mod template;
mod variants;
mod warp;

use alloc::{sync::Arc, vec::Vec};

use crate::{
    map::Map,
    pattern::{Axis, Pattern},
    table::{FRACTION_BITS, Table},
};
use warp::Shears;

pub use amount::CountError;
pub use area::{Area, AreaError, Circle, Polygon};
pub use attribute::{
    Attribute, AttributeError, Attributes, BoundAttributes, Column, ScaleRange, UniformNumber,
};
pub use blocks::{Blocks, Tile};
pub use clear::{ClearOf, ClearOfError, Layer};
pub use cursor::Cursor;
pub use distance::{DistanceError, LeastDistance};
pub use id::{PointId, PointIdError};
pub use kernel::{Backend, F32, F64, Format, Points};
pub use nearest::{Clearance, FindError, Finder, Neighbor};
pub use placement::{Keep, KeepError, Placement};
pub use plan::{Plan, PlanError, Selection};
pub use rank::{rank, side_for};
pub use region::{Region, RegionError};
pub use seed::Seed;
pub use spacing::{Spacing, SpacingError};
pub use stop::Stop;
pub use variants::{Variants, VariantsError};
pub use warp::{Warp, WarpError};

/// Lattice coordinates of a region stay within ±2⁵². There an `f64` can still tell lattice points
/// apart, and no intermediate value overflows or rounds twice.
pub const LATTICE_LIMIT: i64 = 1 << 52;

/// A point in world coordinates with its id.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Point {
    /// The stable id.
    pub id: PointId,
    /// World coordinate.
    pub x: f64,
    /// World coordinate.
    pub y: f64,
}

/// A table made ready to answer queries. Cheap to share behind an [`Arc`].
#[derive(Debug)]
pub struct Sampler {
    table: Table,
    /// The least and the greatest displacement along x and y.
    reach: [[i32; 2]; 2],
}

impl Sampler {
    /// A sampler of a table.
    #[must_use]
    pub fn new(table: Table) -> Self {
        let mut reach = [[i32::MAX, i32::MIN]; 2];
        for vector in table.displacements() {
            for (ends, &v) in reach.iter_mut().zip(vector) {
                *ends = [ends[0].min(v), ends[1].max(v)];
            }
        }
        Self { table, reach }
    }

    /// The table.
    #[must_use]
    pub const fn table(&self) -> &Table {
        &self.table
    }

    /// How much memory the sampler holds, in bytes, for accounting in a cache.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<Self>()
            + size_of_val(self.table.displacements())
            + 28 * self.table.map().intervals()
            + 4096
    }

    /// What a region holds: the exact count now, the points on demand.
    ///
    /// Without warp this takes some ten microseconds, whatever the region holds; with warp time in proportion to the region's circumference.
    ///
    /// # Errors
    /// [`PlanError`] if the region reaches beyond ±2⁵² lattice units at this spacing.
    pub fn plan(self: &Arc<Self>, placement: Placement, region: Region) -> Result<Plan, PlanError> {
        self.select(Selection::new(placement, region))
    }

    /// What a selection holds: the exact count now, the points on demand.
    ///
    /// A box takes as long as in [`plan`](Self::plan); other areas take time in proportion to their
    /// rows, and what keeps clear of layers in proportion to its points.
    ///
    /// # Errors
    /// [`PlanError`] if the area reaches beyond ±2⁵² lattice units at this spacing, or has no end.
    pub fn select(self: &Arc<Self>, selection: Selection) -> Result<Plan, PlanError> {
        Plan::new(self.clone(), selection, None)
    }

    /// The rest of a selection from a cursor on, found without counting anything.
    ///
    /// # Errors
    /// As [`select`](Self::select). A cursor of another selection gives its points from that
    /// lattice address on, and the cursor's counts.
    pub fn resume(
        self: &Arc<Self>,
        selection: Selection,
        cursor: Cursor,
    ) -> Result<Plan, PlanError> {
        Ok(Plan::new(self.clone(), selection, Some(cursor.total))?.from_cursor(cursor))
    }

    /// The largest absolute coordinate that a region may have: ±2⁵² lattice units.
    #[must_use]
    pub fn limit(&self, placement: Placement) -> f64 {
        Frame::new(self, placement).limit()
    }

    /// The point of an id, or `None` if the pattern has no point at that lattice address.
    #[must_use]
    pub fn point(&self, placement: Placement, id: PointId) -> Option<Point> {
        let frame = Frame::new(self, placement);
        let [block_x, block_y] = self.block_within(&frame, id)?;
        let [dx, dy] = self.row(block_y)[block_x];
        let displaced = [fixed(id.x) + i128::from(dx), fixed(id.y) + i128::from(dy)];
        let [x, y] = frame.warped(displaced).map(|k| frame.world(k));
        Some(Point { id, x, y })
    }

    /// The block of the neighborhood map that a point belongs to: the intervals of its two indices,
    /// each below [`Map::intervals`]. Points of one block have the same displacement and, as far as
    /// the map reaches, the same neighbors in the pattern. Nothing if there is no such point.
    #[must_use]
    pub fn block(&self, placement: Placement, id: PointId) -> Option<[usize; 2]> {
        self.block_within(&Frame::new(self, placement), id)
    }

    fn block_within(&self, frame: &Frame, id: PointId) -> Option<[usize; 2]> {
        let within = -LATTICE_LIMIT..=LATTICE_LIMIT;
        if !within.contains(&id.x) || !within.contains(&id.y) {
            return None;
        }
        if !frame.pattern.contains(id.x, id.y) {
            return None;
        }
        let (index_x, index_y) = frame.pattern.index(id.x, id.y);
        let map = self.map();
        Some([map.interval_of(index_x)?, map.interval_of(index_y)?])
    }

    fn map(&self) -> &Map {
        self.table.map()
    }

    /// The displacements of all blocks with one interval of dY.
    fn row(&self, block_y: usize) -> &[[i32; 2]] {
        let n = self.map().intervals();
        &self.table.displacements()[block_y * n..][..n]
    }

    /// How far a point of this frame may lie from its lattice address along an axis.
    fn reach(&self, frame: &Frame, axis: Axis) -> [i32; 2] {
        let [least, most] = self.reach[axis as usize];
        let warp = frame.shears.map_or(0, |shears| shears.reach());
        [least - warp, most + warp]
    }
}

/// A lattice coordinate in fixed point.
const fn fixed(v: i64) -> i128 {
    (v as i128) << FRACTION_BITS
}

/// Where the lattice lies in the world: the pattern from the seed's origin, the warp, the step.
#[derive(Clone, Copy, Debug)]
struct Frame {
    pattern: Pattern,
    placement: Placement,
    shears: Option<Shears>,
    /// World units per fixed-point unit.
    step: f64,
}

/// Kept apart, or both conversions would become the slow one.
#[cold]
#[inline(never)]
fn wide(fixed: i128) -> f64 {
    fixed as f64
}

impl Frame {
    fn new(sampler: &Sampler, placement: Placement) -> Self {
        let alpha = sampler.table.alpha();
        let Placement {
            spacing,
            seed,
            warp,
            keep,
        } = placement;
        // The mean spacing in the grid is 1/t: at scale = spacing · t it becomes the one asked for.
        let scale = spacing.get() * alpha.set_side_f64();
        Self {
            pattern: Pattern::with_origin(alpha, seed.origin())
                .thinned(side_for(keep.get(), alpha.set_side())),
            placement,
            shears: Shears::new(warp, seed, alpha.set_side_f64()),
            step: scale / f64::from(1u32 << FRACTION_BITS),
        }
    }

    /// Where a displaced point ends up.
    fn warped(&self, displaced: [i128; 2]) -> [i128; 2] {
        self.shears
            .map_or(displaced, |shears| shears.apply(displaced))
    }

    /// The world coordinate of a fixed-point one. Monotone.
    #[inline]
    fn world(&self, fixed: i128) -> f64 {
        // Conversions from 64 bits are faster, and round alike.
        let fixed = match i64::try_from(fixed) {
            Ok(fixed) => fixed as f64,
            Err(_) => wide(fixed),
        };
        fixed * self.step
    }

    /// The largest absolute world coordinate of a region.
    fn limit(&self) -> f64 {
        self.world(fixed(LATTICE_LIMIT))
    }

    /// The least fixed-point coordinate whose world coordinate is ≥ `bound`, for a bound within
    /// the limit. Exact: a bisection on the conversion itself.
    fn first_at_or_above(&self, bound: f64) -> i128 {
        let reaches = |k: i128| self.world(k) >= bound;
        let guess = (bound / self.step) as i128;
        let mut width = 2i128;
        let (mut low, mut high) = (guess - 1, guess + 1);
        while reaches(low) {
            low -= width;
            width *= 2;
        }
        while !reaches(high) {
            high += width;
            width *= 2;
        }
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if reaches(middle) {
                high = middle
            } else {
                low = middle
            }
        }
        high
    }
}

/// The columns of a stretch of the lattice, by class: coordinate and block.
type Listed = Vec<(i64, u32)>;
