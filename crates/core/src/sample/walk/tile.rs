//! Tiles: parts of a plan that can be filled independently.

use core::ops::Range;

use crate::{
    pattern::{Axis, Class},
    sample::{
        lattice::{BAND_WIDTH, PointId, clip_to_band},
        scope::Scope,
    },
};

/// Some rows of one band of a plan; see [`Plan::tiles`](crate::Plan::tiles).
///
/// ```
/// use strew_core::{F64, PointSet, Region, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).within(Region::new([0.0, 0.0], [90.0, 90.0])?)?;
/// let mut points = [[0.0; 2]; 1000];
/// let fill = |tile| plan.tile_blocks::<F64>(&tile).fill(&mut points);
/// assert_eq!(plan.tiles(1000).map(fill).sum::<usize>() as u128, plan.count());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    pub(super) band: i64,
    pub(super) rows: Range<i64>,
}

impl Tile {
    /// Some rows of a band.
    pub(super) const fn rows(band: i64, rows: Range<i64>) -> Self {
        Self { band, rows }
    }

    /// A row of a band.
    pub(crate) const fn row(band: i64, row: i64) -> Self {
        let rows = row..row + 1;
        Self { band, rows }
    }

    /// The first address.
    pub(super) const fn start(&self) -> PointId {
        PointId {
            x: self.band * BAND_WIDTH,
            y: self.rows.start,
        }
    }
}

/// The tiles of a scope, in order, of at most `max_points` points each, or one row if that has more.
pub(crate) fn tiles(scope: &Scope, max_points: usize) -> impl Iterator<Item = Tile> + use<> {
    let (rows, columns) = (scope.y.all.clone(), scope.x.all.clone());
    let pattern = scope.lattice.pattern;
    scope.bands().flat_map(move |band| {
        let columns = clip_to_band(band, &columns);
        let longest = Class::ALL
            .map(|class| pattern.axis_set(Axis::X, class).count(columns.clone()))
            .into_iter()
            .fold(1, u64::max);
        let height = (max_points as u64 / longest).clamp(1, 1 << 40) as i64;
        let end = rows.end;
        let mut start = rows.start;
        core::iter::from_fn(move || {
            let rows = start..end.min(start + height);
            start = rows.end;
            (!rows.is_empty()).then_some(Tile { band, rows })
        })
    })
}
