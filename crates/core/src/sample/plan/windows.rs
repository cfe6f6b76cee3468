//! Windows: parts of a request's points, and the cursors between them.

use alloc::vec::Vec;

use super::Plan;
use crate::{
    sample::{
        lattice::PointId,
        seek::locate_all,
        walk::{Mark, locate_graded},
    },
    window::{Cursor, Window, Windowed},
};

impl Windowed for Plan {
    type Id = PointId;

    fn part(&self) -> Window<PointId> {
        self.window
    }

    fn part_mut(&mut self) -> &mut Window<PointId> {
        &mut self.window
    }

    fn locate(&self, numbers: &[u128]) -> Vec<Option<PointId>> {
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
}

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
        self.window_from(offset, limit)
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
        self.window_at(cursor)
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
        self.first_cursor()
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
        self.cursor_after()
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
        self.clone().split_in(parts)
    }
}
