//! Flat lists of the points of a patch: row after row without gaps, so that vectors are full however short
//! the rows are.

use alloc::vec::Vec;
use core::ops::Range;

use super::{Columns, Lattice, Listed, Patch};
use crate::{
    pattern::Axis,
    sample::kernel::{Backend, compiled, warp_all},
};

/// The points of some rows of a patch, by row and column.
#[derive(Clone, Debug, Default)]
pub(crate) struct Flat {
    /// Their displaced positions, relative to the patch's origin.
    displaced: [Vec<i32>; 2],
    /// Their places: where the warp, if there is one, moves these.
    places: [Vec<i32>; 2],
    /// Their addresses: see [`address`].
    addresses: Vec<u32>,
}

/// A point that was found: its place and its address, both relative to the patch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) place: [i32; 2],
    pub(crate) address: u32,
}

impl Found {
    /// A point at a place and a column and a row of up to 16 bits, all relative to an origin.
    pub(crate) const fn new(place: [i32; 2], [column, row]: [i64; 2]) -> Self {
        Self {
            place,
            address: address(column, row),
        }
    }

    /// The column and the row, relative to the patch.
    #[inline(always)]
    pub(crate) const fn address(self) -> [i64; 2] {
        [(self.address & 0xffff) as i64, (self.address >> 16) as i64]
    }
}

/// The address of a column and row, relative to the patch's origin: 16 bits each, the row in the upper ones.
const fn address(column: i64, row: i64) -> u32 {
    (row as u32) << 16 | column as u32
}

/// Lists end at a multiple of this, a pair of the widest vectors.
const WHOLE: usize = 32;

/// Room for most lists.
const LISTED: usize = 2048;

impl Flat {
    /// Lists the points of a patch in some columns, from row `rows.start` on, until there are at least
    /// `enough` or the rows end. Returns the first row that is not listed.
    pub(crate) fn list(
        &mut self,
        lattice: &Lattice,
        patch: &Patch,
        (columns, part): (&mut Columns, &Listed),
        rows: Range<i64>,
        enough: usize,
        backend: Backend,
    ) -> i64 {
        let Self {
            displaced: [xs, ys],
            addresses,
            ..
        } = self;
        xs.clear();
        ys.clear();
        addresses.clear();
        let room = enough.min(LISTED);
        xs.reserve(room);
        ys.reserve(room);
        addresses.reserve(room);
        let [left, bottom] = patch.origin();
        let mut next = rows.end;
        for y in rows {
            if addresses.len() >= enough {
                next = y;
                break;
            }
            let Some((class, block)) = lattice.row(y) else {
                continue;
            };
            let columns = columns.of_part(lattice, class, block, part);
            let vectors = lattice.vectors(block);
            let row = patch.relative(Axis::Y, y);
            let start = xs.len();
            let length = start + columns.len();
            xs.resize(length, 0);
            ys.resize(length, 0);
            let listed = xs[start..].iter_mut().zip(&mut ys[start..]);
            for ((x, dy), column) in listed.zip(columns) {
                let vector = vectors[column.block as usize];
                *x = patch.relative(Axis::X, column.at) + vector[0];
                *dy = row + vector[1];
            }
            let first = address(0, y - bottom);
            addresses.extend(
                columns
                    .iter()
                    .map(|column| first | (column.at - left) as u32),
            );
        }
        let length = xs.len();
        let whole = length.next_multiple_of(WHOLE);
        for (list, places) in self.displaced.iter_mut().zip(&mut self.places) {
            let last = list.last().copied().unwrap_or(0);
            list.resize(whole, last);
            places.resize(whole, 0);
        }
        if let Some(shears) = patch.shears() {
            let [x, y] = &self.displaced;
            warp_all(backend, shears, [x, y], &mut self.places);
        } else {
            for (places, displaced) in self.places.iter_mut().zip(&self.displaced) {
                places.copy_from_slice(displaced);
            }
        }
        next
    }

    /// The number of points listed.
    pub(crate) fn len(&self) -> usize {
        self.addresses.len()
    }

    /// The places, by coordinate, and the addresses.
    fn points(&self) -> impl Iterator<Item = ([i32; 2], u32)> {
        let [x, y] = &self.places;
        let places = x.iter().zip(y).map(|(&x, &y)| [x, y]);
        places.zip(self.addresses.iter().copied())
    }

    /// The number of points inside the region.
    pub(crate) fn count(&self, patch: &Patch, backend: Backend) -> usize {
        compiled(backend, || {
            let inside = |(place, _)| u32::from(patch.holds(place));
            self.points().map(inside).sum::<u32>() as usize
        })
    }

    /// Replaces `inside` by the points inside the region.
    pub(crate) fn sift(&self, patch: &Patch, backend: Backend, inside: &mut Inside) {
        let length = self.len();
        inside
            .places
            .iter_mut()
            .for_each(|places| places.resize(length, 0));
        inside.addresses.resize(length, 0);
        let [xs, ys] = &mut inside.places;
        let (xs, ys, addresses) = (&mut xs[..], &mut ys[..], &mut inside.addresses[..]);
        inside.length = compiled(backend, || {
            let mut next = 0;
            for ([x, y], address) in self.points() {
                // Written in any case; the next one goes to the same place if this is outside.
                (xs[next], ys[next], addresses[next]) = (x, y, address);
                next += usize::from(patch.holds([x, y]));
            }
            next
        });
    }

    /// The row of a point, and its number in the row, both relative to the patch; `number` counts the points
    /// inside.
    pub(crate) fn locate(&self, patch: &Patch, number: usize) -> Option<(i64, usize)> {
        let (at, (_, address)) = self
            .points()
            .enumerate()
            .filter(|(_, (place, _))| patch.holds(*place))
            .nth(number)?;
        let row = address >> 16;
        let before = self.addresses[..at].iter().rev();
        let in_row = before.take_while(|&&other| other >> 16 == row).count();
        Some((patch.origin()[1] + i64::from(row), in_row))
    }
}

/// The points of a flat list that lie inside a region.
#[derive(Clone, Debug, Default)]
pub(crate) struct Inside {
    places: [Vec<i32>; 2],
    addresses: Vec<u32>,
    length: usize,
}

impl Inside {
    /// The number of points.
    pub(crate) const fn len(&self) -> usize {
        self.length
    }

    /// The points.
    #[inline(always)]
    pub(crate) fn points(&self) -> impl Iterator<Item = Found> {
        let [xs, ys] = &self.places;
        let (xs, ys) = (&xs[..self.length], &ys[..self.length]);
        let places = xs.iter().zip(ys).map(|(&x, &y)| [x, y]);
        places
            .zip(&self.addresses[..self.length])
            .map(|(place, &address)| Found { place, address })
    }
}
