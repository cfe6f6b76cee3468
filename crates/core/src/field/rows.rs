//! The points of rows of a patch in a field, many at a time.

use alloc::vec::Vec;
use core::ops::Range;

use super::tiles::{self, Strip, TILE};
use crate::{
    kernel::{Backend, PlainLoop, compiled_loop, warp_all},
    lattice::{Columns, Found, Grade, Lattice, Patch, PointId, Scale, Span},
    pattern::Axis,
    table::{Displacement, FRACTION_BITS},
};

/// Lists end at a multiple of this, a pair of the widest vectors.
const PAIR: usize = 32;

/// Marks a position whose point is left whatever its share. There are fewer blocks than this.
const WHOLE: u32 = 1 << 31;

/// The number of candidates that are kept at once if all are left.
const FEW: usize = 16;

/// The points of some rows of a patch, and the memory to find them.
///
/// They are found in stages, each for all candidates before the next: addresses that tiles leave, their
/// places, the shares there, and those that are left. Lists are longer than the number of candidates.
#[derive(Clone, Debug, Default)]
pub(crate) struct FieldRows {
    strip: Strip,
    /// The number of candidates, then of the points among them that are left.
    number: usize,
    /// Positions relative to the patch, which the warp moves.
    places: [Vec<i32>; 2],
    /// Columns in the lower 16 bits and rows in the upper ones, relative to the patch.
    addresses: Vec<u32>,
    /// The positions of their blocks in the order of blocks, with [`WHOLE`].
    positions: Vec<u32>,
    at: Vec<[f64; 2]>,
    shares: Vec<f64>,
    /// The points that were found.
    found: Vec<Found>,
    /// Their shares, until some are left out.
    found_shares: Vec<f64>,
    next: usize,
}

/// The place of the rows that are listed: a patch, the spans of the box, and the columns of the band in a range.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) grade: &'a Grade,
    pub(crate) patch: &'a Patch,
    pub(crate) spans: [&'a Span; 2],
    pub(crate) columns: (&'a Columns, &'a Range<i64>),
}

impl FieldRows {
    /// Forgets the points and the tiles, before another patch.
    pub(crate) fn clear(&mut self) {
        self.strip.forget();
        self.found.clear();
        self.next = 0;
    }

    /// The points that were found and not yet taken.
    pub(crate) fn left(&self) -> &[Found] {
        &self.found[self.next..]
    }

    /// The points that were found last, with their shares.
    pub(crate) fn with_shares(&self) -> (&[Found], &[f64]) {
        (&self.found, &self.found_shares)
    }

    /// Takes the next points.
    pub(crate) const fn take(&mut self, number: usize) {
        self.next += number;
    }

    /// Keeps the points that pass.
    pub(crate) fn retain(&mut self, mut passes: impl FnMut(Found) -> bool) {
        self.found.retain(|found| passes(*found));
    }

    /// Finds the points of a patch that lie inside, from row `rows.start` on, until there are at least
    /// `enough` candidates or the rows end. Returns the first row that is not listed.
    pub(crate) fn list(
        &mut self,
        source: Source<'_>,
        rows: Range<i64>,
        enough: usize,
        backend: Backend,
    ) -> i64 {
        self.found.clear();
        self.found_shares.clear();
        self.next = 0;
        self.number = 0;
        let mut next = rows.start;
        while next < rows.end && self.number < enough {
            let strip = next..rows.end.min((next & !(TILE - 1)) + TILE);
            if !self.strip.holds(next) {
                let Source {
                    lattice,
                    grade,
                    patch,
                    spans,
                    columns,
                } = source;
                tiles::list(
                    lattice,
                    grade,
                    patch,
                    spans,
                    columns,
                    &strip,
                    &mut self.strip,
                );
            }
            next = self.candidates(source, strip, enough);
        }
        if self.number > 0 {
            self.find(source, backend);
        }
        next
    }

    /// Makes room for more candidates.
    fn reserve(&mut self, more: usize) {
        let length = (self.number + more).next_multiple_of(PAIR);
        if self.addresses.len() < length {
            self.addresses.resize(length, 0);
            self.positions.resize(length, 0);
            self.at.resize(length, [0.0; 2]);
            self.shares.resize(length, 0.0);
            for list in &mut self.places {
                list.resize(length, 0);
            }
        }
    }

    /// Lists the points that the tiles of a strip leave. Returns the first row that is not listed.
    fn candidates(&mut self, source: Source<'_>, strip: Range<i64>, enough: usize) -> i64 {
        let Source { lattice, patch, .. } = source;
        let rows = self.strip.rows();
        if rows.is_empty() {
            return strip.end;
        }
        let [_, bottom] = patch.origin();
        let n = lattice.map().intervals();
        for y in strip.start.max(rows.start)..strip.end.min(rows.end) {
            if self.number >= enough {
                return y;
            }
            let Some((class, block_y)) = lattice.row(y) else {
                continue;
            };
            self.reserve(self.strip.columns(class).len());
            let columns = self.strip.columns(class);
            let start = self.number;
            let most = start + columns.len();
            let [xs, ys] = &mut self.places;
            let mut listed = ListedRow {
                first: ((y - bottom) as u32) << 16,
                row: patch.relative(Axis::Y, y),
                columns,
                positions: lattice.order().positions(block_y * n..(block_y + 1) * n),
                vectors: lattice.vectors(block_y),
                displaced: [&mut xs[start..most], &mut ys[start..most]],
                addresses: &mut self.addresses[start..most],
                all: &mut self.positions[start..most],
            };
            self.number += match lattice.kinds_in_row(block_y) {
                None => listed.list(|_| true),
                Some(kinds) => listed.list(|c| kinds.keeps(c.block as usize, c.strips)),
            };
        }
        strip.end
    }

    /// Finds the points among the candidates.
    fn find(&mut self, source: Source<'_>, backend: Backend) {
        let Source {
            lattice,
            grade,
            patch,
            ..
        } = source;
        self.place(patch, backend);
        let number = self.number;
        match grade.known() {
            Some(share) => self.shares[..number].fill(share),
            None => self.look((lattice, grade, patch), backend),
        }
        self.keep(lattice, patch);
        let (number, [xs, ys]) = (self.number, &self.places);
        let places = xs.iter().zip(ys).map(|(&x, &y)| [x, y]);
        let all = places.zip(&self.addresses).zip(&self.shares).take(number);
        for ((place, &address), &share) in all {
            if patch.holds(place) {
                self.found.push(Found { place, address });
                self.found_shares.push(share);
            }
        }
    }

    /// Moves displaced positions by the warp.
    fn place(&mut self, patch: &Patch, backend: Backend) {
        let whole = self.number.next_multiple_of(PAIR);
        for list in &mut self.places {
            // What comes after the last one must be near it.
            let last = list[self.number.saturating_sub(1)];
            list[self.number..whole].fill(last);
        }
        if let Some(shears) = patch.shears() {
            let places = self.places.each_mut().map(|list| &mut list[..whole]);
            warp_all(backend, shears, places);
        }
    }

    /// Looks the shares up where the candidates lie.
    fn look(&mut self, (lattice, grade, patch): (&Lattice, &Grade, &Patch), backend: Backend) {
        let (number, scale) = (self.number, Scale::new(lattice, patch));
        let [xs, ys] = &self.places;
        compiled_loop(
            backend,
            &mut Convert {
                scale,
                places: [&xs[..number], &ys[..number]],
                at: &mut self.at[..number],
            },
        );
        grade.shares(&self.at[..number], &mut self.shares[..number]);
    }

    /// Leaves the candidates whose rank is below the share.
    fn keep(&mut self, lattice: &Lattice, patch: &Patch) {
        let order = lattice.order();
        let [left, bottom] = patch.origin();
        let number = self.number;
        let addresses = &mut self.addresses[..number];
        let (positions, shares) = (&self.positions[..number], &mut self.shares[..number]);
        let [xs, ys] = &mut self.places;
        let (xs, ys) = (&mut xs[..number], &mut ys[..number]);
        // Decides a candidate that the tile leaves open.
        let is_left = |address: u32, position: u32, share: f64| {
            // Ranks of a position are at least the number before its start, and less than its end.
            let ranks = order.floors(position as usize);
            let id = || PointId {
                x: left + i64::from(address & 0xffff),
                y: bottom + i64::from(address >> 16),
            };
            share >= ranks.end || share >= ranks.start && lattice.rank(id()) < share
        };
        let (mut next, mut start) = (0, 0);
        while start < number {
            let end = number.min(start + FEW);
            let is_whole = positions[start..end].iter().fold(WHOLE, |all, p| all & p) != 0;
            if is_whole && end - start == FEW {
                addresses.copy_within(start..end, next);
                shares.copy_within(start..end, next);
                for list in [&mut *xs, &mut *ys] {
                    list.copy_within(start..end, next);
                }
                (next, start) = (next + FEW, end);
                continue;
            }
            for i in start..end {
                let (address, position, share) = (addresses[i], positions[i], shares[i]);
                let is_left = position & WHOLE != 0 || is_left(address, position, share);
                // Written in any case; the next one goes to the same place if this has left.
                (addresses[next], shares[next]) = (address, share);
                (xs[next], ys[next]) = (xs[i], ys[i]);
                next += usize::from(is_left);
            }
            start = end;
        }
        self.number = next;
    }
}

/// A row whose candidates are listed. All lists that are written have a place for each column.
struct ListedRow<'a> {
    /// The address of its column 0, and its coordinate.
    first: u32,
    row: i32,
    columns: &'a [tiles::Column],
    /// The positions of the blocks of the row.
    positions: &'a [u32],
    vectors: &'a [Displacement],
    displaced: [&'a mut [i32]; 2],
    addresses: &'a mut [u32],
    all: &'a mut [u32],
}

impl ListedRow<'_> {
    /// Lists the columns of which a point may be left. Returns their number.
    #[inline(always)]
    fn list(&mut self, keeps: impl Fn(&tiles::Column) -> bool) -> usize {
        let length = self.columns.len();
        let [xs, ys] = &mut self.displaced;
        let (xs, ys) = (&mut xs[..length], &mut ys[..length]);
        let (addresses, all) = (&mut self.addresses[..length], &mut self.all[..length]);
        let positions = self.positions;
        let vectors = &self.vectors[..positions.len()];
        let mut number = 0;
        for (i, column) in self.columns.iter().enumerate() {
            // Written in any case; the next one goes to the same place if this has left.
            all[number] = i as u32;
            let position = positions[column.block as usize];
            number += usize::from((position < column.alive) & keeps(column));
        }
        let lists = all.iter_mut().zip(addresses).zip(xs.iter_mut().zip(ys));
        for ((entry, address), (x, y)) in lists.take(number) {
            let column = &self.columns[*entry as usize];
            let block = column.block as usize;
            let (position, [dx, dy]) = (positions[block], vectors[block]);
            *x = column.x + dx;
            *y = self.row + dy;
            *address = self.first | (column.x >> FRACTION_BITS) as u32;
            let whole = if position < column.whole { WHOLE } else { 0 };
            *entry = position | whole;
        }
        number
    }
}

/// Converts places of a patch into those of the world.
struct Convert<'a> {
    scale: Scale,
    places: [&'a [i32]; 2],
    at: &'a mut [[f64; 2]],
}

impl PlainLoop for Convert<'_> {
    #[inline(always)]
    fn run(&mut self) {
        let [xs, ys] = self.places;
        for (at, (&x, &y)) in self.at.iter_mut().zip(xs.iter().zip(ys)) {
            *at = self.scale.world([x, y]);
        }
    }
}
