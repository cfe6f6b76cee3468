//! Plans: what a region holds, before any point is made.

use alloc::sync::Arc;
use core::ops::Range;

use super::{
    Blocks, F32, F64, Format, Frame, LATTICE_LIMIT, Placement, Points, Region, Sampler, Tile,
    count, fixed, region::Corner,
};
use crate::{pattern::Axis, table::FRACTION_BITS};

/// A region beyond the lattice.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A bound is farther from the origin than points can be told apart in `f64`.
    #[error(
        "{corner} is {value:e}; with this spacing it must be within ±{limit:e}, where f64 \
         coordinates still tell neighbors apart"
    )]
    TooFar {
        /// Which coordinate.
        corner: Corner,
        /// Its value.
        value: f64,
        /// The largest absolute value allowed.
        limit: f64,
    },
}

/// One axis of a region in lattice terms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Span {
    /// Fixed-point coordinates inside the region.
    pub(super) bounds: Range<i128>,
    /// Lattice coordinates whose points may lie inside.
    pub(super) all: Range<i64>,
    /// Lattice coordinates whose points lie inside whatever their displacement; at the end of
    /// `all` if there are none.
    pub(super) inner: Range<i64>,
}

impl Span {
    fn new(frame: &Frame, [least, most]: [i32; 2], min: f64, max: f64) -> Self {
        let bounds = frame.first_at_or_above(min)..frame.first_at_or_above(max);
        // The first lattice coordinate at or above a fixed-point one.
        let lattice = |k: i128| -((-k) >> FRACTION_BITS) as i64;
        let all = if bounds.is_empty() {
            let start = lattice(bounds.start);
            start..start
        } else {
            lattice(bounds.start - i128::from(most))..lattice(bounds.end - i128::from(least))
        };
        let inner =
            lattice(bounds.start - i128::from(least))..lattice(bounds.end - i128::from(most));
        let inner = if inner.is_empty() || all.is_empty() {
            all.end..all.end
        } else {
            inner
        };
        Self { bounds, all, inner }
    }

    /// The two stretches of `all` outside `inner`.
    pub(super) fn margins(&self) -> [Range<i64>; 2] {
        [
            self.all.start..self.inner.start,
            self.inner.end..self.all.end,
        ]
    }

    /// Whether the point of a lattice coordinate with this displacement lies inside.
    pub(super) fn holds(&self, v: i64, displacement: i32) -> bool {
        self.bounds.contains(&(fixed(v) + i128::from(displacement)))
    }
}

/// A query made ready: the exact count is known, the points come on demand, in a fixed order.
///
/// The order: bands of 1024 lattice columns at multiples of 1024, ascending; in a band rows
/// ascending; in a row columns ascending. It is the same whatever the region, so the points of a
/// part of a region come in the order they have in the whole.
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) sampler: Arc<Sampler>,
    pub(super) frame: Frame,
    pub(super) x: Span,
    pub(super) y: Span,
    region: Region,
    count: u128,
}

impl Plan {
    pub(super) fn new(
        sampler: Arc<Sampler>,
        frame: Frame,
        region: Region,
    ) -> Result<Self, PlanError> {
        let limit = frame.limit();
        let ([min_x, min_y], [max_x, max_y]) = (region.min(), region.max());
        for (corner, value) in [
            (Corner::MinX, min_x),
            (Corner::MinY, min_y),
            (Corner::MaxX, max_x),
            (Corner::MaxY, max_y),
        ] {
            if value.abs() > limit {
                return Err(PlanError::TooFar {
                    corner,
                    value,
                    limit,
                });
            }
        }
        let x = Span::new(&frame, sampler.reach(&frame, Axis::X), min_x, max_x);
        let y = Span::new(&frame, sampler.reach(&frame, Axis::Y), min_y, max_y);
        debug_assert!(x.all.end < 2 * LATTICE_LIMIT && y.all.end < 2 * LATTICE_LIMIT);
        let count = count::count(&sampler, &frame, &x, &y);
        Ok(Self {
            sampler,
            frame,
            x,
            y,
            region,
            count,
        })
    }

    /// How many points the region holds.
    #[must_use]
    pub const fn count(&self) -> u128 {
        self.count
    }

    /// The region.
    #[must_use]
    pub const fn region(&self) -> Region {
        self.region
    }

    /// Spacing, seed and warp.
    #[must_use]
    pub const fn placement(&self) -> Placement {
        self.frame.placement
    }

    /// The sampler that answers.
    #[must_use]
    pub const fn sampler(&self) -> &Arc<Sampler> {
        &self.sampler
    }

    /// The region's lower corner, to which [`F32`] coordinates are relative.
    #[must_use]
    pub const fn origin(&self) -> [f64; 2] {
        self.region.min()
    }

    /// All points in one of the formats [`F32`], [`F64`] or [`Points`], block by block.
    #[must_use]
    pub fn blocks<F: Format>(&self) -> Blocks<F> {
        Blocks::new(self, None)
    }

    /// [`blocks`](Self::blocks) of interleaved `f32` pairs relative to [`origin`](Self::origin).
    #[must_use]
    pub fn blocks_f32(&self) -> Blocks<F32> {
        self.blocks()
    }

    /// [`blocks`](Self::blocks) of interleaved `f64` pairs.
    #[must_use]
    pub fn blocks_f64(&self) -> Blocks<F64> {
        self.blocks()
    }

    /// [`blocks`](Self::blocks) of points with ids.
    #[must_use]
    pub fn blocks_points(&self) -> Blocks<Points> {
        self.blocks()
    }

    /// The plan cut into tiles that hold at most `max_points` points each (or one lattice row of a
    /// band, if that is more). Tiles one after another give the plan's points in the plan's order,
    /// and can be filled independently.
    pub fn tiles(&self, max_points: usize) -> impl Iterator<Item = Tile> + use<> {
        Tile::of(self, max_points)
    }

    /// The points of one tile of this plan.
    #[must_use]
    pub fn tile_blocks<F: Format>(&self, tile: &Tile) -> Blocks<F> {
        Blocks::new(self, Some(tile))
    }
}
