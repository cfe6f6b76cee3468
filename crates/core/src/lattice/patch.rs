//! Bands and patches: pieces of the lattice in which positions fit 32 bits.
//!
//! A band is 1024 columns wide, a patch 256 rows of a band; both lie at multiples of these sizes. With
//! displacements below 128 grid units and the warp's reach, positions relative to the patch's origin,
//! their sums and their differences stay within 2³¹ units of 2⁻²⁰ grid units.
//!
//! The points of a patch are listed flat, row after row without gaps, so that vectors are full however short the rows
//! are.

use alloc::{boxed::Box, vec::Vec};
use core::{iter, ops::Range};

use super::{Columns, Lattice, Span, places};
use crate::{
    batch::{Batch, Offset, pad},
    kernel::{Backend, Listing, WHOLE, retain_parts, warp_all},
    pattern::Axis,
    table::{FRACTION_BITS, fixed},
    warp::{KNOT_BITS, PatchShears},
};

/// The width of a band in lattice columns. Part of the order of points, so of the algorithm version.
pub(crate) const BAND_WIDTH: i64 = 1024;

/// The height of a patch in lattice rows.
pub(crate) const PATCH_HEIGHT: i64 = 256;

/// The columns of a band that lie in a range.
pub(crate) fn clip_to_band(band: i64, columns: &Range<i64>) -> Range<i64> {
    let start = band * BAND_WIDTH;
    columns.start.max(start)..columns.end.min(start + BAND_WIDTH)
}

/// The geometry that all points of a patch share.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    origin: [i64; 2],
    /// The number of rows.
    height: i64,
    /// The region, relative to the origin.
    bounds: [Range<i32>; 2],
    /// Whether all columns are inner ones.
    pub(crate) columns_are_inner: bool,
    shears: Option<Box<PatchShears>>,
    /// The least and the greatest displacement along x.
    reach: [i32; 2],
}

impl Patch {
    /// The patch of a band that contains a row.
    pub(crate) fn new(lattice: &Lattice, band: i64, row: i64, x: &Span, y: &Span) -> Self {
        let reach = [Axis::X, Axis::Y].map(|axis| lattice.table_reach(axis));
        Self::with_reach(lattice, [band, row], [x, y], reach)
    }

    /// The patch of a band that contains a row, with the least and the greatest displacement along x and y.
    pub(crate) fn with_reach(
        lattice: &Lattice,
        [band, row]: [i64; 2],
        [x, y]: [&Span; 2],
        reach: [[i32; 2]; 2],
    ) -> Self {
        let origin = [band * BAND_WIDTH, row & !(PATCH_HEIGHT - 1)];
        Self::at(lattice, (origin, PATCH_HEIGHT), [x, y], reach)
    }

    /// A patch of twice the height, from a row on or some before it.
    pub(crate) fn tall(lattice: &Lattice, [band, row]: [i64; 2], spans: [&Span; 2]) -> Self {
        let origin = [band * BAND_WIDTH, row & !((1 << KNOT_BITS) - 1)];
        let reach = [Axis::X, Axis::Y].map(|axis| lattice.table_reach(axis));
        Self::at(lattice, (origin, 2 * PATCH_HEIGHT), spans, reach)
    }

    fn at(
        lattice: &Lattice,
        (origin, height): ([i64; 2], i64),
        [x, y]: [&Span; 2],
        reach: [[i32; 2]; 2],
    ) -> Self {
        let relative = |span: &Span, origin: i64| {
            // A bound beyond 32 bits is beyond every point of the patch.
            let clamp =
                |k: i128| (k - fixed(origin)).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
            clamp(span.bounds.start)..clamp(span.bounds.end)
        };
        Self {
            origin,
            height,
            bounds: [relative(x, origin[0]), relative(y, origin[1])],
            columns_are_inner: x.inner.start <= origin[0] && origin[0] + BAND_WIDTH <= x.inner.end,
            reach: reach[0],
            shears: lattice.shears.map(|shears| {
                let ranges =
                    [(Axis::X, x, BAND_WIDTH), (Axis::Y, y, height)].map(|(axis, span, length)| {
                        let origin = origin[axis as usize];
                        let [least, most] = reach[axis as usize];
                        let first = span.all.start.clamp(origin, origin + length) - origin;
                        let end = span.all.end.clamp(origin, origin + length) - origin;
                        let fixed = |v: i64| (v << FRACTION_BITS) as i32;
                        [fixed(first) + least, fixed(end - 1) + most]
                    });
                Box::new(PatchShears::new(&shears, origin, ranges))
            }),
        }
    }

    /// The address of the lower left corner.
    pub(crate) const fn origin(&self) -> [i64; 2] {
        self.origin
    }

    /// The first row above the patch.
    pub(crate) const fn end(&self) -> i64 {
        self.origin[1] + self.height
    }

    /// Whether there is a warp.
    pub(crate) const fn is_warped(&self) -> bool {
        self.shears.is_some()
    }

    /// The warp, if there is one.
    pub(crate) fn shears(&self) -> Option<&PatchShears> {
        self.shears.as_deref()
    }

    /// The least and the greatest displacement along x.
    pub(crate) const fn reach(&self) -> [i32; 2] {
        self.reach
    }

    /// The place of a displaced position, both relative to the origin.
    #[inline(always)]
    pub(crate) fn place(&self, displaced: [i32; 2]) -> [i32; 2] {
        let [x, y] = displaced;
        self.shears().map_or(displaced, |shears| shears.apply(x, y))
    }

    /// The least and the greatest movement by the warp of the points of some columns and rows of the patch, which
    /// are not empty, along x and y.
    pub(crate) fn drift(&self, lattice: &Lattice, piece: &[Range<i64>; 2]) -> [[i32; 2]; 2] {
        let (Some(own), Some(shears)) = (self.shears(), &lattice.shears) else {
            return [[0; 2]; 2];
        };
        let ends = [Axis::X, Axis::Y].map(|axis| {
            let range = &piece[axis as usize];
            let [least, most] = lattice.table_reach(axis);
            let relative = |v: i64| self.relative(axis, v);
            [
                relative(range.start) + least,
                relative(range.end - 1) + most,
            ]
        });
        own.drift(shears, ends)
    }

    /// A lattice row or column of the patch, relative to the origin.
    pub(crate) const fn relative(&self, axis: Axis, v: i64) -> i32 {
        ((v - self.origin[axis as usize]) << FRACTION_BITS) as i32
    }

    /// Whether a relative coordinate lies inside the region.
    #[inline(always)]
    pub(crate) fn holds_along(&self, axis: Axis, v: i32) -> bool {
        self.bounds[axis as usize].contains(&v)
    }

    /// The region, relative to the origin.
    pub(crate) const fn bounds(&self) -> &[Range<i32>; 2] {
        &self.bounds
    }

    /// Whether a relative position lies inside the region.
    #[inline(always)]
    pub(crate) fn holds(&self, [x, y]: [i32; 2]) -> bool {
        self.bounds[0].contains(&x) && self.bounds[1].contains(&y)
    }
}

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

/// Converts positions relative to a patch's origin into the coordinates that
/// [`Lattice::world`] reports.
#[derive(Clone, Copy)]
pub(crate) struct Scale {
    base: [f64; 2],
    step: f64,
}

impl Scale {
    pub(crate) fn new(lattice: &Lattice, patch: &Patch) -> Self {
        Self::at(lattice, patch.origin())
    }

    /// The scale of the patch at an origin.
    pub(crate) fn at(lattice: &Lattice, origin: [i64; 2]) -> Self {
        Self {
            base: origin.map(|v| fixed(v) as f64),
            step: lattice.step,
        }
    }

    /// The sum is exact in `f64` while lattice coordinates stay below 2⁵³ units, so it rounds as the
    /// conversion of the whole integer does.
    #[inline(always)]
    pub(crate) fn world(self, position: [i32; 2]) -> [f64; 2] {
        [
            (self.base[0] + f64::from(position[0])) * self.step,
            (self.base[1] + f64::from(position[1])) * self.step,
        ]
    }
}
