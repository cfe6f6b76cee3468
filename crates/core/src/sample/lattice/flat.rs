//! Flat lists of the points of a patch: row after row without gaps, so that vectors are full however short
//! the rows are.

use alloc::vec::Vec;
use core::{iter, ops::Range};

use super::{Columns, Lattice, Patch, places};
use crate::{
    batch::{Batch, Offset, pad},
    pattern::Axis,
    sample::kernel::{Backend, Listing, WHOLE, retain_parts, warp_all},
    table::FRACTION_BITS,
};

/// Lists the points of patches that lie inside a region, some rows at a time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Flat {
    /// The points that were listed last.
    pub(crate) found: Batch<2, i32>,
    listing: Listing,
    /// The columns that were listed last: their range, and the places of each class.
    listed: (Range<i64>, [Range<usize>; 4]),
    /// The same in a set without all points, where rows have different ones.
    columns: Columns,
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
        let address = (row as u32) << 16 | column as u32;
        Self { place, address }
    }

    /// The same point relative to an origin some rows lower.
    #[inline(always)]
    pub(crate) const fn lifted(self, rows: i32) -> Self {
        let [x, y] = self.place;
        Self {
            place: [x, y + (rows << FRACTION_BITS)],
            address: self.address.wrapping_add((rows << 16) as u32),
        }
    }

    /// The column and the row, relative to the patch.
    #[inline(always)]
    pub(crate) fn address(self) -> [i64; 2] {
        (self.address as i32).offset()
    }
}

impl Flat {
    /// Lists rows as [`list`](Self::list) does, and not their points yet.
    fn list_rows(
        &mut self,
        (lattice, patch): (&Lattice, &Patch),
        [range, part]: [&Range<i64>; 2],
        rows: Range<i64>,
        enough: usize,
    ) -> i64 {
        let [left, bottom] = patch.origin();
        if self.listed.0 != *range {
            self.list_columns(lattice, range, left);
        }
        let listing = &mut self.listing;
        let has_all = lattice.has_all();
        let mut all = self.listed.1.clone();
        if !has_all {
            listing.clear();
        } else if part != range {
            let [start, end] = [part.start, part.end].map(|at| at - left);
            all = all.map(|class| listing.between(class, start..end));
        }
        listing.restart(length(&rows));
        let mut next = rows.end;
        for y in rows {
            if listing.len() >= enough {
                next = y;
                break;
            }
            let Some((class, block)) = lattice.row(y) else {
                continue;
            };
            let columns = if has_all {
                all[class.ordinal()].clone()
            } else {
                let columns = self.columns.of_row(lattice, class, block);
                let columns = columns[places(columns, part)].iter();
                listing.add(columns.map(|line| [(line.at - left) as u32, line.block]))
            };
            let first = block * lattice.map().intervals();
            listing.add_row((y - bottom) as i32, columns, first);
        }
        next
    }

    /// The number of all points of a patch in a part of a range of columns and in some rows.
    pub(crate) fn count(
        &mut self,
        of: (&Lattice, &Patch),
        columns: [&Range<i64>; 2],
        rows: Range<i64>,
    ) -> usize {
        self.list_rows(of, columns, rows, usize::MAX);
        self.listing.len()
    }

    /// Lists the points of a patch in a part of a range of columns that lie inside, from row `rows.start` on, until there
    /// are at least `enough` candidates or the rows end. Returns the first row that is not listed. All patches have one
    /// lattice; those of a range share its columns.
    pub(crate) fn list(
        &mut self,
        (lattice, patch): (&Lattice, &Patch),
        columns: [&Range<i64>; 2],
        rows: Range<i64>,
        enough: usize,
        backend: Backend,
    ) -> i64 {
        let next = self.list_rows((lattice, patch), columns, rows, enough);
        let (found, listing) = (&mut self.found, &self.listing);
        found.restart(patch.origin());
        let ([xs, ys], ids) = (&mut found.places, &mut found.ids);
        listing.write(backend, lattice.turned.vectors(), [xs, ys, ids]);
        let length = found.len();
        found.pad(WHOLE);
        pad(&mut found.ids, WHOLE);
        let Batch { places, ids, .. } = found;
        if let Some(shears) = patch.shears() {
            warp_all(backend, shears, places.each_mut().map(Vec::as_mut_slice));
        }
        let [xs, ys] = places;
        let all = iter::once(0..length);
        match retain_parts(backend, [xs, ys, ids], all, patch.bounds()) {
            Some(kept) => self.found.truncate(kept),
            None => {
                self.found.truncate(length);
                self.found.retain(|place| patch.holds(place));
            }
        }
        next
    }

    /// Lists the columns of a range.
    fn list_columns(&mut self, lattice: &Lattice, range: &Range<i64>, left: i64) {
        self.listed = (range.clone(), Default::default());
        if !lattice.has_all() {
            self.columns.list(lattice, range.clone());
            return;
        }
        let visit = |at: i64| {
            let (class, index) = lattice.pattern.visit(Axis::X, at)?;
            let block = lattice.map().locate(index);
            Some((class.ordinal(), (at - left) as u32, block))
        };
        // Every other column has one parity.
        let most = length(range) / 2 + 1;
        let columns = range.clone().filter_map(visit);
        self.listed.1 = self.listing.set_classes(most, columns);
    }
}

/// The length of a range of rows or columns.
fn length(range: &Range<i64>) -> usize {
    usize::try_from(range.end - range.start).unwrap_or(0)
}

impl Batch<2, i32> {
    /// Adds a point.
    pub(crate) fn push(&mut self, Found { place, address }: Found) {
        for (list, v) in self.places.iter_mut().zip(place) {
            list.push(v);
        }
        self.ids.push(address as i32);
    }

    /// Some of the points.
    #[inline(always)]
    pub(crate) fn points(&self, range: Range<usize>) -> impl Iterator<Item = Found> {
        let [xs, ys] = self.places.each_ref().map(|list| &list[range.clone()]);
        let places = xs.iter().zip(ys).map(|(&x, &y)| [x, y]);
        let found = |(place, &id): (_, &i32)| Found {
            place,
            address: id as u32,
        };
        places.zip(&self.ids[range]).map(found)
    }
}
