//! The points of a set in a field that lie in a box.
//!
//! A point lies near its lattice address: its full displacement and the warp away when the field is
//! looked at, and up to a displacement of the ladder and the warp when it is placed. So the lattice around
//! the box is visited in tiles, and bounds of the field over a tile leave out all of it, or the blocks
//! that have left.

use alloc::vec::Vec;
use core::ops::Range;

use super::{Field, Graded};
use crate::{
    error::Error,
    pattern::{Axis, Class},
    sample::{
        area::{Area, Region},
        lattice::{BAND_WIDTH, Columns, Patch, Point, PointId, Span, clip_to_band, places},
        member::Member,
        scope::Scope,
        sieve::Scale,
        stop::Stop,
    },
    table::{FRACTION_BITS, Order},
};

/// The sides of a tile in lattice units. Both divide those of a band and a patch.
const TILE: i64 = 64;

/// Some columns of a strip of rows.
struct Tile {
    /// The places of its columns in the list of each class.
    columns: [Range<usize>; 4],
    /// The number of positions of which any point may be left.
    alive: usize,
}

impl<F: Field> Graded<F> {
    /// The points in a box, in the order of their lattice addresses: bands of 1024 columns, in a band rows,
    /// in a row columns.
    ///
    /// # Errors
    /// [`ErrorKind::TooFar`](crate::ErrorKind::TooFar) if the box reaches beyond the
    /// [limit](crate::PointSet::limit).
    ///
    /// ```
    /// use strew_core::{PointSet, Region, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).seed(7).in_field(|[x, _]: [f64; 2]| x / 40.0);
    /// // The halves of a box have its points, each once.
    /// let of = |from, to| Ok(set.within(Region::new([from, 0.0], [to, 40.0])?)?.len());
    /// assert_eq!(of(0.0, 17.0)? + of(17.0, 40.0)?, of(0.0, 40.0)?);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn within(&self, region: Region) -> Result<Vec<Member>, Error> {
        let mut found = Vec::new();
        let seed = self.lattice.placement.seed;
        self.for_each(region, |point, _| found.push(Member::new(point, seed)))?;
        Ok(found)
    }

    /// The number of points in a box. They are visited, so it takes time in proportion to the points at
    /// full density, where the field's bounds leave any.
    ///
    /// # Errors
    /// As [`within`](Self::within).
    ///
    /// ```
    /// use strew_core::{PointSet, Region, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).in_field(|_: [f64; 2]| 0.25);
    /// let region = Region::new([0.0, 0.0], [40.0, 40.0])?;
    /// assert_eq!(set.count(region)?, set.within(region)?.len() as u64);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn count(&self, region: Region) -> Result<u64, Error> {
        let mut count = 0;
        self.for_each(region, |_, _| count += 1)?;
        Ok(count)
    }

    /// Calls `visit` with each point in a box and the share at its place at full density, in order.
    ///
    /// # Errors
    /// As [`within`](Self::within).
    ///
    /// ```
    /// use strew_core::{PointSet, Region, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table).in_field(|[x, _]: [f64; 2]| x / 40.0);
    /// set.for_each(Region::new([0.0, 0.0], [40.0, 9.0])?, |point, share| {
    ///     // Where points are sparse, they can be drawn larger.
    ///     println!("{} {}: {}", point.x, point.y, 1.0 / share.sqrt());
    /// })?;
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn for_each(&self, region: Region, visit: impl FnMut(Point, f64)) -> Result<(), Error> {
        walk(self, region, visit)
    }
}

/// Calls `visit` with the points in a box and their shares.
pub(super) fn walk<F: Field>(
    graded: &Graded<F>,
    region: Region,
    mut visit: impl FnMut(Point, f64),
) -> Result<(), Error> {
    let lattice = &graded.lattice;
    // Checks the box, and knows its edges in fixed point.
    let scope = Scope::new(lattice, &graded.mask, Area::from(region), Stop::default())?;
    let (order, ladder) = (lattice.order(), lattice.table.ladder());
    if scope.x.bounds.is_empty() || scope.y.bounds.is_empty() {
        return Ok(());
    }
    let seen = reach_of_full(graded);
    let reach = reach_of_moved(graded, 0.0);
    let [x, y] = [&scope.x, &scope.y].map(|span| Span {
        all: around(&span.bounds, reach),
        ..span.clone()
    });
    let (columns, rows) = (x.all.clone(), y.all.clone());
    let moved = displacement_at_most(graded, 0.0);
    let is_masked = graded.mask.area.is_some() || !graded.mask.clear.is_empty();
    let mut listed = Columns::default();
    let mut tiles: Vec<Tile> = Vec::new();
    for band in columns.start.div_euclid(BAND_WIDTH)..=(columns.end - 1).div_euclid(BAND_WIDTH) {
        let columns = clip_to_band(band, &columns);
        if columns.is_empty() {
            continue;
        }
        listed.list(lattice, columns.clone());
        let mut start = rows.start;
        while start < rows.end {
            let strip = start..rows.end.min((start & !(TILE - 1)) + TILE);
            start = strip.end;
            tiles.clear();
            for_tiles(&columns, |tile| {
                if let Some(alive) = alive(graded, &region, &tile, &strip, seen) {
                    let columns = Class::ALL.map(|class| places(listed.of(class), &tile));
                    tiles.push(Tile { columns, alive });
                }
            });
            if tiles.is_empty() {
                continue;
            }
            let reach = [[-moved, moved]; 2];
            let patch = Patch::with_reach(lattice, [band, strip.start], [&x, &y], reach);
            let scale = Scale::new(lattice, &patch);
            for y in strip {
                let Some((class, block_y)) = lattice.row(y) else {
                    continue;
                };
                let n = lattice.map().intervals();
                let blocks = block_y * n..(block_y + 1) * n;
                let (vectors, positions) = (lattice.vectors(block_y), order.positions(blocks));
                let row = patch.relative(Axis::Y, y);
                for tile in &tiles {
                    for column in &listed.of(class)[tile.columns[class.ordinal()].clone()] {
                        let block = column.block as usize;
                        let position = positions[block] as usize;
                        if position >= tile.alive {
                            continue;
                        }
                        let x = patch.relative(Axis::X, column.at);
                        let [dx, dy] = vectors[block];
                        let mut place = patch.place([x + dx, row + dy]);
                        let mut at = scale.world(place);
                        let share = graded.share(at);
                        let id = PointId { x: column.at, y };
                        if !is_left(order, position, share, || lattice.rank(id)) {
                            continue;
                        }
                        if let Some(ladder) = ladder {
                            let [dx, dy] =
                                graded.displacement(ladder, position, [dx, dy], at, share);
                            place = patch.place([x + dx, row + dy]);
                            at = scale.world(place);
                        }
                        let point = Point {
                            id,
                            x: at[0],
                            y: at[1],
                        };
                        if patch.holds(place) && (!is_masked || graded.has(point)) {
                            visit(point, share);
                        }
                    }
                }
            }
        }
    }
    Ok(())
}

/// Whether a point of a position is left at a share. Its rank is computed only if the position's ranks do
/// not decide.
#[inline(always)]
fn is_left(order: &Order, position: usize, share: f64, rank: impl FnOnce() -> f64) -> bool {
    let ranks = order.floors(position);
    // Ranks of a position are at least the number before its start, and less than its end.
    share >= ranks.end || (share >= ranks.start && rank() < share)
}

/// How far the warp moves points along an axis at most, in fixed-point units.
fn reach_of_warp<F: Field>(graded: &Graded<F>) -> i32 {
    graded.lattice.shears.map_or(0, |shears| shears.reach())
}

/// How far points at full density lie from their addresses at most, in fixed-point units.
fn reach_of_full<F: Field>(graded: &Graded<F>) -> i32 {
    displacement_at_most(graded, 1.0) + reach_of_warp(graded)
}

/// How far points at shares from `share` on lie from their addresses at most, in fixed-point units.
fn reach_of_moved<F: Field>(graded: &Graded<F>, share: f64) -> i32 {
    displacement_at_most(graded, share) + reach_of_warp(graded)
}

/// The largest displacement along an axis at shares from `share` on, without the warp.
fn displacement_at_most<F: Field>(graded: &Graded<F>, share: f64) -> i32 {
    let lattice = &graded.lattice;
    let full = [Axis::X, Axis::Y].map(|axis| lattice.table_reach(axis));
    let full = full.iter().flatten().map(|v| v.abs()).fold(0, i32::max);
    let ladder = lattice.table.ladder();
    full.max(ladder.map_or(0, |ladder| ladder.reach(share)))
}

/// The lattice coordinates whose points, up to `reach` from their addresses, may lie between some bounds.
fn around(bounds: &Range<i128>, reach: i32) -> Range<i64> {
    let [first, last] = [
        bounds.start - i128::from(reach),
        bounds.end + i128::from(reach),
    ];
    (first >> FRACTION_BITS) as i64..(last >> FRACTION_BITS) as i64 + 1
}

/// Calls `visit` with pieces of a range that end at multiples of [`TILE`].
fn for_tiles(range: &Range<i64>, mut visit: impl FnMut(Range<i64>)) {
    let mut start = range.start;
    while start < range.end {
        let end = range.end.min((start & !(TILE - 1)) + TILE);
        visit(start..end);
        start = end;
    }
}

/// The number of positions of which points of a tile may be left and lie in the box; `None` if none are.
fn alive<F: Field>(
    graded: &Graded<F>,
    region: &Region,
    columns: &Range<i64>,
    rows: &Range<i64>,
    seen: i32,
) -> Option<usize> {
    let within = |reach: i32| {
        let reach = f64::from(reach) / f64::from(1u32 << FRACTION_BITS) + 1.0;
        let unit = graded.lattice.step * f64::from(1u32 << FRACTION_BITS);
        let ends = [columns, rows].map(|range| {
            let (start, end) = (range.start as f64 - reach, range.end as f64 + reach);
            [start * unit, end * unit]
        });
        Region::between([ends[0][0], ends[1][0]], [ends[0][1], ends[1][1]])
    };
    let [low, high] = graded.field.bounds(&within(seen));
    let [low, high] = [low, high].map(|share| graded.limited(share));
    if high <= 0.0 {
        return None;
    }
    let placed = within(reach_of_moved(graded, low));
    if placed.and(*region).is_empty() {
        return None;
    }
    // One more: a rank may lie just below the start of its position.
    let alive = graded.lattice.order().alive(high.next_up());
    Some(alive)
}
