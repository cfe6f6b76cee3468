//! Windows: parts of a request's points, and the cursors between them.

use alloc::vec::Vec;

use super::Plan;
use crate::sample::{
    cursor::Cursor,
    lattice::PointId,
    seek::locate_all,
    walk::{Mark, Window, locate_graded},
};

/// The most parts that are found together.
const AT_ONCE: u128 = 4096;

impl Plan {
    /// The number of points of the whole request, of which the plan may be a window.
    #[must_use]
    pub const fn total(&self) -> u128 {
        self.window.total
    }

    /// The number of points of the request that come before the plan's.
    #[must_use]
    pub const fn offset(&self) -> u128 {
        self.window.offset
    }

    /// Whether the plan leaves out points of its request.
    #[must_use]
    pub const fn is_window(&self) -> bool {
        self.window.count < self.window.total
    }

    /// The points from number `offset` of this plan on, at most `limit`; none from its end on. The place is
    /// found in O(log) in a box without warp, elsewhere in time proportional to the rows.
    ///
    /// ```
    /// use strew_core::{PointSet, Region, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// // 10¹⁸ points, of which two in the middle are made.
    /// let region = Region::new([-5e8, -5e8], [5e8, 5e8])?;
    /// let plan = PointSet::new(table).within(region)?;
    /// assert_eq!(plan.window(plan.count() / 2, Some(2)).iter().len(), 2);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn window(&self, offset: u128, limit: Option<u128>) -> Self {
        let Window {
            mut start,
            offset: before,
            count,
            total,
        } = self.window;
        let offset = offset.min(count);
        let count = (count - offset).min(limit.unwrap_or(u128::MAX));
        if offset > 0 && count > 0 {
            start = self.locate(before + offset);
        }
        let window = Window {
            start,
            offset: before + offset,
            count,
            total,
        };
        self.with_window(window)
    }

    /// The points of the request from one of its [cursors](Cursor) on, found without counting.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).chunk(20.0, [0, 0])?;
    /// let cursor = plan.window(50, None).cursor().expect("not empty");
    /// assert_eq!(plan.from_cursor(cursor).to_vec(), plan.to_vec()[50..]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn from_cursor(&self, cursor: Cursor) -> Self {
        let total = self.window.total;
        let offset = cursor.offset.min(total);
        self.with_window(Window {
            start: (offset > 0).then_some(cursor.at),
            offset,
            count: total - offset,
            total,
        })
    }

    fn with_window(&self, window: Window) -> Self {
        Self {
            scope: self.scope.clone(),
            window,
            counted: self.counted.clone(),
        }
    }

    /// The lattice address of point number `k` of the request; `None` from its end on.
    fn locate(&self, k: u128) -> Option<PointId> {
        self.locate_all(&[k]).pop().flatten()
    }

    /// The lattice addresses of points of the request of some numbers, which ascend.
    fn locate_all(&self, numbers: &[u128]) -> Vec<Option<PointId>> {
        let Window {
            start,
            offset,
            total,
            ..
        } = self.window;
        if let Some(kept) = &self.counted.kept {
            let id = |&k: &u128| kept.id(usize::try_from(k).ok()?);
            return numbers.iter().map(id).collect();
        }
        if self.scope.lattice.grade.is_none() {
            return locate_all(&self.scope, total, numbers);
        }
        let marks = &self.counted.marks;
        // The window may begin nearer than a mark, and the point that was found last may lie nearer still.
        let mut last = start.map(|at| Mark { at, before: offset });
        let mut locate = |k: u128| {
            if k >= total {
                return None;
            }
            let after = marks.partition_point(|mark| mark.before <= k);
            let mark = after.checked_sub(1).map(|last| marks[last]);
            let own = last.filter(|own| own.before <= k);
            let nearest = [mark, own].into_iter().flatten();
            let at = locate_graded(&self.scope, nearest.max_by_key(|mark| mark.before), k)?;
            last = Some(Mark { at, before: k });
            Some(at)
        };
        numbers.iter().map(|&k| locate(k)).collect()
    }

    /// The windows that begin at some offsets, which ascend, each up to the next, the last one to `end`. Together they
    /// take little longer to find than one of them.
    pub(crate) fn windows(&self, offsets: &[u128], end: u128) -> Vec<Self> {
        let Window {
            start,
            offset: before,
            count,
            total,
        } = self.window;
        let count = end.min(count);
        let inside = |&offset: &u128| offset.min(count);
        let numbers: Vec<u128> = offsets.iter().map(|k| before + inside(k)).collect();
        // The place of an empty window does not matter.
        let sought = numbers.partition_point(|&k| k < before + count);
        let first = numbers.partition_point(|&k| k <= before);
        let found = self.locate_all(&numbers[first.min(sought)..sought]);
        let place = |i: usize| match i.checked_sub(first) {
            Some(i) => found.get(i).copied().flatten(),
            None => start,
        };
        let window = |(i, &offset): (usize, &u128)| {
            let end = numbers.get(i + 1).copied().unwrap_or(before + count);
            self.with_window(Window {
                start: place(i),
                offset,
                count: end.saturating_sub(offset),
                total,
            })
        };
        numbers.iter().enumerate().map(window).collect()
    }

    /// The place of the first point, or `None` if there are no points.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).chunk(20.0, [0, 0])?;
    /// let cursor = plan.window(50, None).cursor().expect("not empty");
    /// assert_eq!((cursor.offset, cursor.at), (50, plan.to_vec()[50].id));
    /// assert_eq!(plan.window(plan.count(), None).cursor(), None);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        let Window {
            start,
            offset,
            count,
            total,
        } = self.window;
        if count == 0 {
            return None;
        }
        let at = start.or_else(|| self.locate(offset))?;
        Some(Cursor { offset, total, at })
    }

    /// The place of the first point of the request after the plan's last, or `None` at the end.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).chunk(20.0, [0, 0])?;
    /// let page = plan.window(0, Some(50));
    /// let next = page.next_cursor().expect("there are more");
    /// assert_eq!(plan.from_cursor(next).offset(), 50);
    /// assert_eq!(plan.next_cursor(), None);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn next_cursor(&self) -> Option<Cursor> {
        let total = self.window.total;
        let offset = self.window.offset + self.window.count;
        let at = self.locate(offset)?;
        Some(Cursor { offset, total, at })
    }

    /// The plan cut into `parts` windows, one after another, whose sizes differ by at most one. 0 parts
    /// count as 1.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).chunk(20.0, [0, 0])?.window(0, Some(10));
    /// let counts: Vec<u128> = plan.split(4).map(|part| part.count()).collect();
    /// assert_eq!(counts, [3, 3, 2, 2]);
    /// let points: Vec<_> = plan.split(4).flatten().collect();
    /// assert!(points.into_iter().eq(plan.iter()));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn split(&self, parts: u32) -> impl Iterator<Item = Self> + use<> {
        let parts = u128::from(parts.max(1));
        let (quotient, rest) = (self.count() / parts, self.count() % parts);
        let start = move |i: u128| i * quotient + i.min(rest);
        let plan = self.clone();
        (0..parts.div_ceil(AT_ONCE)).flat_map(move |batch| {
            let numbers = batch * AT_ONCE..parts.min((batch + 1) * AT_ONCE);
            let end = start(numbers.end);
            let starts: Vec<u128> = numbers.map(start).collect();
            plan.windows(&starts, end)
        })
    }
}
