//! Windows: parts of a request's points, and the cursors between them.

use super::Plan;
use crate::sample::{
    cursor::Cursor,
    lattice::PointId,
    seek::locate,
    walk::{Mark, Window, locate_graded},
};

impl Plan {
    /// The number of points of the whole request, of which the plan may be a window.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).chunk(20.0, [0, 0])?;
    /// let page = plan.window(50, Some(10));
    /// assert_eq!((page.count(), page.total()), (10, plan.count()));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn total(&self) -> u128 {
        self.window.total
    }

    /// The number of points of the request that come before the plan's.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).chunk(20.0, [0, 0])?;
    /// assert_eq!(plan.offset(), 0);
    /// assert_eq!(plan.window(50, None).window(5, None).offset(), 55);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn offset(&self) -> u128 {
        self.window.offset
    }

    /// Whether the plan leaves out points of its request.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).chunk(20.0, [0, 0])?;
    /// assert!(plan.window(0, Some(10)).is_window());
    /// assert!(!plan.window(0, None).is_window());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
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

    /// The lattice address of point number `k` of the request, if it has as many.
    fn locate(&self, k: u128) -> Option<PointId> {
        let Window {
            start,
            offset,
            total,
            ..
        } = self.window;
        if k >= total {
            return None;
        }
        if let Some(kept) = &self.counted.kept {
            return kept.id(usize::try_from(k).ok()?);
        }
        if self.scope.lattice.grade.is_none() {
            return locate(&self.scope, total, k);
        }
        let marks = &self.counted.marks;
        let after = marks.partition_point(|mark| mark.before <= k);
        let mark = after.checked_sub(1).map(|last| marks[last]);
        // A window may begin nearer.
        let own = start.map(|at| Mark { at, before: offset });
        let own = own.filter(|own| own.before <= k);
        let nearest = [mark, own].into_iter().flatten();
        locate_graded(&self.scope, nearest.max_by_key(|mark| mark.before), k)
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
    pub fn split(&self, parts: u32) -> impl Iterator<Item = Self> {
        let parts = u128::from(parts.max(1));
        let start = move |i: u128| {
            let (quotient, rest) = (self.count() / parts, self.count() % parts);
            i * quotient + i.min(rest)
        };
        (0..parts).map(move |i| self.window(start(i), Some(start(i + 1) - start(i))))
    }
}
