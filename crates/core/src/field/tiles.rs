//! Tiles: which pieces of the lattice may have points of a field, and of which blocks.
//!
//! A point lies near its lattice address: its displacement and the warp away. So bounds of the field around a tile
//! leave out all of it, or the blocks that have left, and the longest displacements limit how far outside of the box
//! its addresses can be.

use alloc::{collections::VecDeque, vec::Vec};
use core::ops::Range;

use crate::{
    lattice::{Columns, Grade, Lattice, Line, Patch, Span, places},
    pattern::{Axis, Class},
    shape::Region,
    table::{FRACTION_BITS, fixed},
};

/// The sides of a tile in lattice units. Both divide those of a band and a patch.
pub(super) const TILE: i64 = 64;

/// A column in a strip of tiles: how much of it is visited.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    /// Its coordinate relative to the patch.
    pub(super) x: i32,
    pub(super) block: u32,
    /// See [`Line::strips`](crate::lattice::Line::strips).
    pub(super) strips: u32,
    /// The number of positions of which any point may be left, and of those of which all are.
    pub(super) alive: u32,
    pub(super) whole: u32,
}

/// The tiles of some rows of a patch.
#[derive(Clone, Debug, Default)]
pub(super) struct Strip {
    /// The rows that were looked at, and those among them that may have points.
    known: Range<i64>,
    rows: Range<i64>,
    /// The columns that may have points, by class.
    columns: [Vec<Column>; 4],
}

impl Strip {
    /// Forgets the tiles, before another patch.
    pub(super) fn forget(&mut self) {
        self.known = 0..0;
    }

    /// Whether a row was looked at.
    pub(super) fn holds(&self, y: i64) -> bool {
        self.known.contains(&y)
    }

    /// The rows that may have points.
    pub(super) fn rows(&self) -> Range<i64> {
        self.rows.clone()
    }

    /// The columns of a class that may have points.
    pub(super) fn columns(&self, class: Class) -> &[Column] {
        &self.columns[class.ordinal()]
    }

    /// Adds a tile.
    fn add(&mut self, columns: [&[Line]; 4], rows: &Range<i64>, of: impl Fn(&Line) -> Column) {
        self.rows = if self.rows.is_empty() {
            rows.clone()
        } else {
            self.rows.start.min(rows.start)..self.rows.end.max(rows.end)
        };
        for (all, columns) in self.columns.iter_mut().zip(columns) {
            all.extend(columns.iter().map(&of));
        }
    }
}

/// Some columns and rows of the lattice.
pub(super) type Piece = [Range<i64>; 2];

/// The least and the greatest distance of points from their addresses by axis, in fixed-point units.
fn distances(lattice: &Lattice, piece: &Piece) -> [[i32; 2]; 2] {
    let reach = lattice.turned.reach();
    let Some(shears) = &lattice.shears else {
        return reach;
    };
    let displaced = [0, 1].map(|i| {
        [
            fixed(piece[i].start) + i128::from(reach[i][0]),
            fixed(piece[i].end - 1) + i128::from(reach[i][1]),
        ]
    });
    let drift = shears.drift_from(displaced);
    added(reach, drift)
}

/// The least and the greatest share of the points of a piece, which is not empty.
pub(super) fn shares(lattice: &Lattice, grade: &Grade, piece: &Piece) -> [f64; 2] {
    grade.bounds(&box_at(lattice, piece, distances(lattice, piece)))
}

/// The box around a piece's points that are between two distances from their addresses.
fn box_at(lattice: &Lattice, piece: &Piece, distances: [[i32; 2]; 2]) -> Region {
    // The conversion is monotone.
    let [x, y] = [0, 1].map(|i| {
        [
            lattice.world(fixed(piece[i].start) + i128::from(distances[i][0])),
            lattice.world(fixed(piece[i].end - 1) + i128::from(distances[i][1])),
        ]
    });
    Region::between([x[0], y[0]], [x[1], y[1]])
}

/// The share that a field has at the places of all points of a piece, if it is only one.
pub(crate) fn constant(lattice: &Lattice, grade: &Grade, piece: &Piece) -> Option<f64> {
    if piece.iter().any(Range::is_empty) {
        return Some(0.0);
    }
    let [low, high] = shares(lattice, grade, piece);
    (low.to_bits() == high.to_bits()).then_some(low)
}

/// The end of the first rows of a piece that have no points because the field has none there; its rows
/// begin anywhere and are cut at multiples of `height`.
pub(crate) fn empty_until(
    lattice: &Lattice,
    grade: &Grade,
    [columns, rows]: &Piece,
    height: i64,
) -> i64 {
    let is_empty = |rows: Range<i64>| shares(lattice, grade, &[columns.clone(), rows])[1] <= 0.0;
    let mut start = rows.start;
    let mut step = height;
    while start < rows.end && !columns.is_empty() {
        // Ever higher pieces while they are empty, then lower ones.
        let end = rows.end.min(start.div_euclid(height) * height + step);
        if is_empty(start..end) {
            start = end;
            step = step.saturating_mul(2).min(1 << 40);
        } else if step > height {
            step /= 2;
        } else {
            break;
        }
    }
    start
}

/// The share of the first rows of a piece, and where these end, if it is the same for all of their points;
/// the rows are cut at multiples of `height`.
pub(crate) fn constant_until(
    lattice: &Lattice,
    grade: &Grade,
    [columns, rows]: &Piece,
    height: i64,
) -> Option<(f64, i64)> {
    let of = |rows: Range<i64>| constant(lattice, grade, &[columns.clone(), rows]);
    let next = |from: i64, step: i64| rows.end.min(from.div_euclid(height) * height + step);
    let mut end = next(rows.start, height);
    let share = of(rows.start..end).filter(|share| *share > 0.0)?;
    let mut step = 2 * height;
    // Ever higher pieces while they have the share, then lower ones.
    while end < rows.end && step >= height {
        let further = next(end, step);
        if of(end..further).is_some_and(|other| other.to_bits() == share.to_bits()) {
            end = further;
            step = step.saturating_mul(2).min(1 << 40);
        } else {
            step /= 2;
        }
    }
    Some((share, end))
}

/// About the number of points of a piece that are visited to find those that are left: in smaller and smaller
/// pieces, but no more than `pieces`, the greatest share times the points at full density.
pub(crate) fn candidates(lattice: &Lattice, grade: &Grade, piece: Piece, pieces: usize) -> u128 {
    let side = lattice.table.alpha().set_side_f64();
    let mut open = VecDeque::from([piece]);
    let (mut looked, mut sum) = (0, 0.0);
    while let Some([columns, rows]) = open.pop_front() {
        let [width, height] = [&columns, &rows].map(|range| range.end - range.start);
        if width <= 0 || height <= 0 {
            continue;
        }
        let [low, high] = shares(lattice, grade, &[columns.clone(), rows.clone()]);
        looked += 1;
        let is_small = width <= TILE && height <= TILE;
        if high <= 0.0 {
            continue;
        }
        if is_small || high <= low * 1.1 || looked + open.len() >= pieces {
            sum += width as f64 * height as f64 * side * side * high;
        } else if width > height {
            let middle = columns.start + width / 2;
            open.push_back([columns.start..middle, rows.clone()]);
            open.push_back([middle..columns.end, rows]);
        } else {
            let middle = rows.start + height / 2;
            open.push_back([columns.clone(), rows.start..middle]);
            open.push_back([columns, middle..rows.end]);
        }
    }
    sum as u128
}

/// Lists the tiles of some rows of a patch whose points may be left and lie inside.
pub(super) fn list(
    lattice: &Lattice,
    grade: &Grade,
    patch: &Patch,
    spans: [&Span; 2],
    (columns, range): (&Columns, &Range<i64>),
    rows: &Range<i64>,
    strip: &mut Strip,
) {
    (strip.known, strip.rows) = (rows.clone(), 0..0);
    strip.columns.iter_mut().for_each(Vec::clear);
    let mut start = range.start;
    while start < range.end {
        let end = range.end.min((start & !(TILE - 1)) + TILE);
        let piece = [start..end, rows.clone()];
        start = end;
        let drift = patch.drift(lattice, &piece);
        let distances = added(lattice.turned.reach(), drift);
        let [low, high] = grade.bounds(&box_at(lattice, &piece, distances));
        if high <= 0.0 {
            continue;
        }
        let [across, up] = inside(spans, &piece, distances);
        if across.is_empty() || up.is_empty() {
            continue;
        }
        // One more: a rank may lie just below the start of its position.
        let alive = lattice.order().alive(high.next_up()) as u32;
        let whole = lattice.order().whole(low) as u32;
        let listed = Class::ALL.map(|class| {
            let all = columns.of(class);
            &all[places(all, &across)]
        });
        strip.add(listed, &up, |line| Column {
            x: patch.relative(Axis::X, line.at),
            block: line.block,
            strips: line.strips,
            alive,
            whole,
        });
    }
}

/// The part of a piece whose points may lie inside, between two distances from their addresses.
fn inside(spans: [&Span; 2], piece: &Piece, distances: [[i32; 2]; 2]) -> Piece {
    [0, 1].map(|i| {
        let bounds = &spans[i].bounds;
        let first = |k: i128| (-((-k) >> FRACTION_BITS)) as i64;
        let start = first(bounds.start - i128::from(distances[i][1]));
        let end = first(bounds.end - i128::from(distances[i][0]));
        piece[i].start.max(start)..piece[i].end.min(end)
    })
}

fn added(a: [[i32; 2]; 2], b: [[i32; 2]; 2]) -> [[i32; 2]; 2] {
    [0, 1].map(|i| [a[i][0] + b[i][0], a[i][1] + b[i][1]])
}
