//! Windows: parts of a request's points, and the cursors between them.

use super::Plan;
use crate::sample::{cursor::Cursor, seek::locate, walk::Window};

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

    /// The points from number `offset` of this plan on, at most `limit`. The place is found in O(log) in a
    /// box without warp, elsewhere in time proportional to the rows.
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
            start = locate(&self.scope, total, before + offset);
        }
        let window = Window {
            start,
            offset: before + offset,
            count,
            total,
        };
        self.with_window(window)
    }

    /// The points from a [cursor](Cursor) of the same request on.
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
        }
    }

    /// The place of the first point, or `None` if there are no points.
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
        let at = start.or_else(|| locate(&self.scope, total, offset))?;
        Some(Cursor { offset, total, at })
    }

    /// The place of the first point of the request after the plan's last, or `None` at the end.
    #[must_use]
    pub fn next_cursor(&self) -> Option<Cursor> {
        let total = self.window.total;
        let offset = self.window.offset + self.window.count;
        let at = locate(&self.scope, total, offset)?;
        Some(Cursor { offset, total, at })
    }

    /// The plan cut into `parts` windows, one after another, whose sizes differ by at most one.
    pub fn split(&self, parts: u32) -> impl Iterator<Item = Self> {
        let parts = u128::from(parts.max(1));
        let start = move |i: u128| {
            let (quotient, rest) = (self.count() / parts, self.count() % parts);
            i * quotient + i.min(rest)
        };
        (0..parts).map(move |i| self.window(start(i), Some(start(i + 1) - start(i))))
    }
}
