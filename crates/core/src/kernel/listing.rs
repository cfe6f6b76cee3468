//! Rows without warp, and the displaced positions of the points of rows, listed one after another.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    Backend,
    backend::run_vectors,
    format::{Emit, Row},
    lanes::{Lanes, VectorLoop},
};
use crate::table::FRACTION_BITS;

/// Lists of points end at a multiple of this, a pair of the widest vectors.
pub(crate) const WHOLE: usize = 32;

/// Columns and rows of a patch as vectors take them: what its points are listed from.
#[derive(Clone, Debug, Default)]
pub(crate) struct Listing {
    /// The columns relative to the patch, and the numbers of their vectors in a row.
    columns: [Vec<i32>; 2],
    /// Every number of a vector is below this.
    vectors: usize,
    rows: Vec<ListedRow>,
    /// The number of points of the rows.
    points: usize,
    /// The greatest number of a first vector and the greatest end of columns of theirs.
    last: usize,
    end: usize,
}

#[derive(Clone, Debug)]
struct ListedRow {
    /// The row relative to the patch.
    row: i32,
    columns: Range<usize>,
    /// The number of the first vector of the row.
    first: usize,
}

impl Listing {
    /// Removes all columns and rows.
    pub(crate) fn clear(&mut self) {
        self.columns.iter_mut().for_each(Vec::clear);
        self.vectors = 0;
        self.restart(0);
    }

    /// Removes all rows, and makes room for some.
    pub(crate) fn restart(&mut self, rows: usize) {
        self.rows.clear();
        self.rows.reserve(rows);
        (self.points, self.last, self.end) = (0, 0, 0);
    }

    /// Replaces the columns by some of four classes, at most `most` of each: class, column, number of the vector. Returns
    /// the places of each class.
    pub(crate) fn set_classes(
        &mut self,
        most: usize,
        all: impl Iterator<Item = (usize, u32, usize)>,
    ) -> [Range<usize>; 4] {
        self.clear();
        let lists = &mut self.columns;
        lists.iter_mut().for_each(|list| list.resize(4 * most, 0));
        let [columns, vectors] = lists.each_mut().map(Vec::as_mut_slice);
        let mut ends = [0, most, 2 * most, 3 * most];
        for (class, column, vector) in all {
            let end = &mut ends[class];
            columns[*end] = column as i32;
            vectors[*end] = vector as i32;
            self.vectors = self.vectors.max(vector + 1);
            *end += 1;
        }
        [0, 1, 2, 3].map(|class| class * most..ends[class])
    }

    /// The places of those of some columns, which ascend, that lie in a range.
    pub(crate) fn between(&self, columns: Range<usize>, range: Range<i64>) -> Range<usize> {
        let all = &self.columns[0][columns.clone()];
        let [start, end] = [range.start, range.end]
            .map(|end| columns.start + all.partition_point(|&column| i64::from(column) < end));
        start..end.max(start)
    }

    /// Adds columns with the numbers of their vectors. Returns their places.
    pub(crate) fn add(&mut self, all: impl Iterator<Item = [u32; 2]>) -> Range<usize> {
        let [columns, vectors] = &mut self.columns;
        let start = columns.len();
        for [column, vector] in all {
            columns.push(column as i32);
            vectors.push(vector as i32);
            self.vectors = self.vectors.max(vector as usize + 1);
        }
        start..columns.len()
    }

    /// Adds a row with points in some columns, whose vectors are those from number `first` on.
    pub(crate) fn add_row(&mut self, row: i32, columns: Range<usize>, first: usize) {
        self.points += columns.len();
        self.last = self.last.max(first);
        self.end = self.end.max(columns.end).max(columns.start);
        self.rows.push(ListedRow {
            row,
            columns,
            first,
        });
    }

    /// The number of points of the rows.
    pub(crate) const fn len(&self) -> usize {
        self.points
    }

    /// Adds the points to lists of their x, y and addresses.
    pub(crate) fn write(
        &self,
        backend: Backend,
        vectors: &[[i32; 2]],
        mut lists: [&mut Vec<i32>; 3],
    ) {
        let room = self.points.next_multiple_of(WHOLE);
        lists.iter_mut().for_each(|list| list.reserve(room));
        assert!(self.last + self.vectors.max(1) <= vectors.len());
        assert!(self.columns.iter().all(|list| self.end <= list.len()));
        let mut rows = Rows {
            listing: self,
            vectors,
            lists,
        };
        if run_vectors(backend, &mut rows) == 0 {
            rows.write();
        }
    }
}

/// The rows of a listing, and lists with room for their points. All columns have vectors in all rows.
struct Rows<'a> {
    listing: &'a Listing,
    vectors: &'a [[i32; 2]],
    lists: [&'a mut Vec<i32>; 3],
}

impl Rows<'_> {
    fn write(&mut self) {
        let [columns, places] = &self.listing.columns;
        let [xs, ys, ids] = &mut self.lists;
        for row in &self.listing.rows {
            for i in row.columns.clone() {
                let [dx, dy] = self.vectors[row.first + places[i] as usize];
                xs.push((columns[i] << FRACTION_BITS) + dx);
                ys.push((row.row << FRACTION_BITS) + dy);
                ids.push(row.row << 16 | columns[i]);
            }
        }
    }
}

impl VectorLoop for Rows<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let columns = self.listing.columns.each_ref().map(|list| list.as_ptr());
        // SAFETY: the machine has the instructions. Rows have columns that are there and vectors of two numbers, as
        // `write` has seen. The lists have room for all points, and those of a row are all written: in vectors, the last
        // of which goes back over those before, or one by one.
        unsafe {
            let mut ends = self
                .lists
                .each_mut()
                .map(|list| list.as_mut_ptr().add(list.len()));
            for row in &self.listing.rows {
                let length = row.columns.len();
                let [columns, places] = columns.map(|list| list.add(row.columns.start));
                let [to_x, to_y, to_id] = ends;
                let vectors: *const i32 = self.vectors.as_ptr().add(row.first).cast();
                let (y, first) = (row.row << FRACTION_BITS, row.row << 16);
                if length < L::WIDTH {
                    for i in 0..length {
                        let vector = vectors.add(2 * *places.add(i) as usize);
                        *to_x.add(i) = (*columns.add(i) << FRACTION_BITS) + *vector;
                        *to_y.add(i) = y + *vector.add(1);
                        *to_id.add(i) = first | *columns.add(i);
                    }
                }
                let (y, first) = (L::splat_int(y), L::splat_int(first));
                let mut i = 0;
                while i < length && length >= L::WIDTH {
                    i = i.min(length - L::WIDTH);
                    let place = L::load_ints(places.add(i));
                    let place = L::add_ints(place, place);
                    let [dx, dy] =
                        [vectors, vectors.add(1)].map(|from| L::gather(from.cast(), place));
                    let column = L::load_ints(columns.add(i));
                    L::store_ints(to_x.add(i), L::add_ints(L::fixed(column), L::bits_of(dx)));
                    L::store_ints(to_y.add(i), L::add_ints(y, L::bits_of(dy)));
                    L::store_ints(to_id.add(i), L::add_ints(first, column));
                    i += L::WIDTH;
                }
                ends = ends.map(|end| end.add(length));
            }
            for list in &mut self.lists {
                list.set_len(list.len() + self.listing.points);
            }
        }
        1
    }
}

/// The starts of vectors that cover `length` items, or none if there are fewer than fill a vector. The
/// last vector goes back over items that are already written.
#[inline(always)]
pub(super) fn vector_starts<L: Lanes>(length: usize) -> impl Iterator<Item = usize> {
    let last = length.checked_sub(L::WIDTH);
    let ends = last.map_or(0, |_| length);
    (0..ends)
        .step_by(L::WIDTH)
        .map(move |i| i.min(last.unwrap_or(0)))
}

/// Writes one item per column by plain code: the definition.
#[inline(always)]
pub(super) fn emit<F: Emit>(
    format: &F,
    row: Row,
    columns: &[F::Column],
    displacements: &[i32],
    out: &mut [F::Item],
) {
    for ((item, &column), &displacement) in out.iter_mut().zip(columns).zip(displacements) {
        *item = format.item(row.base, column, row.y + displacement, row.lattice);
    }
}

/// Writes one item per column of a row, up to the end of the shortest slice.
#[inline]
pub(crate) fn fill_row<F: Emit>(
    format: &F,
    backend: Backend,
    row: Row,
    columns: &[F::Column],
    displacements: &[i32],
    out: &mut [F::Item],
) {
    let mut plain = PlainRow {
        format,
        row,
        columns,
        displacements,
        out,
    };
    if run_vectors(backend, &mut plain) == 0 {
        emit(format, row, columns, displacements, plain.out);
    }
}

struct PlainRow<'a, F: Emit> {
    format: &'a F,
    row: Row,
    columns: &'a [F::Column],
    displacements: &'a [i32],
    out: &'a mut [F::Item],
}

impl<F: Emit> VectorLoop for PlainRow<'_, F> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(&mut self) -> usize {
        let (columns, displacements) = (self.columns, self.displacements);
        // SAFETY: as the caller ensures.
        unsafe {
            self.format
                .vector_row::<L>(self.row, columns, displacements, self.out)
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::{vec, vec::Vec};

    use super::*;

    #[test]
    fn rows_have_the_same_points_by_all_backends() {
        let vectors: Vec<[i32; 2]> = (0..60).map(|i| [i * 7919, i * -104_729]).collect();
        let mut listing = Listing::default();
        let columns = (0..100).map(|c| (c as usize % 4, 3 * c, c as usize * 7 % 20));
        let classes = listing.set_classes(25, columns);
        let more = listing.add((0..9).map(|c| [c, c]));
        listing.restart(0);
        let rows = [(0, classes[1].clone(), 20), (7, 5..5, 0), (9, more, 40)];
        for (row, columns, first) in rows.into_iter().chain([(255, classes[3].clone(), 0)]) {
            listing.add_row(row, columns, first);
        }
        assert_eq!(listing.len(), 59);
        let listed = |backend| {
            let mut lists = [vec![1], vec![2], vec![3]];
            listing.write(backend, &vectors, lists.each_mut());
            lists
        };
        let [xs, ys, ids] = listed(Backend::Scalar);
        // The second point: column 15 with vector 20 + 5 · 7 % 20.
        let place = [(15 << FRACTION_BITS) + 35 * 7919, 35 * -104_729, 15];
        assert_eq!([xs[2], ys[2], ids[2]], place);
        for backend in Backend::available() {
            assert_eq!(
                listed(backend),
                [xs.clone(), ys.clone(), ids.clone()],
                "{backend:?}"
            );
        }
    }
}
