//! Windows: parts of a request's points, and the cursors between them. What a plan of the plane, one in space and a
//! period have in common.

use alloc::vec::Vec;

use crate::lattice::PointId;

/// A place in the order of a request's points. [`PointSet::resume`](crate::PointSet::resume) finds the
/// points from there on without counting.
///
/// It belongs to one request. With another one, the points of that from the lattice address on are found,
/// with the numbers of the cursor.
///
/// ```
/// use strew_core::{Cursor, PointId, PointSet, Region, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let (set, region) = (PointSet::new(table), Region::chunk(20.0, [0, 0])?);
/// let plan = set.within(region)?;
/// let cursor = plan.window(0, Some(100)).next_cursor().expect("there are more");
/// // Its parts can be sent to a client and come back with the next request.
/// let Cursor { offset, total, at: PointId { x, y } } = cursor;
/// assert_eq!((offset, total), (100, plan.count()));
/// let back = Cursor { offset, total, at: PointId { x, y } };
/// assert_eq!(set.resume(region, back)?.to_vec(), plan.to_vec()[100..]);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cursor<Id = PointId> {
    /// The number of points before the place.
    pub offset: u128,
    /// The number of points of the request.
    pub total: u128,
    /// The lattice address of the next point.
    pub at: Id,
}

/// A part of the points of a request: from a place on, up to a number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window<Id> {
    /// The lattice address of the first point, unless that is the request's first.
    pub(crate) start: Option<Id>,
    /// The number of points before the window.
    pub(crate) offset: u128,
    /// The number of points of the window.
    pub(crate) count: u128,
    /// The number of points of the request.
    pub(crate) total: u128,
}

impl<Id> Window<Id> {
    /// All of a request.
    pub(crate) const fn whole(total: u128) -> Self {
        Self {
            start: None,
            offset: 0,
            count: total,
            total,
        }
    }
}

/// The most parts that are found together.
const AT_ONCE: u128 = 4096;

/// A request made ready, of whose points any part can be taken.
pub(crate) trait Windowed: Clone {
    type Id: Copy;

    fn part(&self) -> Window<Self::Id>;
    fn part_mut(&mut self) -> &mut Window<Self::Id>;
    /// The lattice addresses of points of the request, which ascend and are below its total.
    fn locate(&self, numbers: &[u128]) -> Vec<Option<Self::Id>>;

    fn with_part(&self, part: Window<Self::Id>) -> Self {
        let mut other = self.clone();
        *other.part_mut() = part;
        other
    }

    fn locate_one(&self, number: u128) -> Option<Self::Id> {
        let is_inside = number < self.part().total;
        is_inside.then(|| self.locate(&[number]).pop().flatten())?
    }

    /// The points from number `offset` of the part on, at most `limit`.
    fn window_from(&self, offset: u128, limit: Option<u128>) -> Self {
        let part = self.part();
        let offset = offset.min(part.count);
        let count = (part.count - offset).min(limit.unwrap_or(u128::MAX));
        self.with_part(Window {
            start: match offset {
                0 => part.start,
                _ => self.locate_one(part.offset + offset),
            },
            offset: part.offset + offset,
            count,
            total: part.total,
        })
    }

    /// The points of the request from a cursor on, found without counting.
    fn window_at(&self, cursor: Cursor<Self::Id>) -> Self {
        let total = self.part().total;
        let offset = cursor.offset.min(total);
        self.with_part(Window {
            start: (offset > 0).then_some(cursor.at),
            offset,
            count: total - offset,
            total,
        })
    }

    /// The windows that begin at some offsets, which ascend, each up to the next, the last one to `end`. Together they
    /// take little longer to find than one of them.
    fn windows_at(&self, offsets: &[u128], end: u128) -> Vec<Self> {
        let part = self.part();
        let end = end.min(part.count);
        // The place of an empty window does not matter.
        let sought = &offsets[..offsets.partition_point(|&k| k < end)];
        let first = sought.partition_point(|&k| k == 0);
        let numbers: Vec<u128> = sought[first..].iter().map(|k| part.offset + k).collect();
        let mut places = self.locate(&numbers).into_iter();
        let window = |(i, &offset): (usize, &u128)| {
            let offset = offset.min(end);
            let next = offsets.get(i + 1).map_or(end, |&next| next.min(end));
            self.with_part(Window {
                start: match i < first {
                    true => part.start,
                    false => places.next().flatten(),
                },
                offset: part.offset + offset,
                count: next - offset,
                total: part.total,
            })
        };
        offsets.iter().enumerate().map(window).collect()
    }

    /// Windows one after another, whose sizes differ by at most one.
    fn split_in(self, parts: u32) -> impl Iterator<Item = Self> {
        let parts = u128::from(parts.max(1));
        let (quotient, rest) = (self.part().count / parts, self.part().count % parts);
        let start = move |i: u128| i * quotient + i.min(rest);
        (0..parts.div_ceil(AT_ONCE)).flat_map(move |batch| {
            let numbers = batch * AT_ONCE..parts.min((batch + 1) * AT_ONCE);
            let end = start(numbers.end);
            let starts: Vec<u128> = numbers.map(start).collect();
            self.windows_at(&starts, end)
        })
    }

    /// The places of the points of some numbers, which ascend; `None` from the part's end on.
    fn cursors_at(&self, numbers: &[u128]) -> Vec<Option<Cursor<Self::Id>>> {
        let Window {
            start,
            offset,
            count,
            total,
        } = self.part();
        let inside = &numbers[..numbers.partition_point(|&k| k < count)];
        // The place of the first point may be known.
        let first = start.map_or(0, |_| inside.partition_point(|&k| k == 0));
        let sought: Vec<u128> = inside[first..].iter().map(|k| offset + k).collect();
        let places = core::iter::repeat_n(start, first).chain(self.locate(&sought));
        let cursor = |(k, at): (&u128, Option<Self::Id>)| {
            let (offset, at) = (offset + k, at?);
            Some(Cursor { offset, total, at })
        };
        let mut cursors: Vec<_> = inside.iter().zip(places).map(cursor).collect();
        cursors.resize_with(numbers.len(), || None);
        cursors
    }

    /// The place of the first point.
    fn first_cursor(&self) -> Option<Cursor<Self::Id>> {
        let part = self.part();
        let at = part.start.or_else(|| self.locate_one(part.offset));
        let (offset, total) = (part.offset, part.total);
        let at = at.filter(|_| part.count > 0)?;
        Some(Cursor { offset, total, at })
    }

    /// The place of the first point of the request after the part's last.
    fn cursor_after(&self) -> Option<Cursor<Self::Id>> {
        let Window {
            offset,
            count,
            total,
            ..
        } = self.part();
        let offset = offset + count;
        let at = self.locate_one(offset)?;
        Some(Cursor { offset, total, at })
    }
}
