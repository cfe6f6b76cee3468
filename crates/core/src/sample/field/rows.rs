//! The points of rows of a patch in a field, many at a time.

use alloc::vec::Vec;
use core::ops::Range;

use super::tiles::{self, TILE, Tile};
use crate::{
    pattern::Axis,
    sample::{
        kernel::{Backend, warp_all},
        lattice::{
            Columns, Found, Grade, Lattice, Patch, PointId, Span, around, damping, part_of_way,
            spread, steepness,
        },
        sieve::Scale,
    },
    table::{FRACTION_BITS, Rung, Stage},
};

/// Lists end at a multiple of this, a pair of the widest vectors.
const WHOLE: usize = 32;

/// Marks a position whose point must look at the field around its place. There are fewer blocks than this.
const STEEP: u32 = 1 << 31;

/// The points of some rows of a patch, and the memory to find them.
///
/// They are found in stages, each for all candidates before the next: addresses that tiles leave, their
/// places at full density, the shares there, those that are left, how far they have moved, and their
/// places.
#[derive(Clone, Debug, Default)]
pub(crate) struct FieldRows {
    /// The tiles of the strip that ends at `strip_end`.
    tiles: Vec<Tile>,
    strip: Option<[i64; 2]>,
    /// Positions relative to the patch, and where the warp moves them.
    displaced: [Vec<i32>; 2],
    places: [Vec<i32>; 2],
    /// Columns in the lower 16 bits and rows in the upper ones, relative to the patch.
    addresses: Vec<u32>,
    /// By position in the order of blocks, with [`STEEP`].
    positions: Vec<u32>,
    at: Vec<[f64; 2]>,
    shares: Vec<f64>,
    stages: Vec<(Stage, Option<[Rung; 2]>)>,
    /// The points where the field is steep, the places that tell how steep, and the shares at these.
    steep: Vec<u32>,
    around: Vec<[[f64; 2]; 4]>,
    shares_around: Vec<f64>,
    /// What was found.
    found: Vec<Found>,
    next: usize,
}

/// What rows are listed of: a patch, the spans of the box, and the columns of the band in a range.
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
        self.strip = None;
        self.found.clear();
        self.next = 0;
    }

    /// The points that were found and not yet taken.
    pub(crate) fn left(&self) -> &[Found] {
        &self.found[self.next..]
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
        self.next = 0;
        self.addresses.clear();
        self.positions.clear();
        self.displaced.iter_mut().for_each(Vec::clear);
        let mut next = rows.start;
        while next < rows.end && self.addresses.len() < enough {
            let strip = next..rows.end.min((next & !(TILE - 1)) + TILE);
            let known = self
                .strip
                .is_some_and(|[start, end]| start <= next && next < end);
            if !known {
                let Source {
                    lattice,
                    grade,
                    spans,
                    columns,
                    ..
                } = source;
                tiles::list(lattice, grade, spans, columns, &strip, &mut self.tiles);
                self.strip = Some([strip.start, strip.end]);
            }
            next = self.candidates(source, strip, enough);
        }
        if !self.addresses.is_empty() {
            self.find(source, backend);
        }
        next
    }

    /// Lists what the tiles of a strip leave. Returns the first row that is not listed.
    fn candidates(&mut self, source: Source<'_>, strip: Range<i64>, enough: usize) -> i64 {
        let Source {
            lattice,
            patch,
            columns: (columns, _),
            ..
        } = source;
        if self.tiles.is_empty() {
            return strip.end;
        }
        let [left, bottom] = patch.origin();
        let n = lattice.map().intervals();
        for y in strip.clone() {
            if self.addresses.len() >= enough {
                return y;
            }
            let Some((class, block_y)) = lattice.row(y) else {
                continue;
            };
            let listed = columns.of(class);
            let vectors = lattice.vectors(block_y);
            let positions = lattice.order().positions(block_y * n..(block_y + 1) * n);
            let kinds = lattice.kinds_in_row(block_y);
            let row = patch.relative(Axis::Y, y);
            let first = ((y - bottom) as u32) << 16;
            let ordinal = class.ordinal();
            let tiles = self.tiles.iter().filter(|tile| tile.rows.contains(&y));
            let mut number = self.addresses.len();
            let most = number + listed.len();
            self.addresses.resize(most, 0);
            self.positions.resize(most, 0);
            self.displaced
                .iter_mut()
                .for_each(|list| list.resize(most, 0));
            let [xs, ys] = &mut self.displaced;
            let (xs, ys) = (&mut xs[..most], &mut ys[..most]);
            let addresses = &mut self.addresses[..most];
            let all = &mut self.positions[..most];
            for tile in tiles {
                let flag = if tile.is_gentle { 0 } else { STEEP };
                for line in &listed[tile.columns[ordinal].clone()] {
                    let block = line.block as usize;
                    let (position, [dx, dy]) = (positions[block], vectors[block]);
                    // Written in any case; the next one goes to the same place if this has left.
                    xs[number] = patch.relative(Axis::X, line.at) + dx;
                    ys[number] = row + dy;
                    addresses[number] = first | (line.at - left) as u32;
                    all[number] = position | flag;
                    let is_kept = kinds.is_none_or(|kinds| kinds.keeps(block, line.strips));
                    number += usize::from((position < tile.alive) & is_kept);
                }
            }
            self.addresses.truncate(number);
            self.positions.truncate(number);
            self.displaced
                .iter_mut()
                .for_each(|list| list.truncate(number));
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
        let scale = Scale::new(lattice, patch);
        self.place(patch, backend);
        let number = self.addresses.len();
        let [xs, ys] = &self.places;
        self.at.clear();
        self.at.extend(
            xs.iter()
                .zip(ys)
                .take(number)
                .map(|(&x, &y)| scale.world([x, y])),
        );
        self.shares.clear();
        self.shares.resize(number, 0.0);
        grade.shares(&self.at, &mut self.shares);
        self.keep(lattice, patch);
        if lattice.table.ladder().is_some() {
            self.displace(lattice, grade);
            self.place(patch, backend);
        }
        let [xs, ys] = &self.places;
        let places = xs.iter().zip(ys).map(|(&x, &y)| [x, y]);
        let all = places.zip(&self.addresses);
        let all = all.filter(|(place, _)| patch.holds(*place));
        self.found
            .extend(all.map(|(place, &address)| Found { place, address }));
    }

    /// Moves displaced positions by the warp.
    fn place(&mut self, patch: &Patch, backend: Backend) {
        let whole = self.addresses.len().next_multiple_of(WHOLE);
        for (list, places) in self.displaced.iter_mut().zip(&mut self.places) {
            let last = list.last().copied().unwrap_or(0);
            list.resize(whole, last);
            places.resize(whole, 0);
        }
        let [x, y] = &self.displaced;
        match patch.shears() {
            Some(shears) => warp_all(backend, shears, [x, y], &mut self.places),
            None => {
                for (list, places) in self.displaced.iter().zip(&mut self.places) {
                    places.copy_from_slice(list);
                }
            }
        }
    }

    /// Leaves the candidates whose rank is below the share.
    fn keep(&mut self, lattice: &Lattice, patch: &Patch) {
        let order = lattice.order();
        let [left, bottom] = patch.origin();
        let number = self.addresses.len();
        let addresses = &mut self.addresses[..number];
        let positions = &mut self.positions[..number];
        let shares = &mut self.shares[..number];
        let at = &mut self.at[..number];
        let [xs, ys] = &mut self.displaced;
        let (xs, ys) = (&mut xs[..number], &mut ys[..number]);
        let [place_xs, place_ys] = &mut self.places;
        let (place_xs, place_ys) = (&mut place_xs[..number], &mut place_ys[..number]);
        let mut next = 0;
        for i in 0..number {
            let (address, position, share) = (addresses[i], positions[i], shares[i]);
            // Ranks of a position are at least the number before its start, and less than its end.
            let ranks = order.floors((position & !STEEP) as usize);
            let mut is_left = share >= ranks.end;
            // Rare, where one test after another would be guessed wrong half of the time.
            if !is_left & (share >= ranks.start) {
                let id = PointId {
                    x: left + i64::from(address & 0xffff),
                    y: bottom + i64::from(address >> 16),
                };
                is_left = lattice.rank(id) < share;
            }
            // Written in any case; the next one goes to the same place if this has left.
            addresses[next] = address;
            positions[next] = position;
            shares[next] = share;
            at[next] = at[i];
            (xs[next], ys[next]) = (xs[i], ys[i]);
            (place_xs[next], place_ys[next]) = (place_xs[i], place_ys[i]);
            next += usize::from(is_left);
        }
        self.addresses.truncate(next);
        self.positions.truncate(next);
        self.shares.truncate(next);
        self.at.truncate(next);
        for list in self.displaced.iter_mut().chain(&mut self.places) {
            list.truncate(next);
        }
    }

    /// Moves the points that are left as the ladder says.
    fn displace(&mut self, lattice: &Lattice, grade: &Grade) {
        let Some(ladder) = lattice.table.ladder() else {
            return;
        };
        let number = self.addresses.len();
        let points = self.shares.iter().zip(&self.positions);
        self.stages.clear();
        self.stages.extend(points.map(|(&share, &position)| {
            let stage = ladder.stage(share);
            (stage, ladder.rungs(stage, (position & !STEEP) as usize))
        }));
        self.look_around(lattice, grade);
        let [xs, ys] = &mut self.displaced;
        let (xs, ys) = (&mut xs[..number], &mut ys[..number]);
        let (stages, positions) = (&self.stages[..number], &self.positions[..number]);
        let addresses = &self.addresses[..number];
        // What is left of a displaced position without its address.
        let full = |i: usize, x: i32, y: i32| {
            let address = addresses[i];
            [
                x - (((address & 0xffff) as i32) << FRACTION_BITS),
                y - (((address >> 16) as i32) << FRACTION_BITS),
            ]
        };
        for i in 0..number {
            let position = positions[i];
            if position & STEEP == 0 {
                let full = full(i, xs[i], ys[i]);
                let to = (lattice.turned).moved_from(ladder, stages[i], position as usize, full);
                xs[i] += to[0] - full[0];
                ys[i] += to[1] - full[1];
            }
        }
        let steep = self.steep.iter().zip(self.shares_around.as_chunks().0);
        for (&i, around) in steep {
            let i = i as usize;
            let (share, position) = (self.shares[i], positions[i] & !STEEP);
            let full = full(i, xs[i], ys[i]);
            let steepness = steepness(share, *around);
            let (stage, rungs) = stages[i];
            let from = (spread(stage, share, steepness), rungs);
            let to = (lattice.turned).moved_from(ladder, from, position as usize, full);
            let vector = part_of_way(full, to, damping(steepness));
            xs[i] += vector[0] - full[0];
            ys[i] += vector[1] - full[1];
        }
    }

    /// Looks at the field around the places where it may be steep.
    fn look_around(&mut self, lattice: &Lattice, grade: &Grade) {
        let spacing = lattice.placement.spacing.get();
        self.steep.clear();
        self.around.clear();
        let points = self.positions.iter().zip(&self.stages).enumerate();
        for (i, (position, (stage, _))) in points {
            if position & STEEP != 0 && *stage != Stage::FULL {
                self.steep.push(i as u32);
                (self.around).push(around(self.at[i], self.shares[i], spacing));
            }
        }
        self.shares_around.clear();
        self.shares_around.resize(4 * self.steep.len(), 0.0);
        grade.shares(self.around.as_flattened(), &mut self.shares_around);
    }
}
