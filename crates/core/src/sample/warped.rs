//! Walking a warped plan: tiles of one band's width, in which positions fit 32 bits.
//!
//! A row's displaced columns do not depend on the row but through its class and block, as without
//! warp; the warp then moves each point by itself. Points of inner rows and inner columns lie
//! inside wherever the warp moves them, so only the margins are looked at.

use core::ops::Range;

use super::{
    Frame, Listed, Sampler,
    blocks::{BAND_WIDTH, list_columns},
    fixed,
    plan::Span,
    warp::{Shears, TileShears},
};
use crate::pattern::{Axis, Class};

/// How many rows a tile has, at multiples of it: with the width of a band, the displacements and
/// the warp's reach, coordinates and their sums stay within 2³¹ units.
pub(super) const TILE_HEIGHT: i64 = 512;

/// The warp near one tile, and the region's bounds relative to the tile's origin.
#[derive(Clone, Debug)]
pub(super) struct WarpedTile {
    pub(super) origin: [i64; 2],
    shears: TileShears,
    bounds: [Range<i32>; 2],
}

impl WarpedTile {
    /// The tile that holds a row of a band.
    pub(super) fn new(shears: &Shears, band: i64, row: i64, x: &Span, y: &Span) -> Self {
        let origin = origin(band, row);
        let relative = |span: &Span, origin: i64| {
            // A bound beyond 32 bits is beyond every point of the tile.
            let clamp =
                |k: i128| (k - fixed(origin)).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
            clamp(span.bounds.start)..clamp(span.bounds.end)
        };
        Self {
            origin,
            shears: TileShears::new(shears, origin),
            bounds: [relative(x, origin[0]), relative(y, origin[1])],
        }
    }

    pub(super) fn covers(&self, band: i64, row: i64) -> bool {
        self.origin == origin(band, row)
    }

    /// Whether all of the tile's columns are inner ones.
    pub(super) fn is_inside(&self, x: &Span) -> bool {
        x.inner.start <= self.origin[0] && self.origin[0] + BAND_WIDTH <= x.inner.end
    }

    /// Where a displaced point, relative to the origin, ends up.
    #[inline(always)]
    pub(super) fn apply(&self, [x, y]: [i32; 2]) -> [i32; 2] {
        self.shears.apply(x, y)
    }

    #[inline(always)]
    pub(super) fn holds(&self, [x, y]: [i32; 2]) -> bool {
        self.bounds[0].contains(&x) && self.bounds[1].contains(&y)
    }

    /// A lattice row or column, relative to the origin.
    pub(super) fn relative(&self, axis: Axis, v: i64) -> i32 {
        // Within a tile: below 2¹¹ lattice units.
        ((v - self.origin[axis as usize]) << crate::table::FRACTION_BITS) as i32
    }
}

fn origin(band: i64, row: i64) -> [i64; 2] {
    [band * BAND_WIDTH, row.div_euclid(TILE_HEIGHT) * TILE_HEIGHT]
}

/// The exact number of points of a warped region: inner rows × inner columns in closed form, the
/// margins point by point, so that the cost grows with the circumference.
pub(super) fn count(sampler: &Sampler, frame: &Frame, shears: &Shears, x: &Span, y: &Span) -> u128 {
    let inner = |class: Class| {
        let columns = frame
            .pattern
            .axis_set(Axis::X, class)
            .count(x.inner.clone());
        let rows = frame
            .pattern
            .axis_set(Axis::Y, class)
            .count(y.inner.clone());
        u128::from(columns) * u128::from(rows)
    };
    let mut margins = Margins {
        sampler,
        frame,
        shears,
        x,
        y,
        columns: Default::default(),
    };
    let [left, right] = x.margins();
    let [bottom, top] = y.margins();
    let looked_at = margins.count(&left, &y.inner)
        + margins.count(&right, &y.inner)
        + margins.count(&x.all, &bottom)
        + margins.count(&x.all, &top);
    Class::ALL.into_iter().map(inner).sum::<u128>() + looked_at
}

struct Margins<'a> {
    sampler: &'a Sampler,
    frame: &'a Frame,
    shears: &'a Shears,
    x: &'a Span,
    y: &'a Span,
    columns: [Listed; 4],
}

impl Margins<'_> {
    /// How many points of a stretch of the lattice lie inside.
    fn count(&mut self, columns: &Range<i64>, rows: &Range<i64>) -> u128 {
        let mut count = 0;
        let mut start = columns.start;
        while start < columns.end {
            let band = start.div_euclid(BAND_WIDTH);
            let end = columns.end.min((band + 1) * BAND_WIDTH);
            list_columns(self.sampler, self.frame, start..end, &mut self.columns);
            count += self.count_in_band(band, rows);
            start = end;
        }
        count
    }

    fn count_in_band(&self, band: i64, rows: &Range<i64>) -> u128 {
        let (sampler, pattern) = (self.sampler, self.frame.pattern);
        let mut tile: Option<WarpedTile> = None;
        let mut count = 0;
        for y in rows.clone() {
            let Some((x_parity, index)) = pattern.visit(Axis::Y, y) else {
                continue;
            };
            let tile = match &mut tile {
                Some(tile) if tile.covers(band, y) => tile,
                slot => slot.insert(WarpedTile::new(self.shears, band, y, self.x, self.y)),
            };
            let class = Class {
                x: x_parity,
                y: (y & 1) as u8,
            };
            let vectors = sampler.row(sampler.map().locate(index));
            let row = tile.relative(Axis::Y, y);
            let inside = self.columns[class.ordinal()].iter().filter(|&&(x, block)| {
                let [dx, dy] = vectors[block as usize];
                tile.holds(tile.apply([tile.relative(Axis::X, x) + dx, row + dy]))
            });
            count += inside.count() as u128;
        }
        count
    }
}
