//! Plans: what a region holds, before any point is made.

use alloc::sync::Arc;
use core::ops::Range;

use super::{
    Area, Blocks, ClearOf, Cursor, F32, F64, Format, Frame, LATTICE_LIMIT, Placement, PointId,
    Points, Region, Sampler, Stop, Tile, count, fixed,
    region::Corner,
    sieve::{self, Sieve},
};
use crate::{pattern::Axis, table::FRACTION_BITS};

/// Which points are asked for.
#[derive(Clone, Debug)]
pub struct Selection {
    /// Spacing, seed and warp.
    pub placement: Placement,
    /// Where.
    pub area: Area,
    /// What they keep clear of.
    pub clear: Arc<[ClearOf]>,
    /// Ends the counting early.
    pub stop: Stop,
}

impl Selection {
    /// All points of an area.
    #[must_use]
    pub fn new(placement: Placement, area: impl Into<Area>) -> Self {
        Self {
            placement,
            area: area.into(),
            clear: Arc::new([]),
            stop: Stop::default(),
        }
    }
}

/// Why a selection cannot be planned.
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
    /// [`Selection::stop`] was raised before the points were counted.
    #[error("the counting was stopped")]
    Stopped,
    /// The area has no end.
    #[error("the area has no end; it must lie within a box")]
    Unbounded,
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

    /// The part of it within a range of lattice coordinates.
    fn within(&self, range: &Range<i64>) -> Self {
        let clip = |part: &Range<i64>| {
            let start = part.start.clamp(range.start, range.end);
            start..part.end.clamp(start, range.end)
        };
        let (all, inner) = (clip(&self.all), clip(&self.inner));
        Self {
            bounds: self.bounds.clone(),
            inner: if inner.is_empty() {
                all.end..all.end
            } else {
                inner
            },
            all,
        }
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
/// ascending; in a row columns ascending. It is the same whatever the area, so the points of a
/// part of an area come in the order they have in the whole.
///
/// A plan may be a [window](Self::window) of its selection's points: those from a place in that
/// order on, up to a number.
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) sampler: Arc<Sampler>,
    pub(super) frame: Frame,
    pub(super) x: Span,
    pub(super) y: Span,
    pub(super) sieve: Option<Arc<Sieve>>,
    stop: Stop,
    region: Region,
    /// How many points the selection has in all.
    pub(super) total: u128,
    /// Where the window begins: the lattice address of its first point, unless that is the
    /// selection's first.
    pub(super) start: Option<PointId>,
    /// How many points come before the window.
    offset: u128,
    count: u128,
}

impl Plan {
    /// A plan; the number of points is counted unless it is known.
    pub(super) fn new(
        sampler: Arc<Sampler>,
        selection: Selection,
        known: Option<u128>,
    ) -> Result<Self, PlanError> {
        let Selection {
            placement,
            area,
            clear,
            stop,
        } = selection;
        let frame = Frame::new(&sampler, placement);
        let region = area.bounds().ok_or(PlanError::Unbounded)?;
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
        let is_box = matches!(area, Area::Region(_));
        let part = if is_box && !clear.is_empty() {
            Some(Area::Region(region))
        } else {
            (!is_box).then_some(area)
        };
        let sieve = Sieve::new(&sampler, &frame, part, clear);
        let mut plan = Self {
            sampler,
            frame,
            x,
            y,
            sieve: sieve.map(Arc::new),
            stop,
            region,
            total: 0,
            start: None,
            offset: 0,
            count: 0,
        };
        plan.total = known.unwrap_or_else(|| plan.count_within(&plan.x.all, &plan.y.all));
        plan.count = plan.total;
        if plan.stop.is_raised() {
            return Err(PlanError::Stopped);
        }
        Ok(plan)
    }

    /// How many points of the selection have lattice addresses in these columns and rows.
    pub(super) fn count_within(&self, columns: &Range<i64>, rows: &Range<i64>) -> u128 {
        let (x, y) = (self.x.within(columns), self.y.within(rows));
        match &self.sieve {
            Some(sieve) => sieve::count(&self.sampler, &self.frame, sieve, [&x, &y], &self.stop),
            None => count::count(&self.sampler, &self.frame, &x, &y, &self.stop),
        }
    }

    /// How many points the plan has.
    #[must_use]
    pub const fn count(&self) -> u128 {
        self.count
    }

    /// How many points the whole selection has, of which the plan may be a window.
    #[must_use]
    pub const fn total(&self) -> u128 {
        self.total
    }

    /// How many points of the selection come before the plan's.
    #[must_use]
    pub const fn offset(&self) -> u128 {
        self.offset
    }

    /// The same plan, whose further counting stops with a flag.
    #[must_use]
    pub fn stopped_by(self, stop: Stop) -> Self {
        Self { stop, ..self }
    }

    /// The points from number `offset` of this plan on, `limit` at most. Without warp, of a box,
    /// that is found in O(log), elsewhere in time proportional to the rows.
    #[must_use]
    pub fn window(&self, offset: u128, limit: Option<u128>) -> Self {
        let offset = offset.min(self.count);
        let count = (self.count - offset).min(limit.unwrap_or(u128::MAX));
        let mut window = self.clone();
        if offset > 0 && count > 0 {
            window.start = self.locate(self.offset + offset);
        }
        window.offset += offset;
        window.count = count;
        window
    }

    /// The points from a cursor of the same selection on.
    #[must_use]
    pub fn from_cursor(&self, cursor: Cursor) -> Self {
        let offset = cursor.offset.min(self.total);
        Self {
            start: (offset > 0).then_some(cursor.at),
            offset,
            count: self.total - offset,
            ..self.clone()
        }
    }

    /// The place of the plan's first point, or `None` if it has none.
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        if self.count == 0 {
            return None;
        }
        let at = self.start.or_else(|| self.locate(self.offset))?;
        Some(Cursor {
            offset: self.offset,
            total: self.total,
            at,
        })
    }

    /// Where the selection goes on after the plan's last point, or `None` at its end.
    #[must_use]
    pub fn next_cursor(&self) -> Option<Cursor> {
        let offset = self.offset + self.count;
        let at = self.locate(offset)?;
        Some(Cursor {
            offset,
            total: self.total,
            at,
        })
    }

    /// The plan in `parts` windows, one after another, whose sizes differ by one at most.
    pub fn split(&self, parts: u32) -> impl Iterator<Item = Self> {
        let parts = u128::from(parts.max(1));
        let start = move |i: u128| {
            let (quotient, rest) = (self.count / parts, self.count % parts);
            i * quotient + i.min(rest)
        };
        (0..parts).map(move |i| self.window(start(i), Some(start(i + 1) - start(i))))
    }

    /// Whether the plan leaves out points of its selection.
    #[must_use]
    pub const fn is_window(&self) -> bool {
        self.count < self.total
    }

    /// A box around all points: the region, for a box.
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

    /// The selection, all of it, cut into tiles that hold at most `max_points` points each (or one lattice row of a
    /// band, if that is more). Tiles one after another give its points in order,
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
